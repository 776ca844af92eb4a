// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "cli/command.hpp"
#include "cli/text.hpp"

namespace sphstab::cli {
namespace {

std::string complex_number(const Json& pair) {
  const double real = pair[0], imaginary = pair[1];
  return imaginary == 0.0 ? fmt::format("{:.8g}", real) : fmt::format("{:.8g}{:+.8g}i", real, imaginary);
}

std::string describe(const Json& answer) {
  std::string text = fmt::format("Amplification matrix E at k = ({}), time step {:.12g}\n\n",
                                 numbers(answer["wave_vector"], 8), answer["time_step"].get<double>());
  const Json& state = answer["state"];
  text += fmt::format("  {:>6}", "");
  for (const Json& name : state) text += fmt::format(" {:>16}", name.get<std::string>());
  text += "\n";
  for (std::size_t i = 0; i < state.size(); ++i) {
    text += fmt::format("  {:>6}", state[i].get<std::string>());
    for (const Json& entry : answer["amplification_matrix"][i]) text += fmt::format(" {:>16}", complex_number(entry));
    text += "\n";
  }
  text += "\n";
  for (const Json& eigenvalue : answer["eigenvalues"]) text += row("eigenvalue", complex_number(eigenvalue));
  text += row("spectral radius", fmt::format("{:.12g}", answer["spectral_radius"].get<double>()));
  return text + row("power-bounded", answer["power_bounded"].get<bool>() ? "yes" : "no");
}

}  // namespace

CaseCommand matrix_command() {
  return {"matrix",
          "the amplification matrix at one mode, its eigenvalues and whether its powers stay bounded",
          {KeyGroup::discretisation, KeyGroup::material, KeyGroup::scheme, KeyGroup::artificial_stress, KeyGroup::mode,
           KeyGroup::time},
          study::matrix_answer,
          describe};
}

}  // namespace sphstab::cli
