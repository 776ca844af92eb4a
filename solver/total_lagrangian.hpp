// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <memory>
#include <optional>
#include <vector>

#include "model/body.hpp"
#include "solver/state.hpp"

namespace sphstab::solver {

/// What the running solvers of the total-Lagrangian schemes share: pairs that never change, loads, clamps, damping,
/// steps and counters. What the forces between particles are is theirs.
template <int Dim, class Scalar = double>
class TotalLagrangian {
 public:
  virtual ~TotalLagrangian() = default;

  int particles() const { return static_cast<int>(material_.size()); }

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

  /// The mass of particle a in the momentum and the energy that the scheme keeps (per thickness in 2-D).
  virtual double inertia(int a) const = 0;

  /// σ of particle a, base state included, a pressure, positive in tension.
  virtual Tensor<Dim, Scalar> stress(const State<Dim, Scalar>& state, int a) const = 0;

  /// Von Mises stress of particle a with the stress out of the modelled directions counted.
  virtual Scalar von_mises_stress(const State<Dim, Scalar>& state, int a) const = 0;

  /// The energy of strain (per thickness in 2-D).
  virtual Scalar strain_energy(const State<Dim, Scalar>& state) const = 0;

  /// An energy (per thickness in 2-D) that is quadratic in a small perturbation s of the base state and zero for rigid
  /// motion and zero-energy modes: what is to grow when a run is said to.
  virtual Scalar perturbation_energy(const State<Dim, Scalar>& state) const = 0;

  /// ½ Σ_a m_a v_a² with the masses `inertia`.
  Scalar kinetic_energy(const State<Dim, Scalar>& state) const;

  /// How often the forces have been evaluated.
  long right_hand_sides() const { return right_hand_sides_; }

 protected:
  struct Substance {
    LameConstants lame;
    double inverse_density;
  };

  TotalLagrangian(const Problem<Dim>& problem, const Body<Dim>& body);

  /// Forces of the particles on each other, per mass.
  virtual void internal_accelerations(const Field<Dim, Scalar>& displacement, Field<Dim, Scalar>& acceleration) = 0;

  const Substance& substance(int a) const { return substances_[material_[a]]; }

  std::vector<int> first_;
  std::vector<int> neighbour_;
  Field<Dim, Real<Scalar>> g_;  ///< per pair, V_b ∂W_ab/∂x_a as the scheme weights it: filled by the derived class

 private:
  struct HeldDirection {
    int particle;
    int axis;
  };

  void undamped_accelerations(const Field<Dim, Scalar>& displacement, Field<Dim, Scalar>& acceleration);

  std::optional<Damping> damping_;
  Integrator integrator_;
  std::vector<Substance> substances_;  ///< what the body is made of
  std::vector<int> material_;          ///< which of them
  Field<Dim, Real<Scalar>> load_;      ///< empty: none
  std::vector<HeldDirection> held_;
  Field<Dim, Scalar> acceleration_;
  long right_hand_sides_ = 0;
};

/// The running solver of the problem's formulation. Throws InvalidInput (`scheme`) for one that is not total
/// Lagrangian.
template <int Dim, class Scalar = double>
std::unique_ptr<TotalLagrangian<Dim, Scalar>> make_simulation(const Problem<Dim>& problem, const Body<Dim>& body);

extern template class TotalLagrangian<1, double>;
extern template std::unique_ptr<TotalLagrangian<1, double>> make_simulation(const Problem<1>&, const Body<1>&);
extern template class TotalLagrangian<1, float>;
extern template std::unique_ptr<TotalLagrangian<1, float>> make_simulation(const Problem<1>&, const Body<1>&);
extern template class TotalLagrangian<1, std::complex<double>>;
extern template std::unique_ptr<TotalLagrangian<1, std::complex<double>>> make_simulation(const Problem<1>&,
                                                                                          const Body<1>&);
extern template class TotalLagrangian<2, double>;
extern template std::unique_ptr<TotalLagrangian<2, double>> make_simulation(const Problem<2>&, const Body<2>&);
extern template class TotalLagrangian<2, float>;
extern template std::unique_ptr<TotalLagrangian<2, float>> make_simulation(const Problem<2>&, const Body<2>&);
extern template class TotalLagrangian<2, std::complex<double>>;
extern template std::unique_ptr<TotalLagrangian<2, std::complex<double>>> make_simulation(const Problem<2>&,
                                                                                          const Body<2>&);
extern template class TotalLagrangian<3, double>;
extern template std::unique_ptr<TotalLagrangian<3, double>> make_simulation(const Problem<3>&, const Body<3>&);
extern template class TotalLagrangian<3, float>;
extern template std::unique_ptr<TotalLagrangian<3, float>> make_simulation(const Problem<3>&, const Body<3>&);
extern template class TotalLagrangian<3, std::complex<double>>;
extern template std::unique_ptr<TotalLagrangian<3, std::complex<double>>> make_simulation(const Problem<3>&,
                                                                                          const Body<3>&);

}  // namespace sphstab::solver
