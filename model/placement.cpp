// SPDX-License-Identifier: MIT
#include "model/placement.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "model/errors.hpp"
#include "model/lattice_index.hpp"
#include "model/uniform.hpp"

namespace sphstab {
namespace {

void refuse_too_many(double particles) {
  if (particles > most_particles)
    throw InvalidInput(
        fmt::format("shape: holds about {:.2g} particles, more than the {} that are allowed; a larger "
                    "spacing makes fewer",
                    particles, most_particles));
}

template <int Dim>
Vector<Dim> lattice_origin(const Shape<Dim>& shape) {
  if (const auto* box = std::get_if<Box<Dim>>(&shape)) return box->from;
  const auto bounds = bounding_box(shape);
  return 0.5 * (bounds.from + bounds.to);
}

/// Of a two-dimensional ball or annulus.
template <int Dim>
Annulus<Dim> as_annulus(const Shape<Dim>& shape) {
  const auto* ball = std::get_if<Ball<Dim>>(&shape);
  const auto* annulus = std::get_if<Annulus<Dim>>(&shape);
  if (Dim != 2 || (ball == nullptr && annulus == nullptr))
    throw InvalidInput("arrangement: polar needs a ball or an annulus in 2 dimensions");
  return ball != nullptr ? Annulus<Dim>{ball->centre, 0.0, ball->radius} : *annulus;
}

/// Adds the particle if it lies in none of the shapes that are cut away.
template <int Dim>
void add(PlacedParticles<Dim>& particles, const Placement<Dim>& placement, const Vector<Dim>& position, double volume,
         double margin) {
  for (const auto& hole : placement.cut)
    if (contains(hole, position, margin)) return;
  particles.position.push_back(position);
  particles.volume.push_back(volume);
}

template <int Dim>
PlacedParticles<Dim> arrange(const LatticeArrangement<Dim>& arrangement, const Placement<Dim>& placement,
                             const Lattice<Dim>& lattice, double margin) {
  const Vector<Dim> origin = lattice_origin(placement.shape) + lattice.spacing() * arrangement.offset;
  const auto bounds = bounding_box(placement.shape);
  // The lattice coordinates of a box reach as far from those of its middle as Σ_j |A⁻¹|_ij times its half lengths.
  const Tensor<Dim> inverse = lattice.primitive_vectors().inverse();
  const Vector<Dim> middle = inverse * (0.5 * (bounds.from + bounds.to) - origin);
  const Vector<Dim> reach = inverse.cwiseAbs() * (0.5 * (bounds.to - bounds.from));
  refuse_too_many((2.0 * reach.array() + 1.0).prod());

  PlacedParticles<Dim> particles{.position = {}, .volume = {}, .layer = lattice.spacing()};
  for_each_index<Dim>((middle - reach).array().floor().template cast<int>(),
                      (middle + reach).array().ceil().template cast<int>(), [&](const LatticeIndex<Dim>& n) {
                        const Vector<Dim> position = origin + lattice.site(n);
                        if (contains(placement.shape, position, margin))
                          add(particles, placement, position, lattice.cell_volume(), margin);
                      });
  return particles;
}

template <int Dim>
PlacedParticles<Dim> arrange(const PolarArrangement& arrangement, const Placement<Dim>& placement, const Lattice<Dim>&,
                             double margin) {
  const auto [centre, inner, outer] = as_annulus(placement.shape);
  refuse_too_many(static_cast<double>(arrangement.rings) * arrangement.sectors);
  const double thickness = (outer - inner) / arrangement.rings, angle = 2.0 * std::numbers::pi / arrangement.sectors;

  PlacedParticles<Dim> particles{.position = {}, .volume = {}, .layer = thickness};
  for (int ring = 0; ring < arrangement.rings; ++ring)
    for (int sector = 0; sector < arrangement.sectors; ++sector) {
      const double radius = inner + (ring + 0.5) * thickness;
      Vector<Dim> position = centre;
      position[0] += radius * std::cos(sector * angle);
      position[Dim - 1] += radius * std::sin(sector * angle);
      add(particles, placement, position, radius * angle * thickness, margin);
    }
  return particles;
}

template <int Dim>
void move(std::vector<Vector<Dim>>& position, const Jitter& jitter, double spacing) {
  std::mt19937_64 random(jitter.seed);
  for (auto& x : position)
    for (double& component : x) component += jitter.fraction * spacing * uniform_number(random);
}

}  // namespace

template <int Dim>
PlacedParticles<Dim> place_particles(const Placement<Dim>& placement, const Lattice<Dim>& lattice) {
  in_context("shape", [&] { check_shape(placement.shape); });
  for (const auto& hole : placement.cut) in_context("cut", [&] { check_shape(hole); });
  const double margin = placement_tolerance * lattice.spacing();
  auto particles =
      std::visit([&](const auto& kind) { return arrange(kind, placement, lattice, margin); }, placement.arrangement);
  if (particles.position.empty()) throw InvalidInput("shape: holds no particle");
  if (placement.jitter) move(particles.position, *placement.jitter, lattice.spacing());
  return particles;
}

template PlacedParticles<1> place_particles(const Placement<1>&, const Lattice<1>&);
template PlacedParticles<2> place_particles(const Placement<2>&, const Lattice<2>&);
template PlacedParticles<3> place_particles(const Placement<3>&, const Lattice<3>&);

}  // namespace sphstab
