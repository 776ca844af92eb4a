// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>

#include "solver/allocations.hpp"
#include "solver/cases.hpp"

using namespace sphstab;
using namespace sphstab::solver;
using namespace sphstab::solver::test;

namespace {

/// 400 steps with an error of 2.2e-16 each, of fields that stay bounded.
constexpr double rounding = 1e-13;
/// Observed orders differ from the integer by the next term of the error, at most ωΔt = 1.39 · 0.025 of the leading
/// one.
constexpr double order_margin = 0.05;
/// A fifth of the critical step 2/ω_max of this kernel and material, where ω_max = 1.39.
constexpr double time_step = 0.3;

Problem<2> problem_with(Integrator integrator, MomentumDensity momentum_density = MomentumDensity::frozen) {
  Problem<2> problem = plain_problem();
  problem.integrator = integrator;
  problem.scheme.momentum_density = momentum_density;
  return problem;
}

Field<2> accelerations_of(Simulation<2>& simulation, const State<2>& state) {
  Field<2> acceleration(state.particles());
  simulation.accelerations(state, acceleration);
  return acceleration;
}

double energy(const Body<2>& body, const Simulation<2>& simulation, const State<2>& state) {
  return 0.5 * mass_product(body, state.velocity, state.velocity) + simulation.strain_energy(state);
}

enum class Velocity { of_the_state, centred };

/// The largest |E − E(0)| / E(0) up to a fixed time. `centred` takes v − ½Δt F(r) for v, half a step before.
double energy_error(Integrator integrator, Velocity velocity, int steps) {
  const Problem<2> problem = problem_with(integrator);
  const auto body = free_plate(problem, LatticeIndex<2>(6, 5));
  Simulation<2> simulation(problem, body);
  State<2> state = random_state(body.size(), 0.01, 2);
  const double dt = 10.0 / steps;
  const auto shifted_energy = [&] {
    State<2> shifted = state;
    if (velocity == Velocity::centred) {
      const Field<2> force = accelerations_of(simulation, state);
      for (int a = 0; a < body.size(); ++a) shifted.velocity[a] += 0.5 * dt * force[a];
    }
    return energy(body, simulation, shifted);
  };
  const double initial = shifted_energy();
  double error = 0.0;
  for (int n = 0; n < steps; ++n) {
    simulation.advance(state, dt);
    error = std::max(error, std::abs(shifted_energy() / initial - 1.0));
  }
  return error;
}

double observed_energy_order(Integrator integrator, Velocity velocity) {
  return std::log2(energy_error(integrator, velocity, 400) / energy_error(integrator, velocity, 800));
}

}  // namespace

TEST_CASE("the energy error of Verlet, and of leapfrog with centred velocities, is of second order", "[fast]") {
  CHECK(std::abs(observed_energy_order(Integrator::verlet, Velocity::of_the_state) - 2.0) < order_margin);
  CHECK(std::abs(observed_energy_order(Integrator::leapfrog, Velocity::centred) - 2.0) < order_margin);
}

TEST_CASE("leapfrog velocities belong to the half step before: taken as they are, energy is of first order", "[fast]") {
  CHECK(std::abs(observed_energy_order(Integrator::leapfrog, Velocity::of_the_state) - 1.0) < order_margin);
}

TEST_CASE("both integrators keep their own quadratic energy over many steps", "[fast]") {
  // With F = −K s: leapfrog keeps v·v + s·K s − Δt v·K s, Verlet v·v + s·K s − ¼Δt² |K s|², products weighted by mass.
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet}) {
    const Problem<2> problem = problem_with(integrator);
    const auto body = free_plate(problem, LatticeIndex<2>(6, 5));
    Simulation<2> simulation(problem, body);
    State<2> state = random_state(body.size(), 0.01, 2);
    const auto invariant = [&] {
      const Field<2> force = accelerations_of(simulation, state);
      const double correction = integrator == Integrator::leapfrog
                                    ? time_step * mass_product(body, state.velocity, force)
                                    : -0.25 * time_step * time_step * mass_product(body, force, force);
      return mass_product(body, state.velocity, state.velocity) - mass_product(body, state.displacement, force) +
             correction;
    };
    const double initial = invariant();
    for (int n = 0; n < 100; ++n) {
      simulation.advance(state, time_step, 20);
      CHECK(invariant() == Approx(initial).epsilon(rounding));
    }
  }
}

TEST_CASE("leapfrog and Verlet visit the same positions when leapfrog starts half a step earlier", "[fast]") {
  for (const auto momentum_density : {MomentumDensity::frozen, MomentumDensity::equation_of_state}) {
    const auto verlet = problem_with(Integrator::verlet, momentum_density);
    const auto leapfrog = problem_with(Integrator::leapfrog, momentum_density);
    const auto body = free_plate(verlet, LatticeIndex<2>(6, 5));
    Simulation<2> verlet_simulation(verlet, body), leapfrog_simulation(leapfrog, body);
    State<2> state = random_state(body.size(), 0.02, 4), staggered = state;
    const Field<2> force = accelerations_of(verlet_simulation, state);
    for (int a = 0; a < body.size(); ++a) staggered.velocity[a] -= 0.5 * time_step * force[a];
    verlet_simulation.advance(state, time_step, 200);
    leapfrog_simulation.advance(staggered, time_step, 200);
    CHECK(largest_difference(state.displacement, staggered.displacement) < rounding * largest(state.displacement));
  }
}

TEST_CASE("Verlet retraces its steps when velocities are reversed", "[fast]") {
  for (const auto momentum_density : {MomentumDensity::frozen, MomentumDensity::equation_of_state}) {
    const auto problem = problem_with(Integrator::verlet, momentum_density);
    const auto body = free_plate(problem, LatticeIndex<2>(6, 5));
    Simulation<2> simulation(problem, body);
    const State<2> initial = random_state(body.size(), 0.02, 4);
    State<2> state = initial;
    simulation.advance(state, time_step, 200);
    CHECK(largest_difference(state.displacement, initial.displacement) > 0.1 * largest(initial.displacement));
    for (auto& v : state.velocity) v = -v;
    simulation.advance(state, time_step, 200);
    CHECK(largest_difference(state.displacement, initial.displacement) < rounding * largest(initial.displacement));
  }
}

TEST_CASE("one leapfrog step is a kick with the force at the old place and a drift with the new velocity", "[fast]") {
  Problem<2> problem = problem_with(Integrator::leapfrog);
  problem.scheme.damping = some_damping;
  const auto body = free_plate(problem, LatticeIndex<2>(4, 3));
  Simulation<2> simulation(problem, body);
  const State<2> before = random_state(body.size(), 0.1, 6);
  const Field<2> F = accelerations_of(simulation, before);
  State<2> after = before;
  simulation.advance(after, time_step);
  for (int a = 0; a < body.size(); ++a) {
    const Vector<2> v = before.velocity[a] + time_step * F[a];
    CHECK((after.velocity[a] - v).norm() < rounding);
    CHECK((after.displacement[a] - before.displacement[a] - time_step * v).norm() < rounding);
  }
}

TEST_CASE("one Verlet step kicks by half with each velocity as it then is", "[fast]") {
  Problem<2> problem = problem_with(Integrator::verlet);
  problem.scheme.damping = some_damping;
  const auto body = free_plate(problem, LatticeIndex<2>(4, 3));
  Simulation<2> simulation(problem, body);
  const State<2> before = random_state(body.size(), 0.1, 6);
  State<2> expected = before;
  const auto half_kick = [&] {
    const Field<2> F = accelerations_of(simulation, expected);
    for (int a = 0; a < body.size(); ++a) expected.velocity[a] += 0.5 * time_step * F[a];
  };
  half_kick();
  for (int a = 0; a < body.size(); ++a) expected.displacement[a] += time_step * expected.velocity[a];
  half_kick();
  State<2> after = before;
  simulation.advance(after, time_step);
  CHECK(largest_difference(after.velocity, expected.velocity) < rounding);
  CHECK(largest_difference(after.displacement, expected.displacement) < rounding);
}

TEST_CASE("damping slows a drifting plate by 1 - c dt a leapfrog step and its half-step square a Verlet step",
          "[fast]") {
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet}) {
    Problem<2> problem = problem_with(integrator);
    problem.scheme.damping = some_damping;
    const auto body = free_plate(problem, LatticeIndex<2>(4, 3));
    State<2> state(body.size());
    for (auto& v : state.velocity) v = Vector<2>(0.5, -0.25);
    Simulation<2>(problem, body).advance(state, time_step, 10);
    const double factor = integrator == Integrator::leapfrog ? std::pow(1.0 - some_damping.rate * time_step, 10)
                                                             : std::pow(1.0 - 0.5 * some_damping.rate * time_step, 20);
    for (const auto& v : state.velocity) CHECK((v - factor * Vector<2>(0.5, -0.25)).norm() < rounding);
  }
}

TEST_CASE("advancing by n steps is n single steps, bit by bit", "[fast]") {
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet}) {
    Problem<2> problem = problem_with(integrator, MomentumDensity::equation_of_state);
    problem.scheme.damping = some_damping;
    const auto body = free_plate(problem, LatticeIndex<2>(5, 4));
    Simulation<2> simulation(problem, body);
    State<2> together = random_state(body.size(), 0.05, 8), one_by_one = together;
    simulation.advance(together, time_step, 7);
    for (int n = 0; n < 7; ++n) simulation.advance(one_by_one, time_step);
    CHECK(together.displacement == one_by_one.displacement);
    CHECK(together.velocity == one_by_one.velocity);
  }
}

TEST_CASE("leapfrog evaluates one right-hand side a step, Verlet one more in all, and a step allocates nothing",
          "[fast]") {
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet})
    for (auto problem : all_variants(plain_problem())) {
      problem.integrator = integrator;
      INFO(describe(problem));
      const auto body = free_plate(problem, LatticeIndex<2>(5, 4));
      Simulation<2> simulation(problem, body);
      State<2> state = random_state(body.size(), 0.01, 8);
      CHECK(simulation.right_hand_sides() == 0);
      const long allocated = allocations();
      simulation.advance(state, time_step, 10);
      const long allocated_by_steps = allocations() - allocated;
      CHECK(allocated_by_steps == 0);
      CHECK(simulation.right_hand_sides() == (integrator == Integrator::leapfrog ? 10 : 11));
    }
}
