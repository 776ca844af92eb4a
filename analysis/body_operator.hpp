// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "model/body.hpp"

namespace sphstab::analysis {

/// The linear operator of a body, M d²s/dt² = −S s + M load, s = (s_1, s_2, …) with the components of a particle
/// adjacent and those that are clamped left out:
///   ε_a     = (1/N_a) sym Σ_b V_b (s_b − s_a) ⊗ ∇_a W_ab                              Zhang's Eq. 9
///   (S s)_a = −V_a Σ_b V_b (σ_a + σ_b) · ∇_a W_ab,  σ_a = 2 G_a ε_a + λ_a tr ε_a I       Eq. 7, times ρ_a V_a N_a
///   M_a     = ρ_a V_a N_a
/// N = 1 or the kernel normalisation Σ V W, W(0) included. S = Σ_a (V_a/N_a) B_aᵀ C_a B_a, B_a the sum of Eq. 9 at
/// particle a: symmetric and not negative, so that M^−½ S M^−½ has the frequencies ω² ≥ 0 (docs/spectrum.md, also for
/// several materials). Keeps a reference to the body; one thread at a time. Tested in
/// tests/analysis/test_body_operator.cpp.
template <int Dim>
class BodyOperator {
 public:
  /// Throws InvalidInput for `density_in_momentum` equation-of-state about a strained state.
  BodyOperator(const Problem<Dim>& problem, const Body<Dim>& body);

  /// y = M^−½ S M^−½ x over all components, clamped ones 0: the strain of each particle, then its force. Allocates
  /// nothing. Accuracy: `rounding()`.
  void apply(const Eigen::VectorXd& x, Eigen::VectorXd& y);

  /// M^−½ x over all components: a displacement from an eigenvector.
  Eigen::VectorXd displacement(const Eigen::VectorXd& x) const { return root_inverse_mass_.cwiseProduct(x); }

  const Body<Dim>& body() const { return body_; }
  int components() const { return static_cast<int>(root_inverse_mass_.size()); }
  /// M^−½ of every component, 0 where it is clamped.
  const Eigen::VectorXd& root_inverse_mass() const { return root_inverse_mass_; }
  /// The components that are not clamped, ascending: the unknowns of `matrix`.
  const std::vector<int>& unknowns() const { return unknowns_; }

  /// M^−½ S M^−½ of the unknowns, its lower triangle. Accuracy: `rounding()`.
  Eigen::SparseMatrix<double> matrix() const;
  /// The particle's position of each unknown, a column each.
  Eigen::MatrixXd places() const;

  /// V_b ∇_a W_ab of an entry of body().pairs.
  const Vector<Dim>& gradient(int pair) const { return gradient_[pair]; }
  /// −Σ_b V_b ∇_a W_ab: what the displacement of a particle itself adds to its strain.
  const Vector<Dim>& own_gradient(int a) const { return own_gradient_[a]; }
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

  const Body<Dim>& body_;
  std::vector<Vector<Dim>> gradient_;
  std::vector<Vector<Dim>> own_gradient_;
  std::vector<Moduli> moduli_;
  Eigen::VectorXd root_inverse_mass_;
  std::vector<int> unknowns_;
  std::vector<Vector<Dim>> displacement_;  ///< of `apply`
  std::vector<Tensor<Dim>> stress_;        ///< of `apply`
};

extern template class BodyOperator<1>;
extern template class BodyOperator<2>;
extern template class BodyOperator<3>;

}  // namespace sphstab::analysis
