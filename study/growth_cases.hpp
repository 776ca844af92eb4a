// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "study/step_comparison.hpp"

/// Growth of the running solver against theory, and what the scheme of Gray is confronted with: units ρ0 = c0 = Δp = 1,
/// periodic patches. Rungs 5 and 6 of the ladder check it (tests/ladder/test_updated_growth.cpp), `report growth-runs`
/// shows it.
namespace sphstab::study {

/// How many runs from noise are averaged.
inline constexpr int noise_runs = 16;
/// Of the growth of a run from the theory's wave, per step. What is left after extrapolation is the square of
/// displacements of 1e-6 Δp, and the rounding of positions, or of 1 + strain, 1e-15, beside them.
inline constexpr double seeded_tolerance = 1e-8;
/// Of the mean over the runs from noise: so many standard errors of it, and growth_tolerance of the growth. Runs end in
/// one wave and round alike, so that they may agree better among each other than with theory: what rounding of
/// positions, 2e-16 Δp, does beside displacements of 1e-7 Δp and less is a part of 1e-9 a step.
inline constexpr double noise_standard_errors = 3.0, noise_floor = 1e-9;
/// Growth of the theory below which a state counts as stable: roundings of eigenvalues on the unit circle.
inline constexpr double no_growth = 1e-7;

/// Growth of one base state at one step, per step.
struct GrowthCase {
  std::string name;
  Integrator integrator;
  double time_step;
  double theory;       ///< ln of the largest spectral radius over the wave vectors that the patch admits, or at one
  double seeded;       ///< of the run that starts from the theory's wave, extrapolated to no amplitude
  bool has_noise;      ///< not where a wave is meant that is not the fastest
  double noise_mean;   ///< of noise_growth
  double noise_error;  ///< standard error of that mean
  int growing;         ///< of those runs

  bool is_stable() const { return theory < no_growth; }
  /// Within the tolerances above; where theory says stable, no run may grow.
  bool holds() const;
};

/// The growth of a base state of any nonlinear scheme, of its fastest wave or the one that is meant.
template <int Dim>
GrowthCase measure_growth(std::string name, const Problem<Dim>& problem, const LatticeIndex<Dim>& cells,
                          double time_step, const std::optional<Vector<Dim>>& wave_vector = {});

std::vector<std::function<GrowthCase()>> growth_cases();

/// The growth of a predictor-corrector at zero stress, where the leading order is (ωΔt)⁴/8, of -pec twice that.
struct WeakGrowthCase {
  Integrator integrator;
  double phase;  ///< ω_max Δt
  double leading_order;
  double theory;
  double seeded;

  /// The run within seeded_tolerance of theory and, to the next order in z = (ωΔt)², of the leading order: 1 − z²/8
  /// of it, from ln √(1 + z²/4); with stored rates 1 + 2z.
  bool holds() const;
};

std::vector<std::function<WeakGrowthCase()>> weak_growth_cases();

/// The critical step of one base state by bisection.
struct BisectionCase {
  std::string name;
  Integrator integrator;
  StepComparison found;
};

std::vector<std::function<BisectionCase()>> bisection_cases();

/// What viscosity does to a long longitudinal wave: decay rates of its amplitude.
struct DampingCase {
  bool is_standing;  ///< or travelling
  double alpha;
  double velocity;   ///< amplitude, in c0
  double theory;     ///< of viscosity on approach and separation
  double all_pairs;  ///< measured with that
  double approaching;
};

std::vector<std::function<DampingCase()>> damping_cases();

/// A state at exactly zero stress whose artificial stress switches with every wave, so that it obeys neither of its
/// linearisations, both of which are stable: hexagonal lattice, h = Δp, ε = 0.3.
struct SwitchCase {
  double fraction;           ///< Δt over the critical step on the side of compression, the smaller one
  double smallest, largest;  ///< growth per step, of runs from noise
  int growing;               ///< of noise_runs
};

std::vector<std::function<SwitchCase()>> switch_cases();

}  // namespace sphstab::study
