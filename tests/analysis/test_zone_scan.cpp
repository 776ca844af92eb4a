// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>

#include "analysis/critical_step.hpp"
#include "analysis/gradient_symbol.hpp"
#include "analysis/zone_scan.hpp"
#include "tests/analysis/problems.hpp"
#include "tests/analysis/updated_problems.hpp"

using namespace sphstab;
using namespace sphstab::analysis;

namespace {

/// The maximum of |D|² over the zone by the certified search.
double certified(const Problem<2>& problem) {
  auto elastic = problem;
  elastic.scheme = Scheme{};
  elastic.integrator = Integrator::leapfrog;
  return std::pow(BulkModes<2>(elastic).symbol_maximum(), 2);
}

}  // namespace

TEST_CASE("a scan finds the maximum that the certified search finds", "[fast]") {
  for (const auto lattice : {LatticeKind::square, LatticeKind::hexagonal, LatticeKind::staggered})
    for (const double h : {1.0, 1.5, 2.0}) {
      const auto problem = updated_problem<2>(lattice, KernelFamily::sinc_5, h, 0.3, 0.0);
      const GradientSymbol<2> symbol(problem);
      const ZoneScan<2> scan(problem);
      const auto found = scan.maximum([&](const Vector<2>& k) { return symbol(k).squaredNorm(); });
      const double expected = certified(problem);
      CHECK(found.value == Approx(expected).epsilon(1e-12));
      // D Dᵀ has the eigenvalues 0 and |D|².
      const auto eigenvalues = [&](const Vector<2>& k) { return EigenvalueRange{0.0, symbol(k).squaredNorm()}; };
      const double bound = scan.upper_bound(eigenvalues, 2, found.value);
      CHECK(bound >= expected);
      CHECK(bound < expected * (1.0 + 1e-4));  // a ring of near-maxima spends the budget
    }
}

TEST_CASE("a dip at a zero-energy mode is found however narrow", "[fast]") {
  const auto problem = updated_problem<2>(LatticeKind::staggered, KernelFamily::cubic_spline, 1.3, 0.3, 0.0);
  const GradientSymbol<2> symbol(problem);
  const ZoneScan<2> scan(problem);
  for (const auto& zero : zero_energy_modes(problem).wave_vectors) {
    const auto dip = [&](const Vector<2>& k) {
      return std::max(std::exp(-(k - zero).squaredNorm() * 1e12), std::exp(-(k + zero).squaredNorm() * 1e12));
    };
    CHECK(scan.maximum(dip).value == Approx(1.0).epsilon(1e-6));
  }
}

TEST_CASE("the upper bound of values that go far below zero keeps the highest of three near peaks", "[fast]") {
  // cos 4θ peaks at 0, π/2 and π, a little higher at π; the grid has a point at π/2, and none at π. A bound that took
  // the least value for 0 would drop the box of π.
  const auto problem = updated_problem<1>(LatticeKind::chain, KernelFamily::cubic_spline, 1.3, 0.3, 0.0);
  const ZoneScan<1> scan(problem);
  constexpr int order = 2;  // times the reach of two neighbours: type 4
  const auto value = [](const Vector<1>& k) {
    const double f = -0.9 + std::cos(4.0 * k[0]) - 0.01 * std::cos(k[0]);
    return EigenvalueRange{f, f};
  };
  const double highest = -0.9 + 1.0 + 0.01;
  double sampled = -1.0;
  for (const auto& k : scan.points()) sampled = std::max(sampled, value(k).high);
  const double bound = scan.upper_bound(value, order, sampled);
  CHECK(bound >= highest);
  CHECK(bound < highest + 1e-9);
}
