// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "analysis/amplification.hpp"
#include "analysis/gradient_symbol.hpp"
#include "analysis/lattice_sums.hpp"
#include "analysis/updated_modes.hpp"
#include "tests/analysis/golden.hpp"
#include "tests/analysis/problems.hpp"
#include "tests/analysis/updated_problems.hpp"

using namespace sphstab;
using namespace sphstab::analysis;

namespace {

constexpr double polished = 1e-12;
/// Two searches, each with an exit at a radius of 1 + 1e-9 and slopes of order 1 (or the root of it at a double λ).
constexpr double searched = 1e-7;

template <int Dim>
ConditionallyStable<Dim> conditional(const StepLimit<Dim>& limit) {
  REQUIRE(std::holds_alternative<ConditionallyStable<Dim>>(limit));
  return std::get<ConditionallyStable<Dim>>(limit);
}

template <int Dim>
double mode_radius(const Problem<Dim>& problem, const Vector<Dim>& k, double time_step) {
  return mode_spectrum(problem, k, time_step).spectral_radius;
}

Problem<2> hexagonal(Integrator integrator, double xsph = 0.0, double pressure = 0.0) {
  auto problem = updated_problem<2>(LatticeKind::hexagonal, KernelFamily::cubic_spline, 1.3, 0.3, pressure);
  problem.integrator = integrator;
  if (xsph != 0.0) problem.scheme.xsph = Xsph{xsph};
  return problem;
}

/// max |D|² over the zone, from the certified search for tl-linear.
template <int Dim>
double largest_symbol(const Problem<Dim>& problem) {
  Problem<Dim> elastic = problem;
  elastic.scheme = Scheme{};
  elastic.integrator = Integrator::leapfrog;
  return BulkModes<Dim>(elastic).symbol_maximum();
}

}  // namespace

TEST_CASE("critical steps and spectral radii of ul agree with the reference", "[fast]") {
  const auto references = golden::cases("dt", "ul");
  REQUIRE(references.size() == 10);
  for (const auto& reference : references) {
    INFO(reference["id"]);
    const UpdatedModes<2> modes(golden::updated_problem(reference));
    const auto& expect = reference["expect"];
    if (expect.contains("critical_time_step")) {
      const auto limit = conditional(modes.limit());
      const double expected = expect["critical_time_step"];
      CHECK(limit.critical_time_step == Approx(expected).epsilon(searched));
      CHECK(limit.bracket_kind == BracketKind::searched);
    }
    if (expect.contains("spectral_radius_at_time_step"))
      CHECK(modes.spectral_radius(reference["time_step"]) ==
            Approx(expect["spectral_radius_at_time_step"].get<double>()).epsilon(polished));
  }
}

TEMPLATE_TEST_CASE_SIG("without stress the limit of leapfrog and verlet is two over the largest frequency", "[fast]",
                       ((int Dim), Dim), 1, 2, 3) {
  // ω_L = c_p |D| without XSPH.
  const auto lattice = Dim == 1 ? LatticeKind::chain : Dim == 2 ? LatticeKind::staggered : LatticeKind::cubic;
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet}) {
    auto problem = updated_problem<Dim>(lattice, KernelFamily::cubic_spline, 1.3, 0.3, 0.0);
    problem.integrator = integrator;
    const auto limit = conditional(UpdatedModes<Dim>(problem).limit());
    const double expected = 2.0 / (std::sqrt(1.4) * largest_symbol(problem));
    CHECK(limit.critical_time_step == Approx(expected).epsilon(polished));
    CHECK(limit.bracket_kind == BracketKind::certified);
    CHECK(limit.bracket.low <= expected);
    CHECK(expected <= limit.bracket.high);
    CHECK(limit.bracket.high - limit.bracket.low < (Dim == 3 ? 1e-6 : 1e-9) * expected);
    CHECK(mode_radius<Dim>(problem, limit.mode.wave_vector, 1.0001 * expected) > 1.001);
    CHECK(UpdatedModes<Dim>(problem).spectral_radius(0.9999 * expected) == 1.0);
  }
}

TEST_CASE("a bar with viscosity is stable while the longest eigenvalue of its kicks is at most 4", "[fast]") {
  // speed.md A2: leapfrog, Δt² K + 2 Δt C ≤ 4 with K = c_p² A², C = −F_v.
  auto problem = updated_problem<1>(LatticeKind::chain, KernelFamily::wendland_c2, 1.4, 0.3, 0.0);
  problem.integrator = Integrator::leapfrog;
  for (const double alpha : {0.01, 0.5, 2.0}) {
    problem.scheme.viscosity = Viscosity{alpha, 0.1};
    const LatticeSummation<1> sums(problem.lattice, problem.kernel, problem.neighbour_rule, {},
                                   problem.scheme.viscosity);
    double smallest = 1e300;
    constexpr int points = 40000;  // off by (π/points · 3)²/2 < 1e-7
    for (int i = 1; i <= points; ++i) {
      const auto at = sums(Vector<1>(std::numbers::pi * i / points));
      const double K = 1.4 * at.A.squaredNorm(), C = -alpha * 1.4 * at.Gamma(0, 0);
      smallest = std::min(smallest, 4.0 / (C + std::sqrt(C * C + 4.0 * K)));
    }
    CHECK(conditional(UpdatedModes<1>(problem).limit()).critical_time_step == Approx(smallest).epsilon(searched));
  }
}

TEST_CASE("below a searched limit no mode of a scan grows, above it the critical one does", "[fast]") {
  for (const auto integrator :
       {Integrator::verlet, Integrator::predictor_corrector, Integrator::predictor_corrector_pec})
    for (const double xsph : {0.0, 0.5}) {
      auto problem = hexagonal(integrator, xsph, -0.02);
      problem.scheme.artificial_stress = ArtificialStress{0.3};
      problem.scheme.viscosity = Viscosity{0.4, 0.1};
      const auto limit = conditional(UpdatedModes<2>(problem).limit());
      for (const double part : {0.3, 0.7, 0.99, 0.99999})
        for (int i = 0; i < 12; ++i)
          for (int j = 0; j < 12; ++j) {
            if (i == 0 && j == 0) continue;
            const Vector<2> k = problem.lattice.reciprocal_vectors() * Vector<2>(i, j) / 12.0;
            REQUIRE(mode_radius<2>(problem, k, part * limit.critical_time_step) < 1.0 + 1e-7);  // defective λ = 1
          }
      CHECK(mode_radius<2>(problem, limit.mode.wave_vector, 1.0001 * limit.critical_time_step) > 1.0 + 1e-6);
    }
}

TEST_CASE("the predictor-corrector grows at every step by the law that it reports", "[fast]") {
  struct Case {
    Integrator integrator;
    double xsph, pressure;
    int exponent;
  };
  for (const auto& [integrator, xsph, pressure, exponent] :
       {Case{Integrator::predictor_corrector, 0.0, 0.0, 4}, Case{Integrator::predictor_corrector, 0.5, 0.0, 4},
        Case{Integrator::predictor_corrector_pec, 0.0, -0.02, 4}, Case{Integrator::predictor_corrector, 0.0, -0.02, 4},
        Case{Integrator::predictor_corrector, 0.5, -0.02, 2},
        Case{Integrator::predictor_corrector_pec, 0.5, -0.02, 2}}) {
    auto problem = hexagonal(integrator, xsph, pressure);
    if (pressure < 0.0) problem.scheme.artificial_stress = ArtificialStress{0.3};
    const UpdatedModes<2> modes(problem);
    const auto limit = modes.limit();
    REQUIRE(std::holds_alternative<WeaklyUnstable<2>>(limit));
    const auto& law = std::get<WeaklyUnstable<2>>(limit);
    CHECK(law.exponent == exponent);
    // The next order is Δt² larger, with a coefficient of order 0.1 against that of Δt².
    const double dt = exponent == 2 ? 0.01 : 0.05;
    const auto error = [&](double step) {
      return (modes.spectral_radius(step) - 1.0) / (law.coefficient * std::pow(step, exponent)) - 1.0;
    };
    CHECK(std::abs(error(dt)) < 0.05);
    CHECK(std::abs(error(0.5 * dt)) < 0.3 * std::abs(error(dt)) + 1e-6);
    CHECK(mode_radius<2>(problem, law.mode.wave_vector, dt) - 1.0 ==
          Approx(law.coefficient * std::pow(dt, exponent)).epsilon(0.05));
  }
}

TEST_CASE("without stress the law and the radius of the predictor-corrector are closed forms", "[fast]") {
  const auto problem = hexagonal(Integrator::predictor_corrector);
  const UpdatedModes<2> modes(problem);
  const double omega = std::sqrt(1.4) * largest_symbol(problem);
  const auto law = std::get<WeaklyUnstable<2>>(modes.limit());
  CHECK(law.coefficient == Approx(std::pow(omega, 4) / 8.0).epsilon(polished));
  for (const double growth : {1e-4, 1e-2}) {
    const auto step = modes.step_for_growth(growth);
    REQUIRE(step);
    // |λ|² = 1 + (ωΔt)⁴/4
    CHECK(*step * omega == Approx(std::pow(4.0 * growth * (2.0 + growth), 0.25)).epsilon(1e-10));
  }
  auto stored = problem;
  stored.integrator = Integrator::predictor_corrector_pec;
  CHECK(std::get<WeaklyUnstable<2>>(UpdatedModes<2>(stored).limit()).coefficient ==
        Approx(std::pow(omega, 4) / 4.0).epsilon(polished));
  CHECK_THROWS_AS(modes.step_for_growth(-1.0), InvalidInput);
  CHECK_FALSE(modes.step_for_growth(0.0));
}

TEST_CASE("what grows in continuous time is never stable, and viscosity only slows it", "[fast]") {
  auto problem = updated_problem<1>(LatticeKind::chain, KernelFamily::cubic_spline, 1.0, 0.0, -0.05);
  problem.integrator = Integrator::leapfrog;
  const auto undamped = std::get<NeverStable<1>>(UpdatedModes<1>(problem).limit());
  const double W2 = problem.kernel.curvature(1.0);
  CHECK(undamped.growth_rate == Approx(std::sqrt(8.0 * W2 * 0.05 / 0.95)).epsilon(polished));
  CHECK_FALSE(UpdatedModes<1>(problem).step_for_growth(0.0));
  problem.scheme.viscosity = Viscosity{0.3, 0.1};
  const auto damped = std::get<NeverStable<1>>(UpdatedModes<1>(problem).limit());
  // The root of r² − F_v r + ω² = 0 at the end of the zone, where F_v = 4 α h c0 W'(1)/(1 + η²).
  const double F_v = 0.3 * 4.0 * problem.kernel.slope(1.0) / 1.01;
  const double at_end = 0.5 * (F_v + std::sqrt(F_v * F_v + 4.0 * std::pow(undamped.growth_rate, 2)));
  const auto alone = std::get<NeverStable<1>>(UpdatedModes<1>(problem, {Vector<1>(std::numbers::pi)}).limit());
  CHECK(alone.growth_rate == Approx(at_end).epsilon(polished));
  CHECK(damped.growth_rate >= at_end * (1.0 - polished));
  CHECK(damped.growth_rate < undamped.growth_rate);
}

TEST_CASE("given wave vectors are asked alone", "[fast]") {
  const auto problem = hexagonal(Integrator::leapfrog);
  const Vector<2> k(1.1, 0.4);
  const double D = GradientSymbol<2>(problem)(k).norm();
  const auto limit = conditional(UpdatedModes<2>(problem, {Vector<2>(0.5, 0.1), k}).limit());
  CHECK(limit.critical_time_step == Approx(2.0 / (std::sqrt(1.4) * D)).epsilon(polished));
  CHECK((limit.mode.wave_vector - k).norm() < polished);
  CHECK(std::holds_alternative<UnconditionallyStable>(UpdatedModes<2>(problem, {Vector<2>::Zero()}).limit()));
  const auto pece = hexagonal(Integrator::predictor_corrector);
  CHECK(UpdatedModes<2>(pece, {k}).spectral_radius(0.7) == Approx(mode_radius<2>(pece, k, 0.7)).epsilon(polished));
  auto viscous = pece;
  viscous.scheme.viscosity = Viscosity{0.5, 0.1};
  const double alone = conditional(UpdatedModes<2>(viscous, {k}).limit()).critical_time_step;
  CHECK(alone > conditional(UpdatedModes<2>(viscous).limit()).critical_time_step);
  CHECK(mode_radius<2>(viscous, k, 0.99999 * alone) <= 1.0 + 1e-9);
  CHECK(mode_radius<2>(viscous, k, 1.00001 * alone) > 1.0 + 1e-9);
}

TEST_CASE("with viscosity the critical mode is the one that grows", "[fast]") {
  // At (π/Δp, 0) A = 0, the friction along k is three times that across, and the wave along k leaves the circle first.
  auto problem = updated_problem<2>(LatticeKind::square, KernelFamily::cubic_spline, 1.3, 0.5, 0.0);
  problem.scheme.viscosity = Viscosity{1.0, 0.1};
  const auto stable = std::get<ConditionallyStable<2>>(UpdatedModes<2>(problem).limit());
  CHECK(stable.mode.wave_vector.isApprox(Vector<2>(std::numbers::pi, 0.0), 1e-6));
  CHECK(stable.mode.branch == Branch::longitudinal);

  // A friction of nothing leaves the fastest growth, and its wave, what they are without.
  auto compressed = updated_problem<2>(LatticeKind::hexagonal, KernelFamily::cubic_spline, 1.3, 0.5, 0.02);
  compressed.scheme.xsph = Xsph{0.5};
  const auto without = std::get<NeverStable<2>>(UpdatedModes<2>(compressed).limit());
  compressed.scheme.viscosity = Viscosity{1e-8, 0.1};
  const auto with = std::get<NeverStable<2>>(UpdatedModes<2>(compressed).limit());
  CHECK(without.mode.branch == Branch::transverse);
  CHECK(with.mode.branch == Branch::transverse);
  CHECK(with.growth_rate == Approx(without.growth_rate).epsilon(1e-6));
}

TEST_CASE("a weight that divides by W(spacing) = 0 is refused, the other is not", "[fast]") {
  auto problem = updated_problem<1>(LatticeKind::chain, KernelFamily::cubic_spline, 0.45, 0.5, -0.02);
  problem.lattice = problem.lattice.deformed(Tensor<1>(0.5));
  problem.scheme.artificial_stress = ArtificialStress{.epsilon = 0.3};
  CHECK_THROWS_WITH(UpdatedModes<1>(problem),
                    "artificial_stress_weight: kernel-ratio divides by W(spacing), which is 0 with this smoothing "
                    "length; distance-ratio does not");
  problem.scheme.artificial_stress->weight = ArtificialStressWeight::distance_ratio;
  CHECK_NOTHROW(UpdatedModes<1>(problem));
}
