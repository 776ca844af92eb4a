// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/body.hpp"
#include "solver/dual.hpp"
#include "solver/updated_neighbours.hpp"
#include "solver/updated_pair_terms.hpp"
#include "solver/updated_state.hpp"

namespace sphstab::solver {

/// The quantities of a state.
enum class UpdatedQuantity { position, velocity, density, deviatoric_stress };

/// What a step evaluates, in its order, and what it makes of that.
enum class UpdatedTerm {
  pair_distance,           ///< r, W(r) and W'(r)/r of all pairs: no direction where two particles are in one place
  equation_of_state,       ///< σ/ρ²
  artificial_stress,       ///< R
  viscosity,               ///< Π of a pair
  momentum,                ///< the sum F, loads included, and v + Δt F
  xsph,                    ///< v̂
  continuity,              ///< dρ/dt, and ρ + Δt dρ/dt, which must stay positive
  deviatoric_stress_rate,  ///< dS/dt, and S + Δt dS/dt
  drift                    ///< r + Δt v̂
};

}  // namespace sphstab::solver

namespace sphstab {

template <>
struct Names<solver::UpdatedQuantity> {
  static constexpr std::array<Named<solver::UpdatedQuantity>, 4> table{
      {{solver::UpdatedQuantity::position, "position"},
       {solver::UpdatedQuantity::velocity, "velocity"},
       {solver::UpdatedQuantity::density, "density"},
       {solver::UpdatedQuantity::deviatoric_stress, "deviatoric stress"}}};
};

template <>
struct Names<solver::UpdatedTerm> {
  static constexpr std::array<Named<solver::UpdatedTerm>, 9> table{
      {{solver::UpdatedTerm::pair_distance, "pair distance"},
       {solver::UpdatedTerm::equation_of_state, "equation of state"},
       {solver::UpdatedTerm::artificial_stress, "artificial stress"},
       {solver::UpdatedTerm::viscosity, "viscosity"},
       {solver::UpdatedTerm::momentum, "momentum sum"},
       {solver::UpdatedTerm::xsph, "XSPH"},
       {solver::UpdatedTerm::continuity, "continuity"},
       {solver::UpdatedTerm::deviatoric_stress_rate, "deviatoric stress rate"},
       {solver::UpdatedTerm::drift, "drift"}}};
};

}  // namespace sphstab

namespace sphstab::solver {

/// Where a run left the numbers: the first particle, and its first quantity, that is infinite or no number, or a
/// density that is not positive.
struct NotFinite {
  long step;  ///< of this call, from 1; 0: the state was not finite to begin with
  int particle;
  UpdatedQuantity quantity;
};

/// The term whose rate a quantity has.
UpdatedTerm maker_of(UpdatedQuantity quantity);

/// The term of a step that first made no number, and the first particle of which.
struct BrokenTerm {
  UpdatedTerm term;
  int particle;
};

/// How often each part of a step has been evaluated, each time for all particles.
struct UpdatedWork {
  long list_builds = 0;          ///< searches for neighbours
  long placements = 0;           ///< distances and kernels of all pairs
  long forces = 0;               ///< F
  long rates = 0;                ///< D
  long smoothings = 0;           ///< XSPH
  long artificial_stresses = 0;  ///< principal stresses
};

/// The running solver of the updated-Lagrangian scheme `ul`: Gray, Monaghan & Swift, Eqs. 2.2-2.7 and 3.1-3.14, of
/// nonlinear motion in a periodic box or of free particles.
///
/// With g_ab = ∇_a W_ab at the present positions, σ = −P I + S, P = c0²(ρ − ρ0) and the smoothed velocity v̂ (3.6),
///   dv_a/dt = Σ_b m_b (σ_a/ρ_a² + σ_b/ρ_b² + Π_ab I + (R_a + R_b) φ_ab) · g_ab + load_a,   dr_a/dt = v̂_a,
///   dρ_a/dt = Σ_b m_b v̂_ab · g_ab (3.8) or ρ_a Σ_b (m_b/ρ_b) v̂_ab · g_ab (3.9),
///   dS_a/dt by (2.3) from ∂v̂_i/∂x_j = Σ_b (m_b/ρ_b) (v̂_b − v̂_a)_i (g_ab)_j (3.10);
/// h and W(Δp) are constant, and Π takes the sound speed of the problem's material. Where particles are held, v and v̂
/// are 0 and their density and stress go on. Terms that the scheme does not name cost nothing; a step allocates nothing
/// unless it builds the list of neighbours. Pairs are summed once for both particles.
/// The artificial stress follows the stress whatever the scheme says of its linearisation. Scalar is double, float, or
/// Dual for derivatives. Checked against sums over all pairs in tests/solver/test_updated_simulation.cpp.
template <int Dim, class Scalar = double>
class UpdatedSimulation {
 public:
  /// A periodic box of n_1 × … × n_Dim cells of the lattice (periodic_patch).
  UpdatedSimulation(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells);
  /// The particles of a body, some perhaps held or loaded: free ones, or in a periodic box of so many cells of the
  /// lattice. Of the neighbours of the body nothing is used.
  /// Both throw InvalidInput for another scheme, another rule of neighbours than `support`, plane stress and materials
  /// of Poisson's ratio 0.5 other than fluids.
  UpdatedSimulation(const Problem<Dim>& problem, const Body<Dim>& body,
                    const std::optional<LatticeIndex<Dim>>& periodic_cells = std::nullopt);

  int particles() const { return static_cast<int>(mass_.size()); }

  /// At rest in the uniform base state: density ρ0 + P/c0² and S of the problem.
  const UpdatedState<Dim, Scalar>& base_state() const { return base_state_; }

  /// `steps` steps of the problem's integrator (solver/updated_stepper.hpp), or fewer: it stops after a step that
  /// leaves the finite numbers, and says where. The state is first made to obey the clamps. With
  /// predictor-corrector-pec a state without stored rates gets those of its own first.
  std::optional<NotFinite> advance(UpdatedState<Dim, Scalar>& state, double time_step, long steps = 1);

  /// What broke in the one step from a finite state to one that is not: makes it once more and looks at every part of
  /// it in its turn. Nothing if it is a step to a finite state. Tested term by term in
  /// tests/solver/test_updated_failures.cpp.
  std::optional<BrokenTerm> broken_term(UpdatedState<Dim, Scalar> state, double time_step);

  /// What solver/updated_stepper.hpp asks of a system, of states that obey the clamps. All but the first are those of
  /// the positions that were placed last.
  void place(const Field<Dim, Scalar>& position);
  void forces(const UpdatedState<Dim, Scalar>& state, Field<Dim, Scalar>& acceleration);
  const Field<Dim, Scalar>& smoothed(const UpdatedState<Dim, Scalar>& state);
  void rates(const UpdatedState<Dim, Scalar>& state, const Field<Dim, Scalar>& smoothed,
             UpdatedRates<Dim, Scalar>& rates);
  bool force_feels_velocity() const { return scheme_.viscosity.has_value(); }

  /// Puts velocities to 0 in the directions that are clamped.
  void hold(UpdatedState<Dim, Scalar>& state) const { hold(state.velocity); }

  /// σ of particle a, a pressure, positive in tension.
  Tensor<Dim, Scalar> stress(const UpdatedState<Dim, Scalar>& state, int a) const;

  /// Von Mises stress of particle a with the stress out of the modelled directions counted.
  Scalar von_mises_stress(const UpdatedState<Dim, Scalar>& state, int a) const;

  /// Particles that have no other one within the support of the positions that were placed last; not a single one in
  /// its box.
  std::vector<int> isolated_particles() const;

  double mass(int a) const { return value_of(mass_[a]); }
  /// Σ (m/ρ)(P²/(2K) + |S|²/(4μ)), |S|² with its components out of the modelled directions; a fluid has no S. An energy
  /// (per thickness in 2-D): that of small strains of an elastic body, which no sum of the scheme keeps exactly.
  Scalar elastic_energy(const UpdatedState<Dim, Scalar>& state) const;
  /// ½ Σ m v², with the velocity that is not smoothed.
  Scalar kinetic_energy(const UpdatedState<Dim, Scalar>& state) const;
  /// Σ m v.
  Vector<Dim, Scalar> momentum(const UpdatedState<Dim, Scalar>& state) const;
  /// Σ m (r ⊗ v − v ⊗ r) about the origin; component (0, 1) is x v_y − y v_x.
  Tensor<Dim, Scalar> angular_momentum(const UpdatedState<Dim, Scalar>& state) const;

  const UpdatedWork& work() const { return work_; }
  /// Pairs within the support of the positions that were placed last, each counted once.
  int pairs() const { return static_cast<int>(first_.back()); }

 private:
  struct Substance {
    Scalar reference_density;
    Scalar sound_speed_squared;
    Scalar shear_modulus;
  };
  struct HeldDirection {
    int particle;
    int axis;
  };
  enum class Viscous { none, all, approaching };
  struct ViscousConstants {
    Scalar alpha_h_c0;
    Scalar eta_h_squared;
  };
  class Observed;

  void hold(Field<Dim, Scalar>& field) const;

  template <class System>
  void store_first_rates(System& system, UpdatedState<Dim, Scalar>& state) const;
  void weigh_pairs(int begin, int size);
  ViscousConstants viscous_constants() const;
  void store_stresses(const UpdatedState<Dim, Scalar>& state);
  template <bool artificial, Viscous viscous>
  void sum_forces(const UpdatedState<Dim, Scalar>& state, Field<Dim, Scalar>& acceleration);
  template <DensityRate density_rate>
  void sum_gradients(const UpdatedState<Dim, Scalar>& state, const Field<Dim, Scalar>& smoothed,
                     std::vector<Scalar>& density_rates);

  Scheme scheme_;
  Integrator integrator_;
  Kernel<Dim> kernel_;
  double spacing_;
  double sound_speed_;

  std::vector<Substance> substances_;
  std::vector<int> material_;
  std::vector<Scalar> mass_;
  Field<Dim, Scalar> load_;  ///< empty: none
  std::vector<HeldDirection> held_;
  UpdatedState<Dim, Scalar> base_state_;

  NeighbourList<Dim> neighbours_;
  std::vector<int> first_;         ///< pairs of a and some b > a: first_[a] … first_[a+1] − 1
  std::vector<int> neighbour_;     ///< b, per pair
  Field<Dim, Scalar> separation_;  ///< r_ab, per pair
  std::vector<Scalar> F_;          ///< W'(r)/r, per pair
  std::vector<Scalar> W_;          ///< per pair, with XSPH
  std::vector<Scalar> phi_;        ///< per pair, with artificial stress

  TensorField<Dim, Scalar> stress_;             ///< σ/ρ²
  TensorField<Dim, Scalar> artificial_stress_;  ///< R
  Field<Dim, Scalar> smoothed_;                 ///< v̂
  TensorField<Dim, Scalar> gradient_;           ///< ∂v̂_i/∂x_j
  UpdatedRates<Dim, Scalar> rates_, next_rates_;
  UpdatedWork work_;
};

extern template class UpdatedSimulation<1, double>;
extern template class UpdatedSimulation<1, float>;
extern template class UpdatedSimulation<1, Dual>;
extern template class UpdatedSimulation<2, double>;
extern template class UpdatedSimulation<2, float>;
extern template class UpdatedSimulation<2, Dual>;
extern template class UpdatedSimulation<3, double>;
extern template class UpdatedSimulation<3, float>;
extern template class UpdatedSimulation<3, Dual>;

}  // namespace sphstab::solver
