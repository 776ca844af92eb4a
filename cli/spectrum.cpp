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

std::string describe(const Json& answer) {
  std::string text =
      fmt::format("Critical time step of {}, {} particles\n", subject(answer), answer["particles"].get<int>());
  text += row("critical time step", fmt::format("{:.12g}", answer["critical_time_step"].get<double>()));
  text += row("bracket", fmt::format("{:.12g} to {:.12g} ({})", answer["bracket"][0].get<double>(),
                                     answer["bracket"][1].get<double>(), bound_in_words(answer)));
  text += row("largest frequency", fmt::format("omega = {:.8g}, residual {:.1e} after {} applications of the operator",
                                               answer["omega_max"].get<double>(), answer["residual"].get<double>(),
                                               answer["applications"].get<long>()));
  if (answer.contains("bulk_theory")) {
    text += row("theory, bulk", number_or(answer["bulk_theory"], "none"));
    text += row("body/bulk - 1", number_or(answer["patch_deficit"], "-", 4));
  }
  if (answer.contains("frequencies")) text += describe_modes(answer);
  return text;
}

}  // namespace

CaseCommand spectrum_command() {
  return {.name = "spectrum",
          .summary = "the critical time step, modes and natural frequencies of a whole plate or scene",
          .groups = {KeyGroup::discretisation, KeyGroup::material, KeyGroup::scheme, KeyGroup::artificial_stress,
                     KeyGroup::body, KeyGroup::spectrum},
          .answer = study::spectrum_answer,
          .describe = describe,
          .has_files = true};
}

}  // namespace sphstab::cli
