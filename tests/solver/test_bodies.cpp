// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>

#include "solver/bodies.hpp"
#include "solver/step_jacobian.hpp"

using namespace sphstab;
using namespace sphstab::solver;
using namespace sphstab::solver::test;

namespace {

/// Two nested sums of at most 60 neighbours each, on both sides of a comparison: 4 · 60 · 2.2e-16. Accelerations are
/// compared after multiplication by the density, so that a density ratio of 1000 hides nothing.
constexpr double rounding = 6e-14;
/// Ends of a run of 400 steps and its sums: 400 · 2.2e-16.
constexpr double run_rounding = 1e-13;
/// Observed orders differ from the integer by the next term of the error, (ω_max Δt)² of at most 0.1 of the leading
/// one.
constexpr double order_margin = 0.1;

/// N_i = Σ_j V_j W_ij over all particles, itself included.
template <int Dim>
double kernel_sum(const Problem<Dim>& problem, const Body<Dim>& body, int i) {
  if (problem.scheme.kernel_normalisation == KernelNormalisation::none) return 1.0;
  double sum = 0.0;
  for (int j = 0; j < body.size(); ++j)
    sum += body.volume[j] * problem.kernel.value((body.position[i] - body.position[j]).norm());
  return sum;
}

/// Accelerations from sums over all particles: Zhang's Eqs. 6, 8 and 9, and Eq. 7 for several materials,
/// ρ_i dv_i/dt = Σ_j V_j (σ_i + σ_j) · ∇W_ij, with load, damping and clamps. Young's modulus, Poisson's ratio and the
/// plane enter through Hooke's law in space.
template <int Dim>
Field<Dim> naive_accelerations(const Problem<Dim>& problem, const Body<Dim>& body, const State<Dim>& state) {
  const int n = body.size();
  const auto gradient = [&](int i, int j) -> Vector<Dim> {
    const Vector<Dim> r = body.position[i] - body.position[j];
    if (i == j || r.norm() >= problem.kernel.support()) return Vector<Dim>::Zero();
    return problem.kernel.slope(r.norm()) * r / r.norm();
  };
  Field<Dim> u(n), result(n);
  for (int i = 0; i < n; ++i) u[i] = problem.displacement_gradient * body.position[i] + state.displacement[i];
  std::vector<Tensor<Dim>> sigma(n);
  for (int i = 0; i < n; ++i) {
    Tensor<Dim> epsilon = Tensor<Dim>::Zero();
    for (int j = 0; j < n; ++j)
      for (int alpha = 0; alpha < Dim; ++alpha)
        for (int beta = 0; beta < Dim; ++beta)
          epsilon(alpha, beta) +=
              0.5 * body.volume[j] *
              ((u[j] - u[i])[beta] * gradient(i, j)[alpha] + (u[j] - u[i])[alpha] * gradient(i, j)[beta]);
    epsilon /= kernel_sum(problem, body, i);
    const Material& made_of = materials[body.material[i]];
    const double mu = made_of.poisson_ratio(), E = made_of.young_modulus(), G = E / (2.0 + 2.0 * mu);
    const double out_of_plane = problem.plane == Plane::stress ? -mu / (1.0 - mu) * epsilon.trace() : 0.0;
    const double dilation = epsilon.trace() + out_of_plane;
    sigma[i] = 2.0 * G * epsilon + E * mu / ((1.0 + mu) * (1.0 - 2.0 * mu)) * dilation * Tensor<Dim>::Identity();
    if (problem.scheme.momentum_density == MomentumDensity::equation_of_state) sigma[i] *= std::exp(2.0 * dilation);
  }
  for (int i = 0; i < n; ++i) {
    Vector<Dim> force = Vector<Dim>::Zero();
    for (int j = 0; j < n; ++j) force += body.volume[j] * (sigma[i] + sigma[j]) * gradient(i, j);
    result[i] = force / (materials[body.material[i]].density() * kernel_sum(problem, body, i));
    if (!body.load.empty()) result[i] += body.load[i];
    if (problem.scheme.damping) result[i] -= problem.scheme.damping->rate * state.velocity[i];
    if (!body.clamped.empty())
      for (int axis = 0; axis < Dim; ++axis)
        if (body.clamped[i][axis]) result[i][axis] = 0.0;
  }
  return result;
}

template <int Dim>
Field<Dim> accelerations_of(const Problem<Dim>& problem, const Body<Dim>& body, const State<Dim>& state) {
  Simulation<Dim> simulation(problem, body);
  Field<Dim> acceleration(body.size());
  simulation.accelerations(state, acceleration);
  return acceleration;
}

/// Σ_a ρ_a V_a N_a left_a · right_a.
template <int Dim>
double inertial_product(const Problem<Dim>& problem, const Body<Dim>& body, const Field<Dim>& left,
                        const Field<Dim>& right) {
  double sum = 0.0;
  for (int a = 0; a < body.size(); ++a) sum += body.mass(a) * kernel_sum(problem, body, a) * left[a].dot(right[a]);
  return sum;
}

template <int Dim>
void check_against_naive_sums(LatticeKind lattice, int side) {
  for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum})
    for (const auto momentum_density : {MomentumDensity::frozen, MomentumDensity::equation_of_state})
      for (const auto plane : {Plane::strain, Plane::stress})
        for (const bool moved : {false, true}) {
          if (plane == Plane::stress && Dim != 2) continue;
          Problem<Dim> problem = problem_in<Dim>(lattice);
          problem.plane = plane;
          problem.scheme.kernel_normalisation = normalisation;
          problem.scheme.momentum_density = momentum_density;
          if (moved) problem.scheme.damping = some_damping;
          if (moved) problem.displacement_gradient = 0.03 * Tensor<Dim>::Constant(1.0) - 0.05 * Tensor<Dim>::Identity();
          const auto free = disordered_block(problem, side);
          for (const auto& body : {free, clamped_and_loaded(free)}) {
            INFO(Dim << " dimensions, " << name_of(normalisation) << ", " << name_of(momentum_density) << ", "
                     << name_of(plane) << ", moved " << moved << ", clamped " << !body.clamped.empty());
            const auto state = random_state_of(body, 0.05, 7);
            const auto expected = naive_accelerations(problem, body, state);
            const auto computed = accelerations_of(problem, body, state);
            CHECK(largest_force<Dim>(body, difference<Dim>(computed, expected)) <
                  rounding * largest_force<Dim>(body, expected));
          }
        }
}

/// The largest change of K + U − Σ m load · s on the way, over the largest K.
double energy_error(KernelNormalisation normalisation, int steps) {
  Problem<2> problem = problem_in<2>(LatticeKind::square);
  problem.integrator = Integrator::verlet;
  problem.scheme.kernel_normalisation = normalisation;
  const auto body = clamped_and_loaded(disordered_block(problem, 5));
  Simulation<2> simulation(problem, body);
  State<2> state = random_state_of(body, 0.01, 2);
  const auto total = [&] {
    return simulation.kinetic_energy(state) + simulation.strain_energy(state) -
           inertial_product(problem, body, body.load, state.displacement);
  };
  const double initial = total();
  double error = 0.0, kinetic = 0.0;
  for (int n = 0; n < steps; ++n) {
    simulation.advance(state, 20.0 / steps);
    error = std::max(error, std::abs(total() - initial));
    kinetic = std::max(kinetic, simulation.kinetic_energy(state));
  }
  return error / kinetic;
}

}  // namespace

TEST_CASE("accelerations of disordered bodies of two materials, clamped and loaded, are sums over all particles",
          "[fast]") {
  check_against_naive_sums<1>(LatticeKind::chain, 9);
  check_against_naive_sums<2>(LatticeKind::square, 5);
  check_against_naive_sums<3>(LatticeKind::cubic, 3);
}

TEST_CASE("a body of two equal materials moves like one of one material, bit by bit", "[fast]") {
  const auto problem = problem_in<2>(LatticeKind::square);
  Body<2> alike = disordered_block(problem, 4);
  alike.materials = {materials[0], materials[0]};
  Body<2> single = alike;
  single.materials = {materials[0]};
  single.material.assign(single.size(), 0);
  State<2> state = random_state_of(alike, 0.05, 7), expected = state;
  Simulation<2>(problem, alike).advance(state, 0.1, 10);
  Simulation<2>(problem, single).advance(expected, 0.1, 10);
  CHECK(state.displacement == expected.displacement);
  CHECK(state.velocity == expected.velocity);
}

TEST_CASE("forces between materials are symmetric under the inertia: two displacements do the same work on each other",
          "[fast]") {
  for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum}) {
    Problem<2> problem = problem_in<2>(LatticeKind::square);
    problem.scheme.kernel_normalisation = normalisation;
    Body<2> body = clamped_and_loaded(disordered_block(problem, 5));
    body.load.clear();
    const auto one = random_state_of(body, 0.1, 11), other = random_state_of(body, 0.1, 12);
    const double there = inertial_product(problem, body, accelerations_of(problem, body, one), other.displacement);
    const double back = inertial_product(problem, body, accelerations_of(problem, body, other), one.displacement);
    CHECK(there == Approx(back).epsilon(rounding));
  }
}

TEST_CASE("the energies of a body of two materials are those of its masses and forces", "[fast]") {
  for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum}) {
    Problem<2> problem = problem_in<2>(LatticeKind::square);
    problem.scheme.kernel_normalisation = normalisation;
    const auto body = disordered_block(problem, 5);
    const auto state = random_state_of(body, 0.1, 11);
    const Simulation<2> simulation(problem, body);
    for (int a = 0; a < body.size(); ++a)
      CHECK(simulation.inertia(a) == Approx(body.mass(a) * kernel_sum(problem, body, a)).epsilon(rounding));
    const double work =
        -0.5 * inertial_product(problem, body, accelerations_of(problem, body, state), state.displacement);
    CHECK(simulation.strain_energy(state) == Approx(work).epsilon(rounding));
    const double motion = 0.5 * inertial_product(problem, body, state.velocity, state.velocity);
    CHECK(simulation.kinetic_energy(state) == Approx(motion).epsilon(rounding));
  }
}

TEST_CASE("Verlet keeps kinetic and strain energy less the work of the loads to second order", "[fast]") {
  for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum}) {
    const double coarse = energy_error(normalisation, 400), fine = energy_error(normalisation, 800);
    CHECK(std::abs(std::log2(coarse / fine) - 2.0) < order_margin);
    CHECK(coarse < 0.1);
  }
}

TEST_CASE("a free body of two materials moves with the sum of its loads", "[fast]") {
  for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum}) {
    Problem<2> problem = problem_in<2>(LatticeKind::square);
    problem.scheme.kernel_normalisation = normalisation;
    Body<2> body = clamped_and_loaded(disordered_block(problem, 5));
    body.clamped.clear();
    State<2> state(body.size());
    const double time_step = 0.02;
    Simulation<2>(problem, body).advance(state, time_step, 400);
    for (int axis = 0; axis < 2; ++axis) {
      const Field<2> unit(body.size(), Vector<2>::Unit(axis));
      const double momentum = inertial_product(problem, body, unit, state.velocity);
      const double load = inertial_product(problem, body, unit, body.load);
      CHECK(momentum == Approx(400 * time_step * load).epsilon(run_rounding));
    }
  }
}

TEST_CASE("clamped directions stay at 0 exactly, also where a state would have them elsewhere", "[fast]") {
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet}) {
    Problem<2> problem = problem_in<2>(LatticeKind::square);
    problem.integrator = integrator;
    problem.scheme.damping = some_damping;
    const auto body = clamped_and_loaded(disordered_block(problem, 5));
    Simulation<2> simulation(problem, body);
    State<2> state = random_state(body.size(), 0.05, 4);
    State<2> held = state;
    for (int a = 0; a < body.size(); ++a)
      for (int i = 0; i < 2; ++i)
        if (body.clamped[a][i]) held.displacement[a][i] = held.velocity[a][i] = 0.0;
    simulation.advance(state, 0.1, 50);
    simulation.advance(held, 0.1, 50);
    CHECK(state.displacement == held.displacement);
    CHECK(state.velocity == held.velocity);
    for (int a = 0; a < body.size(); ++a)
      for (int i = 0; i < 2; ++i)
        if (body.clamped[a][i]) {
          CHECK(state.displacement[a][i] == 0.0);
          CHECK(state.velocity[a][i] == 0.0);
        }
    CHECK(state.displacement[3][0] != 0.0);
  }
}

TEST_CASE("the step Jacobian of a clamped body has empty rows and columns where it is clamped, and no others",
          "[fast]") {
  const auto problem = problem_in<2>(LatticeKind::square);
  const auto body = clamped_and_loaded(disordered_block(problem, 3));
  const Eigen::MatrixXd jacobian = step_jacobian(problem, body, 0.1);
  for (int a = 0; a < body.size(); ++a)
    for (int i = 0; i < 2; ++i)
      for (const int index : {4 * a + i, 4 * a + 2 + i}) {
        CHECK(jacobian.col(index).isZero(0.0) == body.clamped[a][i]);
        CHECK(jacobian.row(index).isZero(0.0) == body.clamped[a][i]);
      }
}

TEST_CASE("stresses of particles are those of their own materials", "[fast]") {
  Problem<2> problem = problem_in<2>(LatticeKind::square);
  problem.scheme.momentum_density = MomentumDensity::equation_of_state;  // which leaves the stress itself alone
  const auto body = disordered_block(problem, 4);
  const auto state = random_state_of(body, 0.1, 11);
  const Simulation<2> simulation(problem, body);
  for (int a = 0; a < body.size(); ++a) {
    const Material& made_of = body.material_of(a);
    const double lambda = made_of.bulk_modulus() - 2.0 / 3.0 * made_of.shear_modulus();
    const Tensor<2> strain = simulation.strain(state, a);
    const Tensor<2> expected = 2.0 * made_of.shear_modulus() * strain + lambda * strain.trace() * Tensor<2>::Identity();
    CHECK((simulation.stress(state, a) - expected).norm() < rounding * expected.norm());
    const double xx = expected(0, 0), yy = expected(1, 1), xy = expected(0, 1), zz = lambda * strain.trace();
    const double von_mises =
        std::sqrt(0.5 * ((xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx)) + 3.0 * xy * xy);
    CHECK(simulation.von_mises_stress(state, a) == Approx(von_mises).epsilon(rounding));
  }
}
