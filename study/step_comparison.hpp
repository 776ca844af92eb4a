// SPDX-License-Identifier: MIT
#pragma once

#include <variant>

#include "model/body.hpp"
#include "solver/state.hpp"
#include "study/bisection.hpp"

namespace sphstab::study {

/// Cells of the problem's lattice along each primitive vector, with periodic images.
template <int Dim>
struct PeriodicPatch {
  LatticeIndex<Dim> cells;
};

/// What is run. Loads of a body do not count: growth is that of a perturbation.
template <int Dim>
using BodyChoice = std::variant<PeriodicPatch<Dim>, Body<Dim>>;

struct RunOptions {
  bool start_from_mode = false;  ///< of the theory, instead of noise
  unsigned noise_seed = 1;
  double tolerance = 1e-6;
  std::optional<long> horizon = std::nullopt;
  std::function<void(double low, double high)> progress = nullptr;  ///< after each run
};

/// What theory says of what is run: the admitted wave vectors of a patch, the spectrum of a body. Without any value
/// nothing limits Δt.
struct TheoryLimit {
  std::optional<double> critical_time_step = std::nullopt;
  std::optional<double> growth_rate = std::nullopt;  ///< of what grows in continuous time, 1 / time
  /// Of what grows at every Δt, in continuous time or, weakly, by its integrator alone: a step at which that shows.
  std::optional<double> growing_step = std::nullopt;
};

/// Growth per step at one step, ln of the amplitude's factor.
struct GrowthComparison {
  double time_step;
  double measured;
  double theory;  ///< ln of the largest spectral radius of the patch
};

/// To how much of itself a growth per step from noise is to agree with theory: what slower modes leave of the fastest.
inline constexpr double growth_tolerance = 5e-3;

/// The critical step of one body, by running and by theory. Absent values: there is no such step.
struct StepComparison {
  Bisection run;
  TheoryLimit theory;
  std::optional<double> bulk_theory;       ///< of the infinite lattice
  std::optional<GrowthComparison> growth;  ///< where theory says that every step grows

  /// |run − theory| / theory of the critical steps, if both exist, or of the growths.
  std::optional<double> relative_difference() const;
  /// theory / bulk_theory − 1: a periodic patch misses the critical wave vector, a body has edges.
  std::optional<double> patch_deficit() const;
  /// Both steps exist and agree within the tolerance, or both growths within growth_tolerance, or nothing grows in
  /// both.
  bool agrees(double tolerance) const;
};

/// Where a search by running starts, a rule of thumb well inside the stable range: 0.3 h over the largest p-wave speed
/// of the materials, or 0.3 over the damping rate, if that is less.
template <int Dim>
double scan_start(const Problem<Dim>& problem, const std::vector<Material>& materials);

/// Theory alone, of the body and of the infinite lattice.
template <int Dim>
TheoryLimit theory_limit(const Problem<Dim>& problem, const BodyChoice<Dim>& choice);
template <int Dim>
std::optional<double> bulk_step(const Problem<Dim>& problem);

/// The displacement of the theory's critical mode on what is run, up to a factor, of total-Lagrangian schemes. Throws
/// InvalidInput (`seed`) where no mode is critical.
template <int Dim>
solver::Field<Dim> critical_mode_displacement(const Problem<Dim>& problem, const BodyChoice<Dim>& choice);

/// Throws InvalidInput (`artificial_stress_linearisation`) for `frozen`: in a run artificial stress follows the stress.
void require_running_artificial_stress(const Scheme& scheme);

/// Finds the critical step by running the solver with `probe` if given (a foreign solver), ours otherwise, and sets
/// theory beside it. Where theory says that every step grows, the growth at one step is measured. Where it says that
/// none does, `ul` is run up to a hundred times the first step. Throws InvalidInput (`displacement_gradient`) for a
/// body with a base state, which is no equilibrium there; of `ul` (`scheme`) for a body, which has no theory, and
/// (`artificial_stress_linearisation`) for `frozen`, because in a run artificial stress follows the stress, and
/// (`artificial_stress_epsilon`) where a principal stress is zero and the artificial stress a kink.
template <int Dim>
StepComparison compare_step(const Problem<Dim>& problem, const BodyChoice<Dim>& choice, const RunOptions& options,
                            const GrowthProbe& probe = nullptr);

}  // namespace sphstab::study
