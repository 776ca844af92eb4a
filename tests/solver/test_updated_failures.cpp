// SPDX-License-Identifier: MIT
// Which term of a step of `ul` breaks: states that are built to break each of them, and what tells them apart.
#include <catch2/catch.hpp>
#include <limits>

#include "solver/updated_cases.hpp"

using namespace sphstab;
using namespace sphstab::solver;
using namespace sphstab::solver::test;

namespace {

constexpr double huge = 1e308;  // twice it is no double
constexpr double time_step = 0.01;

/// A free plate of 5×5 particles at rest, and its state.
struct Plate {
  explicit Plate(const Problem<2>& given, const Vector<2>& load = Vector<2>::Zero())
      : problem(given), simulation(problem, loaded(free_plate(problem, LatticeIndex<2>(5, 5)), load)) {}

  static Body<2> loaded(Body<2> body, const Vector<2>& load) {
    body.load.assign(body.size(), load);
    return body;
  }

  /// The term that breaks in the first step from `state`, and that the step breaks at all.
  BrokenTerm broken(double dt = time_step) {
    auto next = state;
    const auto lost = simulation.advance(next, dt);
    REQUIRE(lost);
    CHECK(lost->step == 1);
    const auto broken = simulation.broken_term(state, dt);
    REQUIRE(broken);
    return *broken;
  }

  Problem<2> problem;
  UpdatedSimulation<2> simulation;
  UpdatedState<2> state = simulation.base_state();
};

Problem<2> problem_with(Integrator integrator) {
  Problem<2> problem = updated_problem<2>();
  problem.integrator = integrator;
  return problem;
}

constexpr int first = 7, second = 8;  // neighbours

}  // namespace

TEST_CASE("ul: two particles in one place break the distance of a pair", "[fast]") {
  for (const auto integrator : updated_integrators) {
    Plate plate(with_all_terms(problem_with(integrator)));
    plate.state.position[first] = plate.state.position[second];
    const auto broken = plate.broken();
    CHECK(broken.term == UpdatedTerm::pair_distance);
    CHECK(broken.particle == first);
  }
}

TEST_CASE("ul: a density whose square vanishes breaks the equation of state", "[fast]") {
  for (const auto integrator : updated_integrators) {
    Plate plate(with_all_terms(problem_with(integrator)));
    plate.state.density[first] = 1e-200;
    const auto broken = plate.broken();
    CHECK(broken.term == UpdatedTerm::equation_of_state);
    CHECK(broken.particle == first);
  }
}

TEST_CASE("ul: a factor of the artificial stress beyond the doubles breaks it", "[fast]") {
  for (const auto integrator : updated_integrators) {
    Problem<2> problem = problem_with(integrator);
    problem.scheme.artificial_stress = ArtificialStress{.epsilon = huge};
    Plate plate(problem);
    plate.state.deviatoric_stress[first] << 100.0, 0.0, 0.0, -100.0;
    const auto broken = plate.broken();
    CHECK(broken.term == UpdatedTerm::artificial_stress);
    CHECK(broken.particle == first);
  }
}

TEST_CASE("ul: velocities too far apart break the viscosity, XSPH without it, and continuity without both", "[fast]") {
  for (const auto integrator : updated_integrators) {
    const auto broken_with = [&](bool viscosity, bool xsph) {
      Problem<2> problem = problem_with(integrator);
      if (viscosity) problem.scheme.viscosity = Viscosity{0.7, 0.1};
      if (xsph) problem.scheme.xsph = Xsph{0.5};
      Plate plate(problem);
      plate.state.velocity[first][0] = huge;
      plate.state.velocity[second][0] = -huge;
      const auto broken = plate.broken();
      CHECK(broken.particle <= second);  // the first particle that feels one of them
      return broken.term;
    };
    CHECK(broken_with(true, true) == UpdatedTerm::viscosity);
    CHECK(broken_with(false, true) == UpdatedTerm::xsph);
    CHECK(broken_with(false, false) == UpdatedTerm::continuity);
  }
}

TEST_CASE("ul: a load that is no number breaks the sum of the momentum", "[fast]") {
  for (const auto integrator : updated_integrators) {
    Plate plate(with_all_terms(problem_with(integrator)), {0.0, std::numeric_limits<double>::infinity()});
    const auto broken = plate.broken();
    CHECK(broken.term == UpdatedTerm::momentum);
    CHECK(broken.particle == 0);
  }
}

TEST_CASE("ul: a step too long for its load breaks the velocity it makes, not what is evaluated from it", "[fast]") {
  for (const auto integrator : updated_integrators) {
    Plate plate(with_all_terms(problem_with(integrator)), {1e10, 0.0});
    // Verlet drifts after half a kick: the load must break that half already.
    CHECK(plate.broken(1e300).term == (integrator == Integrator::leapfrog || integrator == Integrator::verlet
                                           ? UpdatedTerm::momentum
                                           : UpdatedTerm::drift));  // r + ½Δt² F comes before v + Δt F
  }
}

TEST_CASE("ul: a shear modulus beyond the doubles breaks the rate of the deviatoric stress", "[fast]") {
  for (const auto integrator : updated_integrators) {
    Problem<2> problem = problem_with(integrator);
    problem.material = Material::from_sound_speed(rho0, c0, huge);
    Plate plate(problem);
    for (int a = 0; a < plate.state.particles(); ++a) plate.state.velocity[a][0] = 10.0 * plate.state.position[a][1];
    const auto broken = plate.broken();
    CHECK(broken.term == UpdatedTerm::deviatoric_stress_rate);
    CHECK(broken.particle == 0);
  }
}

TEST_CASE("ul: a step too long for its velocity breaks the drift", "[fast]") {
  for (const auto integrator : updated_integrators) {
    Plate plate(with_all_terms(problem_with(integrator)));
    for (auto& v : plate.state.velocity) v[0] = 10.0;  // no pair feels it
    const auto broken = plate.broken(huge);
    CHECK(broken.term == UpdatedTerm::drift);
    CHECK(broken.particle == 0);
  }
}

TEST_CASE("ul: a density that is not positive stops a run and is one of continuity", "[fast]") {
  for (const auto integrator : updated_integrators) {
    Plate plate(problem_with(integrator));
    // ρ + Δt dρ/dt with dρ/dt about −2 H ρ inside the plate, less at its edges.
    const double H = 1.0;
    for (int a = 0; a < plate.state.particles(); ++a) plate.state.velocity[a] = H * plate.state.position[a];
    auto next = plate.state;
    CHECK(!plate.simulation.advance(next, 0.1 / H));
    for (const double density : next.density) CHECK(density > 0.0);

    next = plate.state;
    const auto lost = plate.simulation.advance(next, 2.0 / H, 5);
    REQUIRE(lost);
    CHECK(lost->step == 1);
    CHECK(lost->quantity == UpdatedQuantity::density);
    CHECK(next.density[lost->particle] <= 0.0);
    const auto broken = plate.broken(2.0 / H);
    CHECK(broken.term == UpdatedTerm::continuity);
    // A predictor may overshoot at another particle that the corrector brings back.
    const bool predicted = integrator != Integrator::leapfrog && integrator != Integrator::verlet;
    CHECK((predicted || broken.particle == lost->particle));
  }
}

TEST_CASE("ul: a step that stays within the numbers breaks no term, and is not changed by looking", "[fast]") {
  for (const auto integrator : updated_integrators) {
    Plate plate(with_all_terms(problem_with(integrator)));
    plate.state = disturbed(plate.state, 0.02, 5);
    auto next = plate.state, same = plate.state;
    CHECK(!plate.simulation.advance(next, time_step, 3));
    CHECK(!plate.simulation.broken_term(plate.state, time_step));
    CHECK(!plate.simulation.advance(same, time_step, 3));
    CHECK(flat_state(next) == flat_state(same));
  }
}

TEST_CASE("ul: isolated particles are those without another one within the support", "[fast]") {
  Plate plate(problem_with(Integrator::leapfrog));
  plate.simulation.place(plate.state.position);
  CHECK(plate.simulation.isolated_particles().empty());
  const double support = plate.problem.kernel.support();
  plate.state.position[3][1] -= 10.0 * support;
  plate.state.position[24] += Vector<2>(0.9 * support, 0.0);  // still within reach of the one below
  plate.simulation.place(plate.state.position);
  CHECK(plate.simulation.isolated_particles() == std::vector<int>{3});
  plate.state.position[24] += Vector<2>(0.2 * support, 0.0);
  plate.simulation.place(plate.state.position);
  CHECK(plate.simulation.isolated_particles() == std::vector<int>{3, 24});

  UpdatedSimulation<2> single(plate.problem, LatticeIndex<2>(1, 1));  // has its own images only
  single.place(single.base_state().position);
  CHECK(single.isolated_particles().empty());
}
