// SPDX-License-Identifier: MIT
#include "study/growth_cases.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <tuple>

#include "analysis/amplification.hpp"
#include "analysis/critical_step.hpp"
#include "study/patch_wave.hpp"
#include "study/unit_problem.hpp"
#include "study/updated_growth_run.hpp"

namespace sphstab::study {
namespace {

/// Gray's Courant number: Δt = 0.25 h/c0.
constexpr double courant_number = 0.25;
/// Pressures are ± this times ρ0 c0².
constexpr double stress = 0.05;
constexpr double gray_epsilon = 0.3, gray_xsph = 0.5;
/// E-foldings after which growth is seen, and after which slower waves are left behind.
constexpr double seen_e_foldings = 40.0, noise_e_foldings = 200.0;
constexpr long steps_of_the_stable = 2000;

/// A bar stretched along x by 5 %, its sides held, and the stress of that.
Problem<2> stretched_square() {
  constexpr double strain = 0.05;
  auto problem = unit_problem<2>(LatticeKind::square, KernelFamily::cubic_spline, 1.3, -strain, Integrator::verlet);
  problem.lattice = problem.lattice.deformed(Tensor<2>{{1.0 + strain, 0.0}, {0.0, 1.0}});
  problem.deviatoric_stress =
      2.0 * problem.material.shear_modulus() * strain * Tensor<2>{{2.0 / 3.0, 0.0}, {0.0, -1.0 / 3.0}};
  return problem;
}

/// Mean and standard error of the mean.
std::pair<double, double> mean_and_error(const std::vector<double>& values) {
  double mean = 0.0, square = 0.0;
  const auto count = static_cast<double>(values.size());
  for (const double value : values) mean += value / count;
  for (const double value : values) square += (value - mean) * (value - mean);
  return {mean, std::sqrt(square / (count * (count - 1.0)))};
}

/// At Gray's step.
template <int Dim>
std::function<GrowthCase()> growth_case(std::string name, const Problem<Dim>& problem, const LatticeIndex<Dim>& cells,
                                        const std::optional<Vector<Dim>>& wave_vector = {}) {
  const double time_step = courant_number * problem.kernel.smoothing_length();
  return [=] { return measure_growth<Dim>(name, problem, cells, time_step, wave_vector); };
}

void add_chains(std::vector<std::function<GrowthCase()>>& cases) {
  using enum KernelFamily;
  const auto add = [&](std::string_view what, KernelFamily kernel, double h, double pressure, Integrator integrator) {
    cases.push_back(growth_case<1>(fmt::format("chain, {}, h = {:g} Δp, {}: {}", name_of(kernel), h,
                                               pressure < 0.0 ? "tension" : "compression", what),
                                   unit_problem<1>(LatticeKind::chain, kernel, h, pressure, integrator),
                                   LatticeIndex<1>(24)));
  };
  add("W''(Δp) > 0, clumps", cubic_spline, 1.0, -stress, Integrator::predictor_corrector);
  add("W''(Δp) > 0, stable", cubic_spline, 1.0, stress, Integrator::leapfrog);
  add("W''(Δp) < 0, ΣW'' = 0, marginal", cubic_spline, 1.7, stress, Integrator::leapfrog);
  add("W''(Δp) < 0, clumps", quartic_spline, 2.5, stress, Integrator::verlet);
  for (const auto kernel : {quartic_spline, quintic_spline, gaussian}) {
    add("W''(Δp) < 0, ΣW'' > 0", kernel, 1.5, -stress, Integrator::predictor_corrector_pec);
    add("W''(Δp) < 0, ΣW'' > 0", kernel, 1.5, stress, Integrator::leapfrog);
  }
}

void add_lattices(std::vector<std::function<GrowthCase()>>& cases) {
  using enum LatticeKind;
  constexpr auto spline = KernelFamily::cubic_spline;
  const LatticeIndex<2> cells(8, 8);
  const auto add = [&](LatticeKind lattice, double h, double epsilon, Integrator integrator) {
    auto problem = unit_problem<2>(lattice, spline, h, -stress, integrator);
    if (epsilon > 0.0) problem = with_artificial_stress(problem, epsilon);
    cases.push_back(growth_case<2>(fmt::format("{}, h = {:g} Δp, tension, ε = {:g}", name_of(lattice), h, epsilon),
                                   problem, cells));
  };
  for (const auto lattice : {square, hexagonal, staggered}) add(lattice, 1.0, 0.0, Integrator::predictor_corrector);
  add(square, 1.0, gray_epsilon, Integrator::predictor_corrector);
  add(hexagonal, 1.0, 0.07, Integrator::leapfrog);
  add(hexagonal, 1.0, gray_epsilon, Integrator::leapfrog);
  add(staggered, 1.0, gray_epsilon, Integrator::verlet);
  add(square, 1.3, gray_epsilon, Integrator::predictor_corrector_pec);
  const double pi = std::numbers::pi;
  auto across = with_artificial_stress(unit_problem<2>(square, spline, 1.0, -stress), gray_epsilon);
  cases.push_back(growth_case<2>("square, h = 1 Δp, tension, ε = 0.3: k = (π/Δp, 0), across it", across, cells,
                                 Vector<2>(pi, 0.0)));
  across.scheme.xsph = Xsph{gray_xsph};
  cases.push_back(growth_case<2>("square, h = 1 Δp, tension, ε = 0.3, XSPH: k = (π/Δp, 0), across it", across, cells,
                                 Vector<2>(pi, 0.0)));
  cases.push_back(
      growth_case<2>("square, h = 1.3 Δp, compression", unit_problem<2>(square, spline, 1.3, stress), cells));
  auto smoothed = with_artificial_stress(unit_problem<2>(square, spline, 1.3, -stress, Integrator::predictor_corrector),
                                         gray_epsilon);
  smoothed.scheme.xsph = Xsph{gray_xsph};
  cases.push_back(growth_case<2>("square, h = 1.3 Δp, tension, ε = 0.3, XSPH", smoothed, cells));
  cases.push_back(growth_case<2>("square stretched by 5 %, h = 1.3 Δp", stretched_square(), cells));
  cases.push_back(growth_case<2>("square stretched by 5 %, h = 1.3 Δp, ε = 0.3",
                                 with_artificial_stress(stretched_square(), gray_epsilon), cells));
  cases.push_back(growth_case<3>("fcc, h = 1.3 Δp, tension", unit_problem<3>(LatticeKind::fcc, spline, 1.3, -stress),
                                 LatticeIndex<3>(4, 4, 4)));
}

/// The growth of the mode of the largest ω at zero stress.
WeakGrowthCase weak_growth(Integrator integrator, double phase) {
  const LatticeIndex<2> cells(8, 8);
  const auto problem = unit_problem<2>(LatticeKind::square, KernelFamily::cubic_spline, 1.3, 0.0, integrator);
  const auto weak = std::get<analysis::WeaklyUnstable<2>>(analysis::patch_limit(problem, cells));
  const double time_step = phase / weak.mode.omega;
  const auto wave = fastest_wave<2>(problem, cells, time_step);
  const double part = integrator == Integrator::predictor_corrector ? 8.0 : 4.0;
  return {integrator, phase, std::pow(phase, 4) / part, wave.growth_per_step(),
          seeded_growth<2>(wave, problem, cells, time_step)};
}

/// A wave that travels along a chain and decays, by theory with viscosity on approach and separation.
PatchWave<1> travelling_wave(const Problem<1>& problem, const Vector<1>& wave_vector, double time_step) {
  const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> modes(
      analysis::amplification_matrix(problem, wave_vector, time_step));
  Eigen::Index travelling = 0;
  modes.eigenvalues().imag().maxCoeff(&travelling);
  return {wave_vector, modes.eigenvectors().col(travelling), modes.eigenvalues()[travelling]};
}

/// Over four periods of a wave of 32 particles. A standing wave begins with its velocities alone.
DampingCase damping(bool is_standing, double alpha, double velocity) {
  const LatticeIndex<1> cells(32);
  constexpr double time_step = 0.1, periods = 4.0;
  auto problem = unit_problem<1>(LatticeKind::chain, KernelFamily::cubic_spline, 1.3, 0.0);
  problem.scheme.viscosity = Viscosity{.alpha = alpha, .eta = 0.1};
  auto wave = travelling_wave(problem, Vector<1>(2.0 * std::numbers::pi / cells[0]), time_step);
  const int steps = static_cast<int>(std::lround(periods * 2.0 * std::numbers::pi / std::arg(wave.eigenvalue)));
  if (is_standing) wave.shape = Eigen::VectorXcd::Unit(wave.shape.size(), 1);
  const auto decay_rate = [&](ViscousPairs pairs) {
    problem.scheme.viscosity->pairs = pairs;
    PerturbedPatch<1> patch(problem, cells);
    Eigen::VectorXd departure = velocity / std::abs(wave.shape[1]) * departure_of(wave, problem, cells);
    const double before = patch.amplitude(departure);
    patch.advance(departure, time_step, steps);
    return std::log(before / patch.amplitude(departure)) / (steps * time_step);
  };
  return {is_standing,
          alpha,
          velocity,
          -wave.growth_per_step() / time_step,
          decay_rate(ViscousPairs::all),
          decay_rate(ViscousPairs::approaching)};
}

template <int Dim>
std::function<BisectionCase()> bisection_case(std::string name, const Problem<Dim>& problem,
                                              const LatticeIndex<Dim>& cells) {
  return [=] {
    return BisectionCase{name, problem.integrator, compare_step<Dim>(problem, PeriodicPatch<Dim>{cells}, {})};
  };
}

SwitchCase at_the_switch(double fraction) {
  const LatticeIndex<2> cells(6, 6);
  const auto problem = with_artificial_stress(
      unit_problem<2>(LatticeKind::hexagonal, KernelFamily::cubic_spline, 1.0, 0.0), gray_epsilon);
  const double time_step = fraction * *theory_limit<2>(problem, PeriodicPatch<2>{cells}).critical_time_step;
  SwitchCase result{fraction, std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest(), 0};
  for (unsigned noise_seed = 1; noise_seed <= noise_runs; ++noise_seed) {
    const auto fit = UpdatedGrowthRun<2>(problem, cells, noise_seed)(time_step, steps_of_the_stable);
    result.smallest = std::min(result.smallest, fit.growth_per_step);
    result.largest = std::max(result.largest, fit.growth_per_step);
    result.growing += fit.trend == solver::Trend::growing ? 1 : 0;
  }
  return result;
}

}  // namespace

bool GrowthCase::holds() const {
  if (std::abs(seeded - theory) > seeded_tolerance) return false;
  if (!has_noise) return true;
  if (is_stable()) return growing == 0;
  const double difference = std::abs(noise_mean - theory);
  return growing == noise_runs && difference <= std::max(noise_standard_errors * noise_error, noise_floor) &&
         difference <= growth_tolerance * theory;
}

bool WeakGrowthCase::holds() const {
  const double z = phase * phase, beyond = seeded / leading_order - 1.0;
  const double next_order = integrator == Integrator::predictor_corrector ? -z * z / 8.0 : 2.0 * z;
  return std::abs(seeded - theory) <= seeded_tolerance &&
         std::abs(beyond - next_order) <= 2.0 * z * std::abs(next_order);
}

template <int Dim>
GrowthCase measure_growth(std::string name, const Problem<Dim>& problem, const LatticeIndex<Dim>& cells,
                          double time_step, const std::optional<Vector<Dim>>& wave_vector) {
  const auto wave =
      wave_vector ? fastest_wave<Dim>(problem, *wave_vector, time_step) : fastest_wave<Dim>(problem, cells, time_step);
  const double theory = wave.growth_per_step();
  GrowthCase result{.name = std::move(name),
                    .integrator = problem.integrator,
                    .time_step = time_step,
                    .theory = theory,
                    .seeded = seeded_growth<Dim>(wave, problem, cells, time_step),
                    .has_noise = !wave_vector,
                    .noise_mean = 0.0,
                    .noise_error = 0.0,
                    .growing = 0};
  if (wave_vector) return result;
  std::vector<double> growths;
  for (unsigned noise_seed = 1; noise_seed <= noise_runs; ++noise_seed) {
    const long watched = result.is_stable() ? steps_of_the_stable : std::lround(seen_e_foldings / theory);
    const auto fit = PerturbationRun(perturbed_solver(problem, cells), noise_seed)(time_step, watched);
    result.growing += fit.trend == solver::Trend::growing ? 1 : 0;
    if (!result.is_stable())
      growths.push_back(
          noise_growth<Dim>(problem, cells, noise_seed, time_step, std::lround(noise_e_foldings / theory)));
  }
  if (!result.is_stable()) std::tie(result.noise_mean, result.noise_error) = mean_and_error(growths);
  return result;
}

std::vector<std::function<GrowthCase()>> growth_cases() {
  std::vector<std::function<GrowthCase()>> cases;
  add_chains(cases);
  add_lattices(cases);
  return cases;
}

std::vector<std::function<WeakGrowthCase()>> weak_growth_cases() {
  std::vector<std::function<WeakGrowthCase()>> cases;
  for (const auto integrator : {Integrator::predictor_corrector, Integrator::predictor_corrector_pec})
    for (const double phase : {0.4, 0.3, 0.2}) cases.push_back([=] { return weak_growth(integrator, phase); });
  return cases;
}

std::vector<std::function<BisectionCase()>> bisection_cases() {
  constexpr auto spline = KernelFamily::cubic_spline;
  std::vector<std::function<BisectionCase()>> cases;
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet}) {
    for (const auto lattice : lattices_of(2))
      cases.push_back(bisection_case<2>(fmt::format("{}, h = 1.3 Δp, no stress", name_of(lattice)),
                                        unit_problem<2>(lattice, spline, 1.3, 0.0, integrator), {8, 8}));
    cases.push_back(bisection_case<1>("chain, h = 1 Δp, compression",
                                      unit_problem<1>(LatticeKind::chain, spline, 1.0, stress, integrator),
                                      LatticeIndex<1>(24)));
    cases.push_back(bisection_case<2>("hexagonal, h = 1 Δp, compression",
                                      unit_problem<2>(LatticeKind::hexagonal, spline, 1.0, stress, integrator),
                                      {8, 8}));
    const auto cured =
        with_artificial_stress(unit_problem<2>(LatticeKind::hexagonal, spline, 1.0, -stress, integrator), gray_epsilon);
    cases.push_back(bisection_case<2>("hexagonal, h = 1 Δp, tension, ε = 0.3", cured, {8, 8}));
    auto smoothed = cured;
    smoothed.scheme.xsph = Xsph{gray_xsph};
    cases.push_back(bisection_case<2>("hexagonal, h = 1 Δp, tension, ε = 0.3, XSPH", smoothed, {8, 8}));
    cases.push_back(bisection_case<3>("fcc, h = 1.3 Δp, no stress",
                                      unit_problem<3>(LatticeKind::fcc, spline, 1.3, 0.0, integrator), {4, 4, 4}));
  }
  for (const auto& [integrator, name] : Names<Integrator>::table) {
    auto chain = unit_problem<1>(LatticeKind::chain, spline, 1.3, 0.0, integrator);
    chain.scheme.viscosity = Viscosity{.alpha = 0.5, .eta = 0.1};
    cases.push_back(bisection_case<1>("chain, h = 1.3 Δp, no stress, α = 0.5", chain, LatticeIndex<1>(16)));
    auto square = unit_problem<2>(LatticeKind::square, spline, 1.3, 0.0, integrator);
    square.scheme.viscosity = chain.scheme.viscosity;
    cases.push_back(bisection_case<2>("square, h = 1.3 Δp, no stress, α = 0.5", square, {3, 3}));
  }
  return cases;
}

std::vector<std::function<DampingCase()>> damping_cases() {
  constexpr double small = 1e-6, weak = 0.1;
  std::vector<std::function<DampingCase()>> cases;
  for (const bool is_standing : {true, false})
    for (const double alpha : {0.5, weak, 0.02}) cases.push_back([=] { return damping(is_standing, alpha, small); });
  for (const double velocity : {1e-8, 1e-4, 1e-3, 1e-2}) cases.push_back([=] { return damping(true, weak, velocity); });
  return cases;
}

std::vector<std::function<SwitchCase()>> switch_cases() {
  std::vector<std::function<SwitchCase()>> cases;
  for (const double fraction : {0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.99})
    cases.push_back([=] { return at_the_switch(fraction); });
  return cases;
}

template GrowthCase measure_growth(std::string, const Problem<1>&, const LatticeIndex<1>&, double,
                                   const std::optional<Vector<1>>&);
template GrowthCase measure_growth(std::string, const Problem<2>&, const LatticeIndex<2>&, double,
                                   const std::optional<Vector<2>>&);
template GrowthCase measure_growth(std::string, const Problem<3>&, const LatticeIndex<3>&, double,
                                   const std::optional<Vector<3>>&);

}  // namespace sphstab::study
