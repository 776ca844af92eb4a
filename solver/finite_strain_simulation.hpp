// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <vector>

#include "solver/finite_strain.hpp"
#include "solver/total_lagrangian.hpp"

namespace sphstab::solver {

/// The running solver of finite strain: `tl-corotated`, Tran-Duc, Meylan & Thamwattana, Sec. 2.3, and `tl-pk1`, the
/// same with the force of the first Piola-Kirchhoff stress, for bodies of several materials, held and loaded.
///
/// With ∇_a W_ab and N_a = [Σ_b V_b (X_b − X_a) ⊗ ∇_a W_ab]⁻¹ of the reference state, x = F0 X + s, and the λ, G and ρ0
/// of each particle's material,
///   F_a = F0 + Σ_b V_b (s_b − s_a) ⊗ N_a ∇_a W_ab,
///   dv_a/dt = (1/ρ0_a) Σ_b V_b (P_a N_a + P_b N_b) ∇_a W_ab + load_a − c v_a,
/// P = R(F) S(F) in `tl-corotated` and F S(F) in `tl-pk1` (solver/finite_strain.hpp). The F of any uniform deformation
/// is exact, N being of the bulk and the edges alike; N is symmetric, since ∇W is along X_b − X_a. Two dimensions are
/// plane strain, one is uniaxial strain. In directions in which a particle is clamped, s and v are 0. Kernels and N are
/// evaluated in the constructor only; nothing is allocated afterwards. A particle whose ln J does not exist makes a
/// neo-Hookean run not finite; nothing throws. Scalar is double, float, or std::complex<double> for derivatives by
/// complex step (solver/step_jacobian.hpp). Checked against sums over all pairs in
/// tests/solver/test_finite_strain.cpp.
template <int Dim, class Scalar = double>
class FiniteStrainSimulation final : public TotalLagrangian<Dim, Scalar> {
 public:
  /// Throws InvalidInput (`scheme`, `elastic_law`, `plane`) for what is not finite strain, and (`body`) naming the
  /// first particle whose neighbours lie in a plane, in a line or nowhere, so that its N does not exist.
  FiniteStrainSimulation(const Problem<Dim>& problem, const Body<Dim>& body);

  /// ρ0 V of particle a, a mass (per thickness in 2-D). With these masses a free body keeps its momentum and its
  /// angular momentum, and under `tl-pk1` any body its energy.
  double inertia(int a) const override;

  /// F of particle a, base state included.
  Tensor<Dim, Scalar> deformation_gradient(const State<Dim, Scalar>& state, int a) const;

  /// The Cauchy stress P Fᵀ/J of particle a, base state included; a pressure, positive in tension. That of
  /// `tl-corotated` is R S U Rᵀ/J, with F = R U.
  Tensor<Dim, Scalar> stress(const State<Dim, Scalar>& state, int a) const override;

  /// Von Mises stress of particle a with the stress out of the modelled directions counted (solver/finite_strain.hpp).
  Scalar von_mises_stress(const State<Dim, Scalar>& state, int a) const override;

  /// Σ_a V_a W(F_a), base state included, an energy (per thickness in 2-D): the potential of the forces of `tl-pk1`.
  /// The forces of `tl-corotated` have none; its W is that of Saint Venant-Kirchhoff, a measure of strain.
  Scalar strain_energy(const State<Dim, Scalar>& state) const override;

  /// ½ Σ_a V_a (λ tr²e + 2 G e : e), e = sym(F0ᵀ Σ_b V_b (s_b − s_a) ⊗ N_a ∇_a W_ab): an energy that is a norm of a
  /// small perturbation s of the base state, and zero for its translations, rotations (to first order) and zero-energy
  /// modes. Neither the stress of the base state nor its effect on stiffness counts.
  Scalar perturbation_energy(const State<Dim, Scalar>& state) const override;

 private:
  using Base = TotalLagrangian<Dim, Scalar>;
  using Base::first_, Base::g_, Base::neighbour_, Base::substance;

  Tensor<Dim, Scalar> perturbation_gradient(const Field<Dim, Scalar>& displacement, int a) const;
  Tensor<3, Scalar> stress_in_space(const State<Dim, Scalar>& state, int a) const;
  template <StressMeasure measure>
  void store_stresses(const Field<Dim, Scalar>& displacement);
  void internal_accelerations(const Field<Dim, Scalar>& displacement, Field<Dim, Scalar>& acceleration) override;

  StressMeasure measure_;
  Tensor<Dim, Real<Scalar>> base_gradient_;            ///< F0
  std::vector<double> volume_;                         ///< V
  std::vector<Tensor<Dim, Real<Scalar>>> correction_;  ///< N
  std::vector<Tensor<Dim, Scalar>> corrected_stress_;  ///< P N of the last evaluation
};

extern template class FiniteStrainSimulation<1, double>;
extern template class FiniteStrainSimulation<1, float>;
extern template class FiniteStrainSimulation<1, std::complex<double>>;
extern template class FiniteStrainSimulation<2, double>;
extern template class FiniteStrainSimulation<2, float>;
extern template class FiniteStrainSimulation<2, std::complex<double>>;
extern template class FiniteStrainSimulation<3, double>;
extern template class FiniteStrainSimulation<3, float>;
extern template class FiniteStrainSimulation<3, std::complex<double>>;

}  // namespace sphstab::solver
