// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "solver/updated_cases.hpp"

using namespace sphstab;
using namespace sphstab::solver;
using namespace sphstab::solver::test;

TEST_CASE("ul: a flat state lists position, velocity, density and stress of one particle after the other", "[fast]") {
  UpdatedState<2> state;
  state.position = {{1, 2}, {21, 22}};
  state.velocity = {{3, 4}, {23, 24}};
  state.density = {5, 25};
  state.deviatoric_stress = {(Tensor<2>() << 6, 8, 8, 7).finished(), (Tensor<2>() << 26, 28, 28, 27).finished()};
  CHECK(flat_state(state).head(8) == Eigen::VectorXd::LinSpaced(8, 1, 8));
  CHECK(flat_state(state).tail(8) == Eigen::VectorXd::LinSpaced(8, 21, 28));
  state.stored = UpdatedRates<2>(2);
  state.stored.acceleration = {{9, 10}, {29, 30}};
  state.stored.density = {11, 31};
  state.stored.deviatoric_stress = {(Tensor<2>() << 12, 14, 14, 13).finished(),
                                    (Tensor<2>() << 32, 34, 34, 33).finished()};
  CHECK(flat_state(state).head(14) == Eigen::VectorXd::LinSpaced(14, 1, 14));
  CHECK(flat_state(state).tail(14) == Eigen::VectorXd::LinSpaced(14, 21, 34));
}

TEST_CASE("ul: a flat state put back is the state", "[fast]") {
  Problem<3> problem = updated_problem<3>();
  problem.integrator = Integrator::predictor_corrector_pec;
  UpdatedSimulation<3> simulation(problem, LatticeIndex<3>(3, 3, 3));
  auto state = disturbed(simulation.base_state(), 0.1, 1);
  simulation.advance(state, 0.01);  // stores rates
  auto copy = state;
  set_flat_state<3, double>(Eigen::VectorXd::Zero(flat_state(state).size()), copy);
  CHECK(greatest_norm(copy.stored.deviatoric_stress) == 0.0);
  set_flat_state(flat_state(state), copy);
  CHECK(copy.position == state.position);
  CHECK(copy.velocity == state.velocity);
  CHECK(copy.density == state.density);
  CHECK(copy.deviatoric_stress == state.deviatoric_stress);
  CHECK(copy.stored.acceleration == state.stored.acceleration);
  CHECK(copy.stored.density == state.stored.density);
  CHECK(copy.stored.deviatoric_stress == state.stored.deviatoric_stress);
}
