// SPDX-License-Identifier: MIT
#include "analysis/growth.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "analysis/dispersion.hpp"
#include "analysis/ellipticity.hpp"
#include "analysis/finite_strain.hpp"
#include "analysis/in_range.hpp"
#include "analysis/updated_lagrangian.hpp"

namespace sphstab::analysis {
namespace {

/// Steps of ε, and where an edge is found.
template <int Dim>
constexpr double epsilon_step = Dim == 3 ? 0.05 : 0.01;
constexpr double epsilon_tolerance = 1e-8;
/// Local minima above this part of the range of the sampled values cannot fall to zero within a box of the grid:
/// between points 2w apart a polynomial of type 2σ or 3σ falls by less than that (Riesz's bound, see ZoneScan).
constexpr double near_zero = 0.3;
/// The shift of `fastest_in_cone`: it begins as this part of the range of the least eigenvalue, falls by this factor,
/// and is gone when it is so small beside the negative one.
constexpr double first_shift = 0.3;
constexpr double fall_of_shift = 0.2;
constexpr double last_shift = 0.1;

template <int Dim>
using DynamicsAt = std::function<Dynamics<Dim>(const Vector<Dim>&)>;

template <int Dim>
DynamicsAt<Dim> dynamics_of(const Problem<Dim>& problem) {
  if (is_finite_strain(problem.scheme.formulation))
    return [scheme = FiniteStrain<Dim>(problem)](const Vector<Dim>& k) { return scheme.dynamics(k); };
  return [scheme = UpdatedLagrangian<Dim>(problem)](const Vector<Dim>& k) { return scheme(k).dynamics(); };
}

template <int Dim>
double growth(const Dynamics<Dim>& dynamics) {
  double rate = 0.0;
  for (const auto value : dynamics.omega_squared()) rate = std::max(rate, growth_rate_of(value));
  return rate;
}

template <int Dim>
double largest(const Dynamics<Dim>& dynamics) {
  return dynamics.omega_squared()[Dim - 1].real();
}

template <int Dim>
double minus_least(const Dynamics<Dim>& dynamics) {
  return -dynamics.omega_squared()[0].real();
}

/// −∏ (λ_i − λ_j)² of the eigenvalues of M over the size of such a product: positive where two are complex.
template <int Dim>
double minus_discriminant(const Dynamics<Dim>& dynamics) {
  const double size = dynamics.M.norm();
  if (Dim == 1 || size <= dynamics.rounding) return 0.0;
  const Tensor<Dim> M = dynamics.M / size;
  const double trace = M.trace();
  if constexpr (Dim == 2) {
    const double difference = M(0, 0) - M(1, 1);
    return -(difference * difference + 4.0 * M(0, 1) * M(1, 0));
  } else {
    // λ³ − tλ² + sλ − d.
    const double t = trace, s = 0.5 * (t * t - (M * M).trace()), d = M.determinant();
    return -(18.0 * t * s * d - 4.0 * t * t * t * d + t * t * s * s - 4.0 * s * s * s - 27.0 * d * d);
  }
}

/// A function of M over the zone.
template <int Dim>
using Property = double (*)(const Dynamics<Dim>&);

/// The dynamics over the zone, and what of it was sampled.
template <int Dim>
class DynamicsScan {
 public:
  DynamicsScan(const ZoneScan<Dim>& scan, DynamicsAt<Dim> at, std::vector<Dynamics<Dim>> samples)
      : scan_(scan), at_(std::move(at)), samples_(std::move(samples)) {}
  DynamicsScan(const ZoneScan<Dim>& scan, DynamicsAt<Dim> at) : scan_(scan), at_(std::move(at)) {
    for (const auto& k : scan.points()) samples_.push_back(at_(k));
  }

  ZonePoint<Dim> maximum(Property<Dim> property) const { return scan_.maximum(along(property), values(property)); }

  /// The fastest growth and where, among the samples and beyond them.
  ZonePoint<Dim> fastest() const {
    ZonePoint<Dim> best{Vector<Dim>::Zero(), 0.0};
    const auto raise = [&](const ZonePoint<Dim>& point) {
      if (point.value > best.value) best = point;
    };
    const double range = std::abs(largest(*std::max_element(
        samples_.begin(), samples_.end(), [](const auto& a, const auto& b) { return largest(a) < largest(b); })));
    for (const auto& summit : summits(minus_least, -near_zero * range))
      raise({summit.wave_vector, growth(at_(summit.wave_vector))});
    if (std::all_of(samples_.begin(), samples_.end(), [](const auto& sample) { return sample.symmetric(); }))
      return best;
    for (const auto& summit : summits(growth, 0.0)) raise(summit);
    for (const auto& summit : summits(minus_discriminant, -near_zero))
      if (summit.value > 0.0) raise(scan_.polished(along(growth), summit.wave_vector));
    return best;
  }

 private:
  std::function<double(const Vector<Dim>&)> along(Property<Dim> property) const {
    return [this, property](const Vector<Dim>& k) { return property(at_(k)); };
  }

  std::vector<double> values(Property<Dim> property) const {
    std::vector<double> result(samples_.size());
    std::transform(samples_.begin(), samples_.end(), result.begin(), property);
    return result;
  }

  /// The polished local maxima of those samples that are above `floor`.
  std::vector<ZonePoint<Dim>> summits(Property<Dim> property, double floor) const {
    const std::vector<double> sampled = values(property);
    std::vector<ZonePoint<Dim>> found;
    for (const std::size_t start : scan_.local_maxima(sampled))
      if (sampled[start] > floor) found.push_back(scan_.polished(along(property), scan_.points()[start]));
    return found;
  }

  const ZoneScan<Dim>& scan_;
  DynamicsAt<Dim> at_;
  std::vector<Dynamics<Dim>> samples_;
};

template <int Dim>
GrowthRange<Dim> total_lagrangian_range(const Problem<Dim>& problem) {
  const auto [lowest, highest, kind] = BulkModes<Dim>(problem).frequencies();
  const double rate = std::sqrt(std::max(-lowest.omega_squared, 0.0));
  return {rate,
          {lowest.wave_vector, lowest.branch, rate},
          lowest.omega_squared,
          highest.omega_squared,
          {highest.wave_vector, highest.branch, std::sqrt(highest.omega_squared)}};
}

/// The fastest growth of finite strain. ω² is negative where D~ lies in a cone about the weakest direction, which may
/// be narrower than the grid: it is widened by a shift of ω²/|D~|², and its summits are followed as the shift falls.
template <int Dim>
ZonePoint<Dim> fastest_in_cone(const Problem<Dim>& problem, const ZoneScan<Dim>& scan) {
  ZonePoint<Dim> best{Vector<Dim>::Zero(), 0.0};
  const double weakest = weakest_direction(problem).squared_speed;
  if (weakest >= 0.0) return best;
  const FiniteStrain<Dim> scheme(problem);
  const auto squared = [&](const Vector<Dim>& k) { return scheme.renormalised_symbol(k).squaredNorm(); };
  const auto least = [&](const Vector<Dim>& k) { return scheme.dynamics(k).omega_squared()[0].real(); };
  double highest = 0.0;
  for (const auto& k : scan.points())
    if (const double size = squared(k); size > 0.0) highest = std::max(highest, least(k) / size);

  double shift = first_shift * (highest - weakest);
  const auto shifted = [&](const Vector<Dim>& k) { return shift * squared(k) - least(k); };
  std::vector<Vector<Dim>> summits;
  for (const std::size_t start : scan.local_maxima(scan.sampled(shifted))) summits.push_back(scan.points()[start]);
  for (; shift > -last_shift * weakest; shift *= fall_of_shift)
    for (auto& k : summits) k = scan.polished(shifted, k).wave_vector;
  for (const auto& k : summits) {
    const auto summit = scan.polished([&](const Vector<Dim>& at) { return -least(at); }, k);
    if (const double rate = std::sqrt(std::max(summit.value, 0.0)); rate > best.value)
      best = {summit.wave_vector, rate};
  }
  return best;
}

/// Whether the problem is stable at any ε. M is sampled at two of them, 0 and 1, and polished at each.
template <int Dim>
class EpsilonScan {
 public:
  explicit EpsilonScan(const Problem<Dim>& problem)
      : problem_(problem),
        scan_(problem),
        tolerance_(negligible_growth * std::sqrt(problem.material.p_wave_modulus() / problem.material.density()) /
                   problem.lattice.spacing()) {
    if (!problem_.scheme.artificial_stress) problem_.scheme.artificial_stress = ArtificialStress{1.0};
    for (const auto& k : scan_.points()) without_.push_back(at(0.0)(k));
    for (const auto& k : scan_.points()) with_.push_back(at(1.0)(k));
  }

  /// Whether artificial stress does anything at all.
  bool acts() const {
    for (std::size_t i = 0; i < with_.size(); ++i)
      if (with_[i].M != without_[i].M) return true;
    return false;
  }

  bool stable(double epsilon) {
    for (const auto& k : unstable_)
      if (growth(at(epsilon)(k)) > tolerance_) return false;
    std::vector<Dynamics<Dim>> samples(with_.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      samples[i] = {without_[i].M + epsilon * (with_[i].M - without_[i].M),
                    without_[i].rounding + epsilon * with_[i].rounding};
      if (growth(samples[i]) > tolerance_) return false;
    }
    const ZonePoint<Dim> fastest = DynamicsScan<Dim>(scan_, at(epsilon), std::move(samples)).fastest();
    if (!(fastest.value > tolerance_)) return true;
    unstable_.push_back(fastest.wave_vector);
    return false;
  }

  /// Where stability changes between two ε.
  double edge(double stable_epsilon, double unstable_epsilon) {
    while (std::abs(stable_epsilon - unstable_epsilon) > epsilon_tolerance) {
      const double middle = 0.5 * (stable_epsilon + unstable_epsilon);
      (stable(middle) ? stable_epsilon : unstable_epsilon) = middle;
    }
    return stable_epsilon;
  }

 private:
  DynamicsAt<Dim> at(double epsilon) const {
    Problem<Dim> problem = problem_;
    problem.scheme.artificial_stress->epsilon = epsilon;
    return dynamics_of(problem);
  }

  Problem<Dim> problem_;
  ZoneScan<Dim> scan_;
  double tolerance_;
  std::vector<Dynamics<Dim>> without_;
  std::vector<Dynamics<Dim>> with_;
  std::vector<Vector<Dim>> unstable_;  ///< found by polishing, at some ε
};

}  // namespace

template <int Dim>
GrowthRange<Dim> growth_range(const Problem<Dim>& problem) {
  switch (problem.scheme.formulation) {
    case Formulation::total_lagrangian_linear:
    case Formulation::total_lagrangian_corotated:
    case Formulation::total_lagrangian_pk1:
      return total_lagrangian_range(problem);
    case Formulation::updated_lagrangian:
      break;
  }
  return growth_range(problem, ZoneScan<Dim>(problem));
}

template <int Dim>
GrowthRange<Dim> growth_range(const Problem<Dim>& problem, const ZoneScan<Dim>& scan) {
  Problem<Dim> inviscid = problem;
  inviscid.scheme.viscosity.reset();
  const DynamicsScan<Dim> dynamics(scan, dynamics_of(inviscid));
  const ZonePoint<Dim> highest = dynamics.maximum(largest);
  ZonePoint<Dim> lowest = dynamics.maximum(minus_least), fastest = dynamics.fastest();
  if (is_finite_strain(problem.scheme.formulation))
    if (const auto in_cone = fastest_in_cone(problem, scan); in_cone.value > fastest.value) {
      fastest = in_cone;
      lowest = {in_cone.wave_vector, in_cone.value * in_cone.value};
    }
  require_in_range(std::isfinite(highest.value) && std::isfinite(lowest.value));

  const BrillouinZone<Dim> zone(problem.lattice);
  const DispersionRelation<Dim> dispersion(inviscid);
  using Wave = WaveBranch<Dim>;
  const auto mode = [&](const Vector<Dim>& wave_vector, double omega, const auto& before) {
    const Vector<Dim> k = tidy<Dim>(zone, wave_vector);
    const auto waves = dispersion(k);
    return CriticalMode<Dim>{k, std::max_element(waves.begin(), waves.end(), before)->branch, omega};
  };
  return {fastest.value,
          mode(fastest.wave_vector, fastest.value,
               [](const Wave& a, const Wave& b) { return a.growth_rate < b.growth_rate; }),
          -std::max(lowest.value, 0.0), std::max(highest.value, 0.0),
          mode(highest.wave_vector, std::sqrt(std::max(highest.value, 0.0)),
               [](const Wave& a, const Wave& b) { return a.omega_squared.real() < b.omega_squared.real(); })};
}

template <int Dim>
std::vector<EpsilonInterval> stabilising_epsilon(const Problem<Dim>& problem,
                                                 const std::function<void(double)>& progress) {
  EpsilonScan<Dim> scan(problem);
  if (!scan.acts()) {
    if (!scan.stable(0.0)) return {};
    return {{0.0, largest_epsilon}};
  }
  std::vector<EpsilonInterval> intervals;
  const int steps = static_cast<int>(std::lround(largest_epsilon / epsilon_step<Dim>));
  bool before = false;
  for (int i = 0; i <= steps; ++i) {
    const double epsilon = i * epsilon_step<Dim>, previous = (i - 1) * epsilon_step<Dim>;
    const bool now = scan.stable(epsilon);
    if (now && !before) intervals.push_back({i == 0 ? 0.0 : scan.edge(epsilon, previous), largest_epsilon});
    if (before && !now) intervals.back().to = scan.edge(previous, epsilon);
    before = now;
    if (progress) progress(static_cast<double>(i) / steps);
  }
  return intervals;
}

template GrowthRange<1> growth_range(const Problem<1>&);
template GrowthRange<1> growth_range(const Problem<1>&, const ZoneScan<1>&);
template std::vector<EpsilonInterval> stabilising_epsilon(const Problem<1>&, const std::function<void(double)>&);
template GrowthRange<2> growth_range(const Problem<2>&);
template GrowthRange<2> growth_range(const Problem<2>&, const ZoneScan<2>&);
template std::vector<EpsilonInterval> stabilising_epsilon(const Problem<2>&, const std::function<void(double)>&);
template GrowthRange<3> growth_range(const Problem<3>&);
template GrowthRange<3> growth_range(const Problem<3>&, const ZoneScan<3>&);
template std::vector<EpsilonInterval> stabilising_epsilon(const Problem<3>&, const std::function<void(double)>&);

}  // namespace sphstab::analysis
