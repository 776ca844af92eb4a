// SPDX-License-Identifier: MIT
// Rungs 5 and 6 of the updated-Lagrangian scheme: growth and critical steps of the running solver against theory.
#include <catch2/catch.hpp>
#include <cmath>

#include "analysis/critical_step.hpp"
#include "ladder/cases.hpp"
#include "study/growth_cases.hpp"
#include "study/patch_wave.hpp"
#include "study/updated_growth_run.hpp"
#include "tests/analysis/updated_problems.hpp"

using namespace sphstab;
using namespace sphstab::study;

namespace {

/// Rung 6.
constexpr double bisection_tolerance = 1e-6;

/// Growth rate of the transverse wave k = (π/Δp, 0) that artificial stress drives on the square lattice (theory.md §3):
/// ρ̄ω² = 2κσ (εf − B)_yy, f_yy = −1.3465, B_yy = −0.09695 and w = 0.63754 of the cubic spline at h = Δp, ε = 0.3,
/// σ = 0.05, ρ̄ = 0.95; with XSPH of 0.5 it is 0.148.
double rate_across(bool smoothed) {
  const double kappa = smoothed ? 1.0 - 0.5 * 0.6375384390513321 : 1.0;
  return std::sqrt(kappa * 0.1 * (0.3 * 1.346460922601237 - 0.09694965902670272) / 0.95);
}

}  // namespace

TEST_CASE("rung 5: the running scheme of Gray grows as its amplification matrix says, from a wave and from noise",
          "[ladder]") {
  int stable = 0, across = 0;
  for (const auto& make : growth_cases()) {
    const auto found = make();
    INFO(ladder::describe(found));
    CHECK(found.holds());
    stable += found.is_stable() ? 1 : 0;
    if (found.has_noise) continue;
    const bool smoothed = found.name.find("XSPH") != std::string::npos;
    // Leapfrog: e^g + e^−g − 2 = r²Δt².
    CHECK(2.0 * std::sinh(0.5 * found.seeded) / found.time_step == Approx(rate_across(smoothed)).epsilon(1e-7));
    ++across;
  }
  CHECK(across == 2);
  CHECK(stable == 6);
}

TEST_CASE("rung 5: at zero stress the predictor-corrector grows by (ωΔt)⁴/8 a step, with stored rates by twice that",
          "[ladder]") {
  for (const auto& make : weak_growth_cases()) {
    const auto found = make();
    INFO(name_of(found.integrator) << ", ωΔt = " << found.phase);
    INFO("leading order " << found.leading_order << ", theory " << found.theory << ", run " << found.seeded);
    CHECK(found.holds());
  }
}

TEST_CASE("rung 5: leapfrog and verlet are neutral up to 2/ω_max and grow beyond it", "[ladder]") {
  const LatticeIndex<2> cells(8, 8);
  for (const auto lattice : lattices_of(2))
    for (const auto integrator : {Integrator::leapfrog, Integrator::verlet}) {
      INFO(name_of(lattice) << ", " << name_of(integrator));
      auto problem = updated_problem<2>(lattice, KernelFamily::cubic_spline, 1.3, 0.3, 0.0);
      problem.integrator = integrator;
      const auto limit = std::get<analysis::ConditionallyStable<2>>(analysis::patch_limit(problem, cells));
      CHECK(limit.critical_time_step == Approx(2.0 / limit.mode.omega).epsilon(1e-12));
      UpdatedGrowthRun<2> run(problem, cells, 1);
      constexpr long steps = 2000;
      CHECK(run(0.999 * limit.critical_time_step, steps).trend == solver::Trend::bounded);
      const auto above = run(1.001 * limit.critical_time_step, steps);
      CHECK(above.trend == solver::Trend::growing);
      // λ + 1/λ = 2 − 4 (1.001)²: λ = −e^g, cosh g = 2 (1.001)² − 1.
      CHECK(above.growth_per_step == Approx(2.0 * std::acosh(1.001)).epsilon(1e-4));
      const double slightly = 0.999 * limit.critical_time_step;
      CHECK(std::abs(seeded_growth<2>(fastest_wave<2>(problem, limit.mode.wave_vector, slightly), problem, cells,
                                      slightly)) < no_growth);
    }
}

TEST_CASE("rung 6: bisection of the running scheme of Gray finds the theory's limit", "[ladder][theory-vs-bisection]") {
  for (const auto& make : bisection_cases()) {
    const auto [name, integrator, found] = make();
    INFO(name << ", " << name_of(integrator));
    REQUIRE(found.theory.critical_time_step);
    REQUIRE(found.run.critical_time_step);
    CHECK(*found.relative_difference() < bisection_tolerance);
  }
}

TEST_CASE("viscosity on approach alone damps small waves half as fast, the more exactly the weaker it is", "[ladder]") {
  // The force of half of a wave is half of the force and its even harmonics, which take longer to die; in a wave that
  // travels the harmonics travel with it. theory.md §8: 0.498 to 0.5005 of the rate on approach and separation.
  for (const bool is_standing : {true, false}) {
    double before = 0.5;
    for (const auto& make : damping_cases()) {
      const auto found = make();
      if (found.is_standing != is_standing || found.velocity != 1e-6) continue;
      INFO((is_standing ? "standing" : "travelling") << ", alpha " << found.alpha);
      // Over whole periods the energy of a standing wave ripples by the square of its damping in a period.
      CHECK(found.all_pairs == Approx(found.theory).epsilon(is_standing ? 3e-4 : 1e-6));
      const double ratio = found.approaching / found.all_pairs;
      CHECK(std::abs(ratio - 0.5) < 0.4 * before);
      before = std::abs(ratio - 0.5);
      if (found.alpha == 0.02) CHECK(ratio == Approx(0.5).margin(is_standing ? 1e-3 : 5e-3));
    }
  }
}

TEST_CASE("viscosity on approach alone acts in proportion on waves of any small size", "[ladder]") {
  for (const auto& make : damping_cases()) {
    const auto found = make();
    if (!found.is_standing || found.alpha != 0.1 || found.velocity > 1e-4) continue;
    INFO("velocity " << found.velocity);
    CHECK(found.approaching / found.all_pairs > 0.4975);
    CHECK(found.approaching / found.all_pairs < 0.5005);
  }
}
