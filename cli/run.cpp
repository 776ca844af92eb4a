// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "cli/command.hpp"
#include "cli/text.hpp"

namespace sphstab::cli {
namespace {

ExitStatus status(const Json& answer) { return answer["unstable"].get<bool>() ? run_unstable : done; }

std::string number(const Json& answer, const char* key, int digits = 8) { return number_or(answer[key], "-", digits); }

std::string time_step_row(const Json& answer) {
  if (answer["critical_time_step"].is_null())
    return row("time step", number(answer, "time_step") + "; there is no critical step");
  const double fraction = answer["time_step"].get<double>() / answer["critical_time_step"].get<double>();
  return row("time step", fmt::format("{}, {:.4g} of the critical step {}", number(answer, "time_step"), fraction,
                                      number(answer, "critical_time_step"))) +
         (fraction > 1.0 ? row("WARNING", "the time step is above the critical one: the fastest modes grow") : "");
}

/// What a run that went wrong lost or gained.
std::string loss(const Json& answer) {
  if (answer.contains("failure")) {
    const Json& failure = answer["failure"];
    const auto field = failure["field"].get<std::string>();
    const std::string lost =
        fmt::format("the {} of particle {} is no {}number at step {}", field, failure["particle"].get<int>(),
                    field == "density" ? "positive " : "", failure["step"].get<long>());
    return failure.contains("term")
               ? fmt::format("{}; the first term to break: {}", lost, failure["term"].get<std::string>())
               : lost;
  }
  if (const long lost = answer["lost_particles"].get<long>(); lost > 0)
    return fmt::format("particles that have lost all their neighbours: {}", lost);
  if (answer.contains("growth") && answer["growth"].contains("step"))
    return fmt::format(
        "there is more energy than the start and the loads gave, or ellipticity is lost for long, at step {}",
        answer["growth"]["step"].get<long>());
  return "the energy is more than a thousand times what the start and the loads gave";
}

/// Whether the run went wrong, how, and why.
std::string unstable_row(const Json& answer) {
  if (!answer["unstable"].get<bool>()) return "";
  const bool has_cause =
      answer.contains("growth") && (answer["growth"].contains("step") || answer["growth"]["cause"] != "unknown");
  return row("UNSTABLE", loss(answer)) +
         (has_cause ? row("cause", answer["growth"]["cause"].get<std::string>()) : std::string());
}

std::string describe(const Json& answer) {
  std::string text = fmt::format("Run of {}: {} particles\n", subject(answer), answer["particles"].get<int>());
  text += time_step_row(answer);
  text += row("critical step of", answer["critical_time_step_of"].get<std::string>());
  if (answer.contains("followed")) {
    const Json& followed = answer["followed"];
    text += row("followed", fmt::format("steps from {} to {}; {} updates took {:.2g} % of the CPU time",
                                        number(followed, "smallest_time_step"), number(followed, "largest_time_step"),
                                        followed["updates"].get<long>(), 100.0 * followed["cost_share"].get<double>()));
  }
  if (answer.contains("note")) text += row("note", answer["note"].get<std::string>());
  if (answer.contains("predicted_growth_e_foldings"))
    text += row("WARNING", fmt::format("at this step theory predicts {} e-foldings of the fastest mode",
                                       number(answer, "predicted_growth_e_foldings", 3)));
  if (answer.contains("critical_time_step_at_end"))
    text += row("critical at the end", number(answer, "critical_time_step_at_end"));
  text += row("simulated", fmt::format("{} in {} steps", number(answer, "time"), answer["steps"].get<long>()));
  text += unstable_row(answer);
  text += row("displacement, at most", number(answer, "largest_displacement"));
  text += row("velocity, at most", number(answer, "largest_velocity"));
  text += row("von Mises, at most", number(answer, "largest_von_mises_stress"));
  text += row("energy at the start", number(answer, "initial_energy", 6));
  text += row("energy at the end",
              fmt::format("kinetic {}, strain {}, work of the loads {}", number(answer, "kinetic_energy", 6),
                          number(answer, "strain_energy", 6), number(answer, "work", 6)));
  if (!answer["momentum_drift"].is_null()) text += row("momentum drift", number(answer, "momentum_drift", 2));
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
                     KeyGroup::body, KeyGroup::noise, KeyGroup::time, KeyGroup::run},
          .answer = study::run_answer,
          .describe = describe,
          .status = status,
          .has_files = true};
}

}  // namespace sphstab::cli
