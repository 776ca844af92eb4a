// SPDX-License-Identifier: MIT
#include "study/scene_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "solver/finite_strain_simulation.hpp"
#include "solver/updated_simulation.hpp"
#include "study/thread_clock.hpp"

namespace sphstab::study {
namespace {

using solver::Field;

/// Steps between two looks at the whole body, each of which costs half a right-hand side.
constexpr long look_every = 50;
/// Numbers beyond it count as not finite: their squares times any modulus or mass are still numbers, so that the
/// energies of the last state are. Forces of finite strain go like the cubes of displacements.
constexpr double largest_number(Formulation formulation) {
  return formulation == Formulation::updated_lagrangian ? 1e100 : 1e40;
}
/// A duration that is a whole number of time steps but for rounding takes no step more.
constexpr double rounding_of_steps = 1e-12;

/// Looks at a run of finite strain between two that compare its energies and judge its particles.
constexpr long looks_between_close_ones = 10;
/// Steps between two looks at the velocities of a run whose limit is followed.
constexpr long heed_every = 10;
/// Changes of the followed limit, relative, that do not change the step.
constexpr double smallest_change = 1e-3;

/// More steps than a run can take; far below the largest whole number.
constexpr double most_steps = 1e15;

template <class Numbers>
bool in_range(const Numbers& numbers, double largest) {
  return (numbers.array().abs() <= largest).all();
}

template <int Dim>
std::optional<int> first_not_finite(const Field<Dim>& field, double largest) {
  const auto found =
      std::find_if(field.begin(), field.end(), [largest](const Vector<Dim>& y) { return !in_range(y, largest); });
  if (found == field.end()) return std::nullopt;
  return static_cast<int>(found - field.begin());
}

/// A number that is none.
struct LostNumber {
  int particle;
  std::string_view field;
  std::optional<std::string_view> term = std::nullopt;
};

/// A scene of a total-Lagrangian scheme as it moves. This, and the class of the same members below, is what a run knows
/// of a formulation.
template <int Dim>
class LagrangianMotion {
 public:
  using State = solver::State<Dim>;

  explicit LagrangianMotion(const Scene<Dim>& scene)
      : scene_(scene),
        simulation_(solver::make_simulation(scene.problem, scene.body)),
        state_(scene.body.size()),
        force_at_start_(accelerations()) {
    if (!scene.velocity.empty()) state_.velocity = scene.velocity;
    simulation_->hold(state_);
  }

  int particles() const { return state_.particles(); }
  double mass(int a) const { return simulation_->inertia(a); }  ///< with which energy and momentum are kept

  const State& state() const { return state_; }
  void go_back_to(const State& state) { state_ = state; }
  void advance(double time_step, long steps) { simulation_->advance(state_, time_step, steps); }

  /// v + `time` times the acceleration.
  void kick(double time) {
    const Field<Dim> acceleration = accelerations();
    for (int a = 0; a < particles(); ++a) state_.velocity[a] += time * acceleration[a];
  }

  /// Of finite strain.
  std::optional<GrowthWatch<Dim>> growth_watch() const {
    const auto* simulation = dynamic_cast<const solver::FiniteStrainSimulation<Dim>*>(simulation_.get());
    if (simulation == nullptr) return std::nullopt;
    return GrowthWatch<Dim>(scene_, *simulation, state_.displacement);
  }

  const Vector<Dim>& displacement(int a) const { return state_.displacement[a]; }
  const Vector<Dim>& velocity(int a) const { return state_.velocity[a]; }
  Tensor<Dim> stress(int a) const { return simulation_->stress(state_, a); }
  double von_mises_stress(int a) const { return simulation_->von_mises_stress(state_, a); }
  std::vector<double> density() const { return {}; }
  double strain_energy() const { return simulation_->strain_energy(state_); }

  Field<Dim> accelerations() {
    Field<Dim> force(particles());
    simulation_->accelerations(state_, force);
    return force;
  }
  /// Of loads and base state, per mass: the forces that do work whatever moves.
  const Field<Dim>& constant_force() const { return force_at_start_; }

  /// The first number of the state that is none, velocities first.
  std::optional<LostNumber> lost_number() const {
    constexpr double largest = largest_number(Formulation::total_lagrangian_pk1);
    if (const auto a = first_not_finite<Dim>(state_.velocity, largest)) return LostNumber{*a, "velocity"};
    if (const auto a = first_not_finite<Dim>(state_.displacement, largest)) return LostNumber{*a, "displacement"};
    return std::nullopt;
  }
  /// The number that one step from a state of numbers has lost.
  LostNumber failure(const State&, double) const { return *lost_number(); }

  std::vector<int> lost_particles() const { return {}; }
  long right_hand_sides() const { return simulation_->right_hand_sides(); }
  std::optional<long> list_builds() const { return std::nullopt; }

 private:
  const Scene<Dim>& scene_;
  std::unique_ptr<solver::TotalLagrangian<Dim>> simulation_;
  State state_;
  Field<Dim> force_at_start_;
};

/// A scene of `ul` as it moves.
template <int Dim>
class UpdatedMotion {
 public:
  using State = solver::UpdatedState<Dim>;

  explicit UpdatedMotion(const Scene<Dim>& scene)
      : simulation_(scene.problem, scene.body, scene.periodic_cells),
        state_(simulation_.base_state()),
        start_(scene.body.position),
        load_(scene.body.load) {
    load_.resize(particles(), Vector<Dim>::Zero());
    if (!scene.velocity.empty()) state_.velocity = scene.velocity;
    simulation_.hold(state_);
  }

  int particles() const { return simulation_.particles(); }
  double mass(int a) const { return simulation_.mass(a); }

  const State& state() const { return state_; }
  void go_back_to(const State& state) { state_ = state; }
  void advance(double time_step, long steps) { simulation_.advance(state_, time_step, steps); }

  /// The step of `ul` is not followed, and its growth judged at the end.
  void kick(double) {}
  std::optional<GrowthWatch<Dim>> growth_watch() const { return std::nullopt; }

  Vector<Dim> displacement(int a) const { return state_.position[a] - start_[a]; }
  const Vector<Dim>& velocity(int a) const { return state_.velocity[a]; }
  Tensor<Dim> stress(int a) const { return simulation_.stress(state_, a); }
  double von_mises_stress(int a) const { return simulation_.von_mises_stress(state_, a); }
  const std::vector<double>& density() const { return state_.density; }
  double strain_energy() const { return simulation_.elastic_energy(state_); }

  Field<Dim> accelerations() {
    Field<Dim> force(particles());
    simulation_.place(state_.position);
    simulation_.forces(state_, force);
    return force;
  }
  const Field<Dim>& constant_force() const { return load_; }

  std::optional<LostNumber> lost_number() const {
    for (int a = 0; a < particles(); ++a)
      if (const auto quantity = lost_quantity(a)) return LostNumber{a, name_of(*quantity)};
    return std::nullopt;
  }
  LostNumber failure(const State& before, double time_step) {
    const LostNumber first = *lost_number();
    const auto broken = simulation_.broken_term(before, time_step);
    if (!broken) return {first.particle, first.field, name_of(solver::maker_of(*lost_quantity(first.particle)))};
    const auto quantity = lost_quantity(broken->particle);
    return {broken->particle, quantity ? name_of(*quantity) : first.field, name_of(broken->term)};
  }

  std::vector<int> lost_particles() {
    simulation_.place(state_.position);
    return simulation_.isolated_particles();
  }
  long right_hand_sides() const { return simulation_.work().forces; }
  std::optional<long> list_builds() const { return simulation_.work().list_builds; }

 private:
  std::optional<solver::UpdatedQuantity> lost_quantity(int a) const {
    constexpr double largest = largest_number(Formulation::updated_lagrangian);
    if (!in_range(state_.velocity[a], largest)) return solver::UpdatedQuantity::velocity;
    if (!in_range(state_.position[a], largest)) return solver::UpdatedQuantity::position;
    if (!(state_.density[a] > 0.0 && state_.density[a] <= largest)) return solver::UpdatedQuantity::density;
    if (!in_range(state_.deviatoric_stress[a], largest)) return solver::UpdatedQuantity::deviatoric_stress;
    return std::nullopt;
  }

  solver::UpdatedSimulation<Dim> simulation_;
  State state_;
  Field<Dim> start_;
  Field<Dim> load_;
};

/// The directions in which no particle is clamped: only there is momentum kept.
template <int Dim>
Directions<Dim> free_directions(const Body<Dim>& body) {
  Directions<Dim> free = Directions<Dim>::Constant(true);
  for (const auto& clamped : body.clamped) free = free && !clamped;
  return free;
}

template <int Dim, class Motion>
class Run {
 public:
  Run(const Scene<Dim>& scene, const SceneRunOptions<Dim>& options)
      : scene_(scene),
        options_(options),
        follower_(make_follower(scene, options)),
        time_step_(first_step()),
        steps_(static_cast<long>(std::ceil(options.duration / time_step_ * (1.0 - rounding_of_steps)))),
        sample_stride_(options.probe_samples ? (steps_ + *options.probe_samples - 1) / *options.probe_samples : 1),
        snapshots_(std::min(options.snapshots, steps_)),
        motion_(scene),
        last_finite_(motion_.state()),
        free_(free_directions(scene.body)),
        momentum_at_change_(momentum()),
        initial_energy_(kinetic_energy() + motion_.strain_energy()) {
    for (int a = 0; a < motion_.particles(); ++a) total_force_ += motion_.mass(a) * motion_.constant_force()[a];
    for (const auto& probe : scene.probes) probes_.push_back({probe.name, probe.particle, {}, {}, {}});
  }

  SceneRunResult<Dim> result() {
    observe();
    while (step_ < steps_ && !growth_ && advance_to(next_event())) observe();
    if (failure_ || growth_) {
      look();
      if (options_.snapshots > 0 && step_ != step_of_last_snapshot_) take_snapshot();
      if (!probes_.empty() && time() != sample_times_.back()) sample();
    }
    return {snapshot(), sample_times_, probes_, summary(), failure_, growth_};
  }

 private:
  using Follower = StepFollower<Dim>;

  static std::optional<Follower> make_follower(const Scene<Dim>& scene, const SceneRunOptions<Dim>& options) {
    if (!options.followed_fraction) return std::nullopt;
    return std::optional<Follower>(std::in_place, scene);
  }

  double first_step() const {
    if (!follower_) return options_.time_step;
    if (!follower_->critical_step())
      throw InvalidInput("time_step: auto needs a body in which some mode has a restoring force");
    return followed_limit() / follower_->room_for_loads();
  }

  double time() const { return time_of_change_ + static_cast<double>(step_ - step_of_change_) * time_step_; }

  long steps_of_snapshot(long index) const {
    if (step_of_change_ == 0)
      return std::lround(static_cast<double>(index) * static_cast<double>(steps_) / static_cast<double>(snapshots_));
    const double time_left =
        options_.duration * static_cast<double>(index) / static_cast<double>(snapshots_) - time_of_change_;
    return std::min(steps_, step_of_change_ + std::lround(time_left / time_step_));
  }

  /// Another step from here on. Velocities of `leapfrog` are half a step behind, of whichever step.
  void change_step(double time_step) {
    momentum_at_change_ = momentum_without_drift();
    time_of_change_ = time();
    step_of_change_ = step_;
    if (scene_.problem.integrator == Integrator::leapfrog) {
      const double kick = 0.5 * (time_step_ - time_step);
      motion_.kick(kick);
      momentum_at_change_ += kick * total_force_;
    }
    time_step_ = time_step;
    steps_ = step_ + static_cast<long>(
                         std::ceil((options_.duration - time_of_change_) / time_step * (1.0 - rounding_of_steps)));
    smallest_step_ = std::min(smallest_step_, time_step);
    largest_step_ = std::max(largest_step_, time_step);
  }

  std::vector<Vector<Dim>> displacements() const {
    std::vector<Vector<Dim>> all(motion_.particles());
    for (int a = 0; a < motion_.particles(); ++a) all[a] = motion_.displacement(a);
    return all;
  }

  void follow() {
    follower_->update(displacements());
    step_of_update_ = step_ + follower_->interval();
    const double time_step = followed_step();
    if (std::abs(time_step / time_step_ - 1.0) > smallest_change) change_step(time_step);
  }

  /// The part of the last limit that is asked for.
  double followed_limit() const { return *options_.followed_fraction * *follower_->critical_step(); }

  double followed_step() const {
    return followed_limit() / follower_->room_for_waves(displacements(), motion_.state().velocity);
  }

  /// Between updates the step is only lowered.
  void heed_waves() {
    if (const double time_step = followed_step(); time_step < time_step_ * (1.0 - smallest_change))
      change_step(time_step);
  }

  bool snapshots_left() const { return snapshots_ > 0 && next_snapshot_ <= snapshots_; }

  long next_event() const {
    const auto next_multiple = [this](long stride) { return (step_ / stride + 1) * stride; };
    long next = std::min(steps_, next_multiple(look_every));
    if (!probes_.empty()) next = std::min(next, next_multiple(sample_stride_));
    if (snapshots_left()) next = std::min(next, std::max(step_ + 1, steps_of_snapshot(next_snapshot_)));
    if (follower_) next = std::min({next, step_of_update_, next_multiple(heed_every)});
    return next;
  }

  /// False if a number was not finite on the way; then the state is that of the step before.
  bool advance_to(long end) {
    last_finite_ = motion_.state();
    motion_.advance(time_step_, end - step_);
    if (motion_.lost_number()) {
      motion_.go_back_to(last_finite_);
      find_failure();
      return false;
    }
    step_ = end;
    return true;
  }

  /// Goes the way again step by step, which gives the same numbers.
  void find_failure() {
    while (!motion_.lost_number()) {
      last_finite_ = motion_.state();
      motion_.advance(time_step_, 1);
      ++step_;
    }
    const LostNumber lost = motion_.failure(last_finite_, time_step_);
    failure_ = {step_, time(), lost.particle, lost.field, lost.term};
    motion_.go_back_to(last_finite_);
    --step_;
    if (watch_) name_growth();
  }

  void observe() {
    if (step_ % look_every == 0 || step_ == steps_) look();
    if ((step_ % sample_stride_ == 0 || step_ == steps_) && !probes_.empty()) sample();
    if (snapshots_left() && step_ >= steps_of_snapshot(next_snapshot_)) take_snapshot();
    if (watch_ && (step_ % look_every == 0 || step_ == steps_)) watch_growth();
    if (!follower_ || step_ == 0 || step_ >= steps_) return;
    if (step_ >= step_of_update_)
      follow();
    else if (step_ % heed_every == 0)
      heed_waves();
  }

  /// Energies cost two right-hand sides, and the judgement of all particles about as much.
  void watch_growth() {
    const bool looks_closely = step_ % (look_every * looks_between_close_ones) == 0;
    const bool judges = looks_closely || (step_ % look_every == 0 && watch_->sees_loss());
    if (judges && watch_->sees_lasting_loss(displacements())) return name_growth();
    if (!looks_closely && step_ < steps_) return;
    largest_work_ = std::max(largest_work_, std::abs(work()));
    const double given = initial_energy_ + largest_work_ + energy_of_rounding(scene_);
    if (watch_->has_grown(kinetic_energy() + motion_.strain_energy(), given, time_step_)) return name_growth();
    watch_->keep(displacements());
  }

  void name_growth() {
    const bool is_too_long = options_.followed_fraction.value_or(0.0) > 1.0;
    growth_ = {step_, time(), is_too_long ? GrowthCause::time_step : watch_->cause(time_step_, !follower_)};
  }

  double work() const {
    double work = 0.0;
    for (int a = 0; a < motion_.particles(); ++a)
      work += motion_.mass(a) * motion_.constant_force()[a].dot(motion_.displacement(a));
    return work;
  }

  void look() {
    double momentum_scale = 0.0;
    for (int a = 0; a < motion_.particles(); ++a) {
      largest_displacement_ = std::max(largest_displacement_, motion_.displacement(a).norm());
      largest_velocity_ = std::max(largest_velocity_, motion_.velocity(a).norm());
      largest_von_mises_ = std::max(largest_von_mises_, motion_.von_mises_stress(a));
      momentum_scale += motion_.mass(a) * motion_.velocity(a).norm();
    }
    const Vector<Dim> drift = free_.template cast<double>() * (momentum() - momentum_without_drift()).array();
    largest_momentum_drift_ = std::max(largest_momentum_drift_, drift.norm());
    largest_momentum_ = std::max(largest_momentum_, momentum_scale);
    if (options_.progress) options_.progress(step_, steps_);
  }

  Vector<Dim> momentum() const {
    Vector<Dim> sum = Vector<Dim>::Zero();
    for (int a = 0; a < motion_.particles(); ++a) sum += motion_.mass(a) * motion_.velocity(a);
    return sum;
  }

  /// Constant forces f add nf Δt to the momentum p of the start, or of the last change of the step, up to step n.
  /// Damping leaves qⁿ p + (f/c)(1 − qⁿ) with q = 1 − cΔt of a leapfrog step and (1 − ½cΔt)² of a Verlet step.
  Vector<Dim> momentum_without_drift() const {
    if (!scene_.problem.scheme.damping) return momentum_at_change_ + (time() - time_of_change_) * total_force_;
    const double rate = scene_.problem.scheme.damping->rate, decay = rate * time_step_;
    const double q =
        scene_.problem.integrator == Integrator::leapfrog ? 1.0 - decay : (1.0 - 0.5 * decay) * (1.0 - 0.5 * decay);
    const double kept = std::pow(q, step_ - step_of_change_);
    return kept * momentum_at_change_ + (1.0 - kept) / rate * total_force_;
  }

  void sample() {
    sample_times_.push_back(time());
    for (auto& probe : probes_) {
      probe.displacement.push_back(motion_.displacement(probe.particle));
      probe.velocity.push_back(motion_.velocity(probe.particle));
      probe.stress.push_back(motion_.stress(probe.particle));
    }
  }

  Snapshot<Dim> snapshot() const {
    Snapshot<Dim> snapshot{step_, time(), {}, {}, {}, {}, motion_.density()};
    for (int a = 0; a < motion_.particles(); ++a) {
      snapshot.displacement.push_back(motion_.displacement(a));
      snapshot.velocity.push_back(motion_.velocity(a));
      snapshot.stress.push_back(motion_.stress(a));
      snapshot.von_mises_stress.push_back(motion_.von_mises_stress(a));
    }
    return snapshot;
  }

  void take_snapshot() {
    ++next_snapshot_;
    step_of_last_snapshot_ = step_;
    if (options_.visit) options_.visit(snapshot());
  }

  SceneSummary summary() {
    const long right_hand_sides = motion_.right_hand_sides();
    const auto list_builds = motion_.list_builds();
    std::optional<double> momentum_drift;
    if (free_.any()) momentum_drift = moves() ? largest_momentum_drift_ / largest_momentum_ : 0.0;
    return {.time = time(),
            .steps = step_,
            .right_hand_sides = right_hand_sides,
            .largest_displacement = largest_displacement_,
            .largest_velocity = largest_velocity_,
            .largest_von_mises_stress = largest_von_mises_,
            .initial_energy = initial_energy_,
            .kinetic_energy = kinetic_energy(),
            .strain_energy = motion_.strain_energy(),
            .work = work(),
            .momentum_drift = momentum_drift,
            .following = following(),
            .list_builds = list_builds,
            .lost_particles = motion_.lost_particles(),
            .is_elliptic = !watch_ || watch_->is_elliptic(displacements())};
  }

  std::optional<StepFollowing> following() const {
    if (!follower_) return std::nullopt;
    return StepFollowing{smallest_step_, largest_step_, follower_->work(),
                         follower_->work().cpu_seconds / (thread_seconds() - cpu_seconds_at_start_)};
  }

  /// Whether anything moves at more than what the rounding of the stresses of a body at rest brings about.
  bool moves() const {
    double mass = 0.0;
    for (int a = 0; a < motion_.particles(); ++a) mass += motion_.mass(a);
    return largest_momentum_ > velocity_of_rounding * mass * p_wave_speed(scene_.problem);
  }

  /// ½ Σ m v² with velocities at the time of the displacements. Those of the start are taken as they are.
  double kinetic_energy() {
    const bool behind = scene_.problem.integrator == Integrator::leapfrog && step_ > 0;
    const double kick = behind ? 0.5 * time_step_ : 0.0;
    const Field<Dim> force = behind ? motion_.accelerations() : Field<Dim>(motion_.particles(), Vector<Dim>::Zero());
    double energy = 0.0;
    for (int a = 0; a < motion_.particles(); ++a)
      energy += 0.5 * motion_.mass(a) * (motion_.velocity(a) + kick * force[a]).squaredNorm();
    return energy;
  }

  const Scene<Dim>& scene_;
  const SceneRunOptions<Dim>& options_;
  double cpu_seconds_at_start_ = thread_seconds();
  std::optional<Follower> follower_;
  double time_step_;
  double smallest_step_ = time_step_, largest_step_ = time_step_;
  long steps_;
  long sample_stride_;
  long snapshots_;
  long step_ = 0;
  /// When the step was last changed, and when it will be looked at again.
  long step_of_change_ = 0;
  double time_of_change_ = 0.0;
  long step_of_update_ = follower_ ? follower_->interval() : 0;
  Motion motion_;
  typename Motion::State last_finite_;
  Directions<Dim> free_;
  Vector<Dim> momentum_at_change_;
  double initial_energy_;
  Vector<Dim> total_force_ = Vector<Dim>::Zero();

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
  std::optional<GrowthWatch<Dim>> watch_ = motion_.growth_watch();
  double largest_work_ = 0.0;
  std::optional<RunGrowth> growth_;
};

}  // namespace

template <int Dim>
SceneRunResult<Dim> run_scene(const Scene<Dim>& scene, const SceneRunOptions<Dim>& options) {
  if (options.followed_fraction && !is_finite_strain(scene.problem.scheme.formulation))
    throw InvalidInput(
        fmt::format("time_step: auto follows the limit of tl-corotated and tl-pk1, which changes, not of {}",
                    name_of(scene.problem.scheme.formulation)));
  if (!options.followed_fraction) require_positive("time_step", options.time_step);
  require_positive("duration", options.duration);
  const double largest = largest_number(scene.problem.scheme.formulation);
  if (const auto particle = first_not_finite<Dim>(scene.velocity, largest))
    throw InvalidInput(fmt::format("velocity: that of particle {} is beyond {:g}", *particle, largest));
  if (!options.followed_fraction && !(options.duration / options.time_step <= most_steps))
    throw InvalidInput(
        fmt::format("duration: {} takes more than {} steps of {}", options.duration, most_steps, options.time_step));
  switch (scene.problem.scheme.formulation) {
    case Formulation::total_lagrangian_linear:
    case Formulation::total_lagrangian_corotated:
    case Formulation::total_lagrangian_pk1:
      return Run<Dim, LagrangianMotion<Dim>>(scene, options).result();
    case Formulation::updated_lagrangian:
      return Run<Dim, UpdatedMotion<Dim>>(scene, options).result();
  }
  return {};
}

template SceneRunResult<1> run_scene(const Scene<1>&, const SceneRunOptions<1>&);
template SceneRunResult<2> run_scene(const Scene<2>&, const SceneRunOptions<2>&);
template SceneRunResult<3> run_scene(const Scene<3>&, const SceneRunOptions<3>&);

}  // namespace sphstab::study
