// SPDX-License-Identifier: MIT
#include "study/hard_cases.hpp"

#include <catch2/catch.hpp>

#include "analysis/critical_step.hpp"
#include "model/body.hpp"

using namespace sphstab;

namespace {

/// Every case brings its own tolerances, with the reason for each at the place where it is made.
void check_group(std::string_view group, std::size_t cases) {
  const auto found = study::hard_cases(group);
  CHECK(found.size() == cases);
  for (const auto& hard : found) {
    INFO(hard.name);
    CHECK(hard.theory_difference() <= hard.theory_tolerance);
    if (hard.run) CHECK(*hard.run_difference() <= hard.run_tolerance);
    CHECK(hard.holds());
  }
}

}  // namespace

TEST_CASE("the Courant number does not depend on Poisson's ratio, however near to its ends", "[ladder]") {
  check_group("Poisson's ratio", 9);
}

TEST_CASE("supports that barely hold a neighbour and such that hold hundreds have their closed forms", "[ladder]") {
  check_group("support", 15);
}

TEST_CASE("a shell on the support does not count, and a knot of the spline is crossed smoothly", "[ladder]") {
  check_group("knots and shells", 10);
}

TEST_CASE("lattices without a name have the closed forms of their neighbours, in any basis", "[ladder]") {
  check_group("custom lattices", 6);
}

TEST_CASE("chains side by side without neighbours across have whole lines of zero-energy modes, and a limit",
          "[ladder]") {
  const Problem<2> problem{.lattice = Lattice<2>(Tensor<2>{{1.0, 0.0}, {0.0, 3.0}}, 1.0),
                           .kernel = Kernel<2>(KernelFamily::cubic_spline, 0.8),
                           .material = Material::from_young_modulus(1.0, 1.0, 0.3)};
  CHECK_FALSE(analysis::zero_energy_modes(problem).complete);
  const auto limit = std::get<analysis::ConditionallyStable<2>>(analysis::BulkModes<2>(problem).limit());
  // Largest at sin(k·d) = ±1, d = (1, 0), whatever the other component; V = 3, cubic spline.
  const double omega = 2.0 * 3.0 * std::abs(problem.kernel.slope(1.0)) *
                       std::sqrt(problem.material.lame(Plane::strain).p_wave_modulus());
  CHECK(limit.critical_time_step == Approx(2.0 / omega).epsilon(1e-12));
}

TEST_CASE("the Courant number does not depend on units", "[ladder]") { check_group("units", 12); }

TEST_CASE("damping shortens the step by the closed form of one mode, up to what a mode bears", "[ladder]") {
  check_group("damping", 10);
}

TEST_CASE("compression has a critical step up to the closed form of its onset and grows beyond it", "[ladder]") {
  check_group("onset of compression", 12);
}

TEST_CASE("a support that ends on the nearest neighbours is refused and says why", "[ladder]") {
  const Problem<2> problem{.lattice = Lattice<2>(LatticeKind::square, 0.37),
                           .kernel = Kernel<2>(KernelFamily::cubic_spline, 0.5 * 0.37),
                           .material = Material::from_young_modulus(1.0, 1.0, 0.3)};
  CHECK_THROWS_WITH(
      analysis::BulkModes<2>(problem),
      "smoothing_length: no neighbour lies strictly inside the support 0.37 (square lattice, spacing 0.37)");
  CHECK_THROWS_AS(periodic_patch<2>(problem, {4, 4}), InvalidInput);
}

TEST_CASE("ul: where W'' or its sum vanishes nothing grows, beside it as the sums say", "[ladder]") {
  check_group("ul: marginal states", 14);
}

TEST_CASE("ul: isotropic stress grows by the sums at the zero-energy points, and is no special case", "[ladder]") {
  check_group("ul: isotropic stress", 4);
}

TEST_CASE("ul: a hair beside zero stress a run steps as far as the linearisation of that side", "[ladder]") {
  check_group("ul: sign switch", 2);
}

TEST_CASE("ul: a complex ω² grows, in a run too", "[ladder]") { check_group("ul: complex ω²", 2); }

TEST_CASE("ul: smoothing beyond 1 turns growth into oscillation and oscillation into growth", "[ladder]") {
  check_group("ul: inverted smoothing", 2);
}

TEST_CASE("ul: artificial stress drives what was stable", "[ladder]") {
  check_group("ul: driven by artificial stress", 2);
}

TEST_CASE("every group of hard cases is tested here", "[ladder]") { CHECK(study::hard_case_groups().size() == 13); }
