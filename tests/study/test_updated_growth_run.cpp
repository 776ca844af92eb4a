// SPDX-License-Identifier: MIT
#include "study/updated_growth_run.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "analysis/amplification.hpp"
#include "analysis/critical_step.hpp"
#include "solver/growth.hpp"
#include "study/patch_wave.hpp"
#include "study/step_comparison.hpp"
#include "tests/analysis/updated_problems.hpp"

using namespace sphstab;
using namespace sphstab::study;
using solver::Trend;

namespace {

Problem<2> square(double pressure, Integrator integrator = Integrator::leapfrog) {
  auto problem = updated_problem<2>(LatticeKind::square, KernelFamily::cubic_spline, 1.3, 0.3, pressure);
  problem.integrator = integrator;
  return problem;
}

Problem<1> chain(double pressure, double h, Integrator integrator = Integrator::leapfrog) {
  auto problem = updated_problem<1>(LatticeKind::chain, KernelFamily::cubic_spline, h, 0.3, pressure);
  problem.integrator = integrator;
  return problem;
}

/// Velocities (−1)ⁱ along x on every particle, which strain nothing.
template <int Dim>
Eigen::VectorXd alternating(const PerturbedPatch<Dim>& patch, int period) {
  const int size = patch.numbers_per_particle();
  Eigen::VectorXd departure = Eigen::VectorXd::Zero(size * patch.particles());
  for (int a = 0; a < patch.particles(); ++a) departure[size * a + Dim] = a / period % 2 == 0 ? 1e-9 : -1e-9;
  return departure;
}

/// ln of the amplitude after every step.
template <int Dim>
std::vector<double> course(PerturbedPatch<Dim>& patch, Eigen::VectorXd departure, double time_step, int steps) {
  std::vector<double> log_amplitude{std::log(patch.amplitude(departure))};
  for (int i = 0; i < steps; ++i) {
    patch.advance(departure, time_step, 1);
    log_amplitude.push_back(std::log(patch.amplitude(departure)));
  }
  return log_amplitude;
}

std::string complaint(const Problem<2>& problem, const BodyChoice<2>& choice = PeriodicPatch<2>{{4, 4}}) {
  try {
    compare_step<2>(problem, choice, {});
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

TEST_CASE("the amplitude of a wave at zero stress is its energy: it stays, in short steps", "[fast]") {
  // Leapfrog conserves an energy that differs from it by O(ωΔt).
  const auto problem = square(0.0, Integrator::verlet);
  PerturbedPatch<2> patch(problem, {6, 6});
  for (const double time_step : {0.02, 0.01}) {
    const auto log_amplitude = course(patch, patch.noise_departure(3) * 1e-9, time_step, 400);
    for (const double amplitude : log_amplitude)
      CHECK(std::abs(amplitude - log_amplitude.front()) < time_step * time_step);
  }
}

TEST_CASE("amplitudes are velocities in units of c_p, and densities and stresses of the same energy", "[fast]") {
  const auto problem = square(0.0);
  const double c_p = std::sqrt(1.0 + 0.3 * 4.0 / 3.0);
  PerturbedPatch<2> patch(problem, {3, 2});
  const int size = patch.numbers_per_particle();
  REQUIRE(size == 8);
  const auto amplitude_of = [&](int number, double value) {
    Eigen::VectorXd departure = Eigen::VectorXd::Zero(size * patch.particles());
    for (int a = 0; a < patch.particles(); ++a) departure[size * a + number] = value;
    return patch.amplitude(departure) * c_p;
  };
  CHECK(amplitude_of(0, 0.1) == 0.0);
  CHECK(amplitude_of(3, 0.1) == Approx(0.1));
  CHECK(amplitude_of(4, 0.1) == Approx(0.1));                          // c0 δρ/ρ
  CHECK(amplitude_of(7, 0.1) == Approx(std::sqrt(2.0 * 0.01 / 0.6)));  // |S|²/2μ
  CHECK(amplitude_of(5, 0.1) == Approx(std::sqrt(2.0 * 0.01 / 0.6)));  // S_zz = −S_xx
}

TEST_CASE("the drift of zero-energy modes is no growth: its amplitude stays to the last digits", "[fast]") {
  PerturbedPatch<2> patch(square(0.0), {4, 4});
  const auto log_amplitude = course(patch, alternating(patch, 1), 0.5, 2000);
  CHECK(std::abs(log_amplitude.back() - log_amplitude.front()) < 1e-6);
  CHECK(solver::judge_growth(log_amplitude).trend == Trend::bounded);
}

TEST_CASE("a wave whose stiffness vanishes is accelerated by a constant stress, and that is no growth", "[fast]") {
  // Two rows of a chain in tension: A(k) ≠ 0, and ω² = c² A² + (2σ/ρ)(A² − B) = 0 by choice of σ < 0 there.
  const LatticeIndex<1> cells(5);
  auto problem = chain(0.0, 1.3);
  const auto wave_vector = analysis::patch_wave_vectors<1>(problem.lattice, cells)[2];
  const auto stiffness = [&](double pressure) {
    problem.pressure = pressure;
    return analysis::dynamical_matrix<1>(problem, wave_vector)(0, 0);
  };
  double low = -0.9, high = 0.0;
  REQUIRE(stiffness(low) * stiffness(high) < 0.0);
  for (int i = 0; i < 100; ++i)
    (stiffness(0.5 * (low + high)) * stiffness(high) < 0.0 ? low : high) = 0.5 * (low + high);
  PerturbedPatch<1> patch(problem, cells);
  Eigen::VectorXd departure = Eigen::VectorXd::Zero(4 * patch.particles());
  for (int a = 0; a < patch.particles(); ++a) departure[4 * a + 2] = 1e-12 * std::sin(wave_vector[0] * a);
  const auto log_amplitude = course(patch, departure, 0.3, 3000);
  CHECK(log_amplitude.back() - log_amplitude.front() > std::log(100.0));  // it does rise
  CHECK(solver::judge_growth(log_amplitude).trend != Trend::growing);
}

TEST_CASE("clumping, which strains nothing, is seen", "[fast]") {
  // k = π/Δp of a chain in tension: A = 0, growth √(8 W''(Δp) σ/ρ̄).
  const auto problem = chain(-0.05, 1.0);
  PerturbedPatch<1> patch(problem, LatticeIndex<1>(4));
  const double rate = std::sqrt(8.0 * problem.kernel.curvature(1.0) * 0.05 / 0.95);
  const auto log_amplitude = course(patch, alternating(patch, 1), 0.05 / rate, 200);
  const auto fit = solver::judge_growth(log_amplitude);
  CHECK(fit.trend == Trend::growing);
  CHECK(2.0 * std::sinh(0.5 * fit.growth_per_step) == Approx(0.05).epsilon(1e-4));
}

TEST_CASE("a run may see forty e-foldings, though its departure stays small", "[fast]") {
  const auto problem = square(-0.05);
  const LatticeIndex<2> cells(6, 6);
  constexpr double time_step = 0.3;
  const double theory = fastest_wave<2>(problem, cells, time_step).growth_per_step();
  UpdatedGrowthRun<2> run(problem, cells, 1);
  const auto steps = std::lround(100.0 / theory);
  const auto first = run(time_step, steps), second = run(time_step, steps);
  CHECK(static_cast<double>(first.steps) * theory > 20.0);
  CHECK(second.growth_per_step == Approx(theory).epsilon(1e-4));
}

TEST_CASE("the same noise gives the same run of ul", "[fast]") {
  const auto problem = square(-0.05, Integrator::predictor_corrector_pec);
  const auto growth = [&](unsigned noise_seed) {
    return UpdatedGrowthRun<2>(problem, {4, 4}, noise_seed)(0.3, 400).growth_per_step;
  };
  CHECK(growth(1) == growth(1));
  CHECK(growth(1) != growth(2));
}

TEST_CASE("a step far beyond the limit counts as growth, wherever its particles are thrown", "[fast]") {
  const auto problem = square(0.0);
  for (const double time_step : {5.0, 50.0}) {
    const auto fit = UpdatedGrowthRun<2>(problem, {4, 4}, 1)(time_step, 20000);
    CHECK(fit.trend == Trend::growing);
    CHECK(fit.growth_per_step > 0.0);
  }
}

TEST_CASE("one cell has no perturbation", "[fast]") {
  CHECK_THROWS_WITH(UpdatedGrowthRun<2>(square(0.0), {1, 1}, 1), Catch::StartsWith("patch: one cell"));
}

TEST_CASE("compare_step of ul knows every verdict", "[fast]") {
  const PeriodicPatch<2> patch{{5, 4}};
  const auto stable = compare_step<2>(square(0.0), patch, {.tolerance = 1e-4});
  CHECK(stable.theory.critical_time_step);
  CHECK_FALSE(stable.growth);
  CHECK(stable.agrees(1e-4));

  const auto never = compare_step<2>(square(-0.05), patch, {});
  CHECK(never.theory.growth_rate);
  REQUIRE(never.growth);
  CHECK(never.agrees(1e-6));

  const auto weak = compare_step<2>(square(0.0, Integrator::predictor_corrector), patch, {});
  CHECK_FALSE(weak.theory.growth_rate);
  REQUIRE(weak.growth);
  CHECK(weak.agrees(1e-6));
  // |λ|² = 1 + (ωΔt)⁴/4 at ωΔt = 1.
  CHECK(weak.growth->theory == Approx(0.5 * std::log(1.25)).epsilon(1e-9));
  CHECK(weak.growth->measured == Approx(weak.growth->theory).epsilon(growth_tolerance));

  const auto none = compare_step<2>(square(0.0), PeriodicPatch<2>{{2, 2}}, {});
  CHECK_FALSE(none.theory.critical_time_step);
  CHECK_FALSE(none.growth);
  CHECK(none.agrees(1e-6));
}

TEST_CASE("a growth that differs from theory does not agree", "[fast]") {
  StepComparison found{};
  found.growth = GrowthComparison{.time_step = 0.3, .measured = 0.0503, .theory = 0.05};
  CHECK(*found.relative_difference() == Approx(0.006));
  CHECK_FALSE(found.agrees(1.0));
  found.growth->measured = 0.0502;
  CHECK(found.agrees(1e-9));
  found.run.low = 0.3;  // it did not grow
  CHECK_FALSE(found.agrees(1e-9));
}

TEST_CASE("runs of ul start from the mode of E as well as from noise", "[fast]") {
  for (const double pressure : {0.0, -0.05}) {
    const PeriodicPatch<2> patch{{5, 4}};
    const auto found = compare_step<2>(square(pressure), patch, {.start_from_mode = true, .tolerance = 1e-6});
    CHECK(found.agrees(1e-6));
    if (found.growth) CHECK(*found.relative_difference() < 1e-6);
  }
}

TEST_CASE("what has no theory is not compared", "[fast]") {
  const auto frozen = [] {
    auto problem = square(-0.05);
    problem.scheme.artificial_stress =
        ArtificialStress{.epsilon = 0.3, .linearisation = ArtificialStressLinearisation::frozen};
    return problem;
  };
  CHECK_THAT(complaint(frozen()), Catch::StartsWith("artificial_stress_linearisation: "));
  auto at_switch = square(0.0);
  at_switch.scheme.artificial_stress = ArtificialStress{.epsilon = 0.3};
  CHECK_THAT(complaint(at_switch), Catch::StartsWith("artificial_stress_epsilon: a principal stress is 0"));
  auto one_sided = square(0.0);
  one_sided.scheme.viscosity = Viscosity{.alpha = 0.3, .eta = 0.1, .pairs = ViscousPairs::approaching};
  CHECK_THAT(complaint(one_sided), Catch::StartsWith("viscosity_pairs: "));
  CHECK_THAT(complaint(square(0.0), periodic_patch<2>(square(0.0), {4, 4})), Catch::Contains("bisect takes a patch"));
}
