// SPDX-License-Identifier: MIT
#pragma once

#include <span>

namespace sphstab::solver {

/// How the amplitude of a run develops.
enum class Trend {
  bounded,   ///< no growth that this many steps could show
  growing,   ///< exponential growth
  undecided  ///< still rising, but not at one rate: a transient, beating or drift; more steps will tell
};

/// Exponential growth fitted to a run.
struct GrowthFit {
  Trend trend;
  double growth_per_step;      ///< slope of ln(amplitude) over the last third of the run
  double smallest_detectable;  ///< slopes below this count as bounded
  double disagreement;         ///< |slope over the last third − slope over the second| / slope over the last
  long steps;                  ///< of the run
};

/// A run counts as growing only if it grows by at least this many e-foldings in its last third. A defective pair (a +
/// bn) rises by no more than ln 2 in a third, so drift can never pass for growth.
inline constexpr double smallest_e_foldings = 1.0;

/// … and only if the slope of the second third agrees with that of the last to this fraction and the run ends as far
/// above all of its first third: a beat (sin θn) has slopes that fall, or returns to a height where it has been.
inline constexpr double slope_agreement = 0.2;

/// No run, ours or a foreign one, is judged by fewer amplitudes.
inline constexpr long fewest_amplitudes = 12;

/// Judges ln(amplitude), one value every `stride` steps, the first at step 0: least-squares slopes over the second and
/// the last third. The amplitude must be a norm of the perturbation that rigid motion and zero-energy modes, which
/// drift linearly in time, do not raise (study/perturbation_run.hpp). Non-finite values must have been cut off. Needs
/// at least 6 values (assertion). Tested in tests/solver/test_growth.cpp with drift, beating and slow growth.
GrowthFit judge_growth(std::span<const double> log_amplitude, int stride = 1);

}  // namespace sphstab::solver
