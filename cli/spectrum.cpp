// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "cli/command.hpp"
#include "cli/text.hpp"

namespace sphstab::cli {
namespace {

std::string bound_in_words(const Json& answer) {
  const std::string kind = answer["bracket_kind"];
  if (kind == "factorisation") return "proven by a factorisation";
  if (kind == "norm-bound") return "proven by a norm, loose below";
  return fmt::format("fails with probability {:.0e}", answer["failure_probability"].get<double>());
}

std::string describe_modes(const Json& answer) {
  const Json& frequencies = answer["frequencies"];
  std::string text = fmt::format("\nLowest {} modes ({} rigid, {} of zero energy):\n", frequencies.size(),
                                 answer["rigid_modes"].get<int>(), answer["zero_energy_modes"].get<int>());
  for (std::size_t i = 0; i < frequencies.size(); ++i)
    text += fmt::format("  {:>4}  {:>14.8g} Hz  {}\n", i + 1, frequencies[i].get<double>(),
                        answer["mode_kinds"][i].get<std::string>());
  return text;
}

std::string describe_bulk(const Json& answer) {
  if (!answer.contains("bulk_theory")) return "";
  return row("theory, bulk", number_or(answer["bulk_theory"], "none")) +
         row("body/bulk - 1", number_or(answer["patch_deficit"], "-", 4));
}

std::string describe_rest(const Json& answer) {
  return row("critical time step", fmt::format("{:.12g}", answer["critical_time_step"].get<double>())) +
         row("bracket", fmt::format("{:.12g} to {:.12g} ({})", answer["bracket"][0].get<double>(),
                                    answer["bracket"][1].get<double>(), bound_in_words(answer))) +
         row("largest frequency", fmt::format("omega = {:.8g}, residual {:.1e} after {} applications of the operator",
                                              answer["omega_max"].get<double>(), answer["residual"].get<double>(),
                                              answer["applications"].get<long>()));
}

std::string verdict_in_words(const Json& answer) {
  const std::string verdict = answer["verdict"];
  if (verdict == "never-stable") return "never stable: a mode grows at every time step";
  return fmt::format("{}: at short steps nothing was seen to grow, faster than {:.1e} per time",
                     verdict == "undecided" ? "undecided" : "conditionally stable",
                     answer["smallest_detectable_growth_rate"].get<double>());
}

std::string describe_state(const Json& answer) {
  const auto square = [&](const char* key) { return complex_number(complex_of(answer[key]), 8); };
  std::string text = row("critical time step", number_or(answer["critical_time_step"], "none")) +
                     row("verdict", verdict_in_words(answer));
  if (answer["critical_time_step"].is_null())
    text += row("growth rate", fmt::format("{:.8g} per time, of omega^2 = {}", answer["growth_rate"].get<double>(),
                                           square("omega_squared_of_growth"))) +
            row("limit of vibrations",
                number_or(answer["critical_time_step_of_largest"], "none") + ", of the largest omega^2 alone");
  return text + row("omega^2", fmt::format("{} to {} ({}), residual {:.1e} after {} applications of the operator",
                                           square("omega_squared_min"), square("omega_squared_max"),
                                           answer["whole_spectrum"].get<bool>() ? "all modes looked at"
                                                                                : "not all modes looked at",
                                           answer["residual"].get<double>(), answer["applications"].get<long>()));
}

std::string describe_squares(const Json& answer) {
  std::string text = fmt::format("\nLowest {} modes:\n", answer["omega_squared"].size());
  for (std::size_t i = 0; i < answer["omega_squared"].size(); ++i)
    text += fmt::format("  {:>4}  {:>14.8g} Hz  omega^2 = {}\n", i + 1, answer["frequencies"][i].get<double>(),
                        complex_number(complex_of(answer["omega_squared"][i]), 8));
  return text;
}

std::string describe(const Json& answer) {
  const bool at_rest = !answer["bracket"].is_null();
  std::string text = fmt::format("Critical time step of {}", subject(answer));
  if (answer.contains("state"))
    text += fmt::format(" about its snapshot {} at time {:.6g}", answer["state"]["snapshot"].get<int>(),
                        answer["state"]["time"].get<double>());
  text += fmt::format(", {} particles\n", answer["particles"].get<int>());
  text += (at_rest ? describe_rest(answer) : describe_state(answer)) + describe_bulk(answer);
  if (answer.contains("omega_squared"))
    text += describe_squares(answer);
  else if (answer.contains("frequencies"))
    text += describe_modes(answer);
  return text;
}

}  // namespace

CaseCommand spectrum_command() {
  return {
      .name = "spectrum",
      .summary =
          "the critical time step, modes and natural frequencies of a whole plate, patch or scene, at rest or deformed",
      .groups = {KeyGroup::discretisation, KeyGroup::material, KeyGroup::scheme, KeyGroup::artificial_stress,
                 KeyGroup::body, KeyGroup::spectrum},
      .answer = study::spectrum_answer,
      .describe = describe,
      .has_files = true};
}

}  // namespace sphstab::cli
