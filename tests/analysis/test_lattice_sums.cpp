// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "analysis/gradient_symbol.hpp"
#include "analysis/lattice_sums.hpp"
#include "tests/analysis/golden.hpp"
#include "tests/analysis/problems.hpp"

using namespace sphstab;
using namespace sphstab::analysis;

namespace {

/// Both sums carry some 10 roundings of each of up to 30 terms that cancel at most tenfold.
constexpr double rounding_tolerance = 1e-13;
/// The third-order error of D − L k falls by 8 when k is halved; the next order is (kΔp)² ~ 1e-4 of it.
constexpr double order_tolerance = 1e-2;

}  // namespace

TEST_CASE("the lattice sums agree with the reference", "[fast]") {
  const auto references = golden::cases("sums");
  REQUIRE(references.size() == 10);
  for (const auto& reference : references) {
    INFO(reference["id"]);
    const auto problem = golden::problem(reference);
    const ArtificialStress weight{.epsilon = 1.0, .exponent = reference["artificial_stress_exponent"].get<double>()};
    const LatticeSummation<2> summation(problem.lattice, problem.kernel, problem.neighbour_rule, weight, std::nullopt);
    const auto sums = summation(golden::numbers<Vector<2>>(reference["wave_vector"]));
    const auto& expect = reference["expect"];
    const double tolerance = reference["tolerance"];
    CHECK(summation.neighbours() == expect["neighbours"]);
    CHECK(golden::difference(sums.beta_sum, expect["beta_sum"]) < tolerance);
    for (int i = 0; i < 2; ++i) {
      CHECK(golden::difference(sums.A[i], expect["A"][i]) < tolerance);
      for (int j = 0; j < 2; ++j) {
        CHECK(golden::difference(sums.B(i, j), expect["B"][i][j]) < tolerance);
        CHECK(golden::difference(sums.f(i, j), expect["f"][i][j]) < tolerance);
      }
    }
  }
}

TEST_CASE("the gradient symbol is minus the sum A on every lattice", "[fast]") {
  for (const LatticeKind lattice : lattices_of(2)) {
    INFO(name_of(lattice));
    const auto problem = problem_2d(lattice, KernelFamily::quintic_spline, 1.3);
    const GradientSymbol<2> symbol(problem);
    const LatticeSummation<2> summation(problem.lattice, problem.kernel, problem.neighbour_rule, std::nullopt,
                                        std::nullopt);
    for (const Vector<2>& k : {Vector<2>(0.3, 0.1), Vector<2>(-1.9, 2.7), Vector<2>(3.0, -0.4)}) {
      const auto sums = summation(k);
      CHECK((symbol(k) + sums.A).norm() < rounding_tolerance);
      CHECK((symbol(-k) + symbol(k)).norm() == 0.0);
      const Vector<2> equivalent = k + problem.lattice.reciprocal_vectors() * Vector<2>(2.0, -1.0);
      CHECK((symbol(equivalent) - symbol(k)).norm() < rounding_tolerance);
    }
  }
}

TEST_CASE("long waves see the consistency matrix, with third-order error", "[fast]") {
  for (const LatticeKind lattice : lattices_of(2)) {
    INFO(name_of(lattice));
    const GradientSymbol<2> symbol(problem_2d(lattice, KernelFamily::cubic_spline, 1.3));
    const auto error = [&](double size) {
      const Vector<2> k(0.8 * size, 0.6 * size);
      return (symbol(k) - symbol.consistency() * k).norm();
    };
    CHECK(error(0.02) / error(0.01) == Approx(8.0).epsilon(order_tolerance));
  }
}

TEST_CASE("the staggered lattice stretches the gradient differently along its axes", "[fast]") {
  // theory.md §1: L = diag(.98560, .97856), square 1.01310 I, cubic spline with h = Δp; five digits are printed.
  constexpr double printed = 5.1e-6;
  const auto staggered =
      GradientSymbol<2>(problem_2d(LatticeKind::staggered, KernelFamily::cubic_spline, 1.0)).consistency();
  CHECK(std::abs(staggered(0, 0) - 0.98560) < printed);
  CHECK(std::abs(staggered(1, 1) - 0.97856) < printed);
  CHECK(std::abs(staggered(0, 1)) < rounding_tolerance);
  const auto square = GradientSymbol<2>(problem_2d(LatticeKind::square, KernelFamily::cubic_spline, 1.0)).consistency();
  CHECK((square - 1.01310 * Tensor<2>::Identity()).norm() < 2.0 * printed);
}
