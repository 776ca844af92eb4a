// SPDX-License-Identifier: MIT
#include "analysis/gradient_symbol.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <utility>

#include "model/lattice_index.hpp"
#include "model/lattice_reduction.hpp"

namespace sphstab::analysis {
namespace {

constexpr double few_roundings = 4.0 * std::numeric_limits<double>::epsilon();

/// V Σ_j W_ij over the neighbours and the particle itself, or 1 without normalisation.
template <int Dim>
double normalisation_sum(const Problem<Dim>& problem, const std::vector<LatticeNeighbour<Dim>>& neighbours) {
  if (problem.scheme.kernel_normalisation == KernelNormalisation::none) return 1.0;
  double sum = problem.kernel.value(0.0);
  for (const auto& neighbour : neighbours) sum += problem.kernel.value(neighbour.distance);
  return problem.lattice.cell_volume() * sum;
}

template <int Dim>
SineSeries<Dim> symbol_series(const Problem<Dim>& problem, const Tensor<Dim>& basis) {
  const auto neighbours = lattice_neighbours(problem.lattice, problem.kernel.support(), problem.neighbour_rule);
  const double factor = -2.0 * problem.lattice.cell_volume() / normalisation_sum(problem, neighbours);
  std::vector<SineTerm<Dim>> terms;
  double coefficient_error = 0.0;
  for (const auto& d : neighbours) {
    const LatticeIndex<Dim> frequency = lattice_coordinates<Dim>(basis, d.position);
    if (!in_upper_half<Dim>(frequency)) continue;
    const double slope = problem.kernel.slope(d.distance);
    terms.push_back({frequency, factor * slope / d.distance * d.position});
    // A handful of roundings of the product, and those of r/h, which matter where W' falls steeply to the support.
    coefficient_error += few_roundings * std::abs(factor) *
                         (std::abs(slope) + d.distance * std::abs(problem.kernel.curvature(d.distance)));
  }
  return SineSeries<Dim>(std::move(terms), coefficient_error);
}

}  // namespace

template <int Dim>
GradientSymbol<Dim>::GradientSymbol(const Problem<Dim>& problem)
    : basis_(reduced_basis<Dim>(problem.lattice.primitive_vectors())),
      wave_vectors_of_phases_(basis_.inverse().transpose()),
      consistency_(Tensor<Dim>::Zero()),
      weight_sum_(0.0),
      series_(symbol_series<Dim>(problem, basis_)) {
  for (const auto& term : series_.terms()) {
    consistency_ += basis_ * term.frequency.template cast<double>() * term.coefficient.transpose();
    weight_sum_ += term.coefficient.norm();
  }
}

template <int Dim>
Vector<Dim> GradientSymbol<Dim>::cleaned(const Vector<Dim>& wave_vector) const {
  const Vector<Dim> theta = phases(wave_vector);
  const Vector<Dim> value = series_(theta);
  // Phases carry Dim + 1 roundings each (of k and of k·a_i).
  const double of_phases = (Dim + 1) * std::numeric_limits<double>::epsilon() * series_.type() *
                           theta.template lpNorm<Eigen::Infinity>() * weight_sum_;
  return value.norm() > series_.rounding() + of_phases ? value : Vector<Dim>::Zero();
}

template class GradientSymbol<1>;
template class GradientSymbol<2>;
template class GradientSymbol<3>;

}  // namespace sphstab::analysis
