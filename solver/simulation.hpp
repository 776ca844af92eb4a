// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "model/body.hpp"
#include "solver/state.hpp"

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
class Simulation {
 public:
  Simulation(const Problem<Dim>& problem, const Body<Dim>& body);

  int particles() const { return static_cast<int>(weight_.size()); }

  /// F(r, v), force per mass (length / time²), into a buffer of particles() vectors; 0 where a particle is clamped. The
  /// state must obey the clamps.
  void accelerations(const State<Dim, Scalar>& state, Field<Dim, Scalar>& acceleration);

  /// `steps` steps of the problem's integrator (solver/stepper.hpp). A pure function of the state, which is first made
  /// to obey the clamps.
  void advance(State<Dim, Scalar>& state, double time_step, long steps = 1);

  /// Puts displacement and velocity to 0 in the directions that are clamped.
  void hold(State<Dim, Scalar>& state) const;

  /// Another damping from here on.
  void set_damping(const std::optional<Damping>& damping) { damping_ = damping; }

  /// ρ0 V N of particle a, a mass (per thickness in 2-D). With these masses a free body keeps its momentum, and any
  /// body its energy; without normalisation N = 1.
  double inertia(int a) const { return weight_[a] / substances_[material_[a]].inverse_density; }

  /// ε of particle a, base state included (9).
  Tensor<Dim, Scalar> strain(const State<Dim, Scalar>& state, int a) const;

  /// σ of particle a, base state included (3, 8), whatever the density in the momentum equation; a pressure.
  Tensor<Dim, Scalar> stress(const State<Dim, Scalar>& state, int a) const;

  /// Von Mises stress of particle a with the stress out of the plane counted (solver/stress.hpp).
  Scalar von_mises_stress(const State<Dim, Scalar>& state, int a) const;

  /// ½ Σ_a V_a N_a σ(δε_a) : δε_a, an energy (per thickness in 2-D), where δε is the strain of the perturbation s
  /// alone: zero for a translation and for every zero-energy mode.
  Scalar strain_energy(const State<Dim, Scalar>& state) const;

  /// ½ Σ_a ρ0_a V_a N_a v_a².
  Scalar kinetic_energy(const State<Dim, Scalar>& state) const;

  /// How often the sums of Eqs. 7 and 9 have been evaluated.
  long right_hand_sides() const { return right_hand_sides_; }

 private:
  struct Substance {
    LameConstants lame;
    double inverse_density;
  };
  struct HeldDirection {
    int particle;
    int axis;
  };

  Tensor<Dim, Scalar> perturbation_strain(const Field<Dim, Scalar>& displacement, int a) const;
  template <MomentumDensity density>
  void store_stresses(const Field<Dim, Scalar>& displacement);
  void undamped_accelerations(const Field<Dim, Scalar>& displacement, Field<Dim, Scalar>& acceleration);

  Plane plane_;
  MomentumDensity momentum_density_;
  std::optional<Damping> damping_;
  Integrator integrator_;

  std::vector<Substance> substances_;  ///< what the body is made of
  std::vector<int> material_;          ///< which of them
  std::vector<double> weight_;         ///< V N
  std::vector<int> first_;
  std::vector<int> neighbour_;
  Field<Dim, Real<Scalar>> g_;                          ///< per pair
  std::vector<Tensor<Dim, Real<Scalar>>> base_strain_;  ///< sym Σ_b H r_ba ⊗ g_ab
  Field<Dim, Real<Scalar>> load_;                       ///< empty: none
  std::vector<HeldDirection> held_;

  std::vector<Tensor<Dim, Scalar>> P_;  ///< (ρ0/ρ)² σ of the last evaluation
  Field<Dim, Scalar> acceleration_;
  long right_hand_sides_ = 0;
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
