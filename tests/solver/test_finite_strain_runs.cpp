// SPDX-License-Identifier: MIT
// Runs of finite strain: what they keep, at which order, and their derivatives.
#include <catch2/catch.hpp>

#include "solver/allocations.hpp"
#include "solver/bloch.hpp"
#include "solver/finite_strain_cases.hpp"
#include "solver/step_jacobian.hpp"

using namespace sphstab;
using namespace sphstab::solver;
using namespace sphstab::solver::test;

namespace {

/// Two nested sums of at most 60 neighbours each, multiplied by N of edges, of at most 10 times the bulk's: 4 · 60 · 10
/// · 2.2e-16.
constexpr double rounding = 6e-13;
/// Central differences with step 1e-5 of a map with third derivatives of order 100: 100 · 1e-10 / 6, and 2e-16 / 1e-5.
constexpr double difference_step = 1e-5, difference_tolerance = 2e-9;
/// An observed order differs from the integer by the next term of the error, (ω_max Δt)² of at most 0.1 of the leading
/// one.
constexpr double order_margin = 0.1;
/// Below the limit of free edges, 0.58 · 1.9 spacings over the wave speed 1.35 (theory of both schemes at rest).
constexpr double time_step = 0.3;

/// A free jittered body of one material that turns, pulses and shakes: velocities are those of a spin and of noise.
template <int Dim>
struct FreeBody {
  explicit FreeBody(const Scheme& scheme, Integrator integrator) : problem(finite_strain_problem<Dim>(scheme)) {
    problem.integrator = integrator;
    body = disordered_block(problem, Dim == 2 ? 6 : 3);
    body.materials = {problem.material};
    body.material.assign(body.size(), 0);
    state = random_state_of(body, 0.03, 2);
    for (int a = 0; a < body.size(); ++a) {
      const Vector<Dim>& x = body.position[a];
      state.velocity[a] += 0.1 * (turn<Dim>(1.0) - turn<Dim>(-1.0)) * x + Vector<Dim>::Constant(0.2);
    }
  }

  Vector<Dim> momentum() const {
    Vector<Dim> sum = Vector<Dim>::Zero();
    for (int a = 0; a < body.size(); ++a) sum += body.mass(a) * state.velocity[a];
    return sum;
  }

  /// Σ m (x ⊗ v − v ⊗ x).
  Tensor<Dim> angular_momentum() const {
    Tensor<Dim> sum = Tensor<Dim>::Zero();
    for (int a = 0; a < body.size(); ++a) {
      const Tensor<Dim> xv = (body.position[a] + state.displacement[a]) * state.velocity[a].transpose();
      sum += body.mass(a) * (xv - xv.transpose());
    }
    return sum;
  }

  Problem<Dim> problem;
  Body<Dim> body;
  State<Dim> state{0};
};

template <int Dim>
void check_momentum() {
  for (const auto& scheme : finite_strain_schemes)
    for (const auto integrator : {Integrator::leapfrog, Integrator::verlet}) {
      INFO(Dim << " dimensions, " << describe(scheme) << ", " << name_of(integrator));
      FreeBody<Dim> run(scheme, integrator);
      FiniteStrainSimulation<Dim> simulation(run.problem, run.body);
      const auto momentum = run.momentum();
      const auto angular_momentum = run.angular_momentum();
      const auto start = run.state;
      simulation.advance(run.state, 0.2 * time_step, 500);
      CHECK((run.momentum() - momentum).norm() < rounding * momentum.norm());
      CHECK((run.angular_momentum() - angular_momentum).norm() < rounding * angular_momentum.norm());
      CHECK(simulation.deformation_gradient(run.state, 0).allFinite());
      CHECK((run.state.velocity[0] - start.velocity[0]).norm() > 0.1 * start.velocity[0].norm());
      CHECK(simulation.right_hand_sides() == (integrator == Integrator::leapfrog ? 500 : 501));
    }
}

/// The largest |E − E(0)| / E(0) up to a fixed time. Velocities of leapfrog belong half a step before their places.
double energy_error(const Scheme& scheme, Integrator integrator, int steps) {
  FreeBody<2> run(scheme, integrator);
  FiniteStrainSimulation<2> simulation(run.problem, run.body);
  const double dt = 10.0 / steps;
  const auto energy = [&] {
    State<2> centred = run.state;
    if (integrator == Integrator::leapfrog) {
      const auto force = accelerations_of<2>(simulation, run.state);
      for (int a = 0; a < run.body.size(); ++a) centred.velocity[a] += 0.5 * dt * force[a];
    }
    return simulation.kinetic_energy(centred) + simulation.strain_energy(centred);
  };
  const double initial = energy();
  double error = 0.0;
  for (int n = 0; n < steps; ++n) {
    simulation.advance(run.state, dt);
    error = std::max(error, std::abs(energy() / initial - 1.0));
  }
  return error;
}

double& component(State<2>& state, int index) {
  return index % 4 < 2 ? state.velocity[index / 4][index % 4] : state.displacement[index / 4][index % 4 - 2];
}

/// The step Jacobian by differences of real steps.
Eigen::MatrixXd differences(FiniteStrainSimulation<2>& simulation, double dt) {
  const int size = 4 * simulation.particles();
  Eigen::MatrixXd jacobian(size, size);
  for (int column = 0; column < size; ++column) {
    State<2> above(simulation.particles()), below = above;
    component(above, column) = difference_step;
    component(below, column) = -difference_step;
    simulation.advance(above, dt);
    simulation.advance(below, dt);
    for (int row = 0; row < size; ++row)
      jacobian(row, column) = (component(above, row) - component(below, row)) / (2.0 * difference_step);
  }
  return jacobian;
}

/// [[I, Δt A], [Δt I, I + Δt² A]] of leapfrog for [v̂, ŝ].
template <int Dim>
BlochStepMatrix<Dim> leapfrog_step(const Tensor<Dim, std::complex<double>>& A, double dt) {
  BlochStepMatrix<Dim> matrix = BlochStepMatrix<Dim>::Identity();
  matrix.template topRightCorner<Dim, Dim>() = dt * A;
  matrix.template bottomLeftCorner<Dim, Dim>().diagonal().setConstant(dt);
  matrix.template bottomRightCorner<Dim, Dim>() += dt * dt * A;
  return matrix;
}

/// −(1/ρ0) [G |D|² I + (λ + G) D Dᵀ] of isotropic elasticity for D = N Σ_b V sin(k·r_ab) ∂W/∂r_ab, plain sums over a
/// lattice.
template <int Dim>
Tensor<Dim> elastic_acceleration_matrix(const Problem<Dim>& problem, const Vector<Dim>& k) {
  Tensor<Dim> sum = Tensor<Dim>::Zero();
  Vector<Dim> D = Vector<Dim>::Zero();
  for (const auto& b : lattice_neighbours(problem.lattice, problem.kernel.support(), NeighbourRule::support)) {
    const Vector<Dim>& r = b.position;
    const Vector<Dim> gradient = problem.lattice.cell_volume() * problem.kernel.slope(r.norm()) / r.norm() * r;
    sum -= r * gradient.transpose();
    D += std::sin(k.dot(r)) * gradient;
  }
  D = sum.inverse() * D;
  const double G = problem.material.shear_modulus(), lambda = problem.material.bulk_modulus() - 2.0 / 3.0 * G;
  return -(G * D.squaredNorm() * Tensor<Dim>::Identity() + (lambda + G) * D * D.transpose()) / density;
}

template <int Dim>
void check_bloch_matrices() {
  for (const auto& scheme : finite_strain_schemes) {
    Problem<Dim> problem = finite_strain_problem<Dim>(scheme);
    const LatticeIndex<Dim> cells = LatticeIndex<Dim>::Constant(Dim == 3 ? 4 : 5);
    const auto patch = periodic_patch(problem, cells);
    Vector<Dim> k = problem.lattice.reciprocal_vectors().col(0) / cells[0];
    if constexpr (Dim > 1) k += problem.lattice.reciprocal_vectors().col(1) * 2.0 / cells[1];
    INFO(Dim << " dimensions, " << describe(scheme));
    CHECK((bloch_acceleration_matrix(problem, patch, k) - elastic_acceleration_matrix(problem, k)).norm() < rounding);
    const Tensor<Dim> Q = turn<Dim>(1.2);
    problem.deformation_gradient = stretch<Dim>();
    const auto stretched = bloch_acceleration_matrix(problem, patch, k);
    CHECK((bloch_step_matrix(problem, patch, k, time_step) - leapfrog_step<Dim>(stretched, time_step)).norm() <
          rounding);
    problem.deformation_gradient = Q * stretch<Dim>();
    CHECK((bloch_acceleration_matrix(problem, patch, k) - Q * stretched * Q.transpose()).norm() < rounding);
  }
}

}  // namespace

TEST_CASE("finite strain: a free body keeps momentum and angular momentum over many steps of large motion", "[fast]") {
  check_momentum<2>();
  check_momentum<3>();
}

TEST_CASE("the energy error of tl-pk1 is of second order, with Verlet and with centred velocities of leapfrog",
          "[fast]") {
  for (const auto& scheme : {pk1, neo_hookean})
    for (const auto integrator : {Integrator::verlet, Integrator::leapfrog}) {
      INFO(describe(scheme) << ", " << name_of(integrator));
      const double coarse = energy_error(scheme, integrator, 400), fine = energy_error(scheme, integrator, 800);
      CHECK(std::abs(std::log2(coarse / fine) - 2.0) < order_margin);
      CHECK(coarse < 0.01);
    }
}

TEST_CASE("finite strain: the step Jacobian is the limit of differences of real steps", "[fast]") {
  for (auto scheme : finite_strain_schemes)
    for (const auto integrator : {Integrator::leapfrog, Integrator::verlet}) {
      scheme.damping = some_damping;
      Problem<2> problem = finite_strain_problem<2>(scheme);
      problem.integrator = integrator;
      problem.deformation_gradient = large_deformation<2>();
      INFO(describe(scheme) << ", " << name_of(integrator));
      const auto body = clamped_and_loaded(disordered_block(problem, 3));
      FiniteStrainSimulation<2> simulation(problem, body);
      const double error = (step_jacobian(problem, body, 0.1) - differences(simulation, 0.1)).cwiseAbs().maxCoeff();
      CHECK(error < difference_tolerance);
    }
}

TEST_CASE("finite strain: Bloch matrices are those of elasticity at rest, turn with the base state, and make a step",
          "[fast]") {
  check_bloch_matrices<1>();
  check_bloch_matrices<2>();
  check_bloch_matrices<3>();
}

TEST_CASE("finite strain: many steps are single ones, bit by bit, and allocate nothing", "[fast]") {
  for (const auto& scheme : finite_strain_schemes)
    for (const auto integrator : {Integrator::leapfrog, Integrator::verlet}) {
      FreeBody<3> run(scheme, integrator);
      FiniteStrainSimulation<3> simulation(run.problem, run.body);
      State<3> single = run.state;
      const long allocated = allocations();
      simulation.advance(run.state, 0.1, 20);
      const long allocated_by_steps = allocations() - allocated;
      CHECK(allocated_by_steps == 0);
      for (int n = 0; n < 20; ++n) simulation.advance(single, 0.1);
      CHECK(single.displacement == run.state.displacement);
      CHECK(single.velocity == run.state.velocity);
    }
}

TEST_CASE("finite strain: clamped directions stay at 0 exactly, and a free body falls with gravity", "[fast]") {
  for (const auto& scheme : finite_strain_schemes) {
    const auto problem = finite_strain_problem<2>(scheme);
    Body<2> body = clamped_and_loaded(disordered_block(problem, 5));
    State<2> held = random_state(body.size(), 0.03, 4);
    FiniteStrainSimulation<2>(problem, body).advance(held, 0.05, 100);
    CHECK(held.displacement[0] == Vector<2>::Zero());
    CHECK(held.velocity[0] == Vector<2>::Zero());
    CHECK(held.displacement[3][1] == 0.0);
    CHECK(held.displacement[3][0] != 0.0);

    body.clamped.clear();
    const Vector<2> gravity(0.0, -9.81);
    body.load.assign(body.size(), gravity);
    State<2> falling(body.size());
    FiniteStrainSimulation<2>(problem, body).advance(falling, 0.05, 10);
    for (const auto& v : falling.velocity) CHECK((v - 0.5 * gravity).norm() < rounding * gravity.norm());
  }
}

TEST_CASE("turned inside out, a neo-Hookean body has no accelerations and the others run on", "[fast]") {
  const Tensor<2> inside_out = Vector<2>(1.0, -0.1).asDiagonal();
  for (const auto& scheme : finite_strain_schemes) {
    INFO(describe(scheme));
    const auto problem = finite_strain_problem<2>(scheme);
    const auto body = disordered_block(problem, 5);
    State<2> state = carried<2>(problem, body, State<2>(body.size()), inside_out);
    FiniteStrainSimulation<2> simulation(problem, body);
    CHECK(simulation.deformation_gradient(state, 0).determinant() < 0.0);
    simulation.advance(state, 0.05, 100);
    for (const auto& s : state.displacement)
      CHECK(s.allFinite() == (scheme.elastic_law == ElasticLaw::saint_venant_kirchhoff));
  }
}
