// SPDX-License-Identifier: MIT
#include "analysis/deformed_spectrum.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "analysis/finite_strain.hpp"
#include "tests/analysis/plain_finite_strain.hpp"

using namespace sphstab;
using namespace sphstab::analysis;

namespace {

/// Two dense eigenproblems of up to 200 unknowns whose matrices differ by the roundings of sums over 20 neighbours;
/// relative, of ω² to the largest one, of growth rates to the largest frequency: √ω² of 1e-3 of the largest ω² or more.
constexpr double rounding = 1e-12;
/// What is asked of the ends of a large spectrum, times ten.
constexpr double of_ends = 1e-9;

/// A free plate bent as in bodies::bent.
struct BentPlate {
  Problem<2> problem;
  Body<2> body;
  Eigen::VectorXd displacement;
  DeformedBodyOperator<2> op;

  BentPlate(const bodies::FiniteStrainScheme& scheme, const LatticeIndex<2>& particles, double strain,
            std::optional<Damping> damping = {})
      : problem(damped(bodies::finite_strain_problem<2>(scheme), damping)),
        body(bodies::block<2>(problem, particles)),
        displacement(bodies::bent(body, strain)),
        op(problem, body) {
    op.set_state(displacement);
  }
  BentPlate(const BentPlate&) = delete;

  static Problem<2> damped(Problem<2> problem, const std::optional<Damping>& damping) {
    problem.scheme.damping = damping;
    return problem;
  }
};

/// 24×24 cells, 1152 unknowns, stretched along x: the squares of all its waves are known one by one.
struct LargePatch {
  Problem<2> problem;
  Body<2> body;
  DeformedBodyOperator<2> op;
  double largest = 0.0, smallest = 0.0;

  explicit LargePatch(double stretch)
      : problem(stretched(stretch)), body(periodic_patch(problem, LatticeIndex<2>(cells, cells))), op(problem, body) {
    const FiniteStrain<2> waves(problem);
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < cells; ++j) {
        const Vector<2> k = problem.lattice.reciprocal_vectors() * Vector<2>(i, j) / cells;
        const Eigen::VectorXd squares = waves.dynamics(k).omega_squared().real();
        largest = std::max(largest, squares.maxCoeff());
        smallest = std::min(smallest, squares.minCoeff());
      }
  }
  LargePatch(const LargePatch&) = delete;

  static constexpr int cells = 24;
  static Problem<2> stretched(double stretch) {
    auto problem = bodies::finite_strain_problem<2>(bodies::finite_strain_schemes[0]);
    problem.material = Material::from_young_modulus(1.0, 1.3, 0.3);
    problem.deformation_gradient(0, 0) = stretch;
    return problem;
  }
};

int pairs_of(const DeformedSpectrum& spectrum) {
  return static_cast<int>(std::count_if(spectrum.all.begin(), spectrum.all.end(),
                                        [](const DeformedMode& mode) { return mode.omega_squared.imag() > 0.0; }));
}

constexpr auto corotated = bodies::finite_strain_schemes[0];

}  // namespace

TEST_CASE("a mode grows at the larger root of s² + c s + ω² = 0", "[fast]") {
  CHECK(growth_rate_of(-4.0, 0.0) == 2.0);
  CHECK(growth_rate_of(4.0, 0.0) == 0.0);
  CHECK(growth_rate_of(-4.0, 3.0) == Approx(1.0));  // s² + 3 s − 4 = (s − 1)(s + 4)
  CHECK(growth_rate_of(4.0, 3.0) == Approx(-1.5));  // two conjugate roots
  CHECK(growth_rate_of(2.0, 3.0) == Approx(-1.0));  // (s + 1)(s + 2)
  const std::complex<double> omega(2.0, 0.5);       // e^{±iωt}
  CHECK(growth_rate_of(omega * omega, 0.0) == Approx(0.5));
  CHECK(growth_rate_of(std::conj(omega * omega), 0.0) == Approx(0.5));
}

TEST_CASE("the whole spectrum about a bent state is that of the derivative of the nonlinear force, with 50 digits",
          "[fast]") {
  for (const auto& scheme : bodies::finite_strain_schemes)
    for (const double strain : {0.05, 0.4}) {
      INFO(name_of(scheme.formulation) << ", " << name_of(scheme.law) << ", " << strain);
      BentPlate plate(scheme, {12, 4}, strain);
      const auto spectrum = deformed_spectrum(plate.op);
      const Eigen::VectorXcd expected =
          bodies::PlainFiniteStrain<2>(plate.problem, plate.body).stiffness(plate.displacement).eigenvalues();
      REQUIRE(spectrum.all.size() == 96);
      const double largest = expected.real().maxCoeff();
      double fastest = 0.0;
      for (const auto square : expected) fastest = std::max(fastest, growth_rate_of(square, 0.0));
      CHECK(std::abs(spectrum.largest.omega_squared.real() - largest) < rounding * largest);
      CHECK(std::abs(spectrum.smallest.omega_squared.real() - expected.real().minCoeff()) < rounding * largest);
      CHECK(std::abs(spectrum.growth_rate - fastest) < rounding * std::sqrt(largest));
      CHECK(spectrum.growing->omega_squared.real() < 0.0);
      CHECK(*spectrum.step_of_largest == Approx(2.0 / std::sqrt(largest)).epsilon(rounding));
      CHECK(pairs_of(spectrum) == (strain > 0.1 && scheme.formulation == corotated.formulation ? 1 : 0));
      const double sum =
          std::accumulate(spectrum.all.begin(), spectrum.all.end(), 0.0,
                          [](double part, const DeformedMode& mode) { return part + mode.omega_squared.real(); });
      CHECK(sum == Approx(expected.real().sum()).epsilon(rounding));
    }
}

TEST_CASE("modes are eigenvectors, and their residuals what they state", "[fast]") {
  BentPlate plate(corotated, {10, 5}, 0.1);
  const auto spectrum = deformed_spectrum(plate.op);
  Eigen::VectorXd image(plate.op.components());
  for (const DeformedMode& mode : {spectrum.largest, spectrum.smallest, *spectrum.growing}) {
    plate.op.apply(mode.vector, image);
    CHECK((image - mode.omega_squared.real() * mode.vector).norm() < rounding * spectrum.largest.omega_squared.real());
    CHECK(mode.vector.norm() == Approx(1.0).epsilon(rounding));
    CHECK(mode.residual < rounding);
  }
}

TEST_CASE("a complex pair inside the spectrum of a bent plate grows, and damping that is strong enough holds it back",
          "[fast]") {
  // ω² = a + ib, b small: the pair grows at b/(2√a) without damping and not if c > b/√a.
  BentPlate plate(corotated, {12, 8}, 0.05);
  const auto free = deformed_spectrum(plate.op);
  REQUIRE(free.growing);
  const auto square = free.growing->omega_squared;
  CHECK(square.imag() > 0.0);
  CHECK(pairs_of(free) == 1);
  CHECK(free.growth_rate == Approx(0.5 * square.imag() / std::sqrt(square.real())).epsilon(1e-3));
  CHECK_FALSE(free.has_damped_pairs);
  const double balance = square.imag() / std::sqrt(square.real());
  BentPlate slowed(corotated, {12, 8}, 0.05, Damping{0.9 * balance}),
      held(corotated, {12, 8}, 0.05, Damping{1.1 * balance});
  const auto slower = deformed_spectrum(slowed.op), still = deformed_spectrum(held.op);
  CHECK(slower.growth_rate == Approx(0.1 * free.growth_rate).epsilon(0.01));
  CHECK_FALSE(slower.has_damped_pairs);
  CHECK_FALSE(still.growing);
  CHECK(still.growth_rate == 0.0);
  CHECK(still.has_damped_pairs);
}

TEST_CASE("of a body that is too large to be looked at whole both ends are found, and what grows there", "[fast]") {
  LargePatch patch(0.44);
  const auto spectrum = deformed_spectrum(patch.op);
  CHECK(spectrum.all.empty());
  CHECK(std::abs(spectrum.largest.omega_squared - patch.largest) < of_ends * patch.largest);
  CHECK(std::abs(spectrum.smallest.omega_squared - patch.smallest) < of_ends * patch.largest);
  CHECK(spectrum.growth_rate == Approx(std::sqrt(-patch.smallest)).epsilon(1e-6));
}

TEST_CASE("a large body that does not grow is followed until only slow growth is left to miss", "[ladder]") {
  LargePatch patch(1.3);
  double told = 0.0;
  const auto spectrum = deformed_spectrum(patch.op, [&](double fraction) {
    CHECK(fraction >= told);
    told = fraction;
  });
  CHECK(told > 0.5);
  CHECK(told <= 1.0);
  CHECK(std::abs(spectrum.largest.omega_squared - patch.largest) < of_ends * patch.largest);
  CHECK_FALSE(spectrum.growing);
  CHECK(spectrum.smallest_seen_growth_rate < 1e-3 * std::sqrt(patch.largest));
}

TEST_CASE("weak growth of a large bent plate, lost among modes that hardly feel a force, is found to the last digits",
          "[ladder]") {
  BentPlate plate(corotated, {25, 21}, 0.05);
  const auto spectrum = deformed_spectrum(plate.op);
  double fastest = 0.0;
  for (const auto square : bodies::applied(plate.op).eigenvalues())
    fastest = std::max(fastest, growth_rate_of(square, 0.0));
  REQUIRE(spectrum.growing);
  CHECK(fastest < 0.01 * std::sqrt(spectrum.largest.omega_squared.real()));
  CHECK(spectrum.growth_rate == Approx(fastest).epsilon(1e-6));
}

TEST_CASE("a pair that flutters in a large body is found inside its spectrum", "[ladder]") {
  // Plates that do not touch have the spectrum of one of them, which is small enough to be looked at whole.
  BentPlate one(corotated, {12, 8}, 0.06);
  const auto expected = deformed_spectrum(one.op);
  constexpr int plates = 6;
  Body<2> body = one.body;
  for (int plate = 1; plate < plates; ++plate)
    for (int a = 0; a < one.body.size(); ++a) {
      body.position.push_back(one.body.position[a] + Vector<2>(0.0, 100.0 * plate));
      body.volume.push_back(one.body.volume[a]);
      body.material.push_back(one.body.material[a]);
    }
  body.pairs = find_pairs(body.position, one.problem.kernel.support());
  DeformedBodyOperator<2> op(one.problem, body);
  op.set_state(one.displacement.replicate(plates, 1));
  const auto spectrum = deformed_spectrum(op);
  CHECK(spectrum.all.empty());
  REQUIRE(spectrum.growing);
  CHECK(spectrum.growing->omega_squared.imag() > 0.0);
  CHECK(std::abs(spectrum.growing->omega_squared - expected.growing->omega_squared) <
        of_ends * spectrum.largest.omega_squared.real());
  CHECK(spectrum.growth_rate == Approx(expected.growth_rate).epsilon(1e-4));
}

TEST_CASE("a body at rest does not grow, and one of which nothing moves is refused", "[fast]") {
  BentPlate plate(corotated, {9, 7}, 0.0);
  const auto spectrum = deformed_spectrum(plate.op);
  CHECK_FALSE(spectrum.growing);
  CHECK(spectrum.growth_rate == 0.0);
  Body<2> body = plate.body;
  body.clamped.assign(body.size(), Directions<2>::Constant(true));
  DeformedBodyOperator<2> held(plate.problem, body);
  CHECK_THROWS_WITH(deformed_spectrum(held), "clamp: holds every particle, so that nothing moves");
}
