// SPDX-License-Identifier: MIT
#include "study/particle_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sphstab::study {
namespace {

/// Of the body's size, that the farthest particle of a mode moves.
constexpr double mode_amplitude = 0.1;

/// Sizes of the body.
constexpr double farthest_drawn = 100.0;

/// The order in which particles are drawn.
template <int Dim>
std::vector<int> drawing_order(const Body<Dim>& body) {
  std::vector<int> order(body.size());
  std::iota(order.begin(), order.end(), 0);
  if constexpr (Dim == 3)
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return body.position[a][2] < body.position[b][2]; });
  return order;
}

template <int Dim>
double size(const Body<Dim>& body) {
  Vector<Dim> low = body.position.front(), high = low;
  for (const auto& x : body.position) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  return (high - low).norm();
}

}  // namespace

template <int Dim>
bool drawable(const Body<Dim>& body, const std::vector<Vector<Dim>>& displacement) {
  const double farthest = farthest_drawn * size(body);
  return std::all_of(displacement.begin(), displacement.end(),
                     [&](const Vector<Dim>& s) { return s.norm() <= farthest; });
}

template <int Dim>
io::ParticlePanel particle_panel(std::string title, const Body<Dim>& body, const std::vector<Vector<Dim>>& displacement,
                                 double factor, const std::vector<double>& values) {
  io::ParticlePanel panel{.title = std::move(title), .positions = {}};
  for (const int a : drawing_order(body)) {
    const Vector<Dim> x = body.position[a] + factor * displacement[a];
    panel.positions.emplace_back(x[0], Dim == 1 ? 0.0 : x[Dim == 1 ? 0 : 1]);
    panel.values.push_back(values[a]);
  }
  return panel;
}

template <int Dim>
double particle_radius(const Body<Dim>& body) {
  const double volume = std::accumulate(body.volume.begin(), body.volume.end(), 0.0);
  return 0.5 * std::pow(volume / body.size(), 1.0 / Dim);
}

template <int Dim>
io::ParticleFigure mode_figure(const std::string& title, const Body<Dim>& body,
                               const std::vector<std::pair<std::string, std::vector<Vector<Dim>>>>& named_modes) {
  io::ParticleFigure figure{.title = title,
                            .x_label = "x",
                            .y_label = Dim == 1 ? "" : "y",
                            .value_label = "displacement / largest",
                            .radius = particle_radius(body),
                            .panels = {},
                            .columns = std::min(3, static_cast<int>(named_modes.size())),
                            .value_range = std::pair(0.0, 1.0)};
  for (const auto& [name, displacement] : named_modes) {
    std::vector<double> distance;
    for (const auto& s : displacement) distance.push_back(s.norm());
    const double largest = *std::max_element(distance.begin(), distance.end());
    for (double& value : distance) value /= largest;
    figure.panels.push_back(
        particle_panel<Dim>(name, body, displacement, mode_amplitude * size(body) / largest, distance));
  }
  return figure;
}

template bool drawable(const Body<1>&, const std::vector<Vector<1>>&);
template io::ParticlePanel particle_panel(std::string, const Body<1>&, const std::vector<Vector<1>>&, double,
                                          const std::vector<double>&);
template double particle_radius(const Body<1>&);
template io::ParticleFigure mode_figure(const std::string&, const Body<1>&,
                                        const std::vector<std::pair<std::string, std::vector<Vector<1>>>>&);
template bool drawable(const Body<2>&, const std::vector<Vector<2>>&);
template io::ParticlePanel particle_panel(std::string, const Body<2>&, const std::vector<Vector<2>>&, double,
                                          const std::vector<double>&);
template double particle_radius(const Body<2>&);
template io::ParticleFigure mode_figure(const std::string&, const Body<2>&,
                                        const std::vector<std::pair<std::string, std::vector<Vector<2>>>>&);
template bool drawable(const Body<3>&, const std::vector<Vector<3>>&);
template io::ParticlePanel particle_panel(std::string, const Body<3>&, const std::vector<Vector<3>>&, double,
                                          const std::vector<double>&);
template double particle_radius(const Body<3>&);
template io::ParticleFigure mode_figure(const std::string&, const Body<3>&,
                                        const std::vector<std::pair<std::string, std::vector<Vector<3>>>>&);

}  // namespace sphstab::study
