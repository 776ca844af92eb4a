// SPDX-License-Identifier: MIT
#include "study/scene_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solver/simulation.hpp"

namespace sphstab::study {
namespace {

using solver::Field;
using solver::State;

/// Steps between two looks at the whole body, each of which costs half a right-hand side.
constexpr long look_every = 50;
/// Numbers beyond it count as not finite: their squares times any modulus or mass are still numbers, so that the
/// energies of the last state are.
constexpr double largest_number = 1e100;
/// A duration that is a whole number of time steps but for rounding takes no step more.
constexpr double rounding_of_steps = 1e-12;

/// More steps than a run can take; far below the largest whole number.
constexpr double most_steps = 1e15;

template <int Dim>
std::optional<int> first_not_finite(const Field<Dim>& field) {
  const auto found = std::find_if(field.begin(), field.end(),
                                  [](const Vector<Dim>& y) { return !(y.array().abs() <= largest_number).all(); });
  if (found == field.end()) return std::nullopt;
  return static_cast<int>(found - field.begin());
}

template <int Dim>
double largest_norm(const Field<Dim>& field) {
  double norm = 0.0;
  for (const auto& y : field) norm = std::max(norm, y.norm());
  return norm;
}

/// The directions in which no particle is clamped: only there is momentum kept.
template <int Dim>
Directions<Dim> free_directions(const Body<Dim>& body) {
  Directions<Dim> free = Directions<Dim>::Constant(true);
  for (const auto& clamped : body.clamped) free = free && !clamped;
  return free;
}

template <int Dim>
class Run {
 public:
  Run(const Scene<Dim>& scene, const SceneRunOptions<Dim>& options)
      : scene_(scene),
        options_(options),
        steps_(static_cast<long>(std::ceil(options.duration / options.time_step * (1.0 - rounding_of_steps)))),
        sample_stride_(options.probe_samples ? (steps_ + *options.probe_samples - 1) / *options.probe_samples : 1),
        snapshots_(std::min(options.snapshots, steps_)),
        simulation_(scene.problem, scene.body),
        free_(free_directions(scene.body)),
        state_(scene.body.size()),
        last_finite_(scene.body.size()),
        force_at_rest_(scene.body.size()) {
    simulation_.accelerations(state_, force_at_rest_);
    for (int a = 0; a < scene.body.size(); ++a) total_force_ += simulation_.inertia(a) * force_at_rest_[a];
    for (const auto& probe : scene.probes) probes_.push_back({probe.name, probe.particle, {}, {}, {}});
  }

  SceneRunResult<Dim> result() {
    observe();
    while (step_ < steps_ && advance_to(next_event())) observe();
    if (failure_) {
      look();
      if (options_.snapshots > 0 && step_ != step_of_last_snapshot_) take_snapshot();
      if (!probes_.empty() && time() != sample_times_.back()) sample();
    }
    return {state_, sample_times_, probes_, summary(), failure_};
  }

 private:
  double time() const { return static_cast<double>(step_) * options_.time_step; }

  long steps_of_snapshot(long index) const {
    return std::lround(static_cast<double>(index) * static_cast<double>(steps_) / static_cast<double>(snapshots_));
  }

  bool snapshots_left() const { return snapshots_ > 0 && next_snapshot_ <= snapshots_; }

  long next_event() const {
    const auto next_multiple = [this](long stride) { return (step_ / stride + 1) * stride; };
    long next = std::min(steps_, next_multiple(look_every));
    if (!probes_.empty()) next = std::min(next, next_multiple(sample_stride_));
    if (snapshots_left()) next = std::min(next, steps_of_snapshot(next_snapshot_));
    return next;
  }

  /// False if a number was not finite on the way; then the state is that of the step before.
  bool advance_to(long end) {
    last_finite_ = state_;
    simulation_.advance(state_, options_.time_step, end - step_);
    if (!is_finite()) {
      state_ = last_finite_;
      find_failure();
      return false;
    }
    step_ = end;
    return true;
  }

  bool is_finite() const {
    return !first_not_finite<Dim>(state_.velocity) && !first_not_finite<Dim>(state_.displacement);
  }

  /// Goes the way again step by step, which gives the same numbers.
  void find_failure() {
    while (is_finite()) {
      last_finite_ = state_;
      simulation_.advance(state_, options_.time_step);
      ++step_;
    }
    const auto of_velocity = first_not_finite<Dim>(state_.velocity);
    const auto particle = of_velocity ? of_velocity : first_not_finite<Dim>(state_.displacement);
    failure_ = {step_, time(), *particle, of_velocity ? "velocity" : "displacement"};
    state_ = last_finite_;
    --step_;
  }

  void observe() {
    if (step_ % look_every == 0 || step_ == steps_) look();
    if ((step_ % sample_stride_ == 0 || step_ == steps_) && !probes_.empty()) sample();
    if (snapshots_left() && step_ == steps_of_snapshot(next_snapshot_)) take_snapshot();
  }

  void look() {
    largest_displacement_ = std::max(largest_displacement_, largest_norm<Dim>(state_.displacement));
    largest_velocity_ = std::max(largest_velocity_, largest_norm<Dim>(state_.velocity));
    Vector<Dim> momentum = Vector<Dim>::Zero();
    double momentum_scale = 0.0;
    for (int a = 0; a < simulation_.particles(); ++a) {
      largest_von_mises_ = std::max(largest_von_mises_, simulation_.von_mises_stress(state_, a));
      momentum += simulation_.inertia(a) * state_.velocity[a];
      momentum_scale += simulation_.inertia(a) * state_.velocity[a].norm();
    }
    const Vector<Dim> drift = free_.template cast<double>() * (momentum - momentum_given_by_forces()).array();
    largest_momentum_drift_ = std::max(largest_momentum_drift_, drift.norm());
    largest_momentum_ = std::max(largest_momentum_, momentum_scale);
    if (options_.progress) options_.progress(step_, steps_);
  }

  /// Forces at rest f add nf Δt up to step n, of which damping leaves (f/c)(1 − qⁿ) with q = 1 − cΔt of a leapfrog step
  /// and (1 − ½cΔt)² of a Verlet step.
  Vector<Dim> momentum_given_by_forces() const {
    if (!scene_.problem.scheme.damping) return time() * total_force_;
    const double rate = scene_.problem.scheme.damping->rate, decay = rate * options_.time_step;
    const double q =
        scene_.problem.integrator == Integrator::leapfrog ? 1.0 - decay : (1.0 - 0.5 * decay) * (1.0 - 0.5 * decay);
    return (1.0 - std::pow(q, step_)) / rate * total_force_;
  }

  void sample() {
    sample_times_.push_back(time());
    for (auto& probe : probes_) {
      probe.displacement.push_back(state_.displacement[probe.particle]);
      probe.velocity.push_back(state_.velocity[probe.particle]);
      probe.stress.push_back(simulation_.stress(state_, probe.particle));
    }
  }

  void take_snapshot() {
    ++next_snapshot_;
    step_of_last_snapshot_ = step_;
    if (!options_.visit) return;
    Snapshot<Dim> snapshot{step_, time(), state_, {}, {}};
    for (int a = 0; a < simulation_.particles(); ++a) {
      snapshot.stress.push_back(simulation_.stress(state_, a));
      snapshot.von_mises_stress.push_back(simulation_.von_mises_stress(state_, a));
    }
    options_.visit(snapshot);
  }

  SceneSummary summary() {
    const long right_hand_sides = simulation_.right_hand_sides();
    double work = 0.0;
    for (int a = 0; a < simulation_.particles(); ++a)
      work += simulation_.inertia(a) * force_at_rest_[a].dot(state_.displacement[a]);
    std::optional<double> momentum_drift;
    if (free_.any()) momentum_drift = largest_momentum_ > 0.0 ? largest_momentum_drift_ / largest_momentum_ : 0.0;
    return {.time = time(),
            .steps = step_,
            .right_hand_sides = right_hand_sides,
            .largest_displacement = largest_displacement_,
            .largest_velocity = largest_velocity_,
            .largest_von_mises_stress = largest_von_mises_,
            .kinetic_energy = simulation_.kinetic_energy(synchronised()),
            .strain_energy = simulation_.strain_energy(state_),
            .work = work,
            .momentum_drift = momentum_drift};
  }

  /// The state with velocities at the time of the displacements.
  State<Dim> synchronised() {
    State<Dim> state = state_;
    if (scene_.problem.integrator != Integrator::leapfrog || step_ == 0) return state;
    Field<Dim> force(state.particles());
    simulation_.accelerations(state, force);
    for (int a = 0; a < state.particles(); ++a) state.velocity[a] += 0.5 * options_.time_step * force[a];
    return state;
  }

  const Scene<Dim>& scene_;
  const SceneRunOptions<Dim>& options_;
  long steps_;
  long sample_stride_;
  long snapshots_;
  solver::Simulation<Dim> simulation_;
  Directions<Dim> free_;
  State<Dim> state_;
  State<Dim> last_finite_;
  Field<Dim> force_at_rest_;  ///< per mass
  Vector<Dim> total_force_ = Vector<Dim>::Zero();

  long step_ = 0;
  long next_snapshot_ = 0;
  long step_of_last_snapshot_ = -1;
  std::vector<double> sample_times_;
  std::vector<ProbeHistory<Dim>> probes_;
  double largest_displacement_ = 0.0;
  double largest_velocity_ = 0.0;
  double largest_von_mises_ = 0.0;
  double largest_momentum_drift_ = 0.0;
  double largest_momentum_ = 0.0;
  std::optional<NonFiniteValue> failure_;
};

}  // namespace

template <int Dim>
SceneRunResult<Dim> run_scene(const Scene<Dim>& scene, const SceneRunOptions<Dim>& options) {
  require_positive("time_step", options.time_step);
  require_positive("duration", options.duration);
  if (!(options.duration / options.time_step <= most_steps))
    throw InvalidInput(
        fmt::format("duration: {} takes more than {} steps of {}", options.duration, most_steps, options.time_step));
  return Run<Dim>(scene, options).result();
}

template SceneRunResult<1> run_scene(const Scene<1>&, const SceneRunOptions<1>&);
template SceneRunResult<2> run_scene(const Scene<2>&, const SceneRunOptions<2>&);
template SceneRunResult<3> run_scene(const Scene<3>&, const SceneRunOptions<3>&);

}  // namespace sphstab::study
