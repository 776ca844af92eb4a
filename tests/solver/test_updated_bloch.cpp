// SPDX-License-Identifier: MIT
#include "solver/updated_bloch.hpp"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <numbers>

#include "solver/updated_cases.hpp"

using namespace sphstab;
using namespace sphstab::solver;
using namespace sphstab::solver::test;

namespace {

/// Sums of 20 neighbours and 30 particles with errors of 1e-16 each, of matrices with entries of up to ten.
constexpr double rounding = 1e-12;
/// Eigenvalues ±iω beside a defective pair at 0, which rounding of 1e-16 splits by 1e-8.
constexpr double eigenvalue_error = 1e-7;
constexpr double time_step = 0.1;

/// Stress of both signs, whose axes are not those of the lattice.
Problem<2> stressed_problem(Integrator integrator) {
  Problem<2> problem = with_all_terms(updated_problem<2>());
  problem.integrator = integrator;
  problem.pressure = -0.05;
  problem.deviatoric_stress << 0.2, 0.1, 0.1, -0.3;
  return problem;
}

/// The first wave of four cells along one direction and the second along the other.
Vector<2> some_wave_vector(const Problem<2>& problem) {
  return problem.lattice.reciprocal_vectors() * Vector<2>(0.25, 0.5);
}

/// E of one step composed of L = `rates` as interface.md words it, where the first Dim numbers are r and the next v.
Eigen::MatrixXcd composed_step(Integrator integrator, const Eigen::MatrixXcd& rates, double dt) {
  const auto size = rates.rows();
  const Eigen::MatrixXcd identity = Eigen::MatrixXcd::Identity(size, size);
  Eigen::MatrixXcd forces = Eigen::MatrixXcd::Zero(size, size);
  forces.middleRows<2>(2) = rates.middleRows<2>(2);
  const Eigen::MatrixXcd others = rates - forces;  // of r and q
  switch (integrator) {
    case Integrator::leapfrog:
      return (identity + dt * others) * (identity + dt * forces);
    case Integrator::verlet:
      return (identity + 0.5 * dt * forces) * (identity + dt * others) * (identity + 0.5 * dt * forces);
    case Integrator::predictor_corrector:
    case Integrator::predictor_corrector_pec:
      Eigen::MatrixXcd predicted = identity + dt * rates;
      predicted.topRows<2>() += 0.5 * dt * dt * rates.middleRows<2>(2);
      Eigen::MatrixXcd correction = 0.5 * dt * rates * (predicted - identity);
      correction.topRows<2>().setZero();
      return predicted + correction;
  }
  return identity;
}

}  // namespace

TEST_CASE("ul: a step maps Bloch waves to Bloch waves by E(k)", "[fast]") {
  const LatticeIndex<2> cells(4, 6);
  for (const auto integrator : updated_integrators) {
    const Problem<2> problem = stressed_problem(integrator);
    const Vector<2> k = some_wave_vector(problem);
    const auto E = bloch_step_matrix(problem, cells, k, time_step);
    const auto size = E.rows();
    CHECK(size == (integrator == Integrator::predictor_corrector_pec ? 14 : 8));
    const Eigen::VectorXcd amplitude = Eigen::VectorXcd::Random(size);
    UpdatedSimulation<2, Dual> simulation(problem, cells);
    auto base = simulation.base_state();
    if (size == 14) base.stored = UpdatedRates<2, Dual>(base.particles());
    const auto wave = [&](const Eigen::VectorXcd& y) {
      Eigen::VectorXcd field(size * base.particles());
      for (int a = 0; a < base.particles(); ++a)
        field.segment(size * a, size) =
            y * std::polar(1.0, k[0] * base.position[a][0].value + k[1] * base.position[a][1].value);
      return field;
    };
    const Eigen::VectorXcd before = wave(amplitude), after = wave(E * amplitude);
    const Eigen::VectorXd real = step_derivative<2>(simulation, base, before.real(), time_step);
    const Eigen::VectorXd imaginary = step_derivative<2>(simulation, base, before.imag(), time_step);
    CHECK((after.real() - real).norm() < rounding * real.norm());
    CHECK((after.imag() - imaginary).norm() < rounding * imaginary.norm());
  }
}

TEST_CASE("ul: E(k) and L(k) do not know the size of the box", "[fast]") {
  const Problem<2> problem = stressed_problem(Integrator::predictor_corrector);
  const Vector<2> k = some_wave_vector(problem);
  const auto E = bloch_step_matrix<2>(problem, {4, 2}, k, time_step);
  CHECK((bloch_step_matrix<2>(problem, {8, 6}, k, time_step) - E).norm() < rounding);
  const auto L = bloch_rate_matrix<2>(problem, {4, 2}, k);
  CHECK((bloch_rate_matrix<2>(problem, {8, 6}, k) - L).norm() < rounding);
  CHECK_THROWS_WITH(bloch_rate_matrix<2>(problem, {3, 2}, k), Catch::StartsWith("wave_vector: "));
}

TEST_CASE("ul: E(k) is composed of L(k) as the steps of the interface are", "[fast]") {
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet, Integrator::predictor_corrector}) {
    const Problem<2> problem = stressed_problem(integrator);
    const Vector<2> k = some_wave_vector(problem);
    const auto L = bloch_rate_matrix<2>(problem, {4, 2}, k);
    const auto E = bloch_step_matrix<2>(problem, {4, 2}, k, time_step);
    CHECK((E - composed_step(integrator, L, time_step)).norm() < rounding);
  }
}

TEST_CASE("ul: on a chain at rest frequencies are c_p times the sine sum of the kernel", "[fast]") {
  const Problem<1> problem = updated_problem<1>();
  const int cells = 12;
  for (const int n : {1, 2, 5}) {
    const double k = 2.0 * std::numbers::pi * n / (cells * dp);
    double A = 0.0;
    for (const auto& b : lattice_neighbours(problem.lattice, problem.kernel.support(), NeighbourRule::support))
      A += dp * std::sin(k * b.position[0]) * problem.kernel.slope(b.distance) * (b.position[0] > 0.0 ? 1.0 : -1.0);
    const double omega = std::sqrt(c0 * c0 + 4.0 / 3.0 * mu / rho0) * std::abs(A);
    const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> solver(
        bloch_rate_matrix(problem, LatticeIndex<1>(cells), Vector<1>(k)), false);
    Eigen::VectorXd frequencies = solver.eigenvalues().imag();
    std::sort(frequencies.begin(), frequencies.end());
    CHECK(solver.eigenvalues().real().norm() < eigenvalue_error);
    CHECK((frequencies - Eigen::Vector4d(-omega, 0.0, 0.0, omega)).norm() < eigenvalue_error);
  }
}
