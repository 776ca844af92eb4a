// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <vector>

#include "solver/total_lagrangian.hpp"

namespace sphstab::solver {

/// The running solver of the total-Lagrangian linear scheme `tl-linear`: Zhang, Hu, Cui & Wang, Eqs. 6-11, for bodies
/// of several materials, held and loaded.
///
/// With g_ab = V_b ∂W_ab/∂x_a of the reference state, divided by N_a = Σ_b V_b W_ab (W(0) included) if the scheme
/// normalises, u = H x + s, P = (ρ0/ρ)² σ and the λ, G and ρ0 of each particle's material,
///   ε_a = sym Σ_b (u_b − u_a) ⊗ g_ab (9),   σ = λ tr(ε) I + 2 G ε (3, 8),
///   dv_a/dt = (1/ρ0_a) Σ_b (P_a + P_b) · g_ab + load_a − c v_a (7),
/// where ρ is ρ0 or exp(−tr₃ε) ρ0 (6). In directions in which a particle is clamped, s and v are 0. Kernels are
/// evaluated in the constructor only; nothing is allocated afterwards, and what a body does not have costs nothing.
/// Scalar is double, float, or std::complex<double> for derivatives by complex step (solver/step_jacobian.hpp).
/// Checked against sums over all pairs in tests/solver/test_accelerations.cpp and test_bodies.cpp.
template <int Dim, class Scalar = double>
class Simulation final : public TotalLagrangian<Dim, Scalar> {
 public:
  /// Throws InvalidInput (`scheme`) for any other formulation.
  Simulation(const Problem<Dim>& problem, const Body<Dim>& body);

  /// ρ0 V N of particle a, a mass (per thickness in 2-D). With these masses a free body keeps its momentum, and any
  /// body its energy; without normalisation N = 1.
  double inertia(int a) const override { return weight_[a] / substance(a).inverse_density; }

  /// ε of particle a, base state included (9).
  Tensor<Dim, Scalar> strain(const State<Dim, Scalar>& state, int a) const;

  /// σ of particle a, base state included (3, 8), whatever the density in the momentum equation; a pressure.
  Tensor<Dim, Scalar> stress(const State<Dim, Scalar>& state, int a) const override;

  /// Von Mises stress of particle a with the stress out of the plane counted (solver/stress.hpp).
  Scalar von_mises_stress(const State<Dim, Scalar>& state, int a) const override;

  /// ½ Σ_a V_a N_a σ(δε_a) : δε_a, an energy (per thickness in 2-D), where δε is the strain of the perturbation s
  /// alone: zero for a translation and for every zero-energy mode.
  Scalar strain_energy(const State<Dim, Scalar>& state) const override;

  /// The same.
  Scalar perturbation_energy(const State<Dim, Scalar>& state) const override { return strain_energy(state); }

 private:
  using Base = TotalLagrangian<Dim, Scalar>;
  using Base::first_, Base::g_, Base::neighbour_, Base::substance;

  Tensor<Dim, Scalar> perturbation_strain(const Field<Dim, Scalar>& displacement, int a) const;
  template <MomentumDensity density>
  void store_stresses(const Field<Dim, Scalar>& displacement);
  void internal_accelerations(const Field<Dim, Scalar>& displacement, Field<Dim, Scalar>& acceleration) override;

  Plane plane_;
  MomentumDensity momentum_density_;
  std::vector<double> weight_;                          ///< V N
  std::vector<Tensor<Dim, Real<Scalar>>> base_strain_;  ///< sym Σ_b H r_ba ⊗ g_ab
  std::vector<Tensor<Dim, Scalar>> P_;                  ///< (ρ0/ρ)² σ of the last evaluation
};

extern template class Simulation<1, double>;
extern template class Simulation<1, float>;
extern template class Simulation<1, std::complex<double>>;
extern template class Simulation<2, double>;
extern template class Simulation<2, float>;
extern template class Simulation<2, std::complex<double>>;
extern template class Simulation<3, double>;
extern template class Simulation<3, float>;
extern template class Simulation<3, std::complex<double>>;

}  // namespace sphstab::solver
