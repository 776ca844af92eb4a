// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cli/command.hpp"
#include "cli/text.hpp"

namespace sphstab::cli {
namespace {

constexpr int digits = 8;

/// The matrix with the names of the state above and beside it, every column as wide as its widest entry.
std::string table_of(const Json& state, const Json& matrix) {
  std::string header = fmt::format("  {:>6}", "");
  std::vector<std::string> lines;
  for (const Json& name : state) lines.push_back(fmt::format("  {:>6}", name.get<std::string>()));
  for (std::size_t j = 0; j < state.size(); ++j) {
    std::size_t width = 12;
    std::vector<std::string> cells;
    for (const Json& entries : matrix) {
      cells.push_back(complex_number(complex_of(entries[j]), digits));
      width = std::max(width, cells.back().size());
    }
    header += fmt::format("  {:>{}}", state[j].get<std::string>(), width);
    for (std::size_t i = 0; i < cells.size(); ++i) lines[i] += fmt::format("  {:>{}}", cells[i], width);
  }
  return fmt::format("{}\n{}\n", header, fmt::join(lines, "\n"));
}

std::string describe(const Json& answer) {
  std::string text = fmt::format("Amplification matrix E at k = ({}), time step {:.12g}\n\n{}\n",
                                 numbers(answer["wave_vector"], digits), answer["time_step"].get<double>(),
                                 table_of(answer["state"], answer["amplification_matrix"]));
  for (const Json& eigenvalue : answer["eigenvalues"])
    text += row("eigenvalue", complex_number(complex_of(eigenvalue), digits));
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
