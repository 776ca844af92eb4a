// SPDX-License-Identifier: MIT
#include "study/step_follower.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "study/p_wave_speed.hpp"
#include "study/thread_clock.hpp"

namespace sphstab::study {
namespace {

/// Of the first limit: ω² is right to the square of the residual over the gaps between the largest eigenvalues, to 1e-6
/// or better, and with so small Krylov spaces their orthogonalisation costs less than the operator.
constexpr int small_space = 12;
constexpr double residual_at_rest = 1e-4;
/// Applications of an update, and the noise beside the mode it starts from: a new mode of a corner grows by the fourth
/// power or so of the ratio of eigenvalues in so many.
constexpr int applications = 8;
constexpr double noise_beside_mode = 0.05;
/// Steps between two updates.
constexpr long first_interval = 1000, least_interval = 250, largest_interval = 8000;
/// Relative changes of the limit at which the interval is doubled and halved.
constexpr double small_change = 1e-3, large_change = 1e-2;
/// Of limits that are told: Δt is right to half of it.
constexpr double converged = 1e-6;

template <int Dim>
double slowest_wave(const Scene<Dim>& scene) {
  double slowest = std::numeric_limits<double>::infinity();
  for (const auto& material : scene.body.materials) slowest = std::min(slowest, p_wave_speed(scene.problem, material));
  return slowest;
}

template <int Dim>
double largest(const std::vector<Vector<Dim>>& field) {
  double norm = 0.0;
  for (const auto& y : field) norm = std::max(norm, y.norm());
  return norm;
}

}  // namespace

template <int Dim>
StepFollower<Dim>::StepFollower(const Scene<Dim>& scene)
    : body_(scene.body),
      free_motion_(scene.body, scene.periodic_cells.has_value()),
      wave_speed_(slowest_wave(scene)),
      wave_of_loads_(scene.body.load.empty() ? 0.0
                                             : largest<Dim>(free_motion_.without(body_.position, body_.load)) *
                                                   scene.problem.lattice.spacing() / wave_speed_),
      operator_(scene.problem, scene.body),
      interval_(first_interval) {
  const double start = thread_seconds();
  critical_step_ = limit_of_state({.dimension = small_space, .tolerance = residual_at_rest});
  work_.cpu_seconds += thread_seconds() - start;
}

template <int Dim>
std::optional<double> StepFollower<Dim>::limit_of_state(const analysis::DeformedLimitOptions& options) {
  analysis::DeformedLimit limit = analysis::deformed_limit(operator_, options);
  mode_ = std::move(limit.largest.vector);
  ++work_.updates;
  work_.applications += limit.applications;
  return limit.critical_time_step;
}

template <int Dim>
void StepFollower<Dim>::update(const std::vector<Vector<Dim>>& displacement) {
  const double start = thread_seconds();
  try {
    operator_.set_state(analysis::components_of<Dim>(displacement));
  } catch (const InvalidInput&) {  // turned inside out: what follows will show
    interval_ = least_interval;
    return;
  }
  const auto limit = limit_of_state({.dimension = applications,
                                     .most = applications,
                                     .start = mode_,
                                     .noise = noise_beside_mode,
                                     .seed = static_cast<unsigned>(work_.updates)});
  work_.cpu_seconds += thread_seconds() - start;
  if (!limit || !critical_step_) return;
  const double change = std::abs(*limit / *critical_step_ - 1.0);
  if (change < small_change) interval_ = std::min(2 * interval_, largest_interval);
  if (change > large_change) interval_ = std::max(interval_ / 2, least_interval);
  critical_step_ = limit;
}

template <int Dim>
double StepFollower<Dim>::room_for_waves(const std::vector<Vector<Dim>>& displacement,
                                         const std::vector<Vector<Dim>>& velocity) const {
  if (!free_motion_.exists()) return room_for(std::max(wave_of_loads_, largest<Dim>(velocity)));
  std::vector<Vector<Dim>> position = body_.position;
  for (int a = 0; a < body_.size(); ++a) position[a] += displacement[a];
  return room_for(std::max(wave_of_loads_, largest<Dim>(free_motion_.without(position, velocity))));
}

template <int Dim>
std::optional<analysis::DeformedLimit> limit_about(const Problem<Dim>& problem, const Body<Dim>& body,
                                                   const std::vector<Vector<Dim>>& displacement) {
  analysis::DeformedBodyOperator<Dim> body_operator(problem, body);
  try {
    body_operator.set_state(analysis::components_of<Dim>(displacement));
  } catch (const InvalidInput&) {
    return std::nullopt;
  }
  return analysis::deformed_limit(body_operator, {.tolerance = converged});
}

template class StepFollower<1>;
template class StepFollower<2>;
template class StepFollower<3>;
template std::optional<analysis::DeformedLimit> limit_about(const Problem<1>&, const Body<1>&,
                                                            const std::vector<Vector<1>>&);
template std::optional<analysis::DeformedLimit> limit_about(const Problem<2>&, const Body<2>&,
                                                            const std::vector<Vector<2>>&);
template std::optional<analysis::DeformedLimit> limit_about(const Problem<3>&, const Body<3>&,
                                                            const std::vector<Vector<3>>&);

}  // namespace sphstab::study
