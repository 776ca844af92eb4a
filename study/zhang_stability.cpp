// SPDX-License-Identifier: MIT
#include "study/zhang_stability.hpp"

#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <functional>

#include "analysis/spectrum.hpp"
#include "solver/simulation.hpp"
#include "study/growth_run.hpp"
#include "study/relaxation.hpp"
#include "study/step_comparison.hpp"
#include "study/zhang_cases.hpp"

namespace sphstab::study::zhang {
namespace {

using solver::Field;
using solver::State;

/// Of the largest eigenvalue: nothing but rounding is left, so that curves are smooth where they are minimised.
constexpr double spectrum_tolerance = 1e-13;
/// H/Δ between which Fig. 16 has its minima and the two curves meet.
constexpr double least_ratio = 0.55, largest_ratio = 1.1, widest_ratio = 2.2, narrowest_ratio = 0.4;
/// Bits of a minimum; half as many are left of where it is.
constexpr int bits_of_minimum = 40;
constexpr double ratio_tolerance = 1e-5;

/// Nonlinear plates: first part of the critical step without load, and how often it is halved.
constexpr double first_fraction = 0.4;
constexpr int halvings = 3;
constexpr double rest_tolerance = 1e-11;
constexpr long longest_relaxation = 20000;
/// Bisections start at this part of the rule of thumb: stiff nonlinear plates have smaller steps.
constexpr double start_fraction = 0.2;
constexpr unsigned noise_seed = 1;

/// Departures are scaled back when they have grown to so many of the first ones.
constexpr double largest_departure = 1e20;
/// A particle off all axes of symmetry, so that every mode is pushed.
constexpr int pushed_particle = 47;

double root(const std::function<double(double)>& f, double low, double high) {
  const auto close = [](double a, double b) { return std::abs(b - a) < ratio_tolerance; };
  std::uintmax_t iterations = 60;
  const auto [a, b] = boost::math::tools::toms748_solve(f, low, high, close, iterations);
  return 0.5 * (a + b);
}

double norm(const Field<2>& field) {
  double square = 0.0;
  for (const auto& y : field) square += y.squaredNorm();
  return std::sqrt(square);
}

}  // namespace

Problem<2> plate_problem(const PlateKind& kind) {
  return problem(kind.h_over_spacing * particle_spacing, kind.normalisation, kind.plane);
}

Body<2> plate_body(const PlateKind& kind, double load) {
  return make_scene(stretched_plate(plate_problem(kind), load)).body;
}

FastestMode fastest_mode(const Problem<2>& problem, const Body<2>& body) {
  const auto limit =
      analysis::body_limit(problem, body, {.bound = analysis::BoundKind::norm_bound, .tolerance = spectrum_tolerance});
  Field<2> displacement;
  for (int a = 0; a < body.size(); ++a) displacement.emplace_back(limit.displacement.segment<2>(2 * a));
  return {limit.omega_max, displacement};
}

double critical_step(const PlateKind& kind) { return 2.0 / fastest_mode(plate_problem(kind), plate_body(kind)).omega; }

std::pair<double, double> smallest_critical_step(KernelNormalisation normalisation, Plane plane) {
  const auto step = [&](double ratio) { return critical_step({ratio, normalisation, plane}); };
  return boost::math::tools::brent_find_minima(step, least_ratio, largest_ratio, bits_of_minimum);
}

double crossing_of_normalisation(Plane plane) {
  const auto gain = [&](double ratio) {
    return critical_step({ratio, KernelNormalisation::sum, plane}) /
               critical_step({ratio, KernelNormalisation::none, plane}) -
           1.0;
  };
  return root(gain, least_ratio, largest_ratio);
}

std::pair<double, double> unstable_range(double time_step, KernelNormalisation normalisation) {
  const auto excess = [&](double ratio) { return critical_step({ratio, normalisation}) / time_step - 1.0; };
  const double slowest = smallest_critical_step(normalisation, Plane::stress).first;
  return {root(excess, narrowest_ratio, slowest), root(excess, slowest, widest_ratio)};
}

Bisection bisect_loaded(const Problem<2>& problem, const Body<2>& body, const Field<2>& rest, double tolerance,
                        std::optional<long> horizon) {
  GrowthRun<2> run(problem, body, rest, noise_seed);
  return bisect(
      [&](double time_step, long steps) { return run(time_step, steps); },
      {.start = start_fraction * scan_start(problem, body.materials), .tolerance = tolerance, .horizon = horizon});
}

std::optional<double> growth_rate(const Problem<2>& problem, const Body<2>& body, const Field<2>& rest,
                                  double time_step, long horizon) {
  const auto fit = GrowthRun<2>(problem, body, rest, noise_seed)(time_step, horizon);
  if (fit.trend != solver::Trend::growing) return std::nullopt;
  return fit.growth_per_step / time_step;
}

std::optional<Field<2>> nonlinear_rest(const Problem<2>& problem, const Body<2>& body) {
  Problem<2> linear = problem;
  linear.scheme.momentum_density = MomentumDensity::frozen;
  double time_step = first_fraction * 2.0 / fastest_mode(linear, body).omega;
  for (int i = 0; i <= halvings; ++i, time_step *= 0.5) {
    const auto found = relax(
        problem, body, {.time_step = time_step, .tolerance = rest_tolerance, .largest_steps = longest_relaxation});
    if (found.converged) return found.displacement;
  }
  return std::nullopt;
}

double growth_per_step(double omega, double time_step) { return 2.0 * std::acosh(0.5 * omega * time_step); }

double measured_growth_per_step(const Problem<2>& problem, const Body<2>& body, const Field<2>& rest, double time_step,
                                long steps) {
  solver::Simulation<2> simulation(problem, body);
  State<2> state(body.size());
  Field<2> departure(body.size(), Vector<2>::Zero()), velocity = departure;
  departure[pushed_particle] = {particle_spacing, 0.5 * particle_spacing};
  const double first = norm(departure);
  double last_growth = 0.0, size = first;
  for (long step = 0; step < steps; ++step) {
    for (int a = 0; a < body.size(); ++a) state.displacement[a] = rest[a] + departure[a];
    state.velocity = velocity;
    simulation.advance(state, time_step);
    for (int a = 0; a < body.size(); ++a) departure[a] = state.displacement[a] - rest[a];
    velocity = state.velocity;
    const double next = norm(departure);
    last_growth = std::log(next / size);
    size = next;
    if (size < largest_departure * first) continue;
    const double factor = first / size;
    for (int a = 0; a < body.size(); ++a) {
      departure[a] *= factor;
      velocity[a] *= factor;
    }
    size = first;
  }
  return last_growth;
}

}  // namespace sphstab::study::zhang
