// SPDX-License-Identifier: MIT
#pragma once

#include "analysis/sine_series.hpp"
#include "model/problem.hpp"

namespace sphstab::analysis {

/// The symbol of the SPH gradient on an infinite lattice: for y_a = ŷ e^{ik·x_a},
///   Σ_b V (y_b − y_a) ∇_a W_ab = i D(k) y_a,   D(k) = −V Σ_d sin(k·d) ∇W(d) = −A(k)   (theory.md §1),
/// the sum over the neighbours d = x_a − x_b. D → k (1 + O(quadrature error)) for long waves. With the kernel
/// normalisation `sum` both sums of the scheme carry 1/N, N = V ΣW with W(0) included, and so does D.
/// Tested in tests/analysis/test_linearisation.cpp.
template <int Dim>
class GradientSymbol {
 public:
  explicit GradientSymbol(const Problem<Dim>& problem);

  /// D(k), 1 / length; k in radians per length.
  Vector<Dim> operator()(const Vector<Dim>& wave_vector) const { return series_(phases(wave_vector)); }

  /// ∂D/∂k = −V Σ_d cos(k·d) d ∇Wᵀ (/ N), dimensionless and symmetric.
  Tensor<Dim> jacobian(const Vector<Dim>& wave_vector) const {
    return series_.jet(phases(wave_vector)).jacobian * basis_.transpose();
  }

  /// D as a series in the phases θ_i = k·a_i of a reduced basis a_i, in which its frequencies are the smallest whatever
  /// basis the lattice is given in: searches over the zone cost more the higher they are.
  const SineSeries<Dim>& series() const { return series_; }
  const Tensor<Dim>& basis() const { return basis_; }  ///< columns a_i
  Vector<Dim> phases(const Vector<Dim>& wave_vector) const { return basis_.transpose() * wave_vector; }
  Vector<Dim> wave_vector(const Vector<Dim>& phases) const { return wave_vectors_of_phases_ * phases; }

  /// L = −V Σ d ⊗ ∇W (/ N), dimensionless: SPH returns H L for the gradient of u = H x. The identity up to quadrature
  /// error.
  const Tensor<Dim>& consistency() const { return consistency_; }

  /// D(k), or exactly zero where it vanishes to rounding of the sum and of the phases of k.
  Vector<Dim> cleaned(const Vector<Dim>& wave_vector) const;

 private:
  Tensor<Dim> basis_;
  Tensor<Dim> wave_vectors_of_phases_;
  Tensor<Dim> consistency_;
  double weight_sum_;
  SineSeries<Dim> series_;
};

extern template class GradientSymbol<1>;
extern template class GradientSymbol<2>;
extern template class GradientSymbol<3>;

}  // namespace sphstab::analysis
