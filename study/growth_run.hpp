// SPDX-License-Identifier: MIT
#pragma once

#include "model/body.hpp"
#include "solver/state.hpp"
#include "study/perturbation_run.hpp"

namespace sphstab::study {

/// The total-Lagrangian solver of a body without its loads. A departure is s and v of one particle after another.
template <int Dim>
std::shared_ptr<PerturbedSolver> perturbed_body(const Problem<Dim>& problem, const Body<Dim>& body);

/// The growth of a body by the total-Lagrangian solver, in the norm of its strain energy: rigid motion and zero-energy
/// modes, which drift linearly in time, have none. The body is run without its loads, or under them about its
/// equilibrium, and the perturbation obeys its clamps.
///
/// A run starts from noise in the displacements, or from a given displacement, at rest (so that zero-energy modes do
/// not even drift).
template <int Dim>
class GrowthRun : public PerturbationRun {
 public:
  /// Perturbs with random displacements of every particle; the same `noise_seed` gives the same run on every machine.
  GrowthRun(const Problem<Dim>& problem, const Body<Dim>& body, unsigned noise_seed);

  /// Perturbs with this displacement only. Both throw InvalidInput (`patch`) for a perturbation without strain energy.
  GrowthRun(const Problem<Dim>& problem, const Body<Dim>& body, const solver::Field<Dim>& displacement);

  /// Perturbs the loaded body at rest in its equilibrium with noise. `equilibrium` must be exact to far below the
  /// perturbation, which are strains of 1e-10.
  GrowthRun(const Problem<Dim>& problem, const Body<Dim>& body, const solver::Field<Dim>& equilibrium,
            unsigned noise_seed);
};

}  // namespace sphstab::study
