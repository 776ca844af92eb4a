// SPDX-License-Identifier: MIT
#pragma once

#include "io/figure.hpp"
#include "model/body.hpp"

namespace sphstab::study {

/// Larger bodies get no picture: it would have tens of megabytes.
inline constexpr int largest_picture = 50000;

/// Whether the displaced body can be drawn: not where it has exploded to a hundred times its size.
template <int Dim>
bool drawable(const Body<Dim>& body, const std::vector<Vector<Dim>>& displacement);

/// The particles of a body where they are after `factor` times the displacement, coloured by the values. A body in
/// space is seen along z from above, the nearest particles in front.
template <int Dim>
io::ParticlePanel particle_panel(std::string title, const Body<Dim>& body, const std::vector<Vector<Dim>>& displacement,
                                 double factor, const std::vector<double>& values);

/// Half the edge of the cell of an average particle.
template <int Dim>
double particle_radius(const Body<Dim>& body);

/// The shapes of modes, each so large that it moves the farthest particle by a tenth of the body's size, coloured by
/// how far the particles move relative to it.
template <int Dim>
io::ParticleFigure mode_figure(const std::string& title, const Body<Dim>& body,
                               const std::vector<std::pair<std::string, std::vector<Vector<Dim>>>>& named_modes);

extern template bool drawable(const Body<1>&, const std::vector<Vector<1>>&);
extern template io::ParticlePanel particle_panel(std::string, const Body<1>&, const std::vector<Vector<1>>&, double,
                                                 const std::vector<double>&);
extern template double particle_radius(const Body<1>&);
extern template io::ParticleFigure mode_figure(const std::string&, const Body<1>&,
                                               const std::vector<std::pair<std::string, std::vector<Vector<1>>>>&);
extern template bool drawable(const Body<2>&, const std::vector<Vector<2>>&);
extern template io::ParticlePanel particle_panel(std::string, const Body<2>&, const std::vector<Vector<2>>&, double,
                                                 const std::vector<double>&);
extern template double particle_radius(const Body<2>&);
extern template io::ParticleFigure mode_figure(const std::string&, const Body<2>&,
                                               const std::vector<std::pair<std::string, std::vector<Vector<2>>>>&);
extern template bool drawable(const Body<3>&, const std::vector<Vector<3>>&);
extern template io::ParticlePanel particle_panel(std::string, const Body<3>&, const std::vector<Vector<3>>&, double,
                                                 const std::vector<double>&);
extern template double particle_radius(const Body<3>&);
extern template io::ParticleFigure mode_figure(const std::string&, const Body<3>&,
                                               const std::vector<std::pair<std::string, std::vector<Vector<3>>>>&);

}  // namespace sphstab::study
