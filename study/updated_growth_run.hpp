// SPDX-License-Identifier: MIT
#pragma once

#include "solver/updated_simulation.hpp"
#include "study/perturbation_run.hpp"

namespace sphstab::study {

/// The updated-Lagrangian solver on a periodic patch about its uniform base state. A departure is a flat state
/// (solver/updated_state.hpp) less that of the base state, stored rates included.
///
/// Its amplitude is √(e/(½ M c_p²)), M the mass of the patch, with the energy
///   e = ½ Σ m [v² + (c0 δρ/ρ̄)² + |δS|²/(2μρ̄)]
/// of its motion and of its stresses, |S|² of all three directions (tr S = 0; left out where μ = 0). At zero stress and
/// in continuous time e is constant; a drift adds nothing to it, since v is constant there and δρ, δS do not change.
/// The stresses alone would miss what grows where A(k) = 0: clumping has none. A wave that is marginal under a constant
/// force grows like t, which judge_growth tells from growth.
template <int Dim>
class PerturbedPatch : public PerturbedSolver {
 public:
  /// Throws InvalidInput as UpdatedSimulation does.
  PerturbedPatch(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells);

  int particles() const { return simulation_.particles(); }
  int numbers_per_particle() const { return static_cast<int>(base_.size()) / particles(); }

  /// In the velocities, without momentum. Throws InvalidInput (`patch`) for a patch of one cell, which has no motion
  /// but that of all.
  Eigen::VectorXd noise_departure(unsigned noise_seed) override;
  void advance(Eigen::VectorXd& departure, double time_step, int steps) override;
  double amplitude(const Eigen::VectorXd& departure) override;
  /// Large enough for the rounding of positions, 1e-15, to do no more to growth than 1e-6. Where a step is long, so
  /// that it moves no farther.
  double seed_amplitude(double time_step) const override;
  /// 1e-6, or less where the stress is weak: where neighbours sit on a kink of W'', the error of growth is of that
  /// order.
  double largest_amplitude() const override { return largest_amplitude_; }

 private:
  solver::UpdatedSimulation<Dim> simulation_;
  solver::UpdatedState<Dim> state_;
  Eigen::VectorXd base_;
  double crossing_time_;  ///< Δp / c_p
  double speed_of_p_waves_;
  double of_density_;  ///< c0/ρ̄
  double largest_amplitude_;
  double of_deviatoric_;  ///< 1/(2μρ̄), 0 where μ = 0
};

/// The growth of a periodic patch by the updated-Lagrangian solver.
///
/// A run starts from noise in the velocities, without momentum, at the stresses of the base state (displacements would
/// make no force at zero stress, noise in the stresses may make a constant one), or from a given departure.
template <int Dim>
class UpdatedGrowthRun : public PerturbationRun {
 public:
  /// The same `noise_seed` gives the same run on every machine. Throws InvalidInput (`patch`) for a patch of one cell.
  UpdatedGrowthRun(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells, unsigned noise_seed);
  UpdatedGrowthRun(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells, const Eigen::VectorXd& departure);
};

}  // namespace sphstab::study
