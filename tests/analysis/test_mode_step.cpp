// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "analysis/mode_step.hpp"

using namespace sphstab;
using namespace sphstab::analysis;

namespace {

/// Trace and determinant from the step on unit vectors carry ten roundings of numbers up to (ωΔt)⁴ = 100.
constexpr double rounding_tolerance = 1e-13;
/// Off a limit by this much, relative, the sign of ρ − 1 shows: it exceeds √ε at a double eigenvalue.
constexpr double clear_of_limit = 1e-6;

struct Case {
  Integrator integrator;
  double damping_rate;
  double omega_squared;

  ModeStep step() const {
    return {integrator, damping_rate > 0.0 ? std::optional<Damping>(Damping{damping_rate}) : std::nullopt,
            omega_squared};
  }

  /// The step as `Integrator` documents it: images of (1, 0) and (0, 1) in (v, s).
  std::array<double, 2> stepped(double v, double s, double dt) const {
    const auto force = [&] { return -omega_squared * s - damping_rate * v; };
    if (integrator == Integrator::leapfrog) {
      v += dt * force();
      s += dt * v;
    } else {
      v += 0.5 * dt * force();
      s += dt * v;
      v += 0.5 * dt * force();
    }
    return {v, s};
  }
  double trace(double dt) const { return stepped(1, 0, dt)[0] + stepped(0, 1, dt)[1]; }
  double determinant(double dt) const {
    const auto first = stepped(1, 0, dt), second = stepped(0, 1, dt);
    return first[0] * second[1] - second[0] * first[1];
  }
  /// From trace and determinant by the textbook formula.
  double radius(double dt) const {
    const std::complex<double> half = 0.5 * trace(dt), root = std::sqrt(half * half - determinant(dt));
    return std::max(std::abs(half + root), std::abs(half - root));
  }
};

std::vector<Case> random_cases() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> omega_squared(0.1, 9.0), rate(0.0, 6.0);
  std::vector<Case> cases;
  for (int i = 0; i < 200; ++i)
    for (const auto integrator : {Integrator::leapfrog, Integrator::verlet})
      cases.push_back({integrator, i % 4 == 0 ? 0.0 : rate(random), omega_squared(random)});
  return cases;
}

}  // namespace

TEST_CASE("sum and product of the eigenvalues are trace and determinant of the step", "[fast]") {
  for (const auto& mode : random_cases())
    for (const double sign : {1.0, -1.0})
      for (const double dt : {0.05, 0.4, 0.9, 1.3}) {
        Case signed_mode = mode;
        signed_mode.omega_squared *= sign;
        const auto [first, second] = signed_mode.step().eigenvalues(dt);
        const double scale = 1.0 + std::norm(first) + std::norm(second);
        CHECK(std::abs(first + second - signed_mode.trace(dt)) < rounding_tolerance * scale);
        CHECK(std::abs(first * second - signed_mode.determinant(dt)) < rounding_tolerance * scale);
        CHECK(signed_mode.step().spectral_radius(dt) ==
              Approx(std::max(std::abs(first), std::abs(second))).epsilon(rounding_tolerance));
      }
}

TEST_CASE("the limit is the first time step beyond which the spectral radius exceeds one", "[fast]") {
  for (const auto& mode : random_cases()) {
    INFO(name_of(mode.integrator) << " c = " << mode.damping_rate << " omega^2 = " << mode.omega_squared);
    const auto limit = mode.step().limit();
    REQUIRE(limit);
    for (int i = 1; i <= 100; ++i) CHECK(mode.radius(*limit * (1.0 - clear_of_limit) * i / 100.0) <= 1.0 + 1e-9);
    CHECK(mode.radius(*limit * (1.0 + clear_of_limit)) > 1.0 + 1e-8);
  }
}

TEST_CASE("the limit for a tolerated growth has exactly that growth", "[fast]") {
  for (const auto& mode : random_cases())
    for (const double sign : {1.0, -1.0})
      for (const double growth : {1e-3, 0.1}) {
        Case signed_mode = mode;
        signed_mode.omega_squared *= sign;
        const auto limit = signed_mode.step().limit(growth);
        REQUIRE(limit);
        CHECK(signed_mode.radius(*limit * (1.0 - clear_of_limit)) <= 1.0 + growth);
        CHECK(signed_mode.radius(*limit * (1.0 + clear_of_limit)) > 1.0 + growth);
      }
}

TEST_CASE("limits have the closed forms derived by hand", "[fast]") {
  constexpr double few_ulps = 4e-16;
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet}) {
    CHECK(*Case{integrator, 0.0, 9.0}.step().limit() == Approx(2.0 / 3.0).epsilon(few_ulps));
    CHECK_FALSE(Case{integrator, 0.0, 0.0}.step().limit());
  }
  // Leapfrog ω²Δt² + 2cΔt ≤ 4; modes without restoring force: cΔt ≤ 2, verlet (half-steps) cΔt ≤ 4.
  CHECK(*Case{Integrator::leapfrog, 0.7, 9.0}.step().limit() ==
        Approx(4.0 / (0.7 + std::sqrt(0.49 + 36.0))).epsilon(few_ulps));
  CHECK(*Case{Integrator::leapfrog, 0.8, 0.0}.step().limit() == Approx(2.5).epsilon(few_ulps));
  CHECK(*Case{Integrator::verlet, 0.8, 0.0}.step().limit() == Approx(5.0).epsilon(few_ulps));
  // Verlet, overdamped enough (ω²a²(4−a) < 2c²(8−4a+a²) for all a = cΔt): nothing binds before cΔt = 4.
  CHECK(*Case{Integrator::verlet, 2.0, 0.25}.step().limit() == Approx(2.0).epsilon(few_ulps));
  CHECK(*Case{Integrator::verlet, 1.0, 1.5}.step().limit() < 2.2);
}

TEST_CASE("a stable undamped mode keeps its modulus to the last digit", "[fast]") {
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet})
    for (double dt = 0.01; dt < 2.0; dt += 0.01) CHECK(Case{integrator, 0.0, 1.0}.step().spectral_radius(dt) == 1.0);
}

TEST_CASE("an unstable mode grows at the rate of the continuous equation", "[fast]") {
  const Case mode{Integrator::leapfrog, 0.5, -2.0};
  const double rate = mode.step().continuous_growth_rate();
  CHECK(rate * rate + 0.5 * rate - 2.0 == Approx(0.0).margin(rounding_tolerance));
  constexpr double dt = 1e-5;  // the step's own error is of order Δt
  CHECK(std::log(mode.step().spectral_radius(dt)) / dt == Approx(rate).epsilon(1e-4));
}
