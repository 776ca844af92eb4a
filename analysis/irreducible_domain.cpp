// SPDX-License-Identifier: MIT
#include "analysis/irreducible_domain.hpp"

#include <limits>
#include <vector>

#include "model/brillouin_zone.hpp"

namespace sphstab::analysis {
namespace {

/// A symmetry counts if it holds to the roundings of its own entries: the enclosures of the searches rest on it.
constexpr double few_roundings = 32.0 * std::numeric_limits<double>::epsilon();

/// Whether R is orthogonal and Rᵀ Q R = Q.
template <int Dim>
bool leaves_unchanged(const Tensor<Dim>& form, const Tensor<Dim>& R) {
  const Tensor<Dim> of_metric = R.transpose() * R - Tensor<Dim>::Identity();
  const Tensor<Dim> of_form = R.transpose() * form * R - form;
  return of_metric.norm() <= few_roundings && of_form.norm() <= few_roundings * form.norm();
}

}  // namespace

template <int Dim>
ZoneDomain<Dim> irreducible_domain(const Lattice<Dim>& lattice, const GradientSymbol<Dim>& symbol,
                                   const Tensor<Dim>& form) {
  const BrillouinZone<Dim> zone(lattice);
  std::vector<Tensor<Dim>> group;
  for (const auto& R : zone.point_group())
    if (leaves_unchanged<Dim>(form, R)) group.push_back(R);
  const IrreducibleWedge<Dim> wedge(zone, group);

  Tensor<Dim> to_phases, to_wave_vectors;
  for (int axis = 0; axis < Dim; ++axis) {
    to_phases.col(axis) = symbol.phases(Vector<Dim>::Unit(axis));
    to_wave_vectors.col(axis) = symbol.wave_vector(Vector<Dim>::Unit(axis));
  }
  for (auto& R : group) R = (to_phases * R * to_wave_vectors).array().round();
  std::vector<PhaseHalfSpace<Dim>> half_spaces;
  for (const auto& side : wedge.half_spaces())
    half_spaces.push_back({to_wave_vectors.transpose() * side.normal, side.offset});
  Vector<Dim> low = to_phases * wedge.vertices().front(), high = low;
  for (const auto& vertex : wedge.vertices()) {
    const Vector<Dim> phases = to_phases * vertex;
    low = low.cwiseMin(phases);
    high = high.cwiseMax(phases);
  }
  return {std::move(half_spaces), low, high, std::move(group)};
}

template ZoneDomain<1> irreducible_domain(const Lattice<1>&, const GradientSymbol<1>&, const Tensor<1>&);
template ZoneDomain<2> irreducible_domain(const Lattice<2>&, const GradientSymbol<2>&, const Tensor<2>&);
template ZoneDomain<3> irreducible_domain(const Lattice<3>&, const GradientSymbol<3>&, const Tensor<3>&);

}  // namespace sphstab::analysis
