// SPDX-License-Identifier: MIT
#include "study/perturbation_run.hpp"

#include <algorithm>
#include <cmath>

namespace sphstab::study {
namespace {

using solver::GrowthFit;
using solver::Trend;

/// E-foldings after which a run has seen enough: as many as numbers bear where nothing is scaled back. Of modes as
/// close as those of a large patch, that make a continuum in d dimensions, the mean growth after N e-foldings is behind
/// the fastest by d/(4N): 2e-3 after the second number.
constexpr double enough_of_linear = 40.0, enough_e_foldings = 400.0;
/// A departure this many times as large as the largest one has left the law of small ones within a stride.
constexpr double far_beyond = 1e3;
/// Noise beside the fastest mode of the run before.
constexpr double noise_beside_mode = 0.1;
/// Runs are judged for the first time at this part of the horizon, and again whenever they are twice as long; those
/// that grow at one rate by then end, undecided ones go on up to `longest_run` horizons.
constexpr int first_look = 8;
constexpr int longest_run = 4;
/// Relative difference of two slopes below which a growth is known well enough to find the root of the bisection.
constexpr double settled = 1e-4;
/// Amplitudes taken in a horizon; each costs about half a right-hand side.
constexpr long samples = 1000;

/// The fit of a run that left the small departures before it could be judged: it grew at least as fast as its
/// beginning.
GrowthFit explosion(const std::vector<double>& log_amplitude, int stride) {
  const double steps = stride * std::max(1.0, static_cast<double>(log_amplitude.size()) - 1.0);
  return {Trend::growing, (log_amplitude.back() - log_amplitude.front()) / steps, 0.0, 1.0, static_cast<long>(steps)};
}

}  // namespace

PerturbationRun::PerturbationRun(std::shared_ptr<PerturbedSolver> solver, const Eigen::VectorXd& seed)
    : solver_(std::move(solver)), seed_(seed / solver_->amplitude(seed)) {}

PerturbationRun::PerturbationRun(const std::shared_ptr<PerturbedSolver>& solver, unsigned noise_seed)
    : PerturbationRun(solver, solver->noise_departure(noise_seed)) {}

PerturbationRun::Course PerturbationRun::start(double time_step) const {
  Eigen::VectorXd departure = seed_;
  if (fastest_mode_) departure = *fastest_mode_ + noise_beside_mode * seed_;
  departure *= solver_->seed_amplitude(time_step);
  return {departure, 0.0, {std::log(solver_->amplitude(departure))}};
}

bool PerturbationRun::run(long end, double time_step, int stride, Course& course) const {
  const double seed = solver_->seed_amplitude(time_step), largest = solver_->largest_amplitude();
  const double enough = std::isfinite(largest) ? enough_e_foldings : enough_of_linear;
  while (stride * static_cast<long>(course.log_amplitude.size() - 1) < end) {
    solver_->advance(course.departure, time_step, stride);
    const double amplitude = solver_->amplitude(course.departure);
    const double next = std::log(amplitude) + course.scaled_back;
    if (!std::isfinite(next)) {  // of what is not linear it is known at least that it is small no more
      if (std::isfinite(largest)) course.log_amplitude.push_back(std::log(far_beyond * largest) + course.scaled_back);
      return false;
    }
    course.log_amplitude.push_back(next);
    if (next - course.log_amplitude.front() > enough && std::ssize(course.log_amplitude) > solver::fewest_amplitudes)
      return false;
    if (amplitude <= largest) continue;
    if (amplitude > far_beyond * largest) return false;
    course.departure *= seed / amplitude;
    course.scaled_back += std::log(amplitude / seed);
  }
  return true;
}

GrowthFit PerturbationRun::operator()(double time_step, long horizon) {
  const int stride = static_cast<int>(std::max(1L, horizon / samples));
  Course course = start(time_step);
  const auto& log_amplitude = course.log_amplitude;
  GrowthFit fit{};
  for (long end = std::max(1L, horizon / first_look); end <= longest_run * horizon; end *= 2) {
    const bool goes_on = run(end, time_step, stride, course);
    if (!goes_on && std::ssize(log_amplitude) <= solver::fewest_amplitudes) return explosion(log_amplitude, stride);
    if (goes_on && std::ssize(log_amplitude) <= solver::fewest_amplitudes) continue;
    fit = solver::judge_growth(log_amplitude, stride);
    if (!goes_on || (fit.trend == Trend::growing && fit.disagreement < settled)) break;
    if (end >= horizon && fit.trend != Trend::undecided) break;
  }
  if (fit.trend == Trend::growing) fastest_mode_ = course.departure / solver_->amplitude(course.departure);
  return fit;
}

}  // namespace sphstab::study
