// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "analysis/linearised_body.hpp"

namespace sphstab::analysis {

/// The linear operator of a body about its undeformed state, M d²s/dt² = −S s, in the notation of LinearisedBody:
///   ε_a     = (1/N_a) sym Σ_b V_b (s_b − s_a) ⊗ ∇_a W_ab                              Zhang's Eq. 9
///   (S s)_a = −V_a Σ_b V_b (σ_a + σ_b) · ∇_a W_ab,  σ_a = 2 G_a ε_a + λ_a tr ε_a I       Eq. 7, times ρ_a V_a N_a
/// of `tl-linear`; `tl-corotated` and `tl-pk1`, any elastic law, have N_a ∇_a W_ab in the strain of a and
/// (σ_a N_a + σ_b N_b) · ∇_a W_ab in the force, N_a the tensor. S = Σ_a (V_a/N_a) B_aᵀ C_a B_a, B_a the sum of the
/// strain at particle a: symmetric and not negative, so that M^−½ S M^−½ has the frequencies ω² ≥ 0 (docs/spectrum.md,
/// also for several materials). Tested in tests/analysis/test_body_operator.cpp.
template <int Dim>
class BodyOperator : public LinearisedBody<Dim> {
 public:
  /// Throws InvalidInput for `density_in_momentum` equation-of-state about a strained state, and for a
  /// `deformation_gradient`: DeformedBodyOperator is about those.
  BodyOperator(const Problem<Dim>& problem, const Body<Dim>& body);

  /// y = M^−½ S M^−½ x over all components, clamped ones 0: the strain of each particle, then its force. Allocates
  /// nothing. Accuracy: `rounding()`.
  void apply(const Eigen::VectorXd& x, Eigen::VectorXd& y);

  /// M^−½ S M^−½ of the unknowns, its lower triangle. Accuracy: `rounding()`.
  Eigen::SparseMatrix<double> matrix() const;

  /// The constants of σ = 2 G ε + λ tr ε I over N_a.
  struct Moduli {
    double shear;
    double lambda;
  };
  const Moduli& moduli(int a) const { return moduli_[a]; }

  /// Bound on the norm of what rounding adds to M^−½ S M^−½, assembled or applied: unit roundings of the longest chain
  /// of operations times a bound on the norm of the operator with all its terms positive.
  double rounding() const;

  /// An upper bound on the eigenvalues of M^−½ S M^−½, proven and without storing a matrix: the largest sum of the
  /// entries of a row (Gershgorin), rounding included. Tested in tests/analysis/test_spectrum.cpp.
  double norm_bound() const;

 private:
  class Row;
  using Base = LinearisedBody<Dim>;
  using Base::body_;
  using Base::gradient_;
  using Base::renormalisation_;
  using Base::root_inverse_mass_;
  using Base::unknowns_;

  /// N_a g of finite strain, g itself otherwise.
  Vector<Dim> renormalised(int a, const Vector<Dim>& g) const {
    return renormalisation_.empty() ? g : Vector<Dim>(renormalisation_[a] * g);
  }

  std::vector<Vector<Dim>> own_gradient_;  ///< −Σ_b V_b ∇_a W_ab: what the displacement of a itself adds to its strain
  std::vector<Moduli> moduli_;
};

extern template class BodyOperator<1>;
extern template class BodyOperator<2>;
extern template class BodyOperator<3>;

}  // namespace sphstab::analysis
