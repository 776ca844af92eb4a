// SPDX-License-Identifier: MIT
#include "analysis/zone_zeros.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "analysis/zone_grid.hpp"
#include "analysis/zone_maximum.hpp"

namespace sphstab::analysis {
namespace {

/// σ w of the coarse grid.
constexpr double grid_resolution = 0.1;
/// Work budget in terms of the series evaluated with derivatives, some 10 ns each.
template <int Dim>
constexpr long term_budget = Dim == 3 ? 100'000'000 : 20'000'000;
constexpr int newton_steps = 12;
/// Newton's iteration has converged when it moves by less than this over R, or than rounding allows.
constexpr double converged = 1e-12;
/// Zeros closer than this over R are one: Newton ends at some 1e-14, and certain zeros are far wider apart.
constexpr double same_zero = 1e-7;

template <int Dim>
class ZeroSearch {
 public:
  ZeroSearch(const SineSeries<Dim>& series, const ZoneDomain<Dim>& domain)
      : series_(series),
        domain_(domain),
        largest_(std::sqrt(zone_maximum<Dim>(series, Tensor<Dim>::Identity(), domain).upper)),
        third_derivative_(std::min(std::pow(series.euclidean_type(), 3) * largest_, series.derivative_bound(3))) {}

  ZoneZeros<Dim> run() {
    for (unsigned corner = 0; corner < (1u << Dim); ++corner) {
      Vector<Dim> phases;
      for (int axis = 0; axis < Dim; ++axis) phases[axis] = corner >> axis & 1u ? -std::numbers::pi : 0.0;
      keep(phases);
    }
    complete_ = frequencies_span_space() && zone_grid_size(series_, domain_, grid_resolution) <= largest_zone_grid;
    if (!complete_) return {{zeros_.begin() + 1, zeros_.end()}, complete_};
    const ZoneGrid<Dim> grid(series_, Tensor<Dim>::Identity(), domain_, grid_resolution);
    const double reachable = largest_ * std::sin(series_.type() * grid.half_width()) + series_.rounding();
    std::vector<PhaseBox<Dim>> live;
    for (std::size_t i = 0; i < grid.values().size(); ++i)
      if (grid.values()[i] <= reachable * reachable && domain_.touches(grid.box(i))) live.push_back(grid.box(i));
    while (!live.empty() && complete_) {
      std::vector<PhaseBox<Dim>> next;
      for (const auto& box : live) examine(box, next);
      live = std::move(next);
    }
    zeros_.erase(zeros_.begin());  // Γ
    return {zeros_, complete_};
  }

 private:
  /// Without it the series is constant along a direction, and its zeros are lines or planes.
  bool frequencies_span_space() const {
    Tensor<Dim> squares = Tensor<Dim>::Zero();  // integers, exact
    for (const auto& [n, w] : series_.terms())
      if (!w.isZero(0.0)) squares += (n * n.transpose()).template cast<double>();
    return squares.fullPivLu().rank() == Dim;
  }

  void keep(const Vector<Dim>& phases) {
    const auto same = [&](const Vector<Dim>& zero) {
      return wrapped<Dim>(zero - phases).norm() < same_zero / series_.euclidean_type();
    };
    if (std::none_of(zeros_.begin(), zeros_.end(), same)) zeros_.push_back(wrapped<Dim>(phases));
  }

  /// Bound on |∂²f| within r of the point of the jet.
  double curvature_bound(const SineJet<Dim>& jet, double r) const {
    double squares = 0.0;
    for (const auto& hessian : jet.hessian) squares += hessian.squaredNorm();
    return std::sqrt(squares) + third_derivative_ * r;
  }

  /// The zero to which Newton's iteration from `start` converges without leaving the ball of radius r, if it is
  /// certain.
  std::optional<Vector<Dim>> newton(const Vector<Dim>& start, double r) const {
    Vector<Dim> phases = start;
    for (int step = 0; step < newton_steps; ++step) {
      const SineJet<Dim> jet = series_.jet(phases);
      const Tensor<Dim> inverse = jet.jacobian.inverse();
      const Vector<Dim> move = -inverse * jet.value;
      phases += move;
      if (!((phases - start).norm() < r)) return std::nullopt;
      const double least_slope = 1.0 / inverse.norm();
      if (move.norm() > converged / series_.euclidean_type() + 2.0 * series_.rounding() / least_slope) continue;
      const bool certain = least_slope * least_slope > 4.0 * curvature_bound(jet, r) * series_.rounding();
      return certain ? std::optional<Vector<Dim>>(phases) : std::nullopt;
    }
    return std::nullopt;
  }

  void examine(const PhaseBox<Dim>& box, std::vector<PhaseBox<Dim>>& next) {
    if ((evaluated_terms_ += static_cast<long>(series_.terms().size())) > term_budget<Dim>) {
      complete_ = false;
      return;
    }
    const SineJet<Dim> jet = series_.jet(box.centre);
    const double rho = box.radius(), r = 2.0 * rho, delta = series_.rounding();
    const double K = curvature_bound(jet, r), value = jet.value.norm(), slope = jet.jacobian.norm();
    if (value > slope * rho + 0.5 * K * rho * rho + delta) return;
    const Tensor<Dim> inverse = jet.jacobian.inverse();
    const double inverse_norm = inverse.norm();
    if ((inverse * jet.value).norm() > rho + inverse_norm * (0.5 * K * rho * rho + delta)) return;
    if (inverse_norm * K * r < 1.0)
      if (const auto zero = newton(box.centre, r)) {
        for (const auto& map : domain_.group()) keep(map * *zero);
        return;
      }
    if (value <= delta && slope * rho <= delta) {
      complete_ = false;
      return;
    }
    for (const auto& child : box.children())
      if (domain_.touches(child)) next.push_back(child);
  }

  const SineSeries<Dim>& series_;
  const ZoneDomain<Dim>& domain_;
  double largest_;
  double third_derivative_;
  std::vector<Vector<Dim>> zeros_;
  bool complete_ = true;
  long evaluated_terms_ = 0;
};

}  // namespace

template <int Dim>
ZoneZeros<Dim> zone_zeros(const SineSeries<Dim>& series, const ZoneDomain<Dim>& domain) {
  return ZeroSearch<Dim>(series, domain).run();
}

template ZoneZeros<1> zone_zeros(const SineSeries<1>&, const ZoneDomain<1>&);
template ZoneZeros<2> zone_zeros(const SineSeries<2>&, const ZoneDomain<2>&);
template ZoneZeros<3> zone_zeros(const SineSeries<3>&, const ZoneDomain<3>&);

}  // namespace sphstab::analysis
