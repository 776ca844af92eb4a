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
