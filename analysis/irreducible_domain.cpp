// SPDX-License-Identifier: MIT
#include "analysis/irreducible_domain.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <vector>

#include "model/lattice_index.hpp"

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

/// The last component that is not zero made positive: n and −n are one term.
template <int Dim>
LatticeIndex<Dim> upper(const LatticeIndex<Dim>& n) {
  return in_upper_half<Dim>(n) ? n : -n;
}

/// Whether a map of the phases takes every term of the series to a term: a shell that ends on the support can be parted
/// by rounding, and then the sum has fewer symmetries than the lattice.
template <int Dim>
bool keeps_terms(const SineSeries<Dim>& series, const Tensor<Dim>& phase_map) {
  const auto before = [](const LatticeIndex<Dim>& left, const LatticeIndex<Dim>& right) {
    return std::lexicographical_compare(left.begin(), left.end(), right.begin(), right.end());
  };
  std::vector<LatticeIndex<Dim>> frequencies;
  for (const auto& term : series.terms()) frequencies.push_back(upper<Dim>(term.frequency));
  std::sort(frequencies.begin(), frequencies.end(), before);
  return std::all_of(frequencies.begin(), frequencies.end(), [&](const LatticeIndex<Dim>& n) {
    const LatticeIndex<Dim> image =
        (phase_map.transpose() * n.template cast<double>()).array().round().template cast<int>();
    return std::binary_search(frequencies.begin(), frequencies.end(), upper<Dim>(image), before);
  });
}

/// Adds the products that are missing because the roundings of their factors add up.
template <int Dim>
void close(std::vector<Tensor<Dim>>& group) {
  constexpr double same_element = 1e-6;  // different ones differ by far more, equal ones by rounding
  for (std::size_t i = 0; i < group.size(); ++i)
    for (std::size_t j = 0; j < group.size(); ++j) {
      const Tensor<Dim> product = group[i] * group[j];
      const auto same = [&](const Tensor<Dim>& known) { return (known - product).norm() < same_element; };
      if (std::none_of(group.begin(), group.end(), same)) group.push_back(product);
    }
}

}  // namespace

template <int Dim>
ZoneDomain<Dim> irreducible_domain(const BrillouinZone<Dim>& zone, const GradientSymbol<Dim>& symbol,
                                   const Tensor<Dim>& form) {
  const Tensor<Dim> to_phases = symbol.basis().transpose(), to_wave_vectors = to_phases.inverse();
  std::vector<Tensor<Dim>> group;
  for (const auto& R : zone.point_group())
    if (leaves_unchanged<Dim>(form, R) && keeps_terms<Dim>(symbol.series(), to_phases * R * to_wave_vectors))
      group.push_back(R);
  if (group.size() < zone.point_group().size()) close<Dim>(group);
  const IrreducibleWedge<Dim> wedge(zone, group);

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

template ZoneDomain<1> irreducible_domain(const BrillouinZone<1>&, const GradientSymbol<1>&, const Tensor<1>&);
template ZoneDomain<2> irreducible_domain(const BrillouinZone<2>&, const GradientSymbol<2>&, const Tensor<2>&);
template ZoneDomain<3> irreducible_domain(const BrillouinZone<3>&, const GradientSymbol<3>&, const Tensor<3>&);

}  // namespace sphstab::analysis
