// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study/step_comparison.hpp"

/// What the running scheme of Gray is confronted with theory on: units ρ0 = c0 = Δp = 1, periodic patches. Rungs 5 and
/// 6 of the ladder check them (tests/ladder/test_updated_growth.cpp), `report growth-runs` shows them.
namespace sphstab::study {

/// How many runs from noise are averaged.
inline constexpr int noise_runs = 16;

/// Growth of one base state at one step, per step.
struct GrowthCase {
  std::string name;
  Integrator integrator;
  double time_step;
  double theory;       ///< ln of the largest spectral radius over the wave vectors that the patch admits, or at one
  double seeded;       ///< of the run that starts from the theory's wave, extrapolated to no amplitude
  bool has_noise;      ///< not where a wave is meant that is not the fastest
  double noise_mean;   ///< of the runs from noise, each the second of two: it starts from the fastest mode of the first
  double noise_error;  ///< standard error of that mean
  int growing;         ///< of those runs
};

std::vector<std::function<GrowthCase()>> growth_cases();

/// The growth of a predictor-corrector at zero stress, where the leading order is (ωΔt)⁴/8, of -pec twice that.
struct WeakGrowthCase {
  Integrator integrator;
  double phase;  ///< ω_max Δt
  double leading_order;
  double theory;
  double seeded;
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

}  // namespace sphstab::study
