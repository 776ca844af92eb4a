// SPDX-License-Identifier: MIT
#include "study/growth_run.hpp"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include "solver/simulation.hpp"
#include "study/bisection.hpp"
#include "study/bodies.hpp"

using namespace sphstab;
using namespace sphstab::study;
using namespace sphstab::study::test;

namespace {

constexpr double tolerance = 1e-6;

/// 2 / ω_max of the forces that the solver computes, column by column, in the symmetric form of their inertia: leapfrog
/// grows beyond it.
double step_from_frequencies(const Problem<2>& problem, const Body<2>& body) {
  Body<2> unloaded = body;
  unloaded.load.clear();
  solver::Simulation<2> simulation(problem, unloaded);
  const int size = 2 * body.size();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  solver::Field<2> acceleration(body.size());
  for (int column = 0; column < size; ++column) {
    if (!body.clamped.empty() && body.clamped[column / 2][column % 2]) continue;
    solver::State<2> state(body.size());
    state.displacement[column / 2][column % 2] = 1.0;
    simulation.accelerations(state, acceleration);
    for (int row = 0; row < size; ++row)
      matrix(row, column) =
          -acceleration[row / 2][row % 2] * std::sqrt(simulation.inertia(row / 2) / simulation.inertia(column / 2));
  }
  return 2.0 /
         std::sqrt(
             Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff());
}

void check(const Problem<2>& problem, const Body<2>& body) {
  const double expected = step_from_frequencies(problem, body);
  const auto found = bisect(GrowthRun<2>(problem, body, 1), {.start = 0.4 * expected, .tolerance = tolerance});
  REQUIRE(found.critical_time_step);
  CHECK(*found.critical_time_step == Approx(expected).epsilon(tolerance));
  CHECK(found.high - found.low <= tolerance * found.high);
}

}  // namespace

TEST_CASE("growth of a clamped beam under load ends where its largest frequency says, whatever the load", "[ladder]") {
  for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum}) {
    Problem<2> problem = plain_problem();
    problem.scheme.kernel_normalisation = normalisation;
    check(problem, loaded(clamped_at_left(free_plate(problem, LatticeIndex<2>(12, 4))), {0.3, -7.0}));
  }
}

TEST_CASE("growth of jittered plates ends where their largest frequencies say", "[ladder]") {
  const Problem<2> problem = plain_problem();
  for (const unsigned seed : {1u, 2u, 3u})
    check(problem, jittered(free_plate(problem, LatticeIndex<2>(9, 8)), problem, seed));
}

TEST_CASE("growth of a bar of two materials, one a thousand times denser, ends where its largest frequency says",
          "[ladder]") {
  const Problem<2> problem = plain_problem();
  check(problem, of_two_materials(free_plate(problem, LatticeIndex<2>(14, 4)), 14));
}

TEST_CASE("growth of a nearly incompressible plate ends where its largest frequency says", "[ladder]") {
  const Problem<2> problem = plain_problem(nearly_incompressible);
  check(problem, free_plate(problem, LatticeIndex<2>(8, 7)));
}

TEST_CASE("loads leave growth as it is, bit by bit", "[fast]") {
  const Problem<2> problem = plain_problem();
  const Body<2> beam = clamped_at_left(free_plate(problem, LatticeIndex<2>(8, 4)));
  const double time_step = 1.01 * step_from_frequencies(problem, beam);
  const auto expected = GrowthRun<2>(problem, beam, 1)(time_step, 400);
  const auto found = GrowthRun<2>(problem, loaded(beam, {0.3, -7.0}), 1)(time_step, 400);
  CHECK(expected.trend == solver::Trend::growing);
  CHECK(found.growth_per_step == expected.growth_per_step);
  CHECK(found.steps == expected.steps);
}

TEST_CASE("a body that is clamped all over has no perturbation to grow", "[fast]") {
  const Problem<2> problem = plain_problem();
  Body<2> body = free_plate(problem, LatticeIndex<2>(4, 4));
  body.clamped.assign(body.size(), Directions<2>::Constant(true));
  CHECK_THROWS_AS(GrowthRun<2>(problem, body, 1), InvalidInput);
}
