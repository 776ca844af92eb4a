// SPDX-License-Identifier: MIT
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "analysis/amplification.hpp"
#include "analysis/body_operator.hpp"
#include "tests/analysis/golden.hpp"
#include "tests/analysis/problems.hpp"

using namespace sphstab;
using namespace sphstab::analysis;

namespace {

/// Sums over some 20 neighbours twice, of accelerations of order one.
constexpr double rounding_tolerance = 1e-13;
/// Backward error of the symmetric solver, n ε ‖K‖ with n = 60.
constexpr double spectrum_tolerance = 1e-13;

/// The accelerations by Zhang's Eqs. 7 to 9, particle by particle, each sum divided by its N.
Eigen::VectorXd acceleration(const Problem<2>& problem, const Body<2>& body, const Eigen::VectorXd& s) {
  const bool normalised = problem.scheme.kernel_normalisation == KernelNormalisation::sum;
  const double E = problem.material.young_modulus(), mu = problem.material.poisson_ratio(),
               rho = problem.material.density();
  const double G = E / (1.0 + mu), gamma = mu * G / (problem.plane == Plane::strain ? 1.0 - 2.0 * mu : 1.0 - mu);
  std::vector<double> N;
  std::vector<Tensor<2>> stress;
  const auto for_neighbours = [&](std::size_t a, const auto& visit) {
    for (std::size_t b = 0; b < body.position.size(); ++b) {
      const Vector<2> r = body.position[a] - body.position[b];
      if (a != b && r.norm() < problem.kernel.support() * (1.0 - tie_margin))
        visit(b, r.norm(), Vector<2>(problem.kernel.slope(r.norm()) * r / r.norm()));
    }
  };
  for (std::size_t a = 0; a < body.position.size(); ++a) {
    double W = problem.kernel.value(0.0);
    Tensor<2> gradient = Tensor<2>::Zero();
    for_neighbours(a, [&](std::size_t b, double r, const Vector<2>& dW) {
      W += problem.kernel.value(r);
      gradient += (s.segment<2>(2 * static_cast<int>(b)) - s.segment<2>(2 * static_cast<int>(a))) * dW.transpose();
    });
    N.push_back(normalised ? W * body.volume[a] : 1.0);
    const Tensor<2> strain = 0.5 * (gradient + gradient.transpose()) * body.volume[a] / N[a];
    stress.push_back(G * strain + gamma * strain.trace() * Tensor<2>::Identity());
  }
  Eigen::VectorXd result = Eigen::VectorXd::Zero(s.size());
  for (std::size_t a = 0; a < body.position.size(); ++a)
    for_neighbours(a, [&](std::size_t b, double, const Vector<2>& dW) {
      result.segment<2>(2 * static_cast<int>(a)) +=
          rho * body.volume[b] / (rho * rho) * (stress[a] + stress[b]) * dW / N[a];
    });
  return result;
}

}  // namespace

TEST_CASE("the body operator is Zhang's equations 7 to 9 on a free plate", "[fast]") {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (const auto plane : {Plane::strain, Plane::stress})
    for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum}) {
      auto problem = problem_2d(LatticeKind::square, KernelFamily::cubic_spline, 1.3);
      problem.material = Material::from_young_modulus(1.7, 2.1, 0.35);
      problem.plane = plane;
      problem.scheme.kernel_normalisation = normalisation;
      const auto body = free_plate(problem, {6, 5});
      const auto K = dense_operator(problem, body);
      Eigen::VectorXd s(60);
      for (auto& component : s) component = normal(random);
      CHECK((K * s + acceleration(problem, body, s)).lpNorm<Eigen::Infinity>() < rounding_tolerance);
      // Translations are free of force.
      CHECK((K * Eigen::VectorXd::Ones(60)).lpNorm<Eigen::Infinity>() < rounding_tolerance);
    }
}

TEST_CASE("plate limits agree with the reference, with and without normalisation", "[fast]") {
  const auto references = golden::cases("spectrum");
  REQUIRE(references.size() == 4);
  for (const auto& reference : references) {
    INFO(reference["id"]);
    const auto problem = golden::problem(reference);
    const auto limit =
        dense_body_limit(problem, free_plate(problem, golden::numbers<LatticeIndex<2>>(reference["plate"])));
    const double expected = reference["expect"]["critical_time_step"], tolerance = reference["tolerance"];
    CHECK(std::abs(limit.critical_time_step - expected) < tolerance * expected);
    CHECK(limit.bracket.low <= limit.critical_time_step);
    CHECK(limit.critical_time_step <= limit.bracket.high);
    CHECK(limit.omega_max == limit.omega.back());
  }
}

TEST_CASE("a periodic patch has exactly the frequencies of its wave vectors", "[fast]") {
  for (const LatticeKind lattice : lattices_of(2))
    for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum}) {
      INFO(name_of(lattice));
      auto problem = problem_2d(lattice, KernelFamily::quintic_spline, 1.1);  // the support exceeds half the patch
      problem.scheme.kernel_normalisation = normalisation;
      const LatticeIndex<2> cells(6, 5);
      std::vector<double> expected;
      for (int i = 0; i < cells[0]; ++i)
        for (int j = 0; j < cells[1]; ++j) {
          const Vector<2> k = problem.lattice.reciprocal_vectors() *
                              Vector<2>(static_cast<double>(i) / cells[0], static_cast<double>(j) / cells[1]);
          const Vector<2> squares = dynamical_matrix(problem, k).selfadjointView<Eigen::Lower>().eigenvalues();
          expected.insert(expected.end(), squares.begin(), squares.end());
        }
      std::sort(expected.begin(), expected.end());
      const auto body = dense_body_limit(problem, periodic_patch(problem, cells));
      REQUIRE(body.omega.size() == expected.size());
      for (std::size_t i = 0; i < expected.size(); ++i)
        CHECK(std::abs(body.omega[i] * body.omega[i] - expected[i]) < spectrum_tolerance);
      const auto patch = std::get<ConditionallyStable<2>>(patch_limit(problem, cells));
      CHECK(body.critical_time_step == Approx(patch.critical_time_step).epsilon(spectrum_tolerance));
      CHECK(body.bracket.low <= patch.critical_time_step);
      CHECK(patch.critical_time_step <= body.bracket.high);
    }
}

TEST_CASE("normalised free edges need a smaller step than the bulk", "[fast]") {
  // theory.md §2: 0.837 x the normalised bulk value at H = Δ, 0.735 x at 1.5 Δ; the plain plate 0.3 to 4 % above the
  // bulk.
  struct Edge {
    double h, ratio;
  };
  constexpr double printed = 1e-3;
  for (const auto& [h, ratio] : {Edge{1.0, 0.837}, Edge{1.5, 0.735}}) {
    auto problem = problem_2d(LatticeKind::square, KernelFamily::gaussian, h, 7.0);
    problem.plane = Plane::stress;
    const auto ratio_to_bulk = [&] {
      return dense_body_limit(problem, free_plate(problem, {20, 20})).critical_time_step /
             std::get<ConditionallyStable<2>>(BulkModes(problem).limit()).critical_time_step;
    };
    const double plain = ratio_to_bulk();
    CHECK(plain > 1.0);
    CHECK(plain < 1.04);
    problem.scheme.kernel_normalisation = KernelNormalisation::sum;
    CHECK(std::abs(ratio_to_bulk() - ratio) < printed);
  }
}

TEST_CASE("a body refuses what it does not model", "[fast]") {
  auto problem = problem_2d(LatticeKind::square, KernelFamily::cubic_spline, 1.3);
  CHECK_THROWS_AS(dense_body_limit(problem, periodic_patch(problem, {2, 2})), InvalidInput);
  problem.scheme.momentum_density = MomentumDensity::equation_of_state;
  CHECK_NOTHROW(dense_operator(problem, free_plate(problem, {3, 3})));
  problem.displacement_gradient(0, 1) = 0.1;
  CHECK_THROWS_AS(dense_operator(problem, free_plate(problem, {3, 3})), InvalidInput);
}
