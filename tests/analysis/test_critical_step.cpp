// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "analysis/amplification.hpp"
#include "analysis/critical_step.hpp"
#include "analysis/gradient_symbol.hpp"
#include "tests/analysis/golden.hpp"
#include "tests/analysis/problems.hpp"

using namespace sphstab;
using namespace sphstab::analysis;

namespace {

/// Two results of the certified maximum that should agree exactly.
constexpr double rounding_tolerance = 1e-13;

/// Largest |λ| over a grid of the zone by Eigen's solver, and where.
double scanned_radius(const Problem<2>& problem, double dt, int points) {
  double radius = 0.0;
  for (int i = 0; i < points; ++i)
    for (int j = 0; j < points; ++j) {
      const Vector<2> k = problem.lattice.reciprocal_vectors() * Vector<2>(i, j) / points;
      for (const auto& value : numerical_eigenvalues(amplification_matrix(problem, k, dt)))
        radius = std::max(radius, std::abs(value));
    }
  return radius;
}

ConditionallyStable<2> conditional(const StepLimit<2>& limit) {
  REQUIRE(std::holds_alternative<ConditionallyStable<2>>(limit));
  return std::get<ConditionallyStable<2>>(limit);
}

/// Equibiaxial strain e with the density of Eq. 6; Gaussian, so that L is I to 1e-6.
Problem<2> prestressed(double e) {
  auto problem = problem_2d(LatticeKind::square, KernelFamily::gaussian, 1.3, 7.0);
  problem.scheme.momentum_density = MomentumDensity::equation_of_state;
  problem.displacement_gradient = e * Tensor<2>::Identity();
  return problem;
}
constexpr double gaussian_consistency = 1e-5;

}  // namespace

TEST_CASE("critical time steps agree with the reference", "[fast]") {
  const auto references = golden::cases("dt");
  REQUIRE(references.size() == 20);
  for (const auto& reference : references) {
    INFO(reference["id"]);
    const auto problem = golden::problem(reference);
    const auto& expect = reference["expect"];
    const double tolerance = reference["tolerance"], expected = expect["critical_time_step"];
    const auto limit = conditional(BulkModes(problem).limit());
    CHECK(std::abs(limit.critical_time_step - expected) < tolerance * expected);
    CHECK(limit.bracket.low <= limit.critical_time_step);
    CHECK(limit.critical_time_step <= limit.bracket.high);
    if (expect.contains("symbol_maximum"))
      CHECK(golden::difference(BulkModes(problem).symbol_maximum(), expect["symbol_maximum"]) < tolerance);
    if (expect.contains("published_bound")) {
      REQUIRE(published_bound(problem));
      CHECK(golden::difference(*published_bound(problem), expect["published_bound"]["value"]) < tolerance);
    }
    // The critical mode is where it happens.
    CHECK(conditional(mode_limit(problem, limit.mode.wave_vector)).critical_time_step ==
          Approx(limit.critical_time_step).epsilon(rounding_tolerance));
  }
}

TEST_CASE("the table of limits of eight kernels on the square lattice is reproduced", "[fast]") {
  constexpr double printed = 5.1e-5;  // four decimals
  constexpr std::array<double, 8> h{0.8, 1.0, 1.2, 1.3, 1.5, 2.0, 3.0, 4.0};
  struct Row {
    KernelFamily kernel;
    std::array<double, 8> limit;
  };
  for (const auto& [kernel, limit] :
       {Row{KernelFamily::cubic_spline, {1.8704, 1.8918, 2.2400, 2.4279, 2.7908, 3.7678, 5.6366, 7.5140}},
        Row{KernelFamily::quartic_spline, {1.8213, 2.1112, 2.5251, 2.7408, 3.1624, 4.2108, 6.3170, 8.4228}},
        Row{KernelFamily::quintic_spline, {1.9156, 2.3110, 2.7736, 3.0029, 3.4654, 4.6224, 6.9333, 9.2444}},
        Row{KernelFamily::gaussian, {1.9999, 2.3436, 2.7984, 3.0312, 3.4975, 4.6633, 6.9949, 9.3266}},
        Row{KernelFamily::wendland_c2, {1.9685, 1.8994, 2.1883, 2.3528, 2.6628, 3.5211, 5.2693, 7.0238}},
        Row{KernelFamily::wendland_c4, {2.8328, 1.9050, 1.9394, 2.0487, 2.3269, 3.0680, 4.5946, 6.1256}},
        Row{KernelFamily::wendland_c6, {4.8987, 2.1768, 1.8880, 1.9149, 2.0987, 2.7537, 4.1246, 5.4993}},
        Row{KernelFamily::sinc_5, {3.0465, 1.8827, 1.8795, 1.9841, 2.2698, 3.0274, 4.5414, 6.0552}}})
    for (std::size_t i = 0; i < h.size(); ++i) {
      INFO(name_of(kernel) << " h = " << h[i]);
      const auto problem = problem_2d(LatticeKind::square, kernel, h[i], 7.0);
      const double c_p = std::sqrt(problem.material.lame(problem.plane).p_wave_modulus());
      CHECK(std::abs(conditional(BulkModes(problem).limit()).critical_time_step * c_p - limit[i]) < printed);
    }
}

TEST_CASE("just below the limit no mode of a scan grows, at the critical mode one does just above", "[fast]") {
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet})
    for (const double rate : {0.0, 0.4}) {
      auto problem = problem_2d(LatticeKind::hexagonal, KernelFamily::wendland_c2, 1.4);
      problem.integrator = integrator;
      if (rate > 0.0) problem.scheme.damping = Damping{rate};
      const auto limit = conditional(BulkModes(problem).limit());
      constexpr double defective = 1e-6;  // Eigen splits the double eigenvalue 1 at Γ by √ε
      CHECK(scanned_radius(problem, 0.9999 * limit.critical_time_step, 24) < 1.0 + defective);
      const double above = 1.0001 * limit.critical_time_step;
      const double expected = mode_spectrum(problem, limit.mode.wave_vector, above).spectral_radius;
      CHECK(expected > 1.0001);
      CHECK(BulkModes(problem).spectral_radius(above) == Approx(expected).epsilon(rounding_tolerance));
      CHECK(scanned_radius(problem, above, 24) <= expected + defective);
    }
}

TEST_CASE("the step for a tolerated growth has that growth over the zone", "[fast]") {
  for (const double e : {0.1, -0.5})
    for (const double growth : {1e-4, 1e-2}) {
      const auto problem = prestressed(e);
      const auto step = BulkModes(problem).step_for_growth(growth);
      REQUIRE(step);
      // Near a double eigenvalue growth ~ √(Δt/Δt_c − 1), so that roundings of Δt enter as ε / growth², here ten of
      // them.
      const double conditioning = 2e-15 / (growth * growth);
      CHECK(BulkModes(problem).spectral_radius(*step) - 1.0 == Approx(growth).epsilon(conditioning));
    }
  CHECK_FALSE(BulkModes(prestressed(-0.5)).step_for_growth(0.0));
  CHECK_THROWS_AS(BulkModes(prestressed(0.0)).step_for_growth(-1.0), InvalidInput);
}

TEST_CASE("tension shortens the step by the stiffening of the equation of state", "[fast]") {
  // Equibiaxial e, plane strain: ω_L² ∝ [γ + G + 2 (G + 2γ) e] exp(2·2e), Zhang's G = 1, γ = 0.75 (theory.md §2: x0.724
  // and x0.406 at 10 % and 30 %).
  const double unstressed = conditional(BulkModes(prestressed(0.0)).limit()).critical_time_step;
  for (const double e : {0.1, 0.3, -0.1}) {
    const double factor = std::sqrt(1.75 / ((1.75 + 5.0 * e) * std::exp(4.0 * e)));
    CHECK(conditional(BulkModes(prestressed(e)).limit()).critical_time_step ==
          Approx(factor * unstressed).epsilon(gaussian_consistency));
  }
  auto frozen = prestressed(0.3);
  frozen.scheme.momentum_density = MomentumDensity::frozen;
  CHECK(conditional(BulkModes(frozen).limit()).critical_time_step == unstressed);
}

TEST_CASE("compression beyond (gamma + G) / (2 (G + 2 gamma)) is never stable", "[fast]") {
  const auto limit = conditional(BulkModes(prestressed(-0.349)).limit());
  CHECK(limit.mode.branch == Branch::transverse);  // ω_L² is almost zero there
  const auto compressed = prestressed(-0.4);
  const auto unstable = BulkModes(compressed).limit();
  REQUIRE(std::holds_alternative<NeverStable<2>>(unstable));
  const auto& found = std::get<NeverStable<2>>(unstable);
  // −ω_L² = −(1.75 − 5·0.4) exp(−1.6) |D|².
  const double expected = std::sqrt(0.25 * std::exp(-1.6)) * BulkModes(compressed).symbol_maximum();
  CHECK(found.growth_rate == Approx(expected).epsilon(1e-4));  // 1.75 − 5e cancels tenfold: L enters ten times stronger
  const double at_mode = std::get<NeverStable<2>>(mode_limit(compressed, found.mode.wave_vector)).growth_rate;
  CHECK(found.growth_rate == Approx(at_mode).epsilon(rounding_tolerance));
  CHECK(std::holds_alternative<NeverStable<2>>(BulkModes(prestressed(-0.3501)).limit()));
}

TEST_CASE("uniaxial compression grows across the compressed direction only as far as a scan says", "[fast]") {
  auto problem = prestressed(0.0);
  problem.displacement_gradient << -0.6, 0.1, 0.0, 0.05;
  const auto unstable = BulkModes(problem).limit();
  REQUIRE(std::holds_alternative<NeverStable<2>>(unstable));
  const double rate = std::get<NeverStable<2>>(unstable).growth_rate;
  double scanned = 0.0;
  for (int i = 0; i < 120; ++i)
    for (int j = 0; j < 120; ++j) {
      const Vector<2> k = problem.lattice.reciprocal_vectors() * Vector<2>(i, j) / 120.0;
      const auto limit = mode_limit(problem, k);
      if (const auto* mode = std::get_if<NeverStable<2>>(&limit)) scanned = std::max(scanned, mode->growth_rate);
    }
  CHECK(scanned <= rate * (1.0 + rounding_tolerance));
  CHECK(scanned > rate * (1.0 - 1e-2));  // the grid is off by at most 2π/240 in phase, (2π/240)² R² of ω² with R < 4
  problem.scheme.damping = Damping{0.5};
  const double damped = std::get<NeverStable<2>>(BulkModes(problem).limit()).growth_rate;
  CHECK(damped * damped + 0.5 * damped == Approx(rate * rate).epsilon(rounding_tolerance));
}

TEST_CASE("normalisation multiplies the bulk limit by the kernel sum", "[fast]") {
  // errata / theory.md §2: the Gaussian has N = 1.368, 1.032, 1.0002 at h/Δp = .5, .7, 1.
  struct Sum {
    double h, N, printed;
  };
  for (const auto& [h, N, printed] : {Sum{0.5, 1.368, 5e-4}, Sum{0.7, 1.032, 5e-4}, Sum{1.0, 1.0002, 5e-5}}) {
    auto problem = problem_2d(LatticeKind::square, KernelFamily::gaussian, h, 7.0);
    const double plain = conditional(BulkModes(problem).limit()).critical_time_step;
    problem.scheme.kernel_normalisation = KernelNormalisation::sum;
    CHECK(std::abs(conditional(BulkModes(problem).limit()).critical_time_step / plain - N) < printed);
  }
}

TEST_CASE("modes without restoring force limit nothing, and damped ones by the damping alone", "[fast]") {
  auto problem = problem_2d(LatticeKind::square, KernelFamily::cubic_spline, 1.3);
  CHECK(std::holds_alternative<UnconditionallyStable>(mode_limit(problem, Vector<2>(std::numbers::pi, 0))));
  CHECK(std::holds_alternative<UnconditionallyStable>(patch_limit(problem, {2, 2})));
  problem.scheme.damping = Damping{0.5};
  CHECK(conditional(mode_limit(problem, Vector<2>(0, 0))).critical_time_step == Approx(4.0));
}

TEST_CASE("a patch and Zhang's box admit fewer modes than the zone", "[fast]") {
  const auto problem = problem_2d(LatticeKind::staggered, KernelFamily::cubic_spline, 1.3);
  const double bulk = conditional(BulkModes(problem).limit()).critical_time_step;
  double smallest = 1e300;
  for (int i = 0; i < 7; ++i)
    for (int j = 0; j < 5; ++j) {
      if (i == 0 && j == 0) continue;
      const Vector<2> k = problem.lattice.reciprocal_vectors() * Vector<2>(i / 7.0, j / 5.0);
      smallest = std::min(smallest, conditional(mode_limit(problem, k)).critical_time_step);
    }
  CHECK(conditional(patch_limit(problem, {7, 5})).critical_time_step == smallest);
  CHECK(smallest > bulk);
  CHECK(conditional(patch_limit(problem, {240, 240})).critical_time_step == Approx(bulk).epsilon(1e-3));
  // m = 1 … M: a box one particle wide has Kx Δp = π only.
  const auto square = problem_2d(LatticeKind::square, KernelFamily::cubic_spline, 1.3);
  double along_edge = 1e300;
  for (int l = 1; l <= 7; ++l) {
    const Vector<2> k(std::numbers::pi, l * std::numbers::pi / 8.0);
    along_edge = std::min(along_edge, conditional(mode_limit(square, k)).critical_time_step);
  }
  CHECK(conditional(paper_limit(square, {1, 8})).critical_time_step == Approx(along_edge).epsilon(rounding_tolerance));
  CHECK_THROWS_AS(patch_limit(problem, {0, 3}), InvalidInput);
  CHECK_THROWS_AS(paper_limit(problem, {4, 0}), InvalidInput);
}
