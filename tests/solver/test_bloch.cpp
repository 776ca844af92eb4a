// SPDX-License-Identifier: MIT
#include "solver/bloch.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "solver/cases.hpp"
#include "solver/step_jacobian.hpp"

using namespace sphstab;
using namespace sphstab::solver;
using namespace sphstab::solver::test;

namespace {

using Complex = std::complex<double>;
using Amplitude = Vector<2, Complex>;

/// Two nested sums over some 20 neighbours and a mean over particles, of numbers of order 1, twice: 4 · 20 · 2.2e-16.
constexpr double rounding = 2e-14;
constexpr double time_step = 0.3;

const Amplitude some_amplitude(Complex(0.3, -0.2), Complex(-0.5, 0.7));

/// The wave vector n_1/N_1 b_1 + n_2/N_2 b_2 that a patch of N_1 × N_2 cells admits.
Vector<2> admitted(const Problem<2>& problem, const LatticeIndex<2>& cells, int n_1, int n_2) {
  const auto& b = problem.lattice.reciprocal_vectors();
  return b.col(0) * n_1 / cells[0] + b.col(1) * n_2 / cells[1];
}

double largest_difference(const Field<2, Complex>& left, const Field<2, Complex>& right) {
  double norm = 0.0;
  for (std::size_t a = 0; a < left.size(); ++a) norm = std::max(norm, (left[a] - right[a]).norm());
  return norm;
}

Field<2> real_part(const Field<2, Complex>& wave) {
  Field<2> field;
  for (const auto& y : wave) field.push_back(y.real());
  return field;
}

}  // namespace

TEST_CASE("a Bloch wave projects to its own amplitude and to nothing of another wave vector", "[fast]") {
  const Problem<2> problem = plain_problem(LatticeKind::hexagonal);
  const LatticeIndex<2> cells(3, 4);
  const auto patch = periodic_patch(problem, cells);
  const Vector<2> k = admitted(problem, cells, 1, 2), other = admitted(problem, cells, 2, 1);
  const auto wave = bloch_wave<2>(patch, k, some_amplitude);
  CHECK((bloch_amplitude(patch, k, wave) - some_amplitude).norm() < rounding);
  CHECK(bloch_amplitude(patch, other, wave).norm() < rounding);
  CHECK((bloch_amplitude(patch, k, real_part(wave)) - 0.5 * some_amplitude).norm() < rounding);
  CHECK((bloch_amplitude<2, double>(patch, -k, real_part(wave)) - 0.5 * some_amplitude.conjugate()).norm() < rounding);
}

TEST_CASE("a wave vector that the patch does not admit is refused", "[fast]") {
  const Problem<2> problem = plain_problem();
  const LatticeIndex<2> cells(4, 3);
  const auto patch = periodic_patch(problem, cells);
  CHECK_NOTHROW(bloch_wave<2>(patch, admitted(problem, cells, 3, -2), some_amplitude));
  CHECK_THROWS_AS(bloch_wave<2>(patch, admitted(problem, LatticeIndex<2>(4, 4), 0, 1), some_amplitude), InvalidInput);
  CHECK_THROWS_AS(bloch_wave<2>(patch, admitted(problem, LatticeIndex<2>(5, 3), 1, 0), some_amplitude), InvalidInput);
}

TEST_CASE("with four neighbours a wave feels the forces A and B that the paper prints", "[fast]") {
  // Eqs. A.6 and A.7 with G = E/(1+μ) and m/ρ = V; the force along y is A with its arguments exchanged.
  for (const auto plane : {Plane::strain, Plane::stress}) {
    Problem<2> problem = plain_problem();
    problem.neighbour_rule = NeighbourRule::nearest;
    problem.plane = plane;
    const double mu = poisson_ratio, G = young_modulus / (1.0 + mu);
    const double gamma = mu * G / (plane == Plane::strain ? 1.0 - 2.0 * mu : 1.0 - mu);
    const double factor = std::pow(spacing * spacing * problem.kernel.slope(spacing), 2) / density;
    const LatticeIndex<2> cells(6, 5);
    const auto patch = periodic_patch(problem, cells);
    for (int n = 0; n < 6; ++n)
      for (int m = 0; m < 5; ++m) {
        const Vector<2> k = admitted(problem, cells, n, m);
        const double K = k[0] * spacing, Q = k[1] * spacing;
        const auto A = [&](double K_, double Q_) {
          return factor * (2.0 * (gamma + G) * std::cos(2.0 * K_) + G * std::cos(2.0 * Q_) - 2.0 * gamma - 3.0 * G);
        };
        const double B = factor * (2.0 * gamma + G) * (std::cos(K + Q) - std::cos(K - Q));
        Tensor<2, Complex> expected;
        expected << A(K, Q), B, B, A(Q, K);
        INFO("K = " << K << ", Q = " << Q);
        CHECK((bloch_acceleration_matrix(problem, patch, k) - expected).norm() < rounding);
      }
  }
}

TEST_CASE("the acceleration matrix is what two real runs of the linear scheme show", "[fast]") {
  for (const auto lattice : {LatticeKind::square, LatticeKind::hexagonal, LatticeKind::staggered}) {
    const Problem<2> problem = plain_problem(lattice);
    const LatticeIndex<2> cells(3, 4);
    const auto patch = periodic_patch(problem, cells);
    const Vector<2> k = admitted(problem, cells, 1, -1);
    const auto wave = bloch_wave<2>(patch, k, some_amplitude);
    // The scheme is linear here: a complex field is its real and imaginary part side by side.
    Simulation<2, Complex> simulation(problem, patch);
    State<2, Complex> state(patch.size());
    state.displacement = wave;
    Field<2, Complex> acceleration(patch.size());
    simulation.accelerations(state, acceleration);
    Simulation<2> real_simulation(problem, patch);
    State<2> real_state(patch.size());
    real_state.displacement = real_part(wave);
    Field<2> real_acceleration(patch.size());
    real_simulation.accelerations(real_state, real_acceleration);

    const Amplitude image = bloch_acceleration_matrix(problem, patch, k) * some_amplitude;
    const auto image_wave = bloch_wave<2>(patch, k, image);
    CHECK(largest_difference(acceleration, image_wave) < rounding);
    CHECK(test::largest_difference(real_acceleration, real_part(image_wave)) < rounding);
  }
}

TEST_CASE("the step matrix is built of the acceleration matrix as the integrator says", "[fast]") {
  const LatticeIndex<2> cells(3, 4);
  for (const auto lattice : {LatticeKind::square, LatticeKind::hexagonal, LatticeKind::staggered})
    for (auto problem : all_variants(plain_problem(lattice))) {
      INFO(describe(problem));
      const auto patch = periodic_patch(problem, cells);
      const Vector<2> k = admitted(problem, cells, 1, 2);
      const Tensor<2, Complex> A = bloch_acceleration_matrix(problem, patch, k), I = Tensor<2, Complex>::Identity();
      const double c = problem.scheme.damping ? problem.scheme.damping->rate : 0.0, dt = time_step;

      BlochStepMatrix<2> leapfrog;  // v' = (1 − cΔt) v + Δt A s, s' = s + Δt v'
      leapfrog << (1.0 - c * dt) * I, dt * A, dt * (1.0 - c * dt) * I, I + dt * dt * A;
      CHECK((bloch_step_matrix(problem, patch, k, dt) - leapfrog).norm() < rounding);

      problem.integrator = Integrator::verlet;
      const double d = 1.0 - 0.5 * c * dt;  // v½ = d v + ½Δt A s, s' = s + Δt v½, v' = d v½ + ½Δt A s'
      const Tensor<2, Complex> s_s = I + 0.5 * dt * dt * A;
      BlochStepMatrix<2> verlet;
      verlet << d * d * I + 0.5 * dt * dt * d * A, 0.5 * dt * (d * A + A * s_s), dt * d * I, s_s;
      CHECK((bloch_step_matrix(problem, patch, k, dt) - verlet).norm() < rounding);
    }
}

TEST_CASE("the step Jacobian of a patch maps every Bloch wave as the step matrix of its wave vector", "[fast]") {
  const LatticeIndex<2> cells(3, 2);
  for (auto problem : all_variants(plain_problem(LatticeKind::staggered))) {
    INFO(describe(problem));
    const auto patch = periodic_patch(problem, cells);
    const Eigen::MatrixXcd jacobian = step_jacobian(problem, patch, time_step).cast<Complex>();
    for (int n_1 = 0; n_1 < cells[0]; ++n_1)
      for (int n_2 = 0; n_2 < cells[1]; ++n_2) {
        const Vector<2> k = admitted(problem, cells, n_1, n_2);
        const BlochStepMatrix<2> E = bloch_step_matrix(problem, patch, k, time_step);
        Eigen::MatrixXcd waves(jacobian.rows(), 4);
        for (int a = 0; a < patch.size(); ++a)
          waves.middleRows<4>(4 * a) = std::polar(1.0, k.dot(patch.position[a])) * Eigen::Matrix4cd::Identity();
        CHECK((jacobian * waves - waves * E).norm() < rounding * waves.norm());
      }
  }
}
