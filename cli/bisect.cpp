// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "cli/command.hpp"
#include "cli/text.hpp"

namespace sphstab::cli {
namespace {

ExitStatus status(const Json& answer) { return answer["agrees"].get<bool>() ? done : claim_fails; }

std::string describe(const Json& answer) {
  std::string text = fmt::format("Critical time step by running the solver on {}\n", subject(answer));
  text += row("by running", number_or(answer["critical_time_step"], "none found"));
  text += row("bracket", fmt::format("{} (bounded) to {} (growing)", number_or(answer["bracket"][0], "0"),
                                     number_or(answer["bracket"][1], "infinity")));
  text += row("theory, same body",
              number_or(answer["theory"], answer.contains("theory_growth_rate") ? "every step grows" : "none"));
  text += row("relative difference",
              fmt::format("{} (tolerance {:g}): {}", number_or(answer["relative_difference"], "-", 2),
                          answer["tolerance"].get<double>(), status(answer) == done ? "agrees" : "DOES NOT AGREE"));
  text += row("theory, bulk", number_or(answer["bulk_theory"], "none"));
  text += row("body/bulk - 1", number_or(answer["patch_deficit"], "-", 4));
  return text +
         row("effort", fmt::format("{} runs, {} steps, horizon {}; growth below {:.2g} per step is not seen",
                                   answer["runs"].get<int>(), answer["steps"].get<long>(),
                                   answer["horizon"].get<long>(), answer["smallest_detectable_growth"].get<double>()));
}

}  // namespace

CaseCommand bisect_command() {
  return {"bisect",
          "the critical time step found by running the solver (or --command), beside theory",
          {KeyGroup::discretisation, KeyGroup::material, KeyGroup::scheme, KeyGroup::artificial_stress, KeyGroup::body,
           KeyGroup::patch, KeyGroup::search},
          study::bisection_answer,
          describe,
          status};
}

}  // namespace sphstab::cli
