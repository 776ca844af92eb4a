// SPDX-License-Identifier: MIT
#include "analysis/mode_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sphstab::analysis {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// Roundings that the discriminant and the determinant carry, relative to τ and 1.
constexpr double few_roundings = 16.0 * epsilon;

double value(const Cubic& a, double x) { return a[0] + x * (a[1] + x * (a[2] + x * a[3])); }

/// The x where the sign changes between lo (not negative) and hi (negative), to the last bit.
double bisect(const Cubic& a, double lo, double hi) {
  for (;;) {
    const double middle = 0.5 * (lo + hi);
    if (middle <= lo || middle >= hi) return lo;
    (value(a, middle) < 0.0 ? hi : lo) = middle;
  }
}

/// The smallest x > 0 at which a cubic that is not negative just above 0 turns negative; nothing if none.
std::optional<double> first_exit(const Cubic& a) {
  int degree = 3;
  while (degree > 0 && a[degree] == 0.0) --degree;
  if (degree == 0) return std::nullopt;
  // Cauchy's bound on the roots, then the extrema within: the cubic is monotone between two of these ends.
  const double leading = std::abs(a[degree]);
  const double bound = 1.0 + std::max({std::abs(a[0]), std::abs(a[1]), std::abs(a[2]), std::abs(a[3])}) / leading;
  std::array<double, 3> ends{bound, bound, bound};
  const double discriminant = a[2] * a[2] - 3.0 * a[1] * a[3];
  if (discriminant >= 0.0) {
    const double q = -(a[2] + std::copysign(std::sqrt(discriminant), a[2]));
    if (q != 0.0) ends[0] = a[1] / q;
    if (a[3] != 0.0) ends[1] = q / (3.0 * a[3]);
  }
  for (double& end : ends)
    if (!(end > 0.0 && end < bound)) end = bound;
  std::sort(ends.begin(), ends.end());
  double lo = 0.0;
  for (const double hi : ends) {
    if (value(a, hi) < 0.0) return bisect(a, lo, hi);
    lo = hi;
  }
  return std::nullopt;
}

Cubic combine(double constant, double of_p, const Cubic& p, double of_tau, const Cubic& tau) {
  Cubic sum;
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = of_p * p[i] + of_tau * tau[i];
  sum[0] += constant;
  return sum;
}

}  // namespace

ModeStep::ModeStep(Integrator integrator, const std::optional<Damping>& damping, double omega_squared)
    : damping_rate_(damping ? damping->rate : 0.0), omega_squared_(omega_squared), p_{}, tau_{} {
  const double c = damping_rate_;
  p_[1] = c;
  tau_[2] = omega_squared;
  switch (integrator) {
    case Integrator::leapfrog:
      break;
    case Integrator::verlet:
      p_[2] = -0.25 * c * c;
      tau_[3] = -0.25 * c * omega_squared;
      break;
    case Integrator::predictor_corrector:
    case Integrator::predictor_corrector_pec:
      throw for_updated_lagrangian_only(integrator);
  }
}

ModeStep::Pair ModeStep::pair(double time_step) const {
  const double p = value(p_, time_step), tau = value(tau_, time_step);
  const double half = 0.5 * (p + tau);
  if (!std::isfinite(half * half))
    throw InvalidInput(
        fmt::format("time_step: {} is so long that the eigenvalues leave the range of a double", time_step));
  return {1.0 - half, 1.0 - p, half * half - tau, tau};
}

std::array<std::complex<double>, 2> ModeStep::eigenvalues(double time_step) const {
  const auto [mean, determinant, discriminant, tau] = pair(time_step);
  if (discriminant < 0.0) {
    const double imaginary = std::sqrt(-discriminant);
    return {std::complex<double>(mean, imaginary), std::complex<double>(mean, -imaginary)};
  }
  const double larger = mean + std::copysign(std::sqrt(discriminant), mean);
  return {larger, larger == 0.0 ? 0.0 : determinant / larger};
}

double ModeStep::spectral_radius(double time_step) const {
  const auto [mean, determinant, discriminant, tau] = pair(time_step);
  return discriminant < 0.0 ? std::sqrt(determinant) : std::abs(mean) + std::sqrt(discriminant);
}

bool ModeStep::defective(double time_step) const {
  const auto [mean, determinant, discriminant, tau] = pair(time_step);
  return std::abs(determinant - 1.0) <= few_roundings && std::abs(discriminant) <= few_roundings * std::abs(tau);
}

std::optional<double> ModeStep::limit(double growth_per_step) const {
  // In units of the shortest time of the mode, so that the coefficients are of order one.
  const double rate = std::max(std::sqrt(std::abs(omega_squared_)), damping_rate_);
  if (rate == 0.0) return std::nullopt;
  Cubic p = p_, tau = tau_;
  for (std::size_t i = 1; i < p.size(); ++i)
    for (std::size_t j = i; j < p.size(); ++j) p[j] /= rate, tau[j] /= rate;

  const double g = growth_per_step, rho = 1.0 + g;
  // ρ² − Tρ + P, ρ² + Tρ + P, ρ² − P and ρ² + P must not be negative.
  const std::array<Cubic, 4> conditions{
      combine(g * g, g, p, rho, tau), combine((1.0 + rho) * (1.0 + rho), -(1.0 + rho), p, -rho, tau),
      combine(g * (1.0 + rho), 1.0, p, 0.0, tau), combine(rho * rho + 1.0, -1.0, p, 0.0, tau)};
  std::optional<double> first;
  for (const auto& condition : conditions)
    if (const auto exit = first_exit(condition); exit && (!first || *exit < *first)) first = exit;
  if (first) *first /= rate;
  return first;
}

double ModeStep::continuous_growth_rate() const {
  if (omega_squared_ >= 0.0) return 0.0;
  const double c = damping_rate_;
  return -2.0 * omega_squared_ / (c + std::sqrt(c * c - 4.0 * omega_squared_));
}

}  // namespace sphstab::analysis
