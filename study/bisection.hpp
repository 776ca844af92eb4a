// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <limits>
#include <optional>

#include "solver/growth.hpp"

namespace sphstab::study {

/// Anything that can be run at a time step for some steps and judged: our solver, or a foreign program.
using GrowthProbe = std::function<solver::GrowthFit(double time_step, long horizon)>;

struct BisectionOptions {
  double start;             ///< first step of the scan, a time; a rule of thumb well inside the stable range
  double tolerance = 1e-6;  ///< relative width of the final bracket
  std::optional<long> horizon = std::nullopt;  ///< steps of a run in the final bracket; chosen if absent
  std::function<void(double low, double high)> progress = nullptr;  ///< after each run
  double end = std::numeric_limits<double>::max();                  ///< last step of the scan, a time
};

/// What running found. No critical step: with `low` only nothing grew up to there, with `high` only everything grew.
struct Bisection {
  std::optional<double> critical_time_step;  ///< root of the fitted growth inside the bracket
  double low;                                ///< largest step found bounded; 0 if none
  double high;                               ///< smallest step found growing; infinity if none
  long horizon;                              ///< of the runs in the final bracket
  int runs;
  long steps;                  ///< over all runs
  double smallest_detectable;  ///< growth per step that the horizon can show
};

/// How far a search is that closes [low, high] to a relative width, in [0, 1]; 0 while it has only one end.
double closed_fraction(double low, double high, double tolerance);

/// Steps in which a growth per step makes five e-foldings.
long horizon_for_growth(double growth_per_step);

/// Steps after which growth at a quarter of the tolerance above the limit shows: two eigenvalues that meet at −1 leave
/// the circle as |λ| = 1 + √(8δ) at Δt = (1 + δ) Δt_c, and five e-foldings of δ = tolerance/4 are asked for.
long default_horizon(double tolerance);

/// The critical step by running. Scans upwards from `start` in steps of 20 % to the first exit (the stable set need not
/// be an interval) or the last step, in longer strides where fifty of them find none, then closes the bracket around
/// the root of the growth, fitted to the growing steps nearest to it, halving where no law of growth fits. Both ends of
/// the final bracket were run. Unless a horizon is given it becomes as long as the growth at a quarter of the tolerance
/// above the limit needs, up to 256 times the default; where that growth is slower still, the bracket ends where growth
/// can just be seen. A step that did not grow is no lower end if by the fitted law it may have grown too slowly to be
/// seen: then the bracket stays wider. Tested in tests/study/test_bisection.cpp.
Bisection bisect(const GrowthProbe& probe, const BisectionOptions& options);

}  // namespace sphstab::study
