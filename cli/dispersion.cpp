// SPDX-License-Identifier: MIT
#include "study/dispersion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "cli/command.hpp"
#include "cli/text.hpp"

namespace sphstab::cli {
namespace {

std::complex<double> omega_squared_of(const Json& point, std::size_t branch) {
  return complex_of(point["omega_squared"][branch]);
}

/// ω of one branch: its frequency, its growth rate times i, or, of a coupled pair, both.
std::string frequency(std::complex<double> omega_squared) {
  const auto omega = std::sqrt(omega_squared);
  return omega.real() == 0.0 && omega.imag() != 0.0 ? fmt::format("{:.6g}i", std::abs(omega.imag()))
                                                    : complex_number(omega, 6);
}

std::string describe_waves(const Json& point) {
  std::string text = fmt::format("Waves at k = ({}) on the infinite lattice\n\n", numbers(point["wave_vector"], 8));
  constexpr std::string_view columns = "  {:<13} {:>{}} {:>{}} {:>14} {:>14}  {}\n";
  const Json& branches = point["branches"];
  const bool coupled = std::find(branches.begin(), branches.end(), "coupled") != branches.end();
  const int of_square = coupled ? 29 : 14, of_omega = coupled ? 24 : 14;
  text += fmt::format(columns, "branch", "omega^2", of_square, "omega", of_omega, "phase speed", "group speed",
                      "group velocity");
  for (std::size_t i = 0; i < branches.size(); ++i) {
    const Json& velocity = point["group_velocity"][i];
    const auto omega_squared = omega_squared_of(point, i);
    text += fmt::format(columns, branches[i].get<std::string>(), complex_number(omega_squared, 8), of_square,
                        frequency(omega_squared), of_omega, number_or(point["phase_speed"][i], "-", 8),
                        number_or(point["group_speed"][i], "-", 8),
                        velocity.is_null() ? "-" : "(" + numbers(velocity, 8) + ")");
  }
  return text;
}

/// Whether the point has one longitudinal wave, all others being transverse and equally fast.
bool has_named_branches(const Json& point) {
  const Json &branches = point["branches"], &omega_squared = point["omega_squared"];
  const auto place = [&](std::string_view name) { return std::find(branches.begin(), branches.end(), name); };
  const auto transverse = place("transverse") - branches.begin();
  for (std::size_t i = 0; i < branches.size(); ++i)
    if (branches[i] != "longitudinal" && (branches[i] != "transverse" || omega_squared[i] != omega_squared[transverse]))
      return false;
  return std::count(branches.begin(), branches.end(), "longitudinal") == 1;
}

/// Longitudinal and transverse ω of a point; those of 3-D that are equal are shown once.
std::vector<std::string> frequencies_by_name(const Json& point) {
  std::vector<std::string> cells;
  for (const std::string_view branch : {"longitudinal", "transverse"}) {
    const Json& branches = point["branches"];
    const auto found = std::find(branches.begin(), branches.end(), branch);
    if (found == branches.end()) continue;
    cells.push_back(frequency(omega_squared_of(point, static_cast<std::size_t>(found - branches.begin()))));
  }
  return cells;
}

/// Every ω of a point in the order of ω².
std::vector<std::string> frequencies_in_order(const Json& point) {
  std::vector<std::string> cells;
  for (std::size_t i = 0; i < point["branches"].size(); ++i) cells.push_back(frequency(omega_squared_of(point, i)));
  return cells;
}

std::vector<std::string> names_of_frequencies(std::size_t dimension, bool by_name) {
  if (by_name && dimension == 1) return {"longitudinal"};
  if (by_name) return {"longitudinal", dimension == 3 ? "2 x transverse" : "transverse"};
  std::vector<std::string> names;
  for (std::size_t i = 1; i <= dimension; ++i) names.push_back(fmt::format("omega {}", i));
  return names;
}

std::string describe_points(const Json& points) {
  const Json& first = points.front();
  const std::size_t dimension = first["wave_vector"].size();
  const bool along_path = first.contains("distance");
  const bool by_name = std::all_of(points.begin(), points.end(), has_named_branches);
  const int width = by_name ? 14 : 24;
  std::string text = fmt::format("Angular frequencies on the infinite lattice, {} wave vectors {}\n\n  ", points.size(),
                                 along_path ? "along a path" : "over the first Brillouin zone");
  if (along_path) text += fmt::format("{:<5}", "");
  for (std::size_t axis = 0; axis < dimension; ++axis) text += fmt::format(" {:>11}", fmt::format("k{}", "xyz"[axis]));
  for (const auto& name : names_of_frequencies(dimension, by_name)) text += fmt::format(" {:>{}}", name, width);
  text += fmt::format(" {:>12}\n", "growth rate");
  for (const Json& point : points) {
    text += "  ";
    if (along_path) text += fmt::format("{:<5}", point.contains("label") ? point["label"].get<std::string>() : "");
    for (const Json& component : point["wave_vector"]) text += fmt::format(" {:>11.6g}", component.get<double>());
    for (const auto& cell : by_name ? frequencies_by_name(point) : frequencies_in_order(point))
      text += fmt::format(" {:>{}}", cell, width);
    text += fmt::format(" {:>12.6g}\n", point["growth_rate"].get<double>());
  }
  return text;
}

std::string describe_growth(const Json& points) {
  const auto fastest = std::max_element(points.begin(), points.end(), [](const Json& a, const Json& b) {
    return a["growth_rate"].get<double>() < b["growth_rate"].get<double>();
  });
  const double rate = (*fastest)["growth_rate"];
  if (rate == 0.0) return "";
  return "\n" + row("fastest growth",
                    fmt::format("{:.8g} per time, at k = ({})", rate, numbers((*fastest)["wave_vector"], 6)));
}

std::string describe(const Json& answer) {
  const Json& points = answer["points"];
  return (points.size() == 1 ? describe_waves(points.front()) : describe_points(points)) + describe_growth(points);
}

}  // namespace

CaseCommand dispersion_command() {
  return {.name = "dispersion",
          .summary = "frequency, speeds and growth of waves along a path, on a grid or at one wave vector",
          .groups = {KeyGroup::discretisation, KeyGroup::material, KeyGroup::scheme, KeyGroup::artificial_stress,
                     KeyGroup::mode, KeyGroup::path},
          .answer = study::dispersion_answer,
          .describe = describe,
          .rows = study::dispersion_rows,
          .figure = [](const Case& input) { return io::render_svg(study::band_figure(input)); }};
}

}  // namespace sphstab::cli
