// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "cli/command.hpp"
#include "cli/text.hpp"

namespace sphstab::cli {
namespace {

ExitStatus status(const Json& answer) { return answer["agrees"].get<bool>() ? done : claim_fails; }

std::string agreement(const Json& answer) {
  return row("relative difference",
             fmt::format("{} (tolerance {:g}): {}", number_or(answer["relative_difference"], "-", 2),
                         answer["tolerance"].get<double>(), status(answer) == done ? "agrees" : "DOES NOT AGREE"));
}

std::string effort(const Json& answer) {
  return row("effort", fmt::format("{} runs, {} steps, horizon {}; growth below {:.2g} per step is not seen",
                                   answer["runs"].get<int>(), answer["steps"].get<long>(),
                                   answer["horizon"].get<long>(), answer["smallest_detectable_growth"].get<double>()));
}

std::string bracket(const Json& ends) {
  if (ends[1].is_null()) return fmt::format("nothing grew up to {}", number_or(ends[0], "0"));
  if (ends[0].get<double>() == 0.0) return fmt::format("everything grew down to {}", number_or(ends[1], ""));
  return fmt::format("{} (bounded) to {} (growing)", number_or(ends[0], ""), number_or(ends[1], ""));
}

/// Where theory says that every step grows.
std::string describe_growth(const Json& answer) {
  const Json& growth = answer["growth"];
  std::string text = fmt::format("Growth by running the solver on {}, where no step is stable\n", subject(answer));
  text += row(
      "every step grows",
      answer.contains("theory_growth_rate")
          ? fmt::format("at the rate {:.6g} in continuous time, by theory", answer["theory_growth_rate"].get<double>())
          : "weakly, by its integrator alone; with steps small enough as slowly as you like");
  text += row("at the step", fmt::format("{:.6g}", growth["time_step"].get<double>()));
  text += row("growth per step, run", fmt::format("{:.8g}", growth["measured"].get<double>()));
  text += row("theory, same body", fmt::format("{:.8g}", growth["theory"].get<double>()));
  return text + agreement(answer) + effort(answer);
}

std::string describe_step(const Json& answer) {
  std::string text = fmt::format("Critical time step by running the solver on {}\n", subject(answer));
  text += row("by running", number_or(answer["critical_time_step"], "none found"));
  text += row("bracket", bracket(answer["bracket"]));
  text += row("theory, same body", number_or(answer["theory"], "none"));
  text += agreement(answer);
  text += row("theory, bulk", number_or(answer["bulk_theory"], "none"));
  text += row("body/bulk - 1", number_or(answer["patch_deficit"], "-", 4));
  return text + effort(answer);
}

std::string describe(const Json& answer) {
  return answer.contains("growth") ? describe_growth(answer) : describe_step(answer);
}

}  // namespace

CaseCommand bisect_command() {
  return {"bisect",
          "the critical time step found by running the solver (or --command), beside theory",
          {KeyGroup::discretisation, KeyGroup::material, KeyGroup::scheme, KeyGroup::artificial_stress, KeyGroup::body,
           KeyGroup::noise, KeyGroup::search},
          study::bisection_answer,
          describe,
          status};
}

}  // namespace sphstab::cli
