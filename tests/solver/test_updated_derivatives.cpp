// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "solver/updated_cases.hpp"

using namespace sphstab;
using namespace sphstab::solver;
using namespace sphstab::solver::test;

namespace {

/// Central differences with steps of 1e-5 on functions of order one with third derivatives of up to 1000 (viscosity and
/// kernels change over a tenth of a spacing): 1e-7 of truncation.
constexpr double difference_error = 1e-6;
constexpr double step = 1e-5;
/// A few roundings of 1.1e-16.
constexpr double rounding = 1e-14;

/// The derivative of three steps of a disturbed box along a random direction, by duals and by differences.
template <int Dim>
void check_steps(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells) {
  UpdatedSimulation<Dim> simulation(problem, cells);
  UpdatedSimulation<Dim, Dual> dual_simulation(problem, cells);
  auto state = disturbed(simulation.base_state(), 0.05, 1);
  if (problem.integrator == Integrator::predictor_corrector_pec) simulation.advance(state, 0.02);
  const Eigen::VectorXd from = flat_state(state);
  Noise noise(2);
  Eigen::VectorXd direction(from.size());
  for (double& x : direction) x = noise();

  const auto image = [&](double along) {
    auto moved = state;
    set_flat_state<Dim, double>(from + along * direction, moved);
    REQUIRE(!simulation.advance(moved, 0.02, 3));
    return flat_state(moved);
  };
  auto dual_state = dual_simulation.base_state();
  if (problem.integrator == Integrator::predictor_corrector_pec)
    dual_state.stored = UpdatedRates<Dim, Dual>(state.particles());
  set_flat_state<Dim, Dual>(from.binaryExpr(direction, [](double x, double dx) { return Dual(x, dx); }), dual_state);
  REQUIRE(!dual_simulation.advance(dual_state, 0.02, 3));
  const auto dual_image = flat_state(dual_state);

  const Eigen::VectorXd value = dual_image.unaryExpr([](const Dual& x) { return x.value; });
  const Eigen::VectorXd derivative = dual_image.unaryExpr([](const Dual& x) { return x.derivative; });
  const Eigen::VectorXd difference = (image(step) - image(-step)) / (2.0 * step);
  CHECK((value - image(0.0)).norm() < rounding * value.norm());
  CHECK((derivative - difference).norm() < difference_error * derivative.norm());
}

}  // namespace

TEST_CASE("dual numbers carry the derivatives of arithmetic and of the functions that kernels use", "[fast]") {
  const Dual x(0.7, 2.0), y(-1.3, 0.5);
  const auto check = [](const Dual& found, double value, double derivative) {
    CHECK(found.value == Approx(value).epsilon(rounding));
    CHECK(found.derivative == Approx(derivative).epsilon(rounding));
  };
  check(x + y, -0.6, 2.5);
  check(x - y, 2.0, 1.5);
  check(-x, -0.7, -2.0);
  check(x * y, -0.91, 2.0 * -1.3 + 0.7 * 0.5);
  check(x / y, 0.7 / -1.3, (2.0 * -1.3 - 0.7 * 0.5) / 1.69);
  check(sqrt(x), std::sqrt(0.7), 1.0 / std::sqrt(0.7));
  check(exp(x), std::exp(0.7), 2.0 * std::exp(0.7));
  check(pow(x, 1.5), std::pow(0.7, 1.5), 3.0 * std::sqrt(0.7));
  check(sin(x), std::sin(0.7), 2.0 * std::cos(0.7));
  check(cos(x), std::cos(0.7), -2.0 * std::sin(0.7));
  CHECK(y < x);
  CHECK(x > y);
}

TEST_CASE("ul: derivatives of steps by dual numbers are those by differences, for every integrator and choice of terms",
          "[fast]") {
  for (const auto integrator : updated_integrators) {
    Problem<2> problem = updated_problem<2>(1.37);  // no neighbours at the knots of the spline, nor near the support
    problem.integrator = integrator;
    problem.deviatoric_stress << 0.4, 0.1, 0.1, -0.5;  // no principal stress near the switch at zero
    for_each_choice_of_terms(problem, [](const Problem<2>& choice) {
      // A pair whose approach changes sign within the step of a difference has no derivative.
      if (!choice.scheme.viscosity || choice.scheme.viscosity->pairs == ViscousPairs::all)
        check_steps<2>(choice, {3, 3});
    });
    Problem<1> line = with_all_terms(updated_problem<1>(1.37));
    line.integrator = integrator;
    line.pressure = -0.4;
    check_steps<1>(line, LatticeIndex<1>(7));
    Problem<3> space = with_all_terms(updated_problem<3>(1.2));
    space.integrator = integrator;
    space.deviatoric_stress.diagonal() << 0.4, 0.3, -0.7;
    check_steps<3>(space, {3, 2, 2});
  }
}

TEST_CASE("ul: every kernel runs in double precision, single precision and with derivatives", "[fast]") {
  for (const auto& [family, name] : Names<KernelFamily>::table) {
    INFO(name);
    Problem<2> problem = with_all_terms(updated_problem<2>());
    problem.kernel = Kernel<2>(family, 1.13 * dp);
    problem.deviatoric_stress << 0.4, 0.1, 0.1, -0.5;
    check_steps<2>(problem, {3, 3});
    UpdatedSimulation<2> simulation(problem, LatticeIndex<2>(3, 3));
    UpdatedSimulation<2, float> single(problem, LatticeIndex<2>(3, 3));
    const auto state = disturbed(simulation.base_state(), 0.05, 1);
    auto single_state = single.base_state();
    set_flat_state<2, float>(flat_state(state).cast<float>(), single_state);
    Field<2> converted;
    for (const auto& F : rates_of(single, single_state).acceleration) converted.push_back(F.cast<double>());
    // Separations of positions up to three spacings: six times 6e-8, against forces that cancel to a tenth.
    CHECK(relative_difference(converted, rates_of(simulation, state).acceleration) < 1e-5);
  }
}
