// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "cli/command.hpp"
#include "cli/text.hpp"

namespace sphstab::cli {
namespace {

ExitStatus status(const Json& answer) { return answer["unstable"].get<bool>() ? run_unstable : done; }

std::string number(const Json& answer, const char* key, int digits = 8) { return number_or(answer[key], "-", digits); }

std::string describe(const Json& answer) {
  std::string text = fmt::format("Run of {}, {} particles\n", subject(answer), answer["particles"].get<int>());
  text += row("time step", fmt::format("{}, {:.4g} of the critical step {}", number(answer, "time_step"),
                                       answer["time_step"].get<double>() / answer["critical_time_step"].get<double>(),
                                       number(answer, "critical_time_step")));
  text += row("simulated", fmt::format("{} in {} steps", number(answer, "time"), answer["steps"].get<long>()));
  if (answer.contains("failure"))
    text +=
        row("UNSTABLE",
            fmt::format("the {} of particle {} is no number at step {}", answer["failure"]["field"].get<std::string>(),
                        answer["failure"]["particle"].get<int>(), answer["failure"]["step"].get<long>()));
  else if (answer["unstable"].get<bool>())
    text += row("UNSTABLE", "the energy is more than a thousand times the work of the loads");
  text += row("displacement, at most", number(answer, "largest_displacement"));
  text += row("velocity, at most", number(answer, "largest_velocity"));
  text += row("von Mises, at most", number(answer, "largest_von_mises_stress"));
  text += row("energy at the end",
              fmt::format("kinetic {}, strain {}, work of the loads {}", number(answer, "kinetic_energy", 6),
                          number(answer, "strain_energy", 6), number(answer, "work", 6)));
  for (const auto& [name, probe] : answer["probes"].items())
    text += row(name, fmt::format("displacement ({}), velocity ({})", numbers(probe["displacement"], 6),
                                  numbers(probe["velocity"], 6)));
  return text;
}

}  // namespace

CaseCommand run_command() {
  return {.name = "run",
          .summary = "run a scene and store its states, pictures and probes",
          .groups = {KeyGroup::discretisation, KeyGroup::material, KeyGroup::scheme, KeyGroup::artificial_stress,
                     KeyGroup::body, KeyGroup::patch, KeyGroup::time, KeyGroup::run},
          .answer = study::run_answer,
          .describe = describe,
          .status = status,
          .has_files = true};
}

}  // namespace sphstab::cli
