// SPDX-License-Identifier: MIT
#include "study/dispersion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/command.hpp"
#include "cli/text.hpp"

namespace sphstab::cli {
namespace {

/// ω of one branch, or how fast it grows.
std::string frequency(double omega_squared) {
  return omega_squared < 0.0 ? fmt::format("{:.6g}i", std::sqrt(-omega_squared))
                             : fmt::format("{:.6g}", std::sqrt(omega_squared));
}

double omega_squared_of(const Json& point, std::size_t branch) { return point["omega_squared"][branch][0]; }

std::string describe_waves(const Json& point) {
  std::string text = fmt::format("Waves at k = ({}) on the infinite lattice\n\n", numbers(point["wave_vector"], 8));
  text += fmt::format("  {:<13} {:>14} {:>14} {:>14} {:>14}  {}\n", "branch", "omega^2", "omega", "phase speed",
                      "group speed", "group velocity");
  for (std::size_t i = 0; i < point["branches"].size(); ++i) {
    const Json& velocity = point["group_velocity"][i];
    text += fmt::format("  {:<13} {:>14.8g} {:>14} {:>14} {:>14}  {}\n", point["branches"][i].get<std::string>(),
                        omega_squared_of(point, i), frequency(omega_squared_of(point, i)),
                        number_or(point["phase_speed"][i], "-", 8), number_or(point["group_speed"][i], "-", 8),
                        velocity.is_null() ? "-" : "(" + numbers(velocity, 8) + ")");
  }
  return text;
}

/// Longitudinal and transverse ω of a point; those of 3-D that are equal are shown once.
std::string frequencies(const Json& point) {
  std::string text;
  for (const std::string_view branch : {"longitudinal", "transverse"}) {
    const Json& branches = point["branches"];
    const auto found = std::find(branches.begin(), branches.end(), branch);
    if (found == branches.end()) continue;
    text +=
        fmt::format(" {:>14}", frequency(omega_squared_of(point, static_cast<std::size_t>(found - branches.begin()))));
  }
  return text;
}

std::string describe_points(const Json& points) {
  const Json& first = points.front();
  const std::size_t dimension = first["wave_vector"].size();
  const bool along_path = first.contains("distance");
  std::string text = fmt::format("Angular frequencies on the infinite lattice, {} wave vectors {}\n\n  ", points.size(),
                                 along_path ? "along a path" : "over the first Brillouin zone");
  if (along_path) text += fmt::format("{:<5}", "");
  for (std::size_t axis = 0; axis < dimension; ++axis) text += fmt::format(" {:>11}", fmt::format("k{}", "xyz"[axis]));
  text += fmt::format(" {:>14}", "longitudinal");
  if (dimension > 1) text += fmt::format(" {:>14}", dimension == 3 ? "2 x transverse" : "transverse");
  text += fmt::format(" {:>12}\n", "growth rate");
  for (const Json& point : points) {
    text += "  ";
    if (along_path) text += fmt::format("{:<5}", point.contains("label") ? point["label"].get<std::string>() : "");
    for (const Json& component : point["wave_vector"]) text += fmt::format(" {:>11.6g}", component.get<double>());
    text += frequencies(point) + fmt::format(" {:>12.6g}\n", point["growth_rate"].get<double>());
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
          .figure = study::band_figure};
}

}  // namespace sphstab::cli
