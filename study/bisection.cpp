// SPDX-License-Identifier: MIT
#include "study/bisection.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace sphstab::study {
namespace {

using solver::GrowthFit;
using solver::Trend;

constexpr double scan_factor = 1.2;
/// The scan goes up by this many such steps, a factor of 1.2^50 = 9100, before its strides begin to lengthen; downwards
/// it ends there.
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
constexpr long longest_over_default = 256;
/// An undecided run is repeated with this many times the horizon.
constexpr long prolongation = 4;
/// E-foldings that a run of one horizon is to show.
constexpr double e_foldings = 5.0;
/// Refinement halves the bracket at worst every second run, from 20 % to 1e-9: 56 runs.
constexpr int refinement_limit = 80;

/// A step that grew: |λ| = e^g, x = 2 sinh(g/2).
struct GrowingStep {
  double time_step;
  double x;
};

/// Δt(x) = limit + (linear x + quadratic x²)/(1 + bend x) through the growing steps nearest to the limit. Where two
/// eigenvalues λ, 1/λ meet on the unit circle, x² is analytic in Δt and the linear term vanishes; where one crosses the
/// circle alone (damping, viscosity), x itself is. In general the two λ nearest to the crossing obey a quadratic
/// equation with coefficients analytic in Δt, to first order x² + (p + q δ) x = r δ, δ = Δt − limit: the law with its
/// bend. Overdamped pairs need it: like a square root very near the limit, linear soon after.
struct GrowthLaw {
  double limit, linear, quadratic, bend = 0.0;

  /// How far above the limit x is found.
  double excess(double x) const { return (linear + quadratic * x) * x / (1.0 + bend * x); }

  /// x at a step above the limit; NaN where the law has none.
  double x(double time_step) const {
    const double excess = time_step - limit, slope = linear - bend * excess;
    return 2.0 * excess / (slope + std::sqrt(slope * slope + 4.0 * quadratic * excess));
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

/// The law with its bend through four steps: Δt = limit + (linear + limit·bend) x + quadratic x² − bend x Δt is linear
/// in its unknowns. Times count from the first step.
GrowthLaw bent_law(std::span<const GrowingStep, 4> steps) {
  Eigen::Matrix4d unknowns;
  Eigen::Vector4d times;
  for (int i = 0; i < 4; ++i) {
    const double x = steps[i].x;
    times[i] = steps[i].time_step - steps[0].time_step;
    unknowns.row(i) << 1.0, x, x * x, -x * times[i];
  }
  const Eigen::Vector4d law = unknowns.colPivHouseholderQr().solve(times);
  return {steps[0].time_step + law[0], law[1] - law[0] * law[3], law[2], law[3]};
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
  GrowthFit run_once(double time_step, long horizon) {
    const GrowthFit fit = probe_(time_step, horizon);
    ++runs_;
    steps_ += fit.steps;
    return fit;
  }

  /// One run, or longer ones while it is undecided.
  bool grows(double time_step, long horizon) {
    GrowthFit fit = run_once(time_step, horizon);
    while (fit.trend == Trend::undecided && prolongation * horizon <= longest_horizon())
      fit = run_once(time_step, horizon *= prolongation);
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
    law_ = law();
    low_ = 0.0;
    for (const BoundedStep& step : bounded_) {
      const bool may_grow = law_ && law_->limit < step.time_step && law_->x(step.time_step) < step.smallest_detectable;
      if (step.time_step < high_ && !may_grow) low_ = std::max(low_, step.time_step);
    }
  }

  /// Finds neighbouring steps of the scan, the lower one bounded and the upper one growing, as far as there are any.
  void scan(long horizon, double time_step) {
    if (!grows(time_step, horizon)) return scan_upwards(horizon, time_step);
    for (int i = 0; i < scan_limit; ++i)
      if (!grows(time_step /= scan_factor, horizon)) return;
  }

  /// From a bounded step upwards in strides that lengthen while nothing grows, up to the last step; then
  /// through the last stride in steps of the scan.
  void scan_upwards(long horizon, double time_step) {
    double stride = scan_factor;
    for (int i = 1; !grows(time_step * stride, horizon); ++i) {
      time_step *= stride;
      if (i >= scan_limit) stride *= scan_factor;
      if (time_step * stride > options_.end) return;
    }
    while (time_step * scan_factor * std::sqrt(scan_factor) < high_)
      if (grows(time_step *= scan_factor, horizon)) return;
  }

  /// How many of the growing steps nearest to the limit have growths that can be told apart.
  std::ptrdiff_t distinct_steps() const {
    const auto alike = [](const GrowingStep& p, const GrowingStep& q) {
      return q.x <= (1.0 + smallest_separation) * p.x;
    };
    const auto end = std::adjacent_find(growing_.begin(), growing_.end(), alike);
    return end == growing_.end() ? std::ssize(growing_) : end - growing_.begin() + 1;
  }

  /// The square-root law unless a third step shows that the linear term matters.
  GrowthLaw unbent_law(std::ptrdiff_t distinct) const {
    if (distinct > 2 && growing_[2].x < largest_trusted_x) {
      const auto law = interpolated_law(growing_[0], growing_[1], growing_[2]);
      if (law.linear > smallest_linear_part * std::abs(law.quadratic) * growing_[0].x) return law;
    }
    return square_root_law(growing_[0], growing_[1]);
  }

  /// A law must meet the nearest growing step on its branch x(Δt). It is refuted by a step above its limit that did not
  /// grow in a run in which growth would have shown.
  bool agrees_with_runs(const GrowthLaw& law) const {
    const auto agrees = [&](const BoundedStep& step) {
      return step.time_step <= law.limit || step.time_step >= high_ || law.x(step.time_step) < step.smallest_detectable;
    };
    return law.limit < high_ && std::abs(law.x(high_) / growing_.front().x - 1.0) < smallest_separation &&
           std::all_of(bounded_.begin(), bounded_.end(), agrees);
  }

  /// The simplest law of growth near the limit that no run refutes, if there is any; where a law without bend has been
  /// refuted, one with bend.
  std::optional<GrowthLaw> law() {
    const auto distinct = distinct_steps();
    if (distinct < 2) return std::nullopt;
    if (const auto unbent = unbent_law(distinct); !is_bent_ && agrees_with_runs(unbent)) return unbent;
    if (distinct < 4) return std::nullopt;
    is_bent_ = true;
    const auto bent = bent_law(std::span(growing_).first<4>());
    return agrees_with_runs(bent) ? std::optional(bent) : std::nullopt;
  }

  /// No run is longer.
  long longest_horizon() const {
    return options_.horizon.value_or(longest_over_default * default_horizon(options_.tolerance));
  }

  /// The slowest growth that the longest run shows.
  double slowest_growth() const { return e_foldings / static_cast<double>(longest_horizon()); }

  /// The bracket is to end this far above the limit and twice as far below: a quarter of the tolerance, or where growth
  /// is just fast enough to be seen.
  double margin() const {
    const double of_tolerance = 0.25 * options_.tolerance * high_;
    return law_ ? std::max(of_tolerance, law_->excess(slowest_growth())) : of_tolerance;
  }

  /// Where no law holds: halves the bracket. Growth is a concave function of Δt, so that at the middle it is at least a
  /// third of that at the upper end, if the limit is in the lower quarter.
  void halve() {
    const long needed = horizon_for_growth(std::max(slowest_growth(), growing_.front().x / 3.0));
    const long horizon = short_runs_deceive_ ? horizon_ : std::max(needed, std::min(scan_horizon, horizon_));
    horizon_ = std::max(horizon, horizon_);
    grows(0.5 * (low_ + high_), horizon);
  }

  /// Runs the most telling step inside the bracket: far from the limit one close above it, for a better law; then one a
  /// margin above it, then one two margins below, where the beat is faster.
  void run_inside() {
    if (!law_) return halve();
    const double gap = high_ - law_->limit;
    if (gap <= 1.5 * margin()) {
      grows(law_->limit - 2.0 * margin(), horizon_);
      return;
    }
    const double above = law_->limit + (gap > 8.0 * margin() ? std::max(approach * gap, margin()) : margin());
    horizon_ = std::max(horizon_, horizon_for_growth(std::max(slowest_growth(), law_->x(above))));
    grows(above, horizon_);
  }

  void refine() {
    for (int i = 0; i < refinement_limit && low_ > 0.0; ++i) {
      if (high_ - low_ > 4.0 * margin()) {
        run_inside();
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
    return law_ ? law_->limit : 0.5 * (low_ + high_);
  }

  const GrowthProbe& probe_;
  const BisectionOptions& options_;
  long horizon_;
  double low_ = 0.0;
  double high_ = std::numeric_limits<double>::infinity();
  std::vector<GrowingStep> growing_;  ///< nearest to the limit first
  std::vector<BoundedStep> bounded_;
  std::optional<GrowthLaw> law_;
  bool is_bent_ = false;
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
