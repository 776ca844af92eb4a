// SPDX-License-Identifier: MIT
#include "analysis/zone_maximum.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "analysis/zone_grid.hpp"

namespace sphstab::analysis {
namespace {

/// σ w of the coarse grid: a finer one costs table entries, a coarser one derivatives.
constexpr double grid_resolution = 0.25;
/// Boxes that cannot hold more than this above the best value, relative, are done.
constexpr double target_enclosure = 1e-13;
/// Work budget in terms of the series evaluated with derivatives, some 10 ns each.
template <int Dim>
constexpr long term_budget = Dim == 3 ? 20'000'000 : 400'000;
/// Steps of the Newton iteration are cut to this over R.
constexpr double longest_step = 0.3;
constexpr int newton_steps = 60;
/// Climbs that start from the boxes that the budget did not reach.
constexpr std::size_t climbs_from_the_rest = 100;
/// Phases of a maximum are known to the root of the rounding of its value, some 1e-8; with this radius the ball about
/// one touches the domain somewhere.
constexpr double place_of_maximum = 1e-6;
/// A step that promises less than this of q is no longer taken.
constexpr double negligible_gain = 1e-16;

/// q with gradient and curvatures, the derivatives along the principal axes of its Hessian.
template <int Dim>
struct Expansion {
  double value;
  Tensor<Dim> axes;  ///< columns
  Vector<Dim> slope;
  Vector<Dim> curvature;  ///< ascending
  double first_norm;      ///< of the derivatives of D
  double second_norm;
};

/// Phases within `radius` of `centre` (Euclidean) where q is at most the bound that went into `upper`.
template <int Dim>
struct SafeBall {
  Vector<Dim> centre;
  double radius;
};

template <int Dim>
struct LiveBox {
  PhaseBox<Dim> box;
  double bound;  ///< on the maximum, should the maximiser lie here
};

template <int Dim>
class MaximumSearch {
 public:
  MaximumSearch(const SineSeries<Dim>& series, const Tensor<Dim>& form, const ZoneDomain<Dim>& domain)
      : series_(series), form_(form), domain_(domain) {
    const auto eigenvalues = form.template selfadjointView<Eigen::Lower>().eigenvalues();
    form_norm_ = eigenvalues.cwiseAbs().maxCoeff();
    if (eigenvalues.minCoeff() >= 0.0) return;
    const double largest_square = MaximumSearch(series, Tensor<Dim>::Identity(), domain).run().upper;
    floor_ = eigenvalues.minCoeff() * largest_square;
    largest_image_ = form_norm_ * std::sqrt(largest_square);
  }

  ZoneMaximum<Dim> run() {
    std::vector<LiveBox<Dim>> live = coarse_survivors();
    while (!live.empty()) {
      std::vector<LiveBox<Dim>> next;
      for (const auto& box : live) examine(box, next);
      live = std::move(next);
    }
    climb_from_the_rest();
    return {domain_.images(best_phases_, place_of_maximum).front(), best_, best_ - margin_,
            std::max(upper_, best_ + margin_), evaluations_};
  }

 private:
  /// The bound on q at the maximiser if it is within `width` (max norm) of a point of value q.
  double riesz_bound(double q, double width) const {
    const double cosine = std::cos(series_.type() * width);
    return floor_ + (q - floor_) / (cosine * cosine);
  }
  /// The same from the second derivative, as the first vanishes at the maximiser.
  double value_bound(double q, const PhaseBox<Dim>& box) const {
    return std::min(riesz_bound(q, box.half_width), q + 0.5 * second_derivative_ * box.radius() * box.radius());
  }

  /// Bounds on the derivatives of q in a unit direction, Bernstein's or the product rule's with those of D.
  void bound_derivatives(double ceiling) {
    const double R = series_.euclidean_type();
    const double G1 = series_.derivative_bound(1), G2 = series_.derivative_bound(2), G3 = series_.derivative_bound(3);
    second_derivative_ = 2.0 * std::min(R * R * (ceiling - floor_), form_norm_ * G1 * G1 + largest_image_ * G2);
    third_derivative_ =
        std::min(4.0 * R * R * R * (ceiling - floor_), 2.0 * largest_image_ * G3 + 6.0 * form_norm_ * G1 * G2);
  }

  /// Bound on the third derivative within r of an expansion: there |∂²D| and |∂D| grow from their values at its centre.
  double third_derivative(const Expansion<Dim>& q, double r) const {
    const double G3 = series_.derivative_bound(3), second = q.second_norm + G3 * r, first = q.first_norm + second * r;
    return std::min(third_derivative_, 2.0 * largest_image_ * G3 + 6.0 * form_norm_ * first * second);
  }

  std::vector<LiveBox<Dim>> coarse_survivors() {
    const ZoneGrid<Dim> grid(series_, form_, domain_, grid_resolution);
    const auto& q = grid.values();
    const auto peak = std::max_element(q.begin(), q.end());
    const double ceiling = riesz_bound(*peak, grid.half_width());
    // |Q D| at the maximiser bounds what a rounding error of D does to q.
    if (floor_ == 0.0) largest_image_ = std::sqrt(form_norm_ * ceiling);
    margin_ = (2.0 * largest_image_ + form_norm_ * series_.rounding()) * series_.rounding();
    bound_derivatives(ceiling);

    best_ = *peak;
    best_phases_ = grid.box(static_cast<std::size_t>(peak - q.begin())).centre;
    climb(best_phases_);
    std::vector<LiveBox<Dim>> live;
    const double least = best_ - std::max(value_bound(best_, grid.box(0)) - best_, 0.0);
    for (std::size_t i = 0; i < q.size(); ++i) {
      if (q[i] < least) continue;
      const PhaseBox<Dim> box = grid.box(i);
      const double bound = value_bound(q[i] + margin_, box);
      if (bound >= best_ && domain_.touches(box)) live.push_back({box, bound});
    }
    return live;
  }

  Expansion<Dim> expand(const Vector<Dim>& phases) {
    ++evaluations_;
    const SineJet<Dim> jet = series_.jet(phases);
    const Vector<Dim> QD = form_ * jet.value;
    Tensor<Dim> half_hessian = jet.jacobian.transpose() * form_ * jet.jacobian;
    for (int i = 0; i < Dim; ++i) half_hessian += QD[i] * jet.hessian[i];
    Eigen::SelfAdjointEigenSolver<Tensor<Dim>> solver;
    solver.computeDirect(half_hessian);
    double second_square = 0.0;
    for (const auto& hessian : jet.hessian) second_square += hessian.squaredNorm();
    return {QD.dot(jet.value),
            solver.eigenvectors(),
            2.0 * solver.eigenvectors().transpose() * (jet.jacobian.transpose() * QD),
            2.0 * solver.eigenvalues(),
            jet.jacobian.norm(),
            std::sqrt(second_square)};
  }

  /// Newton ascent in the principal axes of the Hessian. Where it ends on a strict maximum, its safe ball is kept:
  /// within radius ρ = 3μ/2T (T the bound on third derivatives, μ the least curvature) q ≤ q* + |g| r − (μ/2 − Tρ/6) r²
  /// = q* + |g| r − μ r²/4 ≤ q* + |g|²/μ.
  void climb(Vector<Dim> phases) {
    double trust = longest_step / series_.euclidean_type();
    Expansion<Dim> here = expand(phases);
    for (int step = 0; step < newton_steps; ++step) {
      Vector<Dim> move;
      for (int i = 0; i < Dim; ++i)
        move[i] = here.curvature[i] < 0.0 ? -here.slope[i] / here.curvature[i] : std::copysign(trust, here.slope[i]);
      if (move.norm() > trust) move *= trust / move.norm();
      if (0.5 * here.slope.dot(move) <= negligible_gain * std::abs(here.value)) break;
      const Vector<Dim> there = phases + here.axes * move;
      const Expansion<Dim> ahead = expand(there);
      if (ahead.value > here.value) {
        phases = there;
        here = ahead;
      } else {
        trust = 0.25 * move.norm();  // along a curved ridge
      }
    }
    if (here.value > best_) best_ = here.value, best_phases_ = phases;
    const double mu = -here.curvature.maxCoeff();
    if (mu <= 0.0) return;
    const double bound = here.value + margin_ + here.slope.squaredNorm() / mu;
    if (bound > best_ * (1.0 + target_enclosure)) return;
    upper_ = std::max(upper_, bound);
    const double reach = 3.0 * mu / third_derivative_;
    keep_ball(phases, std::min(reach, 1.5 * mu / third_derivative(here, reach)));
  }

  void keep_ball(const Vector<Dim>& phases, double radius) {
    for (const auto& centre : domain_.images(phases, radius)) balls_.push_back({centre, radius});
  }

  bool is_safe(const PhaseBox<Dim>& box) const {
    return std::any_of(balls_.begin(), balls_.end(), [&](const SafeBall<Dim>& ball) {
      const double room = ball.radius - box.radius();
      return room > 0.0 && (box.centre - ball.centre).squaredNorm() < room * room;
    });
  }

  /// max over the box of the second-order expansion, plus the remainder T r³/6 and the rounding of the three terms
  /// (errors ≤ margin, 2R margin, 4R² margin over distances ≤ 1/2R: 2.5 margins).
  double second_order_bound(const Expansion<Dim>& q, const PhaseBox<Dim>& box) const {
    const double rho = box.radius();
    double bound = q.value + third_derivative(q, rho) * rho * rho * rho / 6.0 + 2.5 * margin_;
    for (int i = 0; i < Dim; ++i) {
      const double extent = box.half_width * q.axes.col(i).template lpNorm<1>();
      const double slope = std::abs(q.slope[i]);
      bound += slope < -q.curvature[i] * extent ? -0.5 * slope * slope / q.curvature[i]
                                                : extent * (slope + 0.5 * q.curvature[i] * extent);
    }
    return bound;
  }

  /// A curvature that makes a ball as large as the box promises a maximum that deserves one, unless it has it already.
  bool leads_to_new_ball(const Expansion<Dim>& q, const PhaseBox<Dim>& box) const {
    if (-1.5 * q.curvature.maxCoeff() <= third_derivative(q, box.radius()) * box.radius()) return false;
    const Vector<Dim> newton = -q.axes * q.slope.cwiseQuotient(q.curvature);
    return !is_safe({box.centre + newton, 0.0});
  }

  void examine(const LiveBox<Dim>& live, std::vector<LiveBox<Dim>>& next) {
    if (is_safe(live.box)) return;
    if (evaluations_ * static_cast<long>(series_.terms().size()) > term_budget<Dim>) {
      upper_ = std::max(upper_, live.bound);
      left_over_.push_back(live.box.centre);
      return;
    }
    const Expansion<Dim> q = expand(live.box.centre);
    const double bound =
        std::min({live.bound, value_bound(q.value + margin_, live.box), second_order_bound(q, live.box)});
    if (bound <= best_ * (1.0 + target_enclosure)) {
      upper_ = std::max(upper_, bound);
      return;
    }
    if (q.value > best_ + margin_ || leads_to_new_ball(q, live.box)) {
      climb(live.box.centre);
      if (is_safe(live.box)) return;
    }
    for (const auto& child : live.box.children())
      if (domain_.touches(child)) next.push_back({child, bound});
  }

  /// Where the budget was spent on a ring of near-maxima, climbs from places all along it find the highest of them.
  void climb_from_the_rest() {
    const std::size_t stride = 1 + left_over_.size() / climbs_from_the_rest;
    for (std::size_t i = 0; i < left_over_.size(); i += stride) climb(left_over_[i]);
  }

  const SineSeries<Dim>& series_;
  Tensor<Dim> form_;
  const ZoneDomain<Dim>& domain_;
  double form_norm_ = 0.0;
  double floor_ = 0.0;          ///< m ≤ q
  double largest_image_ = 0.0;  ///< bound on |Q D| where it matters
  double margin_ = 0.0;         ///< bound on the rounding error of q
  double second_derivative_ = 0.0;
  double third_derivative_ = 0.0;
  double best_ = 0.0;
  double upper_ = 0.0;
  Vector<Dim> best_phases_ = Vector<Dim>::Zero();
  std::vector<SafeBall<Dim>> balls_;
  std::vector<Vector<Dim>> left_over_;  ///< centres of the boxes that the budget did not reach
  int evaluations_ = 0;
};

}  // namespace

template <int Dim>
ZoneMaximum<Dim> zone_maximum(const SineSeries<Dim>& series, const Tensor<Dim>& form, const ZoneDomain<Dim>& domain) {
  return MaximumSearch<Dim>(series, form, domain).run();
}

template ZoneMaximum<1> zone_maximum(const SineSeries<1>&, const Tensor<1>&, const ZoneDomain<1>&);
template ZoneMaximum<2> zone_maximum(const SineSeries<2>&, const Tensor<2>&, const ZoneDomain<2>&);
template ZoneMaximum<3> zone_maximum(const SineSeries<3>&, const Tensor<3>&, const ZoneDomain<3>&);

}  // namespace sphstab::analysis
