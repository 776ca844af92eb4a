// SPDX-License-Identifier: MIT
// The thresholds of the verdicts that rungs 5 and 6 rest on: each is as tight as it has to be.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "ladder/cases.hpp"
#include "solver/growth.hpp"
#include "study/step_comparison.hpp"

using namespace sphstab;
using solver::Trend;

namespace {

/// ln(e^{an} + part · e^{bn}): a slower mode that a faster one overtakes.
solver::GrowthFit judge_two_modes(double slow, double fast, double part) {
  std::vector<double> log_amplitude;
  for (int n = 0; n <= 3000; ++n) log_amplitude.push_back(std::log(std::exp(slow * n) + part * std::exp(fast * n)));
  return solver::judge_growth(log_amplitude);
}

}  // namespace

TEST_CASE("while a faster mode overtakes a slower one the growth is not judged, before and after it is", "[ladder]") {
  // The faster mode overtakes at n = ln(1/part) / (fast − slow).
  constexpr double slow = 0.003, fast = 0.006;
  const auto before = judge_two_modes(slow, fast, std::exp(-0.003 * 6000));
  CHECK(before.trend == Trend::growing);
  CHECK(before.growth_per_step == Approx(slow).epsilon(1e-2));
  const auto amid = judge_two_modes(slow, fast, std::exp(-0.003 * 2000));
  CHECK(amid.disagreement > 0.2);
  CHECK(amid.trend == Trend::undecided);
  const auto after = judge_two_modes(slow, fast, std::exp(0.003 * 1000));
  CHECK(after.trend == Trend::growing);
  CHECK(after.growth_per_step == Approx(fast).epsilon(1e-2));
}

TEST_CASE("algebraic growth of any order is not taken for exponential growth", "[ladder]") {
  for (const double order : {1.0, 2.0, 3.0, 5.0, 9.0})
    for (const double start : {1.0, 300.0, 1000.0}) {
      INFO("(n + " << start << ")^" << order);
      std::vector<double> log_amplitude;
      for (int n = 0; n <= 3000; ++n) log_amplitude.push_back(order * std::log(n + start));
      CHECK(solver::judge_growth(log_amplitude).trend != Trend::growing);
    }
}

TEST_CASE("the law of growth knows both ways to leave the unit circle, so that few runs find the exit", "[ladder]") {
  // Weakly damped modes leave the circle alone, at −1, with growth that is linear just above the limit and like a
  // square root soon after. Halving a bracket of 20 % to 1e-6 takes 18 runs besides the scan.
  constexpr int enough_runs = 22;
  for (const double damping : {0.0, 0.02, 0.05, 0.4})
    for (const auto& [integrator, integrator_name] : total_lagrangian_integrators) {
      INFO("damping " << damping << " " << integrator_name);
      auto problem = ladder::basic_problem<1>(LatticeKind::chain, KernelFamily::cubic_spline, 1.2);
      problem.integrator = integrator;
      if (damping > 0.0) problem.scheme.damping = Damping{damping};
      const auto found = study::compare_step<1>(problem, study::PeriodicPatch<1>{LatticeIndex<1>(8)}, {});
      CHECK(found.agrees(1e-6));
      CHECK(found.run.runs <= enough_runs);
    }
}
