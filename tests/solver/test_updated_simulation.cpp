// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <limits>

#include "solver/updated_cases.hpp"

using namespace sphstab;
using namespace sphstab::solver;
using namespace sphstab::solver::test;

namespace {

/// Sums of at most 60 terms that cancel to no less than a tenth of their size, each with some ten roundings of 1.1e-16.
constexpr double rounding = 1e-13;
/// The same in single precision, 6e-8; separations lose a digit against positions of up to ten spacings.
constexpr double float_rounding = 1e-4;
constexpr double disturbance = 0.1;

template <int Dim>
void check_against_paper(UpdatedSimulation<Dim>& simulation, const PaperEquations<Dim>& paper,
                         const UpdatedState<Dim>& state) {
  const auto rates = rates_of(simulation, state);
  const auto expected = paper.rates(state);
  CHECK(relative_difference(rates.acceleration, expected.acceleration) < rounding);
  CHECK(relative_difference(rates.density, expected.density) < rounding);
  CHECK(relative_difference(rates.deviatoric_stress, expected.deviatoric_stress) < rounding);
  simulation.place(state.position);
  CHECK(relative_difference(simulation.smoothed(state), paper.smoothed(state)) < rounding);
}

template <int Dim>
void check_box(const Problem<Dim>& plain, const LatticeIndex<Dim>& cells) {
  for_each_choice_of_terms(plain, [&](const Problem<Dim>& problem) {
    UpdatedSimulation<Dim> simulation(problem, cells);
    const PaperEquations<Dim> paper(problem, masses(simulation), box_translations(problem, cells));
    check_against_paper(simulation, paper, disturbed(simulation.base_state(), disturbance, 3));
  });
}

/// A free body whose masses differ, so that m_a for m_b shows.
template <int Dim>
Body<Dim> uneven_block(const Problem<Dim>& problem, int side) {
  Body<Dim> body = free_plate(problem, LatticeIndex<Dim>(LatticeIndex<Dim>::Constant(side)));
  for (int a = 0; a < body.size(); ++a) body.volume[a] *= 1.0 + 0.2 * std::sin(a);
  return body;
}

template <int Dim>
void check_free_body(int side) {
  for_each_choice_of_terms(updated_problem<Dim>(), [&](const Problem<Dim>& problem) {
    UpdatedSimulation<Dim> simulation(problem, uneven_block(problem, side));
    check_against_paper(simulation, PaperEquations<Dim>(problem, masses(simulation)),
                        disturbed(simulation.base_state(), disturbance, 4));
  });
}

/// A disturbed free body with all terms.
template <int Dim>
struct DisturbedBody {
  explicit DisturbedBody(Integrator integrator = Integrator::predictor_corrector, bool deviatoric = true) {
    problem.integrator = integrator;
    simulation.emplace(problem, uneven_block(problem, 5));
    state = disturbed(simulation->base_state(), disturbance, 5);
    if (!deviatoric)
      for (auto& S : state.deviatoric_stress) S.setZero();
  }
  Problem<Dim> problem = with_all_terms(updated_problem<Dim>());
  std::optional<UpdatedSimulation<Dim>> simulation;
  UpdatedState<Dim> state;
};

template <int Dim>
Vector<Dim> total(const UpdatedSimulation<Dim>& simulation, const Field<Dim>& per_mass) {
  Vector<Dim> sum = Vector<Dim>::Zero();
  for (int a = 0; a < simulation.particles(); ++a) sum += simulation.mass(a) * per_mass[a];
  return sum;
}

/// c of Σ_b V (r_b − r_a) ⊗ g_ab = c I on a lattice of cubic symmetry: what an SPH gradient makes of a uniform one.
template <int Dim>
double gradient_factor(const Problem<Dim>& problem) {
  double c = 0.0;
  for (const auto& b : lattice_neighbours(problem.lattice, problem.kernel.support(), NeighbourRule::support))
    c -= problem.lattice.cell_volume() * b.distance * problem.kernel.slope(b.distance) / Dim;
  return c;
}

}  // namespace

TEST_CASE("ul: rates in a periodic box are the sums of the paper over all images, with every choice of terms",
          "[fast]") {
  check_box<1>(updated_problem<1>(), LatticeIndex<1>(9));
  check_box<1>(updated_problem<1>(), LatticeIndex<1>(2));
  Problem<2> problem = updated_problem<2>();
  problem.pressure = -0.1;
  problem.deviatoric_stress << 0.1, 0.05, 0.05, -0.2;
  check_box<2>(problem, {7, 6});
  check_box<2>(problem, {2, 3});
  problem.lattice = Lattice<2>(LatticeKind::hexagonal, dp).deformed((Tensor<2>() << 1.1, 0.1, 0.0, 0.95).finished());
  check_box<2>(problem, {6, 7});
  check_box<3>(updated_problem<3>(1.1), {4, 3, 2});
}

TEST_CASE("ul: rates of free particles of unequal masses are the sums of the paper", "[fast]") {
  check_free_body<1>(12);
  check_free_body<2>(6);
  check_free_body<3>(4);
}

TEST_CASE("ul: the base state has the density of its pressure, masses of a cell, and rests", "[fast]") {
  Problem<2> problem = with_all_terms(updated_problem<2>());
  problem.pressure = -0.3;
  problem.deviatoric_stress << 0.1, 0.05, 0.05, -0.2;
  UpdatedSimulation<2> simulation(problem, LatticeIndex<2>(8, 7));
  const auto& state = simulation.base_state();
  const double density = rho0 - 0.3 / (c0 * c0);
  CHECK(state.density[5] == Approx(density).epsilon(rounding));
  CHECK(simulation.mass(5) == Approx(density * dp * dp).epsilon(rounding));
  Tensor<2> sigma = problem.deviatoric_stress;
  sigma.diagonal().array() += 0.3;
  CHECK((simulation.stress(state, 5) - sigma).norm() < rounding);
  const auto rates = rates_of(simulation, state);
  CHECK(greatest_norm(rates.acceleration) < rounding * c0 * c0 / dp);
  CHECK(greatest_norm(rates.density) == 0.0);
  CHECK(greatest_norm(rates.deviatoric_stress) == 0.0);
}

TEST_CASE("ul: forces and runs keep momentum, and without deviatoric stress angular momentum", "[fast]") {
  for (const auto integrator : updated_integrators)
    for (const bool deviatoric : {true, false}) {
      DisturbedBody<2> body(integrator, deviatoric);
      auto& simulation = *body.simulation;
      Field<2> F(body.state.particles());
      simulation.place(body.state.position);
      simulation.forces(body.state, F);
      CHECK(total(simulation, F).norm() < rounding * greatest_norm(F) * body.state.particles());
      double torque = 0.0, scale = 0.0;
      for (int a = 0; a < body.state.particles(); ++a) {
        const Vector<2>& r = body.state.position[a];
        torque += simulation.mass(a) * (r[0] * F[a][1] - r[1] * F[a][0]);
        scale += simulation.mass(a) * r.norm() * F[a].norm();
      }
      // A shear stress pulls two particles across their line, and nothing in (3.1) balances its torque.
      CHECK((std::abs(torque) < rounding * scale) == !deviatoric);

      const Vector<2> momentum = simulation.momentum(body.state);
      REQUIRE(!simulation.advance(body.state, 0.01, 100));
      CHECK((simulation.momentum(body.state) - momentum).norm() < rounding * momentum.norm());
    }
}

TEST_CASE("ul: leapfrog and Verlet keep angular momentum step by step, with XSPH too", "[fast]") {
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet}) {
    DisturbedBody<2> body(integrator, false);
    // Shear would build up deviatoric stress.
    body.problem.material = Material::from_sound_speed(rho0, c0, 0.0);
    UpdatedSimulation<2> fluid(body.problem, uneven_block(body.problem, 5));
    const double before = fluid.angular_momentum(body.state)(0, 1);
    REQUIRE(!fluid.advance(body.state, 0.01, 100));
    CHECK(fluid.angular_momentum(body.state)(0, 1) == Approx(before).epsilon(rounding).margin(rounding));
  }
}

TEST_CASE("ul: rates do not know a uniform velocity or a translation", "[fast]") {
  DisturbedBody<2> body;
  const auto rates = rates_of(*body.simulation, body.state);
  for (auto& r : body.state.position) r += Vector<2>(3.0, -2.0);
  for (auto& v : body.state.velocity) v += Vector<2>(0.5, 0.25);
  const auto moved = rates_of(*body.simulation, body.state);
  CHECK(relative_difference(moved.acceleration, rates.acceleration) < 10.0 * rounding);
  CHECK(relative_difference(moved.density, rates.density) < 10.0 * rounding);
  CHECK(relative_difference(moved.deviatoric_stress, rates.deviatoric_stress) < 10.0 * rounding);
}

TEST_CASE("ul: rates of a turned state are turned rates", "[fast]") {
  DisturbedBody<3> body;
  const auto rates = rates_of(*body.simulation, body.state);
  const Tensor<3> Q = Eigen::AngleAxisd(0.7, Vector<3>(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  auto turned = body.state;
  auto expected = rates;
  for (int a = 0; a < turned.particles(); ++a) {
    turned.position[a] = Q * turned.position[a];
    turned.velocity[a] = Q * turned.velocity[a];
    turned.deviatoric_stress[a] = (Q * turned.deviatoric_stress[a] * Q.transpose()).eval();
    expected.acceleration[a] = Q * expected.acceleration[a];
    expected.deviatoric_stress[a] = (Q * expected.deviatoric_stress[a] * Q.transpose()).eval();
  }
  const auto found = rates_of(*body.simulation, turned);
  CHECK(relative_difference(found.acceleration, expected.acceleration) < rounding);
  CHECK(relative_difference(found.density, expected.density) < rounding);
  CHECK(relative_difference(found.deviatoric_stress, expected.deviatoric_stress) < rounding);
}

TEST_CASE("ul: inside a lattice a uniform velocity gradient gives its density and stress rates", "[fast]") {
  // Shear, spin and expansion at once; XSPH leaves a linear field as it is, away from the edges.
  const Tensor<2> L = (Tensor<2>() << 0.3, 0.2, -0.1, 0.15).finished();
  Problem<2> problem = updated_problem<2>();
  problem.scheme.xsph = Xsph{0.5};
  problem.deviatoric_stress << 0.2, 0.1, 0.1, -0.3;
  const double c = gradient_factor(problem);
  CHECK(c == Approx(1.0).margin(0.05));  // a quadrature of 1
  for (const auto rate : {DensityRate::masses, DensityRate::volumes}) {
    problem.scheme.density_rate = rate;
    UpdatedSimulation<2> simulation(problem, free_plate(problem, LatticeIndex<2>(13, 13)));
    auto state = simulation.base_state();
    for (int a = 0; a < state.particles(); ++a) state.velocity[a] = L * state.position[a];
    const auto rates = rates_of(simulation, state);
    const int centre = state.particles() / 2;
    const Tensor<2> strain_rate = 0.5 * (L + L.transpose()), spin = 0.5 * (L - L.transpose());
    const Tensor<2>& S = problem.deviatoric_stress;
    const Tensor<2> expected =
        c * (2.0 * mu * (strain_rate - L.trace() / 3.0 * Tensor<2>::Identity()) + spin * S - S * spin);
    CHECK(rates.density[centre] == Approx(-c * rho0 * L.trace()).epsilon(rounding));
    CHECK((rates.deviatoric_stress[centre] - expected).norm() < rounding * expected.norm());
  }
}

TEST_CASE("ul: a bar of uniform expansion follows the exact density", "[fast]") {
  // In 1-D ∂v/∂x = c H at every inner particle; over a short time ρ = ρ0 (1 − c H t) and Sxx = 4/3 μ c H t to O(t²).
  Problem<1> problem = updated_problem<1>();
  UpdatedSimulation<1> simulation(problem, free_plate(problem, LatticeIndex<1>(15)));
  auto state = simulation.base_state();
  const double H = 1e-3, time = 1e-3, c = gradient_factor(problem);
  for (int a = 0; a < state.particles(); ++a) state.velocity[a] = H * state.position[a];
  simulation.advance(state, time);
  const double second_order = 10.0 * H * time * (H + c0 * c0 / (dp * dp) * time) * time;
  CHECK(std::abs(state.density[7] - rho0 * (1.0 - c * H * time)) < rho0 * second_order);
  CHECK(std::abs(state.deviatoric_stress[7](0, 0) - 4.0 / 3.0 * mu * c * H * time) < mu * second_order);
}

TEST_CASE("ul: energy and momenta are those of the masses", "[fast]") {
  Problem<2> problem = updated_problem<2>();
  UpdatedSimulation<2> simulation(problem, free_plate(problem, LatticeIndex<2>(2, 2)));
  auto state = simulation.base_state();  // at the corners of a square of Δp, at rest but for two
  state.velocity[1] = {3.0, 4.0};        // at (Δp, 0)
  state.velocity[2] = {1.0, 0.0};        // at (0, Δp)
  const double m = rho0 * dp * dp;
  CHECK(simulation.kinetic_energy(state) == Approx(0.5 * m * 26.0).epsilon(rounding));
  CHECK((simulation.momentum(state) - m * Vector<2>(4.0, 4.0)).norm() < rounding);
  CHECK(simulation.angular_momentum(state)(0, 1) == Approx(m * dp * 3.0).epsilon(rounding));
  CHECK(simulation.angular_momentum(state)(1, 0) == -simulation.angular_momentum(state)(0, 1));
}

TEST_CASE("ul: elastic energy and von Mises stress count the stress out of the plane", "[fast]") {
  Problem<2> problem = updated_problem<2>();
  UpdatedSimulation<2> simulation(problem, free_plate(problem, LatticeIndex<2>(3, 2)));
  auto state = simulation.base_state();
  const double x = 0.02, a = 0.03, b = -0.01, c = 0.05, z = -a - c;
  for (auto& density : state.density) density = rho0 * (1.0 + x);
  for (auto& S : state.deviatoric_stress) S << a, b, b, c;
  const double P = c0 * c0 * rho0 * x, K = rho0 * c0 * c0, volume = 6.0 * dp * dp / (1.0 + x);
  const double square = a * a + c * c + z * z + 2.0 * b * b;
  CHECK(simulation.elastic_energy(state) ==
        Approx(volume * (P * P / (2.0 * K) + square / (4.0 * mu))).epsilon(rounding));
  const double von_mises = std::sqrt(0.5 * ((a - c) * (a - c) + (c - z) * (c - z) + (z - a) * (z - a)) + 3.0 * b * b);
  CHECK(simulation.von_mises_stress(state, 4) == Approx(von_mises).epsilon(rounding));

  problem.material = Material::from_sound_speed(rho0, c0, 0.0);
  UpdatedSimulation<2> fluid(problem, free_plate(problem, LatticeIndex<2>(3, 2)));
  CHECK(fluid.elastic_energy(state) == Approx(volume * P * P / (2.0 * K)).epsilon(rounding));

  const Problem<1> bar_problem = updated_problem<1>();
  UpdatedSimulation<1> bar(bar_problem, free_plate(bar_problem, LatticeIndex<1>(4)));
  auto bar_state = bar.base_state();
  for (auto& S : bar_state.deviatoric_stress) S(0, 0) = a;  // and −a/2 across, twice
  CHECK(bar.elastic_energy(bar_state) == Approx(4.0 * dp * 1.5 * a * a / (4.0 * mu)).epsilon(rounding));
  CHECK(bar.von_mises_stress(bar_state, 0) == Approx(1.5 * a).epsilon(rounding));
}

TEST_CASE("ul: held particles stay, are not smoothed, and their density and stress go on", "[fast]") {
  for (const auto integrator : updated_integrators) {
    Problem<2> problem = with_all_terms(updated_problem<2>());
    problem.integrator = integrator;
    Body<2> body = free_plate(problem, LatticeIndex<2>(6, 5));
    body.clamped.assign(body.size(), Directions<2>(false, false));
    body.clamped[7] = {true, true};
    body.clamped[9] = {true, false};
    UpdatedSimulation<2> simulation(problem, body);
    const auto initial = disturbed(simulation.base_state(), disturbance, 6);
    auto state = initial;
    REQUIRE(!simulation.advance(state, 0.02, 20));
    CHECK(state.position[7] == initial.position[7]);
    CHECK(state.velocity[7] == Vector<2>::Zero());
    CHECK(state.position[9][0] == initial.position[9][0]);
    CHECK(state.position[9][1] != initial.position[9][1]);
    CHECK(state.density[7] != initial.density[7]);
    CHECK(state.deviatoric_stress[7] != initial.deviatoric_stress[7]);
    CHECK(simulation.smoothed(state)[7] == Vector<2>::Zero());
  }
}

TEST_CASE("ul: loads accelerate as given", "[fast]") {
  Problem<2> problem = updated_problem<2>();
  Body<2> body = free_plate(problem, LatticeIndex<2>(4, 4));
  UpdatedSimulation<2> free(problem, body);
  const auto state = disturbed(free.base_state(), disturbance, 6);
  auto expected = rates_of(free, state).acceleration;
  for (auto& a : expected) a += Vector<2>(0.5, -9.81);
  body.load.assign(body.size(), Vector<2>(0.5, -9.81));
  UpdatedSimulation<2> loaded(problem, body);
  CHECK(relative_difference(rates_of(loaded, state).acceleration, expected) < rounding);
}

TEST_CASE("ul: a run that leaves the numbers says at which step, particle and quantity", "[fast]") {
  DisturbedBody<2> body;
  auto state = body.state;
  state.density[3] = std::numeric_limits<double>::infinity();
  auto lost = body.simulation->advance(state, 0.01, 5);
  REQUIRE(lost);
  CHECK(lost->step == 0);
  CHECK(lost->particle == 3);
  CHECK(lost->quantity == UpdatedQuantity::density);

  // Two particles in one place have no direction to push each other.
  state = body.state;
  state.position[9] = state.position[4];
  lost = body.simulation->advance(state, 0.01, 5);
  REQUIRE(lost);
  CHECK(lost->step == 1);
  CHECK(lost->particle == 4);
  CHECK(lost->quantity == UpdatedQuantity::position);

  // The first step leads to velocities just within the doubles, the second past them; the third is not made.
  body.problem.integrator = Integrator::leapfrog;
  Body<2> heavy = free_plate(body.problem, LatticeIndex<2>(4, 4));
  heavy.load.assign(heavy.size(), Vector<2>(0.0, 0.75 * std::numeric_limits<double>::max()));
  UpdatedSimulation<2> simulation(body.problem, heavy);
  state = simulation.base_state();
  lost = simulation.advance(state, 1.0, 3);
  REQUIRE(lost);
  CHECK(lost->step == 2);
  CHECK(simulation.work().rates == 2);
}

TEST_CASE("ul: terms that the scheme does not name are not evaluated", "[fast]") {
  Problem<2> problem = updated_problem<2>();
  problem.integrator = Integrator::leapfrog;
  UpdatedSimulation<2> plain(problem, LatticeIndex<2>(7, 7));
  auto state = disturbed(plain.base_state(), 0.01, 7);
  plain.advance(state, 0.01, 10);
  CHECK(plain.work().forces == 10);
  CHECK(plain.work().rates == 10);
  CHECK(plain.work().placements == 10);
  CHECK(plain.work().list_builds == 1);
  CHECK(plain.work().artificial_stresses == 0);
  CHECK(plain.work().smoothings == 0);
  UpdatedSimulation<2> all(with_all_terms(problem), LatticeIndex<2>(7, 7));
  all.advance(state, 0.01, 10);
  CHECK(all.work().artificial_stresses == 10);
  CHECK(all.work().smoothings == 10);
}

TEST_CASE("ul: other schemes, neighbours, plane stress and incompressible materials are refused", "[fast]") {
  Problem<2> problem = updated_problem<2>();
  problem.scheme.formulation = Formulation::total_lagrangian_linear;
  CHECK_THROWS_WITH(UpdatedSimulation<2>(problem, LatticeIndex<2>(7, 7)), "scheme: this run is for ul, not tl-linear");
  problem = updated_problem<2>();
  problem.neighbour_rule = NeighbourRule::nearest;
  CHECK_THROWS_WITH(UpdatedSimulation<2>(problem, LatticeIndex<2>(7, 7)),
                    "neighbours: a run of ul needs support, not nearest");
  problem = updated_problem<2>();
  problem.plane = Plane::stress;
  CHECK_THROWS_WITH(UpdatedSimulation<2>(problem, LatticeIndex<2>(7, 7)),
                    "plane: a run of ul needs strain, not stress");
  problem = updated_problem<2>();
  problem.material = Material::from_young_modulus(rho0, 1.0, 0.5);
  CHECK_THROWS_WITH(UpdatedSimulation<2>(problem, LatticeIndex<2>(7, 7)),
                    "poisson_ratio: 0.5 is not below 0.5 (scheme ul)");
}

TEST_CASE("ul: single precision tracks double precision", "[fast]") {
  const Problem<2> problem = with_all_terms(updated_problem<2>());
  UpdatedSimulation<2> simulation(problem, LatticeIndex<2>(8, 8));
  UpdatedSimulation<2, float> single(problem, LatticeIndex<2>(8, 8));
  auto state = disturbed(simulation.base_state(), disturbance, 8);
  auto single_state = single.base_state();
  set_flat_state<2, float>(flat_state(state).cast<float>(), single_state);
  REQUIRE(!simulation.advance(state, 0.02, 20));
  REQUIRE(!single.advance(single_state, 0.02, 20));
  const Eigen::VectorXd difference = flat_state(single_state).cast<double>() - flat_state(state);
  CHECK(difference.lpNorm<Eigen::Infinity>() < float_rounding * rho0 * c0 * c0);
}
