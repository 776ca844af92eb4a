// SPDX-License-Identifier: MIT
#include "study/relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/simulation.hpp"

namespace sphstab::study {
namespace {

using solver::Field;
using solver::Simulation;
using solver::State;

/// Steps between two looks, each of which costs two right-hand sides.
constexpr long look_every = 50;
/// Damping above this many times 1/Δt would take the stability that a time step of 0.85 of the critical one leaves:
/// leapfrog needs (ωΔt)² ≤ 4 − 2cΔt.
constexpr double largest_damping = 0.5;

template <int Dim>
double norm(const Simulation<Dim>& simulation, const Field<Dim>& field) {
  double square = 0.0;
  for (int a = 0; a < simulation.particles(); ++a) square += simulation.inertia(a) * field[a].squaredNorm();
  return std::sqrt(square);
}

/// The force per mass that keeps the body from rest: F(r, 0). The velocity of `at_rest` is and stays 0.
template <int Dim>
void residual_forces(Simulation<Dim>& simulation, const State<Dim>& state, State<Dim>& at_rest, Field<Dim>& force) {
  at_rest.displacement = state.displacement;
  simulation.accelerations(at_rest, force);
}

/// The body with loads of which none is left over, in directions in which nothing holds it.
template <int Dim>
Body<Dim> with_balanced_loads(const Problem<Dim>& problem, Body<Dim> body) {
  Simulation<Dim> simulation(problem, body);
  Vector<Dim> total = Vector<Dim>::Zero();
  double inertia = 0.0;
  for (int a = 0; a < static_cast<int>(body.load.size()); ++a) {
    total += simulation.inertia(a) * body.load[a];
    inertia += simulation.inertia(a);
  }
  for (const auto& clamped : body.clamped) total = clamped.select(0.0, total.array()).matrix();
  for (auto& load : body.load) load -= total / inertia;
  return body;
}

/// ω² of a field of displacements: strain energy over the kinetic energy that it has as velocities.
template <int Dim>
double rayleigh_quotient(const Simulation<Dim>& simulation, const Field<Dim>& field) {
  State<Dim> state(simulation.particles());
  state.displacement = state.velocity = field;
  return simulation.strain_energy(state) / simulation.kinetic_energy(state);
}

}  // namespace

template <int Dim>
Relaxation<Dim> relax(const Problem<Dim>& problem, const Body<Dim>& body, const RelaxationOptions& options) {
  require_positive("time_step", options.time_step);
  require_positive("tolerance", options.tolerance);
  Simulation<Dim> simulation(problem, with_balanced_loads(problem, body));
  State<Dim> state(body.size());
  State<Dim> at_rest(body.size());
  Field<Dim> force(body.size());
  residual_forces(simulation, state, at_rest, force);
  const double scale = norm(simulation, force);
  Relaxation<Dim> found{.converged = scale == 0.0,
                        .displacement = state.displacement,
                        .steps = 0,
                        .residual = 0.0,
                        .displacement_error = 0.0,
                        .damping_rate = problem.scheme.damping ? problem.scheme.damping->rate : 0.0};
  double slowest = std::numeric_limits<double>::infinity();
  while (!found.converged && found.steps < options.largest_steps) {
    simulation.advance(state, options.time_step, look_every);
    found.steps += look_every;
    residual_forces(simulation, state, at_rest, force);
    found.residual = norm(simulation, force) / scale;
    if (!std::isfinite(found.residual)) break;
    const double now =
        std::min(rayleigh_quotient(simulation, state.displacement), rayleigh_quotient(simulation, state.velocity));
    slowest = std::min(slowest, now);
    found.displacement_error = found.residual * scale / (slowest * norm(simulation, state.displacement));
    found.converged = found.residual < options.tolerance && found.displacement_error < options.tolerance;
    if (!problem.scheme.damping) {
      found.damping_rate = std::min(2.0 * std::sqrt(now), largest_damping / options.time_step);
      simulation.set_damping(Damping{found.damping_rate});
    }
    if (options.progress) options.progress(found.steps, found.residual);
  }
  found.displacement = std::move(state.displacement);
  return found;
}

template Relaxation<1> relax(const Problem<1>&, const Body<1>&, const RelaxationOptions&);
template Relaxation<2> relax(const Problem<2>&, const Body<2>&, const RelaxationOptions&);
template Relaxation<3> relax(const Problem<3>&, const Body<3>&, const RelaxationOptions&);

}  // namespace sphstab::study
