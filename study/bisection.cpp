// SPDX-License-Identifier: MIT
#include "study/bisection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace sphstab::study {
namespace {

using solver::GrowthFit;
using solver::Trend;

constexpr double scan_factor = 1.2;
/// The scan gives up after this many steps in one direction: a factor of 1.2^50 = 9100.
constexpr int scan_limit = 50;
/// The scan only looks for an exit; a growth of 3/200 per step is that of a step 3e-5 above the limit.
constexpr long scan_horizon = 200;
/// A run close above the limit that the law predicts, at this part of the gap, gives a better law.
constexpr double approach = 0.02;
/// Growths closer than this relative difference tell nothing of the law.
constexpr double smallest_separation = 1e-2;
/// The linear term of the law matters from this part of the quadratic one on; below it is what errors of growth make
/// it.
constexpr double smallest_linear_part = 0.2;
/// Faster growth is measured over too few steps for that.
constexpr double largest_trusted_x = 0.5;
/// Where an eigenvalue crosses the circle alone, growth near the limit is slow: the horizon may become this many times
/// the default.
constexpr long longest_horizon = 256;
/// E-foldings that a run of one horizon is to show.
constexpr double e_foldings = 5.0;
/// Refinement halves the bracket at worst every second run, from 20 % to 1e-9: 56 runs.
constexpr int refinement_limit = 80;

/// A step that grew: |λ| = e^g, x = 2 sinh(g/2).
struct GrowingStep {
  double time_step;
  double x;
};

/// Δt(x) = limit + linear x + quadratic x² through the growing steps nearest to the limit. Where two eigenvalues λ, 1/λ
/// meet on the unit circle, x² is analytic in Δt and the linear term vanishes; where one crosses the circle alone
/// (damping, viscosity), x itself is. The fit holds for both and for all between.
struct GrowthLaw {
  double limit, linear, quadratic;

  /// x at a step above the limit.
  double x(double time_step) const {
    const double c = time_step - limit;
    return 2.0 * c / (linear + std::sqrt(linear * linear + 4.0 * quadratic * c));
  }
};

/// The square-root law through two steps, p nearer to the limit than q.
GrowthLaw square_root_law(const GrowingStep& p, const GrowingStep& q) {
  const double quadratic = (q.time_step - p.time_step) / (q.x * q.x - p.x * p.x);
  return {p.time_step - quadratic * p.x * p.x, 0.0, quadratic};
}

/// The law through three steps by divided differences.
GrowthLaw interpolated_law(const GrowingStep& p, const GrowingStep& q, const GrowingStep& r) {
  const double pq = (q.time_step - p.time_step) / (q.x - p.x), qr = (r.time_step - q.time_step) / (r.x - q.x);
  const double quadratic = (qr - pq) / (r.x - p.x);
  const double linear = pq - quadratic * (p.x + q.x);
  return {p.time_step - (linear + quadratic * p.x) * p.x, linear, quadratic};
}

/// A step that did not grow, in a run that can show growth of `smallest_detectable` and more.
struct BoundedStep {
  double time_step;
  long horizon;
  double smallest_detectable;
};

class Search {
 public:
  Search(const GrowthProbe& probe, const BisectionOptions& options)
      : probe_(probe), options_(options), horizon_(options.horizon.value_or(default_horizon(options.tolerance))) {}

  Bisection run() {
    scan(std::min(scan_horizon, horizon_), options_.start);
    if (low_ > 0.0 && std::isfinite(high_)) refine();
    const auto lowest =
        std::find_if(bounded_.begin(), bounded_.end(), [&](const auto& b) { return b.time_step == low_; });
    return {critical_time_step(),
            low_,
            high_,
            horizon_,
            runs_,
            steps_,
            lowest == bounded_.end() ? 0.0 : lowest->smallest_detectable};
  }

 private:
  bool grows(double time_step, long horizon) {
    const GrowthFit fit = probe_(time_step, horizon);
    ++runs_;
    steps_ += fit.steps;
    const bool growing = fit.trend != Trend::bounded;
    if (growing) {
      high_ = time_step;
      growing_.insert(growing_.begin(), {time_step, 2.0 * std::sinh(0.5 * fit.growth_per_step)});
    } else {
      bounded_.push_back({time_step, horizon, fit.smallest_detectable});
    }
    find_low();
    if (options_.progress) options_.progress(low_, high_);
    return growing;
  }

  /// The largest bounded step below `high_`, without those that may well have grown: too slowly for their runs, if the
  /// law of the growing steps holds.
  void find_low() {
    const auto fitted = law();
    low_ = 0.0;
    for (const BoundedStep& step : bounded_) {
      const bool may_grow =
          fitted && fitted->limit < step.time_step && fitted->x(step.time_step) < step.smallest_detectable;
      if (step.time_step < high_ && !may_grow) low_ = std::max(low_, step.time_step);
    }
  }

  /// Finds neighbouring steps of the scan, the lower one bounded and the upper one growing, as far as there are any.
  void scan(long horizon, double time_step) {
    if (grows(time_step, horizon)) {
      for (int i = 0; i < scan_limit; ++i)
        if (!grows(time_step /= scan_factor, horizon)) return;
    } else {
      for (int i = 0; i < scan_limit; ++i)
        if (grows(time_step *= scan_factor, horizon)) return;
    }
  }

  /// The law of growth near the limit, if the growing steps give one: the square-root law unless a third step shows
  /// that the linear term matters.
  std::optional<GrowthLaw> law() const {
    const auto distinct = [this](std::size_t i) {
      return growing_[i].x > (1.0 + smallest_separation) * growing_[i - 1].x;
    };
    if (growing_.size() < 2 || !distinct(1)) return std::nullopt;
    if (growing_.size() > 2 && distinct(2) && growing_[2].x < largest_trusted_x) {
      const auto law = interpolated_law(growing_[0], growing_[1], growing_[2]);
      if (law.linear > smallest_linear_part * std::abs(law.quadratic) * growing_[0].x) return law;
    }
    return square_root_law(growing_[0], growing_[1]);
  }

  /// The law, if its limit lies in the bracket.
  std::optional<GrowthLaw> law_inside() const {
    const auto fitted = law();
    return fitted && fitted->limit > low_ && fitted->limit < high_ ? fitted : std::nullopt;
  }

  /// Halving needs no more steps than show growth at a quarter of the interval, if growth is like a square root.
  long halving_horizon() const {
    if (short_runs_deceive_ || scan_horizon > horizon_) return horizon_;
    return std::clamp(default_horizon((high_ - low_) / high_), scan_horizon, horizon_);
  }

  /// Runs the most telling step inside the bracket: far from the limit one close above it, for a better law; then a
  /// quarter of the tolerance above it, then half below, where the beat is faster. False where the growth that the law
  /// predicts there is too slow for the longest run allowed.
  bool run_inside() {
    const double margin = 0.25 * options_.tolerance * high_;
    const auto fitted = law_inside();
    if (!fitted || (high_ - fitted->limit <= 1.5 * margin && fitted->limit - 2.0 * margin <= low_)) {
      grows(0.5 * (low_ + high_), halving_horizon());
      return true;
    }
    const double gap = high_ - fitted->limit;
    if (gap <= 1.5 * margin) {
      grows(fitted->limit - 2.0 * margin, horizon_);
      return true;
    }
    const double above = fitted->limit + (gap > 8.0 * margin ? std::max(approach * gap, margin) : margin);
    const long needed = horizon_for_growth(fitted->x(above));
    if (!options_.horizon)
      horizon_ = std::clamp(needed, horizon_, longest_horizon * default_horizon(options_.tolerance));
    return grows(above, horizon_) || needed <= horizon_;
  }

  void refine() {
    for (int i = 0; i < refinement_limit && low_ > 0.0; ++i) {
      if (high_ - low_ > options_.tolerance * high_) {
        if (!run_inside()) return;
      } else if (ran_long(low_)) {
        return;
      } else if (grows(low_, horizon_)) {  // its run was too short to see it: only long runs count from here on
        short_runs_deceive_ = true;
        std::erase_if(bounded_, [this](const BoundedStep& step) { return step.horizon < horizon_; });
        scan(horizon_, high_ / scan_factor);
      }
    }
  }

  bool ran_long(double time_step) const {
    return std::any_of(bounded_.begin(), bounded_.end(), [&](const BoundedStep& step) {
      return step.time_step == time_step &&
             (step.horizon >= horizon_ || step.horizon >= default_horizon(options_.tolerance));
    });
  }

  std::optional<double> critical_time_step() const {
    if (!(low_ > 0.0) || !std::isfinite(high_)) return std::nullopt;
    const auto fitted = law_inside();
    return fitted ? fitted->limit : 0.5 * (low_ + high_);
  }

  const GrowthProbe& probe_;
  const BisectionOptions& options_;
  long horizon_;
  double low_ = 0.0;
  double high_ = std::numeric_limits<double>::infinity();
  std::vector<GrowingStep> growing_;  ///< nearest to the limit first
  std::vector<BoundedStep> bounded_;
  bool short_runs_deceive_ = false;
  int runs_ = 0;
  long steps_ = 0;
};

}  // namespace

long horizon_for_growth(double growth_per_step) { return static_cast<long>(std::ceil(e_foldings / growth_per_step)); }

double closed_fraction(double low, double high, double tolerance) {
  if (!(low > 0.0) || !std::isfinite(high)) return 0.0;
  return std::clamp(std::log((high - low) / high) / std::log(tolerance), 0.0, 1.0);
}

long default_horizon(double tolerance) { return horizon_for_growth(std::sqrt(2.0 * tolerance)); }

Bisection bisect(const GrowthProbe& probe, const BisectionOptions& options) { return Search(probe, options).run(); }

}  // namespace sphstab::study
