// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "cli/command.hpp"
#include "cli/text.hpp"
#include "study/explanation.hpp"

namespace sphstab::cli {
namespace {

std::string describe_law(const Json& law) {
  return fmt::format(
      "{:.6g} dt^{} for short steps; steps or tolerated_growth_per_step ask for the largest that you bear",
      law["coefficient"].get<double>(), law["exponent"].get<int>());
}

std::string describe_limit(const Json& answer) {
  const std::string verdict = answer["verdict"];
  if (verdict == "unconditionally-stable") return "  every time step is stable: no mode has a restoring force\n";
  const Json& mode = answer["critical_mode"];
  const std::string wave =
      fmt::format("k = ({}), {}", numbers(mode["wave_vector"], 6), mode["branch"].get<std::string>());
  if (verdict == "never-stable")
    return row("verdict", "never stable: the base state grows at every time step") +
           row("growth rate", fmt::format("{:.8g} per time", answer["growth_rate"].get<double>())) +
           row("fastest mode", wave) + ellipticity_row(answer);
  if (verdict == "weakly-unstable")
    return row("verdict", "weakly unstable: nothing grows in continuous time, yet every time step makes it grow") +
           row("growth per step", describe_law(answer["growth_law"])) +
           row("fastest mode", fmt::format("{}, omega = {:.8g}", wave, mode["omega"].get<double>()));
  return row("critical time step", fmt::format("{:.12g}", answer["critical_time_step"].get<double>())) +
         row(answer["bracket_kind"] == "certified" ? "certified between" : "found between",
             fmt::format("{:.17g} and {:.17g}", answer["bracket"][0].get<double>(),
                         answer["bracket"][1].get<double>())) +
         row("verdict", "conditionally stable") +
         row("critical mode", fmt::format("{}, omega = {:.8g}", wave, mode["omega"].get<double>())) +
         ellipticity_row(answer);
}

std::string describe_bound(const Json& bound) {
  return row("published bound",
             fmt::format("{:.8g} ({}): {}", bound["value"].get<double>(), bound["source"].get<std::string>(),
                         bound["holds"].get<bool>() ? "safe here, and conservative" : "UNSAFE here"));
}

std::string describe_equivalents(const Json& equivalents) {
  std::string text = "\nThe limit as the factor of other codes' rules (time step = factor x unit):\n";
  for (const Json& rule : equivalents) {
    const Json& given = rule["default"];
    const std::string verdict = given.is_null() ? "no default"
                                : rule["default_is_safe"].get<bool>()
                                    ? fmt::format("default {} is safe in bulk", given.dump())
                                    : fmt::format("default {} is UNSAFE", given.dump());
    text += fmt::format("  {:<32} {:<34} {:>8.4f}  {}\n", rule["rule"].get<std::string>(),
                        rule["formula"].get<std::string>(), rule["factor_at_limit"].get<double>(), verdict);
  }
  return text;
}

std::string describe_zero_energy(const Json& answer) {
  const Json& modes = answer["zero_energy_modes"];
  const bool stressed = answer.value("stressed", false);
  std::string text =
      fmt::format("\nZero-energy modes ({}): {}{}\n",
                  stressed ? "no change of stress resists them; the present stress alone decides whether they grow"
                           : "no time step removes them; they drift, they do not grow",
                  modes.size(), answer["zero_energy_modes_complete"].get<bool>() ? "" : " or more");
  constexpr std::size_t shown = 8;
  for (std::size_t i = 0; i < std::min(shown, modes.size()); ++i)
    text += fmt::format("  k = ({})\n", numbers(modes[i], 6));
  if (modes.size() > shown) text += fmt::format("  and {} more (--format json lists them)\n", modes.size() - shown);
  return text;
}

std::string describe(const Json& answer) {
  std::string text = "Bulk value: critical time step of an infinite lattice\n" + describe_limit(answer);
  if (answer.contains("courant_number"))
    text += row("Courant number",
                fmt::format("{:.8g} (time step x p-wave speed / spacing)", answer["courant_number"].get<double>()));
  if (answer.contains("published_bound")) text += describe_bound(answer["published_bound"]);
  if (answer.contains("mode_limit")) text += "\nThe mode given alone:\n" + describe_limit(answer["mode_limit"]);
  if (answer.contains("box_limit"))
    text += "\nThe paper's modes of the box alone:\n" + describe_limit(answer["box_limit"]);
  if (answer.contains("spectral_radius_at_time_step"))
    text += row("spectral radius", fmt::format("{:.12g} at the time step given, over the whole zone",
                                               answer["spectral_radius_at_time_step"].get<double>()));
  if (answer.contains("growth_per_step_at_time_step"))
    text += row("growth per step", fmt::format("{:.8g} at the time step given, a factor e in {:.6g} steps",
                                               answer["growth_per_step_at_time_step"].get<double>(),
                                               1.0 / std::log(answer["spectral_radius_at_time_step"].get<double>())));
  if (answer.contains("time_step_for_tolerance"))
    text += row("tolerable time step", number_or(answer["time_step_for_tolerance"], "none"));
  if (answer.contains("equivalents")) text += describe_equivalents(answer["equivalents"]);
  text += describe_zero_energy(answer);
  if (answer.contains("explanation")) {
    text += "\nHow the limit comes about:\n";
    for (const Json& line : answer["explanation"]) text += fmt::format("  {}\n", line.get<std::string>());
  }
  return text + "\nNote: " + answer["note"].get<std::string>() + ".\n";
}

}  // namespace

CaseCommand dt_command() {
  return {.name = "dt",
          .summary = "the critical time step of a scheme on an infinite lattice",
          .groups = {KeyGroup::discretisation, KeyGroup::material, KeyGroup::scheme, KeyGroup::artificial_stress,
                     KeyGroup::mode, KeyGroup::time, KeyGroup::growth},
          .answer = study::time_step_answer,
          .describe = describe,
          .explain = study::explain_time_step,
          .columns = {"critical_time_step", "courant_number", "verdict", "critical_mode.branch",
                      "critical_mode.wave_vector"}};
}

}  // namespace sphstab::cli
