// SPDX-License-Identifier: MIT
#pragma once

#include "model/problem.hpp"

namespace sphstab::analysis {

/// The symbol of the SPH gradient on an infinite lattice: for y_a = ŷ e^{ik·x_a},
///   Σ_b V (y_b − y_a) ∇_a W_ab = i D(k) y_a,   D(k) = −V Σ_d sin(k·d) ∇W(d) = −A(k)   (theory.md §1),
/// the sum over the neighbours d = x_a − x_b. D → k (1 + O(quadrature error)) for long waves.
template <int Dim>
class GradientSymbol {
 public:
  explicit GradientSymbol(const Problem<Dim>& problem);

  /// D(k), 1 / length; k in radians per length.
  Vector<Dim> operator()(const Vector<Dim>& wave_vector) const;

  /// L = −V Σ d ⊗ ∇W, dimensionless: SPH returns H L for the gradient of u = H x. The identity up to quadrature error.
  Tensor<Dim> consistency() const;

  // … further members as the certified maximum needs them (phases θ = k·a_i, Jacobian, bounds).
};

}  // namespace sphstab::analysis
