// SPDX-License-Identifier: MIT
#include "study/updated_hard_cases.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>
#include <numbers>

#include "analysis/critical_step.hpp"
#include "study/patch_wave.hpp"
#include "study/step_comparison.hpp"
#include "study/unit_problem.hpp"
#include "study/updated_growth_run.hpp"

namespace sphstab::study {
namespace {

using MakeCase = std::function<HardCase()>;

constexpr double stress = 0.05;
/// Sums of a few dozen terms and an eigenvalue of two rows.
constexpr double rounding = 1e-12;
/// Growth is measured at this growth a step, from noise whose slower waves leave so much of it.
constexpr double growth_per_step = 0.05, growth_tolerance = 2e-4;
constexpr long growing_steps = 800;
/// Where nothing is to grow the leapfrog takes this step, and rounding is what may be left of the rate.
constexpr double some_step = 0.3;
constexpr long stable_steps = 2000;

constexpr std::string_view zero_energy_form = "2κσ eig(εf − B)/ρ̄ where A = 0, sums written out";

/// Gray's lattice sums, neighbour by neighbour; f by Z = W^{n+1}/((n+1) W(Δp)ⁿ), φ∇W = ∇Z.
template <int Dim>
struct Sums {
  Vector<Dim> A = Vector<Dim>::Zero();
  Tensor<Dim> B = Tensor<Dim>::Zero(), f = Tensor<Dim>::Zero();
  double w = 0.0;

  Sums(const Problem<Dim>& problem, const Vector<Dim>& k) {
    const auto& kernel = problem.kernel;
    const double V = problem.lattice.cell_volume(), at_spacing = kernel.value(problem.lattice.spacing());
    constexpr double n = 4.0;
    for (const auto& d : lattice_neighbours(problem.lattice, kernel.support(), NeighbourRule::support)) {
      const double distance = d.distance;
      const Vector<Dim> e = d.position / distance;
      const Tensor<Dim> along = e * e.transpose(), across = Tensor<Dim>::Identity() - along;
      const double phase = k.dot(d.position), weight = V * (1.0 - std::cos(phase));
      const double W = kernel.value(distance), slope = kernel.slope(distance), curvature = kernel.curvature(distance);
      const double phi = std::pow(W / at_spacing, n);
      A += V * std::sin(phase) * slope * e;
      B += weight * (curvature * along + slope / distance * across);
      w += weight * W;
      f += weight * phi * ((n * slope * slope / W + curvature) * along + slope / distance * across);
    }
  }
};

/// The fastest growth of the zero-energy modes of a patch of two cells an axis, or of two along the first only, in
/// isotropic stress σ: ρ̄ω² = 2κσ eig(εf − B), ε in tension only.
template <int Dim>
double zero_energy_growth(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells) {
  const double sigma = -problem.pressure, density = 1.0 + problem.pressure;
  const auto& artificial = problem.scheme.artificial_stress;
  const double epsilon = artificial && sigma > 0.0 ? artificial->epsilon : 0.0;
  double growth = 0.0;
  for (const auto& k : analysis::patch_wave_vectors<Dim>(problem.lattice, cells)) {
    const Sums<Dim> sums(problem, k);
    const double kappa = 1.0 - (problem.scheme.xsph ? problem.scheme.xsph->epsilon : 0.0) * sums.w;
    const Tensor<Dim> M = 2.0 * kappa * sigma / density * (epsilon * sums.f - sums.B);
    const Vector<Dim> omega_squared = M.template selfadjointView<Eigen::Lower>().eigenvalues();
    growth = std::max(growth, std::sqrt(std::max(0.0, -omega_squared.minCoeff())));
  }
  return growth;
}

/// √(−ω²) of a run by leapfrog, where e^g + e^−g − 2 = −ω²Δt²; 0 if it does not grow.
template <int Dim>
double measured_growth(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells, double expected) {
  const double time_step = expected > 0.0 ? growth_per_step / expected : some_step;
  const long steps = expected > 0.0 ? growing_steps : stable_steps;
  UpdatedGrowthRun<Dim> run(problem, cells, 1);
  run(time_step, steps);
  const auto fit = run(time_step, steps);
  return fit.trend == solver::Trend::growing ? 2.0 * std::sinh(0.5 * fit.growth_per_step) / time_step : 0.0;
}

template <int Dim>
MakeCase growth_case(std::string name, const Problem<Dim>& problem, const LatticeIndex<Dim>& cells,
                     std::string_view expected_from, double expected, double theory_tolerance = rounding) {
  return [=] {
    return HardCase{.name = name + ": growth rate",
                    .expected_from = expected_from,
                    .expected = expected,
                    .theory = theory_limit<Dim>(problem, PeriodicPatch<Dim>{cells}).growth_rate.value_or(0.0),
                    .theory_tolerance = theory_tolerance,
                    .run = measured_growth<Dim>(problem, cells, expected),
                    .run_tolerance = growth_tolerance};
  };
}

template <int Dim>
MakeCase zero_energy_case(std::string name, const Problem<Dim>& problem, const LatticeIndex<Dim>& cells) {
  return growth_case<Dim>(std::move(name), problem, cells, zero_energy_form, zero_energy_growth<Dim>(problem, cells));
}

/// A critical step and where it is expected from.
template <int Dim>
MakeCase step_case(std::string name, const Problem<Dim>& problem, const LatticeIndex<Dim>& cells,
                   std::string_view expected_from, double expected, double theory_tolerance) {
  return [=] {
    const auto found = compare_step<Dim>(problem, PeriodicPatch<Dim>{cells}, {});
    return HardCase{.name = name + ": critical step",
                    .expected_from = expected_from,
                    .expected = expected,
                    .theory = found.theory.critical_time_step.value_or(0.0),
                    .theory_tolerance = theory_tolerance,
                    .run = found.run.critical_time_step.value_or(0.0)};
  };
}

template <int Dim>
double critical_step(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells) {
  return theory_limit<Dim>(problem, PeriodicPatch<Dim>{cells}).critical_time_step.value_or(0.0);
}

const LatticeIndex<1> two_cells(2);

std::vector<MakeCase> marginal_states() {
  struct State {
    KernelFamily kernel;
    double h;
    std::string_view reason;
  };
  // W'' of the cubic spline is made of straight lines, whose sum cancels for 1.5 ≤ h/Δp ≤ 2.5.
  constexpr std::string_view sum = "ΣW'' over odd neighbours = 0", curvature = "W''(Δp) = 0";
  constexpr std::array<State, 5> states{{{KernelFamily::cubic_spline, 1.5, curvature},
                                         {KernelFamily::wendland_c2, 1.5, curvature},
                                         {KernelFamily::cubic_spline, 1.7, sum},
                                         {KernelFamily::cubic_spline, 2.0, sum},
                                         {KernelFamily::quintic_spline, 2.0, sum}}};
  std::vector<MakeCase> cases;
  for (const auto& [kernel, h, reason] : states)
    for (const double pressure : {-stress, stress})
      cases.push_back(growth_case<1>(
          fmt::format("{}, h = {:g} Δp, {}", name_of(kernel), h, pressure < 0.0 ? "tension" : "compression"),
          unit_problem<1>(LatticeKind::chain, kernel, h, pressure), two_cells, reason, 0.0));
  for (const double off : {-1e-3, 1e-3})
    for (const double pressure : {-stress, stress}) {
      const auto problem = unit_problem<1>(LatticeKind::chain, KernelFamily::wendland_c2, 1.5 * (1.0 + off), pressure);
      // W'' is a thousandth of its size there.
      cases.push_back(growth_case<1>(
          fmt::format("wendland-c2, h = 1.5 Δp {:+g}, {}", 1.5 * off, pressure < 0.0 ? "tension" : "compression"),
          problem, two_cells, zero_energy_form, zero_energy_growth<1>(problem, two_cells), rounding / std::abs(off)));
    }
  return cases;
}

std::vector<MakeCase> isotropic_stress() {
  constexpr auto spline = KernelFamily::cubic_spline;
  std::vector<MakeCase> cases;
  cases.push_back(zero_energy_case<2>(
      "square, tension, ε = 0.3",
      with_artificial_stress(unit_problem<2>(LatticeKind::square, spline, 1.0, -stress), 0.3), {2, 2}));
  cases.push_back(zero_energy_case<2>(
      "hexagonal, tension, ε = 0.05",
      with_artificial_stress(unit_problem<2>(LatticeKind::hexagonal, spline, 1.0, -stress), 0.05), {2, 2}));
  cases.push_back(
      zero_energy_case<3>("cubic, tension", unit_problem<3>(LatticeKind::cubic, spline, 1.0, -stress), {2, 2, 2}));
  // Where principal stresses are equal, so are the slopes of their positive parts.
  const LatticeIndex<2> cells(4, 4);
  const auto hexagonal = with_artificial_stress(unit_problem<2>(LatticeKind::hexagonal, spline, 1.0, -stress), 0.3);
  constexpr double part = 1e-9;
  auto parted = hexagonal;
  parted.deviatoric_stress = Tensor<2>{{part, 0.5 * part}, {0.5 * part, -part}};
  cases.push_back(step_case<2>("hexagonal, tension, ε = 0.3", hexagonal, cells, "principal stresses 2e-9 apart",
                               critical_step<2>(parted, cells), part / stress));
  return cases;
}

/// Hexagonal with ε = 0.3, which is stable on both sides of zero stress.
std::vector<MakeCase> sign_switch() {
  const LatticeIndex<2> cells(4, 4);
  constexpr double hair = 1e-4;
  std::vector<MakeCase> cases;
  for (const auto side : {ZeroStressSide::compression, ZeroStressSide::tension}) {
    auto at_zero =
        with_artificial_stress(unit_problem<2>(LatticeKind::hexagonal, KernelFamily::cubic_spline, 1.0, 0.0), 0.3);
    at_zero.scheme.artificial_stress->zero_side = side;
    auto beside = at_zero;
    beside.pressure = side == ZeroStressSide::compression ? hair : -hair;
    cases.push_back(step_case<2>(
        fmt::format("pressure {:g}, ε = 0.3", beside.pressure), beside, cells,
        side == ZeroStressSide::compression ? "zero stress, side of compression" : "zero stress, side of tension",
        critical_step<2>(at_zero, cells), 5.0 * hair));
  }
  return cases;
}

/// |Re √(−ω²)| of a complex pair ω² of two rows.
double flutter_growth(const Tensor<2>& M) {
  const double mean = 0.5 * M.trace();
  const std::complex<double> omega_squared(mean, std::sqrt(M.determinant() - mean * mean));
  return std::abs(std::sqrt(-omega_squared).real());
}

/// M of theory.md §3 without artificial stress and XSPH.
Tensor<2> dynamical_matrix(const Problem<2>& problem, const Vector<2>& k) {
  const Sums<2> sums(problem, k);
  const Vector<2>& A = sums.A;
  const Tensor<2> S = problem.deviatoric_stress, sigma = S - problem.pressure * Tensor<2>::Identity();
  const double density = 1.0 + problem.pressure;
  Tensor<2> M = -2.0 / density * sigma * sums.B;
  for (int column = 0; column < 2; ++column) {
    const Vector<2> X = Vector<2>::Unit(column);
    const Tensor<2> spin = 0.5 * (X * A.transpose() - A * X.transpose());
    M.col(column) += A * A.dot(X) + 2.0 / density * sigma * A * A.dot(X) +
                     problem.material.shear_modulus() / density * (A.squaredNorm() * X + A * A.dot(X) / 3.0) +
                     (spin * S - S * spin) * A / density;
  }
  return M;
}

/// Theory and run at one short step, both as growth per time of that step.
MakeCase flutter_case(std::string name, const Problem<2>& problem, const LatticeIndex<2>& cells,
                      std::string_view expected_from, double expected, double theory_tolerance) {
  return [=] {
    constexpr double time_step = 0.1;
    const auto wave = fastest_wave<2>(problem, cells, time_step);
    return HardCase{.name = name + ": growth rate",
                    .expected_from = expected_from,
                    .expected = expected,
                    .theory = wave.growth_per_step() / time_step,
                    .theory_tolerance = theory_tolerance,
                    .run = seeded_growth<2>(wave, problem, cells, time_step) / time_step,
                    .run_tolerance = growth_tolerance};
  };
}

std::vector<MakeCase> flutter() {
  std::vector<MakeCase> cases;
  auto staggered =
      with_artificial_stress(unit_problem<2>(LatticeKind::staggered, KernelFamily::cubic_spline, 1.2, -stress), 0.5);
  staggered.scheme.xsph = Xsph{0.5};
  // Two digits are known of it; the patch admits its wave vector (0.4, 17/15) π.
  cases.push_back(flutter_case("isotropic tension, staggered, h = 1.2 Δp, ε = 0.5, XSPH", staggered, {5, 3},
                               "Jacobian of another implementation", 0.0064, 1e-2));
  auto square = unit_problem<2>(LatticeKind::square, KernelFamily::cubic_spline, 1.0, 0.09);
  square.deviatoric_stress = Tensor<2>{{-0.05, -0.08}, {-0.08, 0.05}};
  const Vector<2> k = 2.0 * std::numbers::pi * Vector<2>(0.2, 0.6);
  // The step of 0.1 makes the rate (1 + |ω|²Δt²/24 …) times itself.
  cases.push_back(flutter_case("anisotropic stress, square, h = Δp", square, {5, 5}, "M of theory.md, written out",
                               flutter_growth(dynamical_matrix(square, k)), 2e-3));
  return cases;
}

/// XSPH so strong that 1 − β < 0 at k = π/Δp.
std::vector<MakeCase> inverted_smoothing() {
  std::vector<MakeCase> cases;
  for (const double pressure : {-stress, stress}) {
    auto problem = unit_problem<1>(LatticeKind::chain, KernelFamily::cubic_spline, 1.0, pressure);
    problem.scheme.xsph = Xsph{3.0};
    const std::string name = fmt::format("XSPH 3, chain, {}", pressure < 0.0 ? "tension" : "compression");
    if (pressure > 0.0) {
      cases.push_back(zero_energy_case<1>(name, problem, two_cells));
    } else {
      const Sums<1> sums(problem, Vector<1>(std::numbers::pi));
      const double omega_squared = (3.0 * sums.w - 1.0) * 2.0 * stress / (1.0 - stress) * sums.B(0, 0);
      cases.push_back(
          step_case<1>(name, problem, two_cells, "2/ω, ω² = (1 − β) M", 2.0 / std::sqrt(omega_squared), rounding));
    }
  }
  return cases;
}

std::vector<MakeCase> driven_by_artificial_stress() {
  std::vector<MakeCase> cases;
  const LatticeIndex<2> along_x(2, 1);
  auto square =
      with_artificial_stress(unit_problem<2>(LatticeKind::square, KernelFamily::cubic_spline, 1.0, -stress), 0.3);
  cases.push_back(zero_energy_case<2>("square, k = (π/Δp, 0), ε = 0.3", square, along_x));
  square.scheme.xsph = Xsph{0.5};
  cases.push_back(zero_energy_case<2>("square, k = (π/Δp, 0), ε = 0.3, XSPH", square, along_x));
  return cases;
}

}  // namespace

std::vector<HardCaseGroup> updated_hard_cases() {
  return {{"ul: marginal states", marginal_states()},
          {"ul: isotropic stress", isotropic_stress()},
          {"ul: sign switch", sign_switch()},
          {"ul: complex ω²", flutter()},
          {"ul: inverted smoothing", inverted_smoothing()},
          {"ul: driven by artificial stress", driven_by_artificial_stress()}};
}

}  // namespace sphstab::study
