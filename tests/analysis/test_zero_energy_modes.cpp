// SPDX-License-Identifier: MIT
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "analysis/critical_step.hpp"
#include "analysis/gradient_symbol.hpp"
#include "analysis/zone_grid.hpp"
#include "analysis/zone_zeros.hpp"
#include "tests/analysis/problems.hpp"

using namespace sphstab;
using namespace sphstab::analysis;

namespace {

constexpr double pi = std::numbers::pi;
/// A zero is found to ε/slope; the least slope among these cases is some 1e-3 of the largest.
constexpr double zero_tolerance = 1e-13;
constexpr double position_tolerance = 1e-10;

template <int Dim>
bool contains(const ZeroEnergyModes<Dim>& modes, const Vector<Dim>& k, double tolerance) {
  for (const auto& mode : modes.wave_vectors)
    if ((mode - k).norm() < tolerance) return true;
  return false;
}

/// sin θ Π (cos θ − c_i), i = 1, 2: zero at 0, π and ± arccos c_i.
std::vector<double> sine_coefficients(double c_1, double c_2) { return {0.25 + c_1 * c_2, -0.5 * (c_1 + c_2), 0.25}; }

std::vector<double> zeros_of(double c_1, double c_2) {
  return {0.0, pi, std::acos(c_1), -std::acos(c_1), std::acos(c_2), -std::acos(c_2)};
}

std::vector<SineTerm<1>> line_terms(const std::vector<double>& coefficients) {
  std::vector<SineTerm<1>> terms;
  for (std::size_t m = 0; m < coefficients.size(); ++m)
    terms.push_back({LatticeIndex<1>(static_cast<int>(m + 1)), Vector<1>(coefficients[m])});
  return terms;
}

/// (f(θ1), g(θ2)) of two series on a line.
SineSeries<2> separable(const std::vector<SineTerm<1>>& f, const std::vector<SineTerm<1>>& g) {
  std::vector<SineTerm<2>> terms;
  for (const auto& [n, w] : f) terms.push_back({{n[0], 0}, Vector<2>(w[0], 0.0)});
  for (const auto& [n, w] : g) terms.push_back({{0, n[0]}, Vector<2>(0.0, w[0])});
  return SineSeries<2>(terms);
}

/// Checks that exactly the expected zeros are found, Γ excluded.
template <int Dim>
void check_zeros(const ZoneZeros<Dim>& found, const std::vector<Vector<Dim>>& expected, double tolerance) {
  CHECK(found.complete);
  CHECK(found.phases.size() == expected.size() - 1);
  for (const Vector<Dim>& zero : expected) {
    double nearest = zero.norm();
    for (const auto& phases : found.phases) nearest = std::min(nearest, wrapped<Dim>(phases - zero).norm());
    CHECK(nearest < tolerance);
  }
}

std::vector<Vector<1>> on_line(const std::vector<double>& zeros) {
  std::vector<Vector<1>> points;
  for (const double zero : zeros) points.emplace_back(zero);
  return points;
}

std::vector<Vector<2>> products(const std::vector<double>& first, const std::vector<double>& second) {
  std::vector<Vector<2>> points;
  for (const double x : first)
    for (const double y : second) points.emplace_back(x, y);
  return points;
}

template <int Dim>
Problem<Dim> problem_with(LatticeKind lattice, KernelFamily kernel, double h) {
  return {.lattice = Lattice<Dim>(lattice, 1.0), .kernel = Kernel<Dim>(kernel, h), .material = zhang_material()};
}

}  // namespace

TEST_CASE("zeros that nearly coincide are told apart, and no zero between grid points is lost", "[fast]") {
  // Pairs of zeros as close as `gap`, where every bound of the exclusion and of the uniqueness is needed.
  for (const double gap : {0.3, 0.1, 0.03, 1e-3, 1e-5})
    for (double middle = 0.35; middle < 2.7; middle += 0.0173) {
      INFO("gap " << gap << " middle " << middle);
      const double c_1 = std::cos(middle), c_2 = std::cos(middle + gap), d_1 = std::cos(0.8 * middle), d_2 = -0.1;
      const auto f = line_terms(sine_coefficients(c_1, c_2)), g = line_terms(sine_coefficients(d_1, d_2));
      // The slope at the zeros of a pair is of the size of the gap, so that roundings of 1e-15 move them by 1e-15 /
      // gap.
      const double tolerance = 1e-13 / gap;
      check_zeros<1>(zone_zeros<1>(SineSeries<1>(f)), on_line(zeros_of(c_1, c_2)), tolerance);
      check_zeros<2>(zone_zeros<2>(separable(f, g)), products(zeros_of(c_1, c_2), zeros_of(d_1, d_2)), tolerance);
    }
}

TEST_CASE("the zeros of the steepest series of its type are all found", "[fast]") {
  // sin nθ falls to its zeros as fast as a function bounded by 1 of that type can.
  for (const int n : {3, 4, 5, 7, 11}) {
    INFO("n = " << n);
    std::vector<double> zeros;
    for (int j = 0; j < 2 * n; ++j) zeros.push_back(j * pi / n);
    const std::vector<SineTerm<1>> sine{{LatticeIndex<1>(n), Vector<1>(1.0)}};
    check_zeros<1>(zone_zeros<1>(SineSeries<1>(sine)), on_line(zeros), zero_tolerance);
    check_zeros<2>(zone_zeros<2>(separable(sine, sine)), products(zeros, zeros), zero_tolerance);
  }
}

TEST_CASE("a double zero is not certain, and the list says that it is incomplete", "[fast]") {
  const double c = std::cos(1.0);
  const auto found = zone_zeros<1>(SineSeries<1>(line_terms(sine_coefficients(c, c))));
  CHECK_FALSE(found.complete);
  CHECK(found.phases.size() == 1);  // π
}

TEST_CASE("in three dimensions the points of symmetry are zero-energy modes", "[fast]") {
  // Fractions of the reciprocal vectors: all halves, and P of bcc and W of fcc, which no direction survives.
  for (const LatticeKind lattice : lattices_of(3)) {
    INFO(name_of(lattice));
    const auto problem = problem_with<3>(lattice, KernelFamily::cubic_spline, 1.0);
    const auto modes = zero_energy_modes(problem);
    CHECK(modes.complete);
    std::vector<Vector<3>> fractions{{0.5, 0, 0}, {0.5, 0.5, 0}, {0.5, 0.5, 0.5}};
    if (lattice == LatticeKind::bcc) fractions.emplace_back(0.25, 0.25, 0.25);
    if (lattice == LatticeKind::fcc) fractions.emplace_back(0.25, 0.5, 0.75);
    for (const auto& fraction : fractions) {
      double nearest = 10.0;
      for (const auto& k : modes.wave_vectors) {
        const Vector<3> difference = problem.lattice.primitive_vectors().transpose() * k / (2.0 * pi) - fraction;
        nearest = std::min(nearest, (difference.array() - difference.array().round()).matrix().norm());
      }
      CHECK(nearest < position_tolerance);
    }
  }
}

TEMPLATE_TEST_CASE_SIG("the indices of all zero-energy modes add up to that of the zone, zero", "[fast]",
                       ((int Dim), Dim), 1, 2, 3) {
  // Poincaré and Hopf: D is a vector field on a torus, so sign det ∂D/∂k summed over its zeros is 0: no list that lacks
  // one zero, or a pair k, −k (whose signs are equal), passes.
  for (const LatticeKind lattice : lattices_of(Dim))
    for (const double h :
         Dim == 3 ? std::vector<double>{0.9, 1.0, 1.1} : std::vector<double>{1.1, 1.3, 1.5, 2.1, 3.1, 4.1}) {
      INFO(name_of(lattice) << " h = " << h);
      const auto problem = problem_with<Dim>(lattice, KernelFamily::cubic_spline, h);
      const GradientSymbol<Dim> symbol(problem);
      const auto modes = zero_energy_modes(problem);
      REQUIRE(modes.complete);
      const auto index = [&](const Vector<Dim>& k) {
        return symbol.series().jet(symbol.phases(k)).jacobian.determinant() > 0.0 ? 1 : -1;
      };
      // In phases, whose orientation relative to k is that of the primitive vectors.
      int sum = index(Vector<Dim>::Zero());
      for (const auto& k : modes.wave_vectors) {
        CHECK(symbol(k).norm() < zero_tolerance);
        sum += index(k);
      }
      CHECK(sum == 0);
    }
}

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
        bool mirrored = contains<2>(modes, -k, position_tolerance);
        for (int n = -2; n <= 2; ++n)
          for (int m = -2; m <= 2; ++m) {
            const Vector<2> g = problem.lattice.reciprocal_vectors() * Vector<2>(n, m);
            CHECK((k - g).norm() > k.norm() - position_tolerance);
            mirrored = mirrored || contains<2>(modes, g - k, position_tolerance);
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
