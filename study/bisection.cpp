// SPDX-License-Identifier: MIT
#include "study/bisection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sphstab::study {
namespace {

using solver::GrowthFit;
using solver::Trend;

constexpr double scan_factor = 1.2;
/// The scan gives up after this many steps in one direction: a factor of 1.2^50 = 9100.
constexpr int scan_limit = 50;
/// The scan only looks for an exit; a growth of 3/200 per step is that of a step 3e-5 above the limit.
constexpr long scan_horizon = 200;
/// Refinement halves the bracket at worst every second run, from 20 % to 1e-9: 56 runs.
constexpr int refinement_limit = 80;

/// Where two eigenvalues λ, 1/λ meet on the unit circle and leave it with |λ| = e^g, the sum of both exceeds 2 by
/// 4 sinh²(g/2), which is analytic in Δt with a simple root at the limit.
struct GrowingStep {
  double time_step;
  double excess;
};

class Search {
 public:
  Search(const GrowthProbe& probe, const BisectionOptions& options)
      : probe_(probe), options_(options), horizon_(options.horizon.value_or(default_horizon(options.tolerance))) {}

  Bisection run() {
    if (scan()) refine();
    return {critical_time_step(), low_, high_, horizon_, runs_, steps_, smallest_detectable_};
  }

 private:
  bool grows(double time_step, long horizon) {
    const GrowthFit fit = probe_(time_step, horizon);
    ++runs_;
    steps_ += fit.steps;
    const bool growing = fit.trend != Trend::bounded;
    if (growing) {
      high_ = time_step;
      farther_ = nearest_;
      nearest_ = GrowingStep{time_step, std::pow(std::sinh(0.5 * fit.growth_per_step), 2)};
    } else {
      low_ = time_step;
      low_horizon_ = horizon;
      smallest_detectable_ = fit.smallest_detectable;
    }
    if (options_.progress) options_.progress(low_, high_);
    return growing;
  }

  /// Finds neighbouring steps of the scan, the lower one bounded and the upper one growing.
  bool scan() {
    const long horizon = std::min(scan_horizon, horizon_);
    double time_step = options_.start;
    if (grows(time_step, horizon)) {
      for (int i = 0; i < scan_limit; ++i)
        if (!grows(time_step /= scan_factor, horizon)) return true;
      return false;
    }
    for (int i = 0; i < scan_limit; ++i)
      if (grows(time_step *= scan_factor, horizon)) return true;
    return false;
  }

  /// Where the excess vanishes on the line through the two nearest growing steps.
  std::optional<double> extrapolated_root() const {
    if (!nearest_ || !farther_ || !(farther_->excess > nearest_->excess)) return std::nullopt;
    return nearest_->time_step - nearest_->excess * (farther_->time_step - nearest_->time_step) /
                                     (farther_->excess - nearest_->excess);
  }

  /// Halving needs no more steps than show growth at a quarter of the interval, if growth is like a square root.
  long halving_horizon() const {
    if (short_runs_deceive_ || scan_horizon > horizon_) return horizon_;
    return std::clamp(default_horizon((high_ - low_) / high_), scan_horizon, horizon_);
  }

  /// Runs the most telling step inside the bracket.
  void run_inside() {
    const double margin = 0.25 * options_.tolerance * high_;
    const auto root = extrapolated_root();
    const bool useful = root && *root > low_ - margin && *root < high_;
    if (!useful || (high_ - *root <= 1.5 * margin && *root - 2.0 * margin <= low_))
      grows(0.5 * (low_ + high_), halving_horizon());
    else if (high_ - *root > 8.0 * margin)  // far: close above the root, for a better root
      grows(*root + std::max(0.02 * (high_ - *root), margin), horizon_);
    else  // close: a quarter of the tolerance above it, then half below, where the beat is faster
      grows(high_ - *root > 1.5 * margin ? *root + margin : *root - 2.0 * margin, horizon_);
  }

  void refine() {
    for (int i = 0; i < refinement_limit; ++i) {
      if (high_ - low_ > options_.tolerance * high_)
        run_inside();
      else if (low_horizon_ == horizon_)
        return;
      else if (grows(low_, horizon_)) {  // its run was too short to see it: go on below with long ones only
        low_ /= scan_factor;
        short_runs_deceive_ = true;
      }
    }
  }

  std::optional<double> critical_time_step() const {
    if (!(low_ > 0.0) || !std::isfinite(high_)) return std::nullopt;
    const auto root = extrapolated_root();
    return root && *root > low_ && *root < high_ ? *root : 0.5 * (low_ + high_);
  }

  const GrowthProbe& probe_;
  const BisectionOptions& options_;
  long horizon_;
  double low_ = 0.0;
  long low_horizon_ = 0;  ///< of the run that found `low_` bounded
  double high_ = std::numeric_limits<double>::infinity();
  std::optional<GrowingStep> nearest_, farther_;
  bool short_runs_deceive_ = false;
  int runs_ = 0;
  long steps_ = 0;
  double smallest_detectable_ = 0.0;
};

}  // namespace

long default_horizon(double tolerance) { return static_cast<long>(std::ceil(5.0 / std::sqrt(2.0 * tolerance))); }

Bisection bisect(const GrowthProbe& probe, const BisectionOptions& options) { return Search(probe, options).run(); }

}  // namespace sphstab::study
