// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "analysis/amplification.hpp"
#include "analysis/critical_step.hpp"
#include "tests/analysis/problems.hpp"

// Zhang et al., Appendix A, as corrected in errata.md Z1 to Z4: the closed formulas of four neighbours.

using namespace sphstab;
using namespace sphstab::analysis;

namespace {

/// A dozen roundings.
constexpr double rounding_tolerance = 1e-14;
/// The square roots of A.8 in complex double arithmetic lose half the digits where two eigenvalues meet; here they do
/// not.
constexpr double eigenvalue_tolerance = 1e-12;

struct Appendix {
  Problem<2> problem = problem_2d(LatticeKind::square, KernelFamily::gaussian, 0.7, 7.0);
  double G, gamma, c;

  explicit Appendix(Plane plane) {
    problem.neighbour_rule = NeighbourRule::nearest;
    problem.plane = plane;
    const double mu = problem.material.poisson_ratio(), rho = problem.material.density(), m = rho;
    G = problem.material.young_modulus() / (1.0 + mu);
    gamma = mu * G / (plane == Plane::strain ? 1.0 - 2.0 * mu : 1.0 - mu);
    c = std::pow(m * problem.kernel.slope(1.0), 2) / std::pow(rho, 3);
  }
  /// A.6 and A.7.
  double A(double K, double Q) const {
    return c * (2.0 * (gamma + G) * std::cos(2.0 * K) + G * std::cos(2.0 * Q) - 2.0 * gamma - 3.0 * G);
  }
  double B(double K, double Q) const { return c * (2.0 * gamma + G) * (std::cos(K + Q) - std::cos(K - Q)); }
};

constexpr double K = 0.7, Q = 1.9, t = 1.1;

}  // namespace

TEST_CASE("the amplification matrix of four neighbours is A.5 with C in rows 2 and 4", "[fast]") {
  for (const auto plane : {Plane::strain, Plane::stress}) {
    const Appendix paper(plane);
    const double A = paper.A(K, Q), B = paper.B(K, Q), C = paper.A(Q, K);
    Eigen::Matrix4d expected;
    expected << 1, 0, t * A, t * B, 0, 1, t * B, t * C, t, 0, 1 + t * t * A, t * t * B, 0, t, t * t * B, 1 + t * t * C;
    const auto E = amplification_matrix(paper.problem, Vector<2>(K, Q), t);
    CHECK((E - expected.cast<std::complex<double>>()).norm() < rounding_tolerance);
  }
}

TEST_CASE("the eigenvalues of four neighbours are A.8 as corrected", "[fast]") {
  const Appendix paper(Plane::strain);
  const double A = paper.A(K, Q), B = paper.B(K, Q), C = paper.A(Q, K);
  const double P = std::sqrt(A * A - 2.0 * A * C + C * C + 4.0 * B * B);
  for (const double step : {0.4, 1.1, 3.0}) {
    const double t2 = step * step;
    const auto eigenvalues = mode_spectrum(paper.problem, Vector<2>(K, Q), step).eigenvalues;
    for (const double s : {1.0, -1.0})
      for (const double sign : {1.0, -1.0}) {
        const std::complex<double> root = std::sqrt(std::complex<double>(
            (A * A + 2.0 * B * B + C * C + s * (A + C) * P) * t2 * t2 + 4.0 * (A + C + s * P) * t2));
        const auto expected = 1.0 + t2 * (A + C + s * P) / 4.0 + sign * std::sqrt(2.0) / 4.0 * root;
        double nearest = 1e300;
        for (const auto& value : eigenvalues) nearest = std::min(nearest, std::abs(value - expected));
        CHECK(nearest < eigenvalue_tolerance * std::max(1.0, std::abs(expected)));
      }
  }
}

TEST_CASE("the exact limit of a mode of four neighbours is the second entry of A.9, its first the transverse one",
          "[fast]") {
  const Appendix paper(Plane::stress);
  const double sines = std::pow(std::sin(K), 2) + std::pow(std::sin(Q), 2);
  const auto limit = std::get<ConditionallyStable<2>>(mode_limit(paper.problem, Vector<2>(K, Q)));
  CHECK(std::pow(limit.critical_time_step, 2) ==
        Approx(2.0 / sines / (2.0 * paper.c * (paper.gamma + paper.G))).epsilon(rounding_tolerance));
  // The transverse eigenvalues leave the circle at the first entry: double −1 there.
  const double transverse = std::sqrt(2.0 / sines / (paper.c * paper.G));
  const auto below = mode_spectrum(paper.problem, Vector<2>(K, Q), 0.999 * transverse).eigenvalues;
  const auto above = mode_spectrum(paper.problem, Vector<2>(K, Q), 1.001 * transverse).eigenvalues;
  CHECK(std::max(std::abs(below[2]), std::abs(below[3])) == Approx(1.0).epsilon(rounding_tolerance));
  CHECK(std::max(std::abs(above[2]), std::abs(above[3])) > 1.01);
}

TEST_CASE("Zhang's bound for four neighbours is sufficient and not sharp", "[fast]") {
  for (const auto plane : {Plane::strain, Plane::stress}) {
    const Appendix paper(plane);
    const double bound = std::sqrt(1.0 / (paper.c * (2.0 * paper.gamma + 3.0 * paper.G)));  // A.10
    const double exact = std::sqrt(1.0 / (2.0 * paper.c * (paper.gamma + paper.G)));
    CHECK(*published_bound(paper.problem) == Approx(bound).epsilon(rounding_tolerance));
    const auto bulk = std::get<ConditionallyStable<2>>(BulkModes(paper.problem).limit());
    CHECK(bulk.critical_time_step == Approx(exact).epsilon(rounding_tolerance));
    CHECK(bulk.bracket.low <= exact);
    CHECK(exact <= bulk.bracket.high);
    CHECK(bulk.mode.branch == Branch::longitudinal);
    // errata.md Z4: exact/Eq. 15 = 1.1619 (stress), 1.1339 (strain) at μ = 0.3, four decimals.
    CHECK(std::abs(exact / bound - (plane == Plane::stress ? 1.1619 : 1.1339)) < 5e-5);
    // The box of 20 × 20 particles contains KΔ = QΔ = π/2 (m = l = 10), the worst mode.
    CHECK(std::get<ConditionallyStable<2>>(paper_limit(paper.problem, {20, 20})).critical_time_step ==
          Approx(exact).epsilon(rounding_tolerance));
    CHECK(std::get<ConditionallyStable<2>>(paper_limit(paper.problem, {3, 3})).critical_time_step ==
          Approx(exact / std::sin(std::numbers::pi / 3.0)).epsilon(rounding_tolerance));
  }
}

TEST_CASE("Zhang's bound exceeds the exact limit of a full stencil", "[fast]") {
  // errata.md Z5: Gaussian H = Δ, plane stress, data of validation case 1: Eq. 15 gives 3.138e-3 s, exact 2.830e-3 s.
  Problem<2> problem{Lattice<2>(LatticeKind::square, 2.5e-5),
                     Kernel<2>(KernelFamily::gaussian, 2.5e-5, 7.0),
                     NeighbourRule::support,
                     Material::from_young_modulus(1000.0, 0.39, 0.3),
                     Plane::stress,
                     Scheme{}};
  constexpr double printed = 6e-7;
  CHECK(std::abs(*published_bound(problem) - 3.138e-3) < printed);
  CHECK(std::abs(std::get<ConditionallyStable<2>>(BulkModes(problem).limit()).critical_time_step - 2.830e-3) < printed);
  problem.lattice = Lattice<2>(LatticeKind::hexagonal, 2.5e-5);
  CHECK_FALSE(published_bound(problem));
}
