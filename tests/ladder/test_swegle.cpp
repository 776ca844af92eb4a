// SPDX-License-Identifier: MIT
// Swegle, Hicks and Attaway's setting: a pre-stressed chain. Their criterion W''(Δx) σ > 0 is that of kernels which
// move with the particles; the total-Lagrangian scheme has its kernels in the reference state.
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "analysis/critical_step.hpp"
#include "analysis/gradient_symbol.hpp"
#include "analysis/lattice_sums.hpp"
#include "ladder/cases.hpp"
#include "solver/bloch.hpp"
#include "study/growth_run.hpp"
#include "study/step_comparison.hpp"

using namespace sphstab;

namespace {

constexpr double pi = std::numbers::pi;
/// A dozen roundings of the closed form.
constexpr double rounding = 1e-13;
/// Rung 5, per step.
constexpr double growth_tolerance = 1e-5;
const LatticeIndex<1> cells(30);

struct Setting {
  KernelFamily kernel;
  double h_over_spacing;
};
/// W''(Δx) has either sign among them.
constexpr std::array<Setting, 5> settings{{{KernelFamily::cubic_spline, 1.2},
                                           {KernelFamily::cubic_spline, 1.8},
                                           {KernelFamily::quintic_spline, 1.0},
                                           {KernelFamily::quintic_spline, 1.5},
                                           {KernelFamily::wendland_c2, 1.31}}};

/// A chain with the density of Eq. 6 in which SPH sees the strain `strain`.
Problem<1> strained_chain(const Setting& setting, double strain) {
  auto problem = ladder::basic_problem<1>(LatticeKind::chain, setting.kernel, setting.h_over_spacing);
  problem.scheme.momentum_density = MomentumDensity::equation_of_state;
  problem.displacement_gradient = strain * ladder::consistency(problem).inverse();
  return problem;
}

double p_wave_speed(const Problem<1>& problem) {
  return std::sqrt(problem.material.lame(problem.plane).p_wave_modulus() / problem.material.density());
}

/// ω² = c_p² (1 + 2e) exp(2e) D²: Eq. 8 gives σ = (γ + 2G) e, Eq. 6 exp(2e)/ρ0² for 1/ρ².
double omega_squared(const Problem<1>& problem, double strain, double D) {
  const double c_p = p_wave_speed(problem);
  return c_p * c_p * (1.0 + 2.0 * strain) * std::exp(2.0 * strain) * D * D;
}

/// Of a chain whose kernels move with its particles: ω² = c² A² + (2σ/ρ)(A² − B) (theory.md §7), smallest over k.
double least_omega_squared_of_moving_kernels(const Problem<1>& problem, double strain) {
  const double c_p = p_wave_speed(problem), sigma_over_rho = c_p * c_p * strain;
  const analysis::LatticeSummation<1> summation(problem.lattice, problem.kernel, problem.neighbour_rule, std::nullopt,
                                                std::nullopt);
  double least = 0.0;
  for (int i = 1; i <= 400; ++i) {
    const auto sums = summation(Vector<1>(pi * i / 400.0 / problem.lattice.spacing()));
    const double A2 = sums.A.squaredNorm();
    least = std::min(least, c_p * c_p * A2 + 2.0 * sigma_over_rho * (A2 - sums.B(0, 0)));
  }
  return least;
}

}  // namespace

TEST_CASE("Swegle's chain: no wave of the total-Lagrangian scheme grows in tension, whatever the sign of W''",
          "[ladder]") {
  int signs[2] = {0, 0};
  for (const auto& setting : settings)
    for (const double strain : {0.01, 0.1, 0.5}) {
      INFO(name_of(setting.kernel) << " h/spacing " << setting.h_over_spacing << " strain " << strain);
      auto problem = strained_chain(setting, strain);
      const double curvature = problem.kernel.curvature(problem.lattice.spacing());
      ++signs[curvature > 0.0];
      if (curvature > 0.0) CHECK(least_omega_squared_of_moving_kernels(problem, strain) < 0.0);

      const analysis::GradientSymbol<1> symbol(problem);
      const analysis::BulkModes<1> modes(problem);
      const auto limit = std::get<analysis::ConditionallyStable<1>>(modes.limit());
      CHECK(limit.mode.omega ==
            Approx(std::sqrt(omega_squared(problem, strain, modes.symbol_maximum()))).epsilon(rounding));
      for (int i = 0; i <= 400; ++i) {
        const auto of_mode = analysis::mode_limit<1>(problem, Vector<1>(pi * i / 400.0 / problem.lattice.spacing()));
        CHECK_FALSE(std::holds_alternative<analysis::NeverStable<1>>(of_mode));
      }
      study::GrowthRun<1> run(problem, periodic_patch<1>(problem, cells), 1);
      CHECK(run(0.99 * limit.critical_time_step, 3000).trend == solver::Trend::bounded);
    }
  CHECK(signs[0] > 0);
  CHECK(signs[1] > 0);
}

TEST_CASE("Swegle's chain: compressed beyond one half every wave with strain grows, at the predicted rate",
          "[ladder]") {
  for (const auto& setting : settings) {
    INFO(name_of(setting.kernel) << " h/spacing " << setting.h_over_spacing);
    for (const double strain : {-0.5 + 1e-9, -0.499, -0.1})
      CHECK_FALSE(std::holds_alternative<analysis::NeverStable<1>>(
          analysis::BulkModes(strained_chain(setting, strain)).limit()));
    for (const double strain : {-0.5 - 1e-9, -0.501, -0.6}) {
      const auto problem = strained_chain(setting, strain);
      const auto patch = periodic_patch<1>(problem, cells);
      const analysis::GradientSymbol<1> symbol(problem);
      const auto fastest = std::get<analysis::NeverStable<1>>(analysis::patch_limit(problem, cells));
      const double time_step = 0.05 / fastest.growth_rate;
      // A mode with ω² = −r² grows by 2 asinh(r Δt / 2) a step of leapfrog.
      const auto growth = [&](const Vector<1>& k) {
        const double r = std::sqrt(-omega_squared(problem, strain, symbol.cleaned(k)[0]));
        return 2.0 * std::asinh(0.5 * r * time_step);
      };
      for (int n = 1; n < cells[0] / 2; ++n) {
        const Vector<1> k = problem.lattice.reciprocal_vectors().col(0) * n / cells[0];
        if (symbol(k).norm() < 1e-3 * analysis::BulkModes(problem).symbol_maximum()) continue;
        INFO("strain " << strain << " k spacing " << k[0] * problem.lattice.spacing());
        CHECK(std::holds_alternative<analysis::NeverStable<1>>(analysis::mode_limit<1>(problem, k)));
        const auto E = solver::bloch_step_matrix<1>(problem, patch, k, time_step);
        CHECK(std::log(E.eigenvalues().cwiseAbs().maxCoeff()) == Approx(growth(k)).margin(growth_tolerance));
      }
      if (strain > -0.5001) continue;  // too slow for a run
      const auto seed = study::critical_mode_displacement<1>(problem, study::PeriodicPatch<1>{cells});
      const auto seeded = study::GrowthRun<1>(problem, patch, seed)(time_step, 400);
      const auto noisy = study::GrowthRun<1>(problem, patch, 1)(time_step, 400);
      CHECK(seeded.trend == solver::Trend::growing);
      CHECK(std::abs(seeded.growth_per_step - growth(fastest.mode.wave_vector)) < growth_tolerance);
      CHECK(noisy.trend == solver::Trend::growing);
    }
  }
}
