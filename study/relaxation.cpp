// SPDX-License-Identifier: MIT
#include "study/relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "solver/total_lagrangian.hpp"
#include "solver/updated_simulation.hpp"

namespace sphstab::study {
namespace {

using solver::Field;
using solver::State;

/// Steps between two looks, each of which costs two right-hand sides.
constexpr long look_every = 50;
/// Steps between two kicks of damping in `ul`, whose solver has none.
constexpr long damp_every = 5;
/// Damping above this many times 1/Δt would take the stability that a time step of 0.85 of the critical one leaves:
/// leapfrog needs (ωΔt)² ≤ 4 − 2cΔt.
constexpr double largest_damping = 0.5;

/// What relaxation knows of a body that moves.
template <int Dim>
class RelaxingBody {
 public:
  virtual ~RelaxingBody() = default;

  virtual double inertia(int a) const = 0;
  virtual void advance(double time_step, long steps, double damping_rate) = 0;
  /// The force per mass that keeps the body from rest: F(r, 0).
  virtual void residual_forces(Field<Dim>& force) = 0;
  virtual const Field<Dim>& displacement() = 0;
  /// ω² of the slowest motion that can be told.
  virtual double slowest_square() = 0;
};

template <int Dim>
double norm(const RelaxingBody<Dim>& body, const Field<Dim>& field) {
  double square = 0.0;
  for (std::size_t a = 0; a < field.size(); ++a) square += body.inertia(static_cast<int>(a)) * field[a].squaredNorm();
  return std::sqrt(square);
}

/// The body with loads of which none is left over, in directions in which nothing holds it.
template <int Dim>
Body<Dim> with_balanced_loads(const std::function<double(int)>& inertia, Body<Dim> body) {
  Vector<Dim> total = Vector<Dim>::Zero();
  double mass = 0.0;
  for (int a = 0; a < static_cast<int>(body.load.size()); ++a) {
    total += inertia(a) * body.load[a];
    mass += inertia(a);
  }
  for (const auto& clamped : body.clamped) total = clamped.select(0.0, total.array()).matrix();
  for (auto& load : body.load) load -= total / mass;
  return body;
}

template <int Dim>
class LagrangianBody final : public RelaxingBody<Dim> {
 public:
  LagrangianBody(const Problem<Dim>& problem, const Body<Dim>& body)
      : LagrangianBody(problem, body, *solver::make_simulation(problem, body)) {}

  double inertia(int a) const override { return simulation_->inertia(a); }

  void advance(double time_step, long steps, double damping_rate) override {
    simulation_->set_damping(damping_rate > 0.0 ? std::optional(Damping{damping_rate}) : std::nullopt);
    simulation_->advance(state_, time_step, steps);
  }

  void residual_forces(Field<Dim>& force) override {
    at_rest_.displacement = state_.displacement;
    simulation_->accelerations(at_rest_, force);
  }

  const Field<Dim>& displacement() override { return state_.displacement; }

  /// The strain of a velocity tells a slow motion only where rotations are small.
  double slowest_square() override {
    const double of_displacement = rayleigh_quotient(state_.displacement);
    return is_linear_ ? std::min(of_displacement, rayleigh_quotient(state_.velocity)) : of_displacement;
  }

 private:
  LagrangianBody(const Problem<Dim>& problem, const Body<Dim>& body, const solver::TotalLagrangian<Dim>& unbalanced)
      : simulation_(solver::make_simulation(
            problem, with_balanced_loads<Dim>([&](int a) { return unbalanced.inertia(a); }, body))),
        is_linear_(!is_finite_strain(problem.scheme.formulation)),
        state_(body.size()),
        at_rest_(body.size()) {}

  /// ω² of a field of displacements: strain energy over the kinetic energy that it has as velocities.
  double rayleigh_quotient(const Field<Dim>& field) const {
    State<Dim> state(simulation_->particles());
    state.displacement = state.velocity = field;
    return simulation_->strain_energy(state) / simulation_->kinetic_energy(state);
  }

  std::unique_ptr<solver::TotalLagrangian<Dim>> simulation_;
  bool is_linear_;
  State<Dim> state_;
  State<Dim> at_rest_;  ///< its velocity is and stays 0
};

template <int Dim>
class UpdatedBody final : public RelaxingBody<Dim> {
 public:
  UpdatedBody(const Problem<Dim>& problem, const Body<Dim>& body)
      : simulation_(problem, with_balanced_loads<Dim>([&](int a) { return body.mass(a); }, body)),
        state_(simulation_.base_state()),
        start_(body.position),
        displacement_(body.size()) {}

  double inertia(int a) const override { return simulation_.mass(a); }

  void advance(double time_step, long steps, double damping_rate) override {
    const double kept = std::exp(-damping_rate * time_step * damp_every);
    for (long step = 0; step < steps && !is_lost_; step += damp_every) {
      is_lost_ = simulation_.advance(state_, time_step, damp_every).has_value();
      for (auto& v : state_.velocity) v *= kept;
    }
  }

  void residual_forces(Field<Dim>& force) override {
    if (is_lost_) {  // neighbours of numbers that are none cannot be found
      force.assign(force.size(), Vector<Dim>::Constant(std::numeric_limits<double>::infinity()));
      return;
    }
    auto at_rest = state_;
    for (auto& v : at_rest.velocity) v.setZero();
    simulation_.place(at_rest.position);
    simulation_.forces(at_rest, force);
  }

  const Field<Dim>& displacement() override {
    for (std::size_t a = 0; a < start_.size(); ++a) displacement_[a] = state_.position[a] - start_[a];
    return displacement_;
  }

  double slowest_square() override {
    const double size = norm(*this, displacement());
    return 2.0 * simulation_.elastic_energy(state_) / (size * size);
  }

 private:
  solver::UpdatedSimulation<Dim> simulation_;
  solver::UpdatedState<Dim> state_;
  Field<Dim> start_;
  Field<Dim> displacement_;
  bool is_lost_ = false;  ///< a number is none
};

template <int Dim>
std::unique_ptr<RelaxingBody<Dim>> make_relaxing(const Problem<Dim>& problem, const Body<Dim>& body) {
  if (is_total_lagrangian(problem.scheme.formulation)) return std::make_unique<LagrangianBody<Dim>>(problem, body);
  return std::make_unique<UpdatedBody<Dim>>(problem, body);
}

}  // namespace

template <int Dim>
Relaxation<Dim> relax(const Problem<Dim>& problem, const Body<Dim>& body, const RelaxationOptions& options,
                      const std::function<bool(const Field<Dim>&)>& gives_up) {
  require_positive("time_step", options.time_step);
  require_positive("tolerance", options.tolerance);
  const auto relaxing = make_relaxing(problem, body);
  Field<Dim> force(body.size());
  relaxing->residual_forces(force);
  const double scale = norm(*relaxing, force);
  Relaxation<Dim> found{.converged = scale == 0.0,
                        .displacement = relaxing->displacement(),
                        .steps = 0,
                        .residual = 0.0,
                        .displacement_error = 0.0,
                        .damping_rate = problem.scheme.damping ? problem.scheme.damping->rate : 0.0};
  double slowest = std::numeric_limits<double>::infinity();
  while (!found.converged && found.steps < options.largest_steps) {
    relaxing->advance(options.time_step, look_every, found.damping_rate);
    found.steps += look_every;
    relaxing->residual_forces(force);
    found.residual = norm(*relaxing, force) / scale;
    if (!std::isfinite(found.residual) || (gives_up && gives_up(relaxing->displacement()))) break;
    const double now = relaxing->slowest_square();
    slowest = std::min(slowest, now);
    found.displacement_error = found.residual * scale / (slowest * norm(*relaxing, relaxing->displacement()));
    found.converged = found.residual < options.tolerance && found.displacement_error < options.tolerance;
    if (!problem.scheme.damping)
      found.damping_rate = std::min(2.0 * std::sqrt(now), largest_damping / options.time_step);
    if (options.progress) options.progress(found.steps, found.residual);
  }
  found.displacement = relaxing->displacement();
  return found;
}

template Relaxation<1> relax(const Problem<1>&, const Body<1>&, const RelaxationOptions&,
                             const std::function<bool(const Field<1>&)>&);
template Relaxation<2> relax(const Problem<2>&, const Body<2>&, const RelaxationOptions&,
                             const std::function<bool(const Field<2>&)>&);
template Relaxation<3> relax(const Problem<3>&, const Body<3>&, const RelaxationOptions&,
                             const std::function<bool(const Field<3>&)>&);

}  // namespace sphstab::study
