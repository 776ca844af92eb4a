// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "model/body.hpp"
#include "solver/growth.hpp"
#include "solver/simulation.hpp"

namespace sphstab::study {

/// Runs one body at one time step after another and measures how the strain energy of a small perturbation grows. The
/// body is run without its loads, or under them about its equilibrium, and the perturbation obeys its clamps.
///
/// A run starts from noise in the displacements, or from a given displacement, at rest (so that zero-energy modes do
/// not even drift). After a growing run the fastest mode is known to the solver: the next run starts from it with a
/// tenth of noise, which shows growth early without taking anything from the theory.
template <int Dim>
class GrowthRun {
 public:
  /// Perturbs with random displacements of every particle; the same `noise_seed` gives the same run on every machine.
  GrowthRun(const Problem<Dim>& problem, const Body<Dim>& body, unsigned noise_seed);

  /// Perturbs with this displacement only. Both throw InvalidInput (`patch`) for a perturbation without strain energy.
  GrowthRun(const Problem<Dim>& problem, const Body<Dim>& body, const solver::Field<Dim>& displacement);

  /// Perturbs the loaded body at rest in its equilibrium with noise. `equilibrium` must be exact to far below the
  /// perturbation, which are strains of 1e-10.
  GrowthRun(const Problem<Dim>& problem, const Body<Dim>& body, const solver::Field<Dim>& equilibrium,
            unsigned noise_seed);

  /// Runs `horizon` steps, up to four times as many while the trend is undecided, fewer once the growth is plain. Its
  /// signature is a GrowthProbe (study/bisection.hpp).
  solver::GrowthFit operator()(double time_step, long horizon);

 private:
  /// Starts at `equilibrium` + `displacement` and keeps the loads of the body.
  GrowthRun(const Problem<Dim>& problem, const Body<Dim>& body, const solver::Field<Dim>& equilibrium,
            const solver::Field<Dim>& displacement);

  const solver::State<Dim>& departure(const solver::State<Dim>& state);
  double amplitude(const solver::State<Dim>& departure) const;
  void scale_to_seed(solver::State<Dim>& departure) const;
  solver::State<Dim> first_departure() const;
  /// Appends amplitudes until `end` steps; false if the run exploded before.
  bool run(long end, double time_step, int stride, solver::State<Dim>& state, std::vector<double>& log_amplitude);

  solver::Simulation<Dim> simulation_;
  double energy_scale_;        ///< of a strain of 1
  double largest_e_foldings_;  ///< of a run
  solver::Field<Dim> equilibrium_;
  solver::State<Dim> departure_;  ///< from the equilibrium, of the last state that was asked for
  solver::State<Dim> seed_;       ///< a departure
  std::optional<solver::State<Dim>> fastest_mode_;
};

}  // namespace sphstab::study
