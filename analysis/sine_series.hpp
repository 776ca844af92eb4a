// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "model/tensor.hpp"

namespace sphstab::analysis {

/// One term w sin(n·θ).
template <int Dim>
struct SineTerm {
  LatticeIndex<Dim> frequency;
  Vector<Dim> coefficient;
};

/// Value, first and second derivatives with respect to the phases.
template <int Dim>
struct SineJet {
  Vector<Dim> value;
  Tensor<Dim> jacobian;                  ///< ∂f_i/∂θ_j at (i, j)
  std::array<Tensor<Dim>, Dim> hessian;  ///< ∂²f_i/∂θ_j∂θ_k at [i](j, k)
};

/// A vector-valued odd trigonometric polynomial f(θ) = Σ_n w_n sin(n·θ) of phases θ with integer frequencies n.
///
/// Along any line, f projected on a direction is a real function of exponential type, bounded by F = max |f|. What the
/// searches over the zone use of it, with σ = `type()` for boxes and R = `euclidean_type()` for balls:
///   Bernstein         the m-th derivative in a unit direction is at most Rᵐ F;
///   Duffin, Schaeffer |d arcsin(f/F)| ≤ σ |dx|: at distance |x| (max norm) from a point where f = F it is at least
///                     F cos(σ|x|) (M. Riesz), from a zero at most F sin(σ|x|), for σ|x| ≤ π/2.
template <int Dim>
class SineSeries {
 public:
  /// `terms` hold one of each pair n, −n.
  /// `coefficient_error` bounds the sum of the errors that the coefficients bring with them.
  explicit SineSeries(std::vector<SineTerm<Dim>> terms, double coefficient_error = 0.0);

  const std::vector<SineTerm<Dim>>& terms() const { return terms_; }
  Vector<Dim> operator()(const Vector<Dim>& phases) const;
  SineJet<Dim> jet(const Vector<Dim>& phases) const;

  /// max |n_i| on each axis.
  const LatticeIndex<Dim>& reach() const { return reach_; }
  /// max Σ|n_i|.
  double type() const { return type_; }
  /// max |n|.
  double euclidean_type() const { return euclidean_type_; }
  /// Bounds on the first, second and third derivative in any unit direction from the coefficients: for unit e and u,
  /// Σ|w·e||n·u|ᵐ ≤ √(Σ (w·e)²|n|ᵐ/|w| · Σ (n·u)²|n|ᵐ⁻²|w|) (Cauchy, Schwarz), two largest eigenvalues. Sharper than
  /// Bernstein's for wide kernels, whose outermost neighbours weigh little.
  double derivative_bound(int order) const { return derivative_bounds_[order - 1]; }
  /// Bound on the rounding error of a computed value (Euclidean norm): every term carries the errors of a product of
  /// tabulated powers of e^{iθ} and of its addition to the sum. A derivative's is at most R times it, a second one's
  /// R².
  double rounding() const { return rounding_; }

 private:
  template <class Visit>
  void for_each_term(const Vector<Dim>& phases, const Visit& visit) const;

  std::vector<SineTerm<Dim>> terms_;
  LatticeIndex<Dim> reach_;
  double type_ = 0.0;
  double euclidean_type_ = 0.0;
  std::array<double, 3> derivative_bounds_;
  double rounding_ = 0.0;
};

extern template class SineSeries<1>;
extern template class SineSeries<2>;
extern template class SineSeries<3>;

}  // namespace sphstab::analysis
