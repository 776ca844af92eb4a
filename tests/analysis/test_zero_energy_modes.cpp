// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "analysis/critical_step.hpp"
#include "analysis/gradient_symbol.hpp"
#include "tests/analysis/problems.hpp"

using namespace sphstab;
using namespace sphstab::analysis;

namespace {

constexpr double pi = std::numbers::pi;
/// A zero is found to ε/slope; the least slope among these cases is some 1e-3 of the largest.
constexpr double zero_tolerance = 1e-13;
constexpr double position_tolerance = 1e-10;

bool contains(const ZeroEnergyModes<2>& modes, const Vector<2>& k, double tolerance) {
  for (const auto& mode : modes.wave_vectors)
    if ((mode - k).norm() < tolerance) return true;
  return false;
}

}  // namespace

TEST_CASE("all zero-energy modes of the cubic spline are found", "[fast]") {
  // theory.md §1: zeros of D per zone, Γ included.
  struct Row {
    LatticeKind lattice;
    std::array<std::size_t, 5> zeros;
  };
  constexpr std::array<double, 5> h{1.0, 1.5, 2.0, 3.0, 4.0};
  for (const auto& [lattice, zeros] :
       {Row{LatticeKind::square, {4, 4, 12, 40, 60}}, Row{LatticeKind::hexagonal, {6, 6, 24, 42, 90}},
        Row{LatticeKind::staggered, {6, 6, 20, 32, 72}}})
    for (std::size_t i = 0; i < h.size(); ++i) {
      INFO(name_of(lattice) << " h = " << h[i]);
      const auto problem = problem_2d(lattice, KernelFamily::cubic_spline, h[i]);
      const GradientSymbol<2> symbol(problem);
      const auto modes = zero_energy_modes(problem);
      CHECK(modes.complete);
      CHECK(modes.wave_vectors.size() + 1 == zeros[i]);
      for (const auto& k : modes.wave_vectors) {
        CHECK(symbol(k).norm() < zero_tolerance);
        // In the first zone: no reciprocal vector is nearer than Γ. With k, −k or an equivalent of it is listed.
        bool mirrored = contains(modes, -k, position_tolerance);
        for (int n = -2; n <= 2; ++n)
          for (int m = -2; m <= 2; ++m) {
            const Vector<2> g = problem.lattice.reciprocal_vectors() * Vector<2>(n, m);
            CHECK((k - g).norm() > k.norm() - position_tolerance);
            mirrored = mirrored || contains(modes, g - k, position_tolerance);
          }
        CHECK(mirrored);
      }
    }
}

TEST_CASE("the zero-energy modes of few neighbours are the symmetric points", "[fast]") {
  const auto square = zero_energy_modes(problem_2d(LatticeKind::square, KernelFamily::wendland_c6, 1.3));
  CHECK(square.wave_vectors.size() == 3);
  for (const Vector<2>& k : {Vector<2>(pi, 0), Vector<2>(0, pi), Vector<2>(pi, pi)})
    CHECK(contains(square, k, position_tolerance));
  const auto hexagonal = zero_energy_modes(problem_2d(LatticeKind::hexagonal, KernelFamily::cubic_spline, 1.0));
  CHECK(contains(hexagonal, Vector<2>(4.0 * pi / 3.0, 0), position_tolerance));             // K
  CHECK(contains(hexagonal, Vector<2>(0, 2.0 * pi / std::sqrt(3.0)), position_tolerance));  // M
}

TEST_CASE("the staggered lattice has zero-energy modes at incommensurate wave vectors", "[fast]") {
  // theory.md §1: (u, v) = (.3931, .6966) at h = Δp and (.3472, .6736) at 1.5 Δp in units of the reciprocal vectors.
  constexpr double printed = 1e-4;  // one unit of the last digit: the exact v at h = Δp is .696548
  struct Pair {
    double h, u, v;
  };
  for (const auto& [h, u, v] : {Pair{1.0, 0.3931, 0.6966}, Pair{1.5, 0.3472, 0.6736}}) {
    const auto problem = problem_2d(LatticeKind::staggered, KernelFamily::cubic_spline, h);
    bool found = false;
    for (const auto& k : zero_energy_modes(problem).wave_vectors) {
      const Vector<2> turns = GradientSymbol<2>(problem).phases(k) / (2.0 * pi);
      found = found || (std::abs(turns[0] - std::floor(turns[0]) - u) < printed &&
                        std::abs(turns[1] - std::floor(turns[1]) - v) < printed);
    }
    CHECK(found);
  }
}

TEST_CASE("where the symbol is below rounding on whole regions, the list says that it is incomplete", "[fast]") {
  const auto problem = problem_2d(LatticeKind::square, KernelFamily::gaussian, 4.0, 7.0);  // |D| ~ e^{−39} at (π, 0)
  CHECK_FALSE(zero_energy_modes(problem).complete);
  CHECK(zero_energy_modes(problem).wave_vectors.size() == 3);
}
