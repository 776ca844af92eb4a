// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "analysis/gradient_symbol.hpp"
#include "analysis/amplification.hpp"
#include "analysis/growth.hpp"
#include "analysis/updated_lagrangian.hpp"
#include "model/lattice_index.hpp"
#include "tests/analysis/golden.hpp"
#include "tests/analysis/problems.hpp"
#include "tests/analysis/updated_problems.hpp"

using namespace sphstab;
using namespace sphstab::analysis;

namespace {

/// Maxima that are polished, of sums of some hundred terms.
constexpr double polished = 1e-12;

constexpr std::array bells{KernelFamily::cubic_spline, KernelFamily::quintic_spline, KernelFamily::wendland_c2};

struct Extremes {
  double growth = 0.0, least = 0.0, largest = 0.0;
};

/// Over a grid of the whole zone with `points` an axis.
template <int Dim>
Extremes scanned(const Problem<Dim>& problem, int points) {
  const UpdatedLagrangian<Dim> scheme(problem);
  Extremes found;
  for_each_index<Dim>(LatticeIndex<Dim>::Zero(), LatticeIndex<Dim>::Constant(points - 1), [&](const auto& n) {
    const Vector<Dim> k = problem.lattice.reciprocal_vectors() * n.template cast<double>() / points;
    const auto wave = scheme(k);
    for (const auto value : squared_frequencies<Dim>(wave.dynamical_matrix(), wave.rounding)) {
      found.growth = std::max(found.growth, growth_rate_of(value));
      found.least = std::min(found.least, value.real());
      found.largest = std::max(found.largest, value.real());
    }
  });
  return found;
}

Problem<2> rotated(const Problem<2>& problem, double angle) {
  Tensor<2> R;
  R << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  Problem<2> result = problem;
  result.lattice = problem.lattice.deformed(R);
  result.deviatoric_stress = R * problem.deviatoric_stress * R.transpose();
  return result;
}

Problem<2> under_tension(LatticeKind lattice, double h, ArtificialStressLinearisation linearisation) {
  auto problem = updated_problem<2>(lattice, KernelFamily::cubic_spline, h, 0.3, -0.05);
  problem.scheme.artificial_stress = ArtificialStress{1.0, 4.0, ArtificialStressWeight::kernel_ratio, linearisation};
  return problem;
}

}  // namespace

TEST_CASE("growth over the whole zone agrees with the reference", "[fast]") {
  const auto references = golden::cases("growth", "ul");
  REQUIRE(references.size() == 11);
  for (const auto& reference : references) {
    const auto& expect = reference["expect"];
    if (!expect.contains("growth_rate")) continue;
    INFO(reference["id"]);
    const auto found = growth_range(golden::updated_problem(reference));
    // The reference promises 1e-7 and keeps rounding.
    CHECK(golden::difference(found.growth_rate, expect["growth_rate"]) < polished);
    CHECK(golden::difference(found.omega_squared_min, expect["omega_squared_min"]) < polished);
    CHECK(golden::difference(found.omega_squared_max, expect["omega_squared_max"]) < polished);
    CHECK(found.fastest.omega == found.growth_rate);
  }
}

TEST_CASE("a tl-linear body grows by its certified range", "[fast]") {
  auto problem = problem_2d(LatticeKind::square, KernelFamily::gaussian, 1.3, 7.0);
  problem.scheme.momentum_density = MomentumDensity::equation_of_state;
  problem.displacement_gradient = -0.4 * Tensor<2>::Identity();
  const auto limit = std::get<NeverStable<2>>(BulkModes<2>(problem).limit());
  const auto found = growth_range(problem);
  CHECK(found.growth_rate == Approx(limit.growth_rate).epsilon(polished));
  CHECK(found.omega_squared_min == Approx(-limit.growth_rate * limit.growth_rate).epsilon(polished));
  problem.displacement_gradient.setZero();
  const auto at_rest = growth_range(problem);
  const auto stable = std::get<ConditionallyStable<2>>(BulkModes<2>(problem).limit());
  CHECK(at_rest.growth_rate == 0.0);
  CHECK(at_rest.omega_squared_max == Approx(4.0 / std::pow(stable.critical_time_step, 2)).epsilon(polished));
}

TEST_CASE("a bar grows by the closed form of one dimension", "[fast]") {
  // theory.md §7: ω² = c0² A² + (2σ/ρ)(A² − B) with p-wave speed and ρ = ρ0 + P/c0², here scanned in 1-D; shear 0.
  for (const auto kernel : bells)
    for (const double h : {1.0, 1.3, 1.7})
      for (const double pressure : {-0.05, 0.05}) {
        const auto problem = updated_problem<1>(LatticeKind::chain, kernel, h, 0.0, pressure);
        const double sigma = -pressure, rho = 1.0 + pressure;
        const auto omega_squared = [&](double k) {
          double A = 0.0, B = 0.0;
          for (double j = 1.0; j < problem.kernel.support(); ++j) {
            A += 2.0 * std::sin(k * j) * problem.kernel.slope(j);
            B += 4.0 * std::pow(std::sin(0.5 * k * j), 2) * problem.kernel.curvature(j);
          }
          return A * A + 2.0 * sigma / rho * (A * A - B);
        };
        constexpr int points = 200000;  // off by (π/points · 3)² of the range: 2e-9
        double least = 0.0, largest = 0.0;
        for (int i = 0; i <= points; ++i) {
          const double value = omega_squared(std::numbers::pi * i / points);
          least = std::min(least, value);
          largest = std::max(largest, value);
        }
        INFO(name_of(kernel) << " h " << h << " P " << pressure);
        const auto found = growth_range(problem);
        CHECK(found.omega_squared_min == Approx(least).epsilon(1e-8).margin(1e-15));
        CHECK(found.omega_squared_max == Approx(largest).epsilon(1e-8));
        CHECK(found.growth_rate * found.growth_rate == Approx(-found.omega_squared_min).epsilon(polished));
      }
}

TEST_CASE("neighbours alone grow by Swegle's rate at the end of the zone", "[fast]") {
  auto problem = updated_problem<1>(LatticeKind::chain, KernelFamily::cubic_spline, 1.0, 0.0, -0.05);
  const double expected = std::sqrt(8.0 * problem.kernel.curvature(1.0) * 0.05 / 0.95);
  const auto found = growth_range(problem);
  CHECK(found.growth_rate == Approx(expected).epsilon(polished));
  CHECK(std::abs(found.fastest.wave_vector[0]) == Approx(std::numbers::pi));
}

TEST_CASE("marginal states do not grow at all", "[fast]") {
  // theory.md §7: W'' = 0 at the neighbours, or sums of W'' that cancel.
  for (const double pressure : {-0.05, 0.05})
    for (const auto& [kernel, h] :
         {std::pair(KernelFamily::cubic_spline, 1.5), std::pair(KernelFamily::wendland_c2, 1.5)}) {
      const auto problem = updated_problem<1>(LatticeKind::chain, kernel, h, 0.0, pressure);
      const auto wave = UpdatedLagrangian<1>(problem)(Vector<1>(std::numbers::pi));
      CHECK(squared_frequencies<1>(wave.dynamical_matrix(), wave.rounding)[0] == 0.0);
    }
  for (const auto lattice : {LatticeKind::square, LatticeKind::hexagonal, LatticeKind::staggered})
    for (const double mu : {0.0, 0.3}) {
      const auto found = growth_range(updated_problem<2>(lattice, KernelFamily::cubic_spline, 1.7, mu, 0.0));
      CHECK(found.growth_rate == 0.0);
      CHECK(found.omega_squared_min == 0.0);
    }
}

TEST_CASE("no point of a fine grid grows faster than the maximum found, and some come near", "[fast]") {
  auto sheared = updated_problem<2>(LatticeKind::hexagonal, KernelFamily::wendland_c2, 1.3, 0.3, 0.02);
  sheared.deviatoric_stress << 0.05, 0.02, 0.02, -0.03;
  auto stiffened = updated_problem<2>(LatticeKind::staggered, KernelFamily::cubic_spline, 1.2, 0.3, -0.05);
  stiffened.scheme.artificial_stress = ArtificialStress{0.5};
  stiffened.scheme.xsph = Xsph{0.5};
  constexpr double grid_error = 2e-3;  // of ω², (π/300 · 4)² of the range
  for (const auto& problem : {sheared, stiffened}) {
    const auto found = growth_range(problem);
    const Extremes grid = scanned(problem, 300);
    CHECK(grid.growth <= found.growth_rate * (1.0 + polished));
    CHECK(grid.growth >= found.growth_rate * (1.0 - 0.05));
    CHECK(grid.least >= found.omega_squared_min - polished);
    CHECK(grid.least <= found.omega_squared_min + grid_error * found.omega_squared_max);
    CHECK(grid.largest <= found.omega_squared_max * (1.0 + polished));
    CHECK(grid.largest >= found.omega_squared_max * (1.0 - grid_error));
  }
  auto solid = updated_problem<3>(LatticeKind::bcc, KernelFamily::cubic_spline, 1.1, 0.3, 0.05);
  const auto found = growth_range(solid);
  const Extremes grid = scanned(solid, 24);
  CHECK(grid.growth <= found.growth_rate * (1.0 + polished));
  CHECK(grid.growth >= 0.5 * found.growth_rate);  // a narrow dip beside a coarse grid
  CHECK(grid.largest <= found.omega_squared_max * (1.0 + polished));
  CHECK(grid.largest >= 0.95 * found.omega_squared_max);
}

TEST_CASE("flutter in a narrow tongue is found", "[fast]") {
  // theory.md §3: growth .0064 at k = (.4, 1.1333)π with exact R, none with frozen R in that mode.
  auto problem = under_tension(LatticeKind::staggered, 1.2, ArtificialStressLinearisation::exact);
  problem.scheme.artificial_stress->epsilon = 0.5;
  const auto found = growth_range(problem);
  CHECK(found.growth_rate >= 0.0064);
  CHECK(found.fastest.branch == Branch::coupled);
  problem.scheme.artificial_stress->linearisation = ArtificialStressLinearisation::frozen;
  CHECK(growth_range(problem).growth_rate == 0.0);
}

TEST_CASE("flutter in a tongue narrower than the grid is found by the discriminant", "[fast]") {
  auto problem = updated_problem<2>(LatticeKind::hexagonal, KernelFamily::cubic_spline, 1.5, 0.3, -0.05);
  problem.material = Material::from_sound_speed(1.05, 1.0, 0.3);
  problem.scheme.artificial_stress = ArtificialStress{.epsilon = 0.05};
  problem.scheme.xsph = Xsph{0.5};
  const auto range = growth_range(problem);
  const Vector<2>& k = range.fastest.wave_vector;
  CHECK(range.growth_rate > 1e-5);
  CHECK(range.growth_rate < 2e-5);
  CHECK(range.fastest.branch == Branch::coupled);
  // The pair at that wave vector is complex by its own trace and determinant.
  const Tensor<2> M = dynamical_matrix(problem, k);
  CHECK(std::pow(M(0, 0) - M(1, 1), 2) + 4.0 * M(0, 1) * M(1, 0) < 0.0);
}

TEST_CASE("a rotated body grows at the same rate", "[fast]") {
  auto problem = updated_problem<2>(LatticeKind::staggered, KernelFamily::cubic_spline, 1.3, 0.3, -0.03);
  problem.deviatoric_stress << 0.04, 0.01, 0.01, -0.02;
  problem.scheme.artificial_stress = ArtificialStress{0.3};
  const auto before = growth_range(problem), after = growth_range(rotated(problem, 0.7));
  CHECK(after.growth_rate == Approx(before.growth_rate).epsilon(1e-10));  // neighbours rotate with roundings
  CHECK(after.omega_squared_max == Approx(before.omega_squared_max).epsilon(1e-10));
}

TEST_CASE("the least artificial stress that stabilises is that of the zero-energy modes where R is frozen", "[fast]") {
  // theory.md §9, three digits: the larger of M and K on the hexagonal lattice; (0, π) on the staggered one.
  constexpr double printed = 7e-4;
  const auto least = [](LatticeKind lattice, double h, ArtificialStressLinearisation linearisation) {
    const auto intervals = stabilising_epsilon(under_tension(lattice, h, linearisation));
    return intervals.empty() ? -1.0 : intervals.front().from;
  };
  using enum ArtificialStressLinearisation;
  CHECK(std::abs(least(LatticeKind::hexagonal, 1.0, frozen) - 0.132) < printed);
  CHECK(std::abs(least(LatticeKind::hexagonal, 1.2, frozen) - 0.053) < printed);
  CHECK(std::abs(least(LatticeKind::hexagonal, 1.3, frozen) - 0.015) < printed);
  CHECK(std::abs(least(LatticeKind::staggered, 1.0, frozen) - 0.639) < printed);
  CHECK(std::abs(least(LatticeKind::staggered, 1.2, frozen) - 0.308) < printed);
  CHECK(std::abs(least(LatticeKind::staggered, 1.3, frozen) - 0.187) < printed);
  CHECK(std::abs(least(LatticeKind::staggered, 1.5, frozen) - 0.040) < 1.1e-3);
  CHECK(std::abs(least(LatticeKind::hexagonal, 1.0, exact) - 0.132) < printed);
  for (const double h : {1.0, 1.2, 1.3, 1.5}) CHECK(least(LatticeKind::square, h, exact) == -1.0);
  CHECK(least(LatticeKind::hexagonal, 2.0, exact) == -1.0);
  CHECK(least(LatticeKind::staggered, 1.2, exact) == -1.0);
}

TEST_CASE("within its intervals nothing grows, and beyond each edge something does", "[fast]") {
  auto problem = under_tension(LatticeKind::hexagonal, 1.3, ArtificialStressLinearisation::exact);
  const auto intervals = stabilising_epsilon(problem);
  REQUIRE(intervals.size() == 1);
  const auto rate = [&](double epsilon) {
    problem.scheme.artificial_stress->epsilon = epsilon;
    return growth_range(problem).growth_rate;
  };
  const double c_p = std::sqrt(1.4);
  for (const double inside : {intervals[0].from, 0.5, intervals[0].to}) CHECK(rate(inside) <= negligible_growth * c_p);
  for (const double outside : {intervals[0].from - 1e-6, intervals[0].to + 1e-6})
    CHECK(rate(outside) > negligible_growth * c_p);
}

TEST_CASE("artificial stress that cannot act changes nothing", "[fast]") {
  // In compression R = 0: stable or not at every ε; hexagonal lattices at h = 1.3 are not, all are without stress.
  CHECK(stabilising_epsilon(updated_problem<2>(LatticeKind::hexagonal, KernelFamily::cubic_spline, 1.3, 0.3, 0.05))
            .empty());
  const auto whole =
      stabilising_epsilon(updated_problem<2>(LatticeKind::hexagonal, KernelFamily::cubic_spline, 1.3, 0.3, 0.0));
  REQUIRE(whole.size() == 1);
  CHECK(whole[0].from == 0.0);
  CHECK(whole[0].to == largest_epsilon);
}
