// SPDX-License-Identifier: MIT
#include "solver/step_jacobian.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "solver/cases.hpp"

using namespace sphstab;
using namespace sphstab::solver;
using namespace sphstab::solver::test;

namespace {

/// Central differences with step 1e-5 of a map with third derivatives of order 10: 10 · 1e-10 / 6, and 2e-16 / 1e-5.
constexpr double difference_step = 1e-5, difference_tolerance = 4e-10;
/// A product of 36 pivots of order 1, each with a few roundings: 36 · 2 · 2.2e-16.
constexpr double rounding = 2e-14;
constexpr double time_step = 0.3;

double& component(State<2>& state, int index) {
  return index % 4 < 2 ? state.velocity[index / 4][index % 4] : state.displacement[index / 4][index % 4 - 2];
}

State<2> stepped(Simulation<2>& simulation, int particles, int index, double shift) {
  State<2> state(particles);
  component(state, index) += shift;
  simulation.advance(state, time_step);
  return state;
}

}  // namespace

TEST_CASE("the step Jacobian is the limit of differences of real steps, for every variant", "[fast]") {
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet})
    for (auto problem : all_variants(plain_problem())) {
      problem.integrator = integrator;
      INFO(describe(problem));
      const auto body = free_plate(problem, LatticeIndex<2>(3, 2));
      const Eigen::MatrixXd jacobian = step_jacobian(problem, body, time_step);
      Simulation<2> simulation(problem, body);
      REQUIRE(jacobian.rows() == 4 * body.size());
      double error = 0.0;
      for (int column = 0; column < jacobian.cols(); ++column) {
        State<2> above = stepped(simulation, body.size(), column, difference_step);
        State<2> below = stepped(simulation, body.size(), column, -difference_step);
        for (int row = 0; row < jacobian.rows(); ++row)
          error = std::max(error, std::abs(jacobian(row, column) -
                                           (component(above, row) - component(below, row)) / (2.0 * difference_step)));
      }
      CHECK(error < difference_tolerance);
    }
}

TEST_CASE("an undamped step keeps phase-space volume", "[fast]") {
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet})
    for (auto problem : all_variants(plain_problem())) {
      if (problem.scheme.damping) continue;
      problem.integrator = integrator;
      INFO(describe(problem));
      const Eigen::MatrixXd jacobian = step_jacobian(problem, free_plate(problem, LatticeIndex<2>(3, 3)), time_step);
      CHECK(std::abs(Eigen::PartialPivLU<Eigen::MatrixXd>(jacobian).determinant() - 1.0) < rounding);
    }
}
