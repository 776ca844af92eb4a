// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "analysis/gradient_symbol.hpp"
#include "analysis/zone_maximum.hpp"
#include "tests/analysis/problems.hpp"

using namespace sphstab;
using namespace sphstab::analysis;

namespace {

/// Sums of some ten terms of order one.
constexpr double rounding_tolerance = 1e-14;
/// What the search promises unless its budget is spent, with the rounding of up to a few hundred terms.
constexpr double enclosure = 1e-12;
constexpr int scan_points = 300;

/// q summed in long double with the library's sine, term by term.
long double form_value(const SineSeries<2>& series, const Tensor<2>& form, const Vector<2>& phases) {
  long double D[2] = {0, 0};
  for (const auto& [n, w] : series.terms()) {
    const long double sine =
        std::sin(static_cast<long double>(n[0]) * phases[0] + static_cast<long double>(n[1]) * phases[1]);
    for (int i = 0; i < 2; ++i) D[i] += w[i] * sine;
  }
  return form(0, 0) * D[0] * D[0] + 2.0L * form(0, 1) * D[0] * D[1] + form(1, 1) * D[1] * D[1];
}

struct Scan {
  double value;
  Vector<2> phases;
};

/// The maximum over a grid of the whole zone, refined three times about its best point.
Scan brute_force(const SineSeries<2>& series, const Tensor<2>& form) {
  Scan best{-1e300, Vector<2>::Zero()};
  Vector<2> centre = Vector<2>::Constant(std::numbers::pi);
  for (double width = std::numbers::pi; width > 1e-8; width *= 8.0 / scan_points) {
    for (int i = 0; i <= scan_points; ++i)
      for (int j = 0; j <= scan_points; ++j) {
        const Vector<2> phases = centre + width * Vector<2>(2.0 * i / scan_points - 1.0, 2.0 * j / scan_points - 1.0);
        const Vector<2> D = series(phases);
        if (const double q = D.dot(form * D); q > best.value) best = {q, phases};
      }
    centre = best.phases;
  }
  return best;
}

void check_against_brute_force(const SineSeries<2>& series, const Tensor<2>& form) {
  const auto found = zone_maximum(series, form);
  const auto scan = brute_force(series, form);
  CHECK(scan.value <= found.upper);
  CHECK(found.value >= scan.value - enclosure * std::abs(scan.value));
  const auto exact = static_cast<double>(form_value(series, form, found.phases));
  CHECK(found.lower <= exact);
  CHECK(exact <= found.upper);
  CHECK(std::abs(found.value - exact) <= found.value - found.lower);
}

SineSeries<2> random_series(std::mt19937& random, int reach) {
  std::normal_distribution<double> normal;
  std::vector<SineTerm<2>> terms;
  for (int i = -reach; i <= reach; ++i)
    for (int j = 0; j <= reach; ++j)
      if (j > 0 || i > 0) terms.push_back({{i, j}, Vector<2>(normal(random), normal(random))});
  return SineSeries<2>(terms);
}

Tensor<2> tensor(double xx, double xy, double yy) {
  Tensor<2> t;
  t << xx, xy, xy, yy;
  return t;
}

/// Four neighbours: D = a (sin θ1, sin θ2), so that q ranges over a² times a quadratic form on the square [−1, 1]².
SineSeries<2> four_neighbours(double a) {
  return SineSeries<2>({{{1, 0}, Vector<2>(a, 0)}, {{0, 1}, Vector<2>(0, a)}});
}

/// The maximum of that form: at a corner, or on an edge where the other component is free.
double maximum_on_square(const Tensor<2>& form) {
  double best = std::max(form(0, 0) + 2.0 * std::abs(form(0, 1)) + form(1, 1), 0.0);
  for (const int i : {0, 1}) {
    const double b = form(0, 1), c = form(1 - i, 1 - i);
    if (c < 0.0 && std::abs(b) < -c) best = std::max(best, form(i, i) - b * b / c);
  }
  return best;
}

}  // namespace

TEST_CASE("the certified maximum over four neighbours is the closed one, for definite and indefinite forms", "[fast]") {
  for (const auto& form : {tensor(1, 0, 1), tensor(1, 0.3, 2), tensor(1, 1, 1), tensor(1, 0, -0.2),
                           tensor(0.7, 0.4, -0.9), tensor(-0.2, 0.5, 1.1), tensor(0.05, 0, -3), tensor(-1, 1.2, -1)}) {
    INFO(form);
    const auto found = zone_maximum(four_neighbours(0.6), form);
    const double expected = 0.36 * maximum_on_square(form);
    CHECK(std::abs(found.value - expected) < rounding_tolerance);
    CHECK(found.lower <= expected);
    CHECK(expected <= found.upper);
    CHECK(found.upper - found.lower < enclosure * expected);
  }
}

TEST_CASE("no scan beats the certified maximum of random series", "[fast]") {
  std::mt19937 random(11);
  for (const int reach : {1, 2, 3})
    for (int trial = 0; trial < 4; ++trial) {
      const auto series = random_series(random, reach);
      for (const auto& form :
           {tensor(1, 0, 1), tensor(1, -0.6, 0.5), tensor(1, 1, 1), tensor(0.8, 0.1, -1.0), tensor(-2, 0.1, 0.01)}) {
        INFO("reach " << reach << " trial " << trial << "\n" << form);
        check_against_brute_force(series, form);
      }
    }
}

TEST_CASE("no scan beats the certified maximum of SPH symbols, and the enclosure is tight", "[fast]") {
  for (const auto& [lattice, name] : Names<LatticeKind>::table)
    for (const double h : {0.9, 1.3, 1.55}) {
      INFO(name << " h = " << h);
      const GradientSymbol<2> symbol(problem_2d(lattice, KernelFamily::cubic_spline, h));
      check_against_brute_force(symbol.series(), Tensor<2>::Identity());
      const auto found = zone_maximum<2>(symbol.series(), Tensor<2>::Identity());
      CHECK(found.upper - found.lower < enclosure * found.value);
    }
}

TEST_CASE("an indefinite form on an SPH symbol is certified too", "[fast]") {
  // With a lower bound of 0 on q instead of the true negative one, the excluded boxes would hold the maximum.
  for (const double h : {0.65, 1.3}) {
    const GradientSymbol<2> symbol(problem_2d(LatticeKind::square, KernelFamily::cubic_spline, h));
    for (const auto& form : {tensor(1, 0, -1), tensor(0.02, 0, -1), tensor(-0.3, 0.4, 0.1)}) {
      INFO("h = " << h << "\n" << form);
      check_against_brute_force(symbol.series(), form);
    }
  }
}

TEST_CASE("a ring of near-maxima gives the right value and an honest bracket", "[fast]") {
  struct Ring {
    KernelFamily kernel;
    double h;
    double cutoff;
  };
  for (const auto& ring : {Ring{KernelFamily::gaussian, 2.0, 7.0}, Ring{KernelFamily::wendland_c6, 4.0, 3.0},
                           Ring{KernelFamily::sinc_5, 2.0, 3.0}}) {
    INFO(name_of(ring.kernel));
    const GradientSymbol<2> symbol(problem_2d(LatticeKind::square, ring.kernel, ring.h, ring.cutoff));
    const auto found = zone_maximum<2>(symbol.series(), Tensor<2>::Identity());
    // The radial profile of each of 2000 rays over half a turn, maximised by golden sections.
    double best = 0.0;
    for (int ray = 0; ray < 2000; ++ray) {
      const double angle = std::numbers::pi * ray / 2000.0;
      const auto profile = [&](double k) {
        return symbol.series()(Vector<2>(k * std::cos(angle), k * std::sin(angle))).squaredNorm();
      };
      double lo = 0.5 / ring.h, hi = 2.5 / ring.h;
      while (hi - lo > 1e-7 / ring.h) {
        const double left = hi - (hi - lo) / std::numbers::phi, right = lo + (hi - lo) / std::numbers::phi;
        (profile(left) < profile(right) ? lo : hi) = profile(left) < profile(right) ? left : right;
      }
      best = std::max(best, profile(lo));
    }
    // Rays are 1.6e-3 apart: between two of them q can be higher by the tangential variation, below 1e-5, times
    // (4 · 8e-4)² / 4, as a quarter turn is one period.
    constexpr double ray_spacing_error = 1e-10;
    constexpr double ring_value = 2e-10;  // 1e-10 of max |D|
    CHECK(found.value >= best * (1.0 - ring_value));
    CHECK(found.value <= best * (1.0 + ray_spacing_error));
    CHECK(found.lower <= best * (1.0 + ray_spacing_error));
    CHECK(found.upper >= best);
    CHECK(found.upper < best * (1.0 + 1e-4));
  }
}
