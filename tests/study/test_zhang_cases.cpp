// SPDX-License-Identifier: MIT
#include "study/zhang_cases.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "io/scene_input.hpp"
#include "study/zhang_stability.hpp"
#include "study/zhang_statics.hpp"

using namespace sphstab;
using namespace sphstab::study::zhang;

namespace {

/// Numbers of the files are decimal, those of the code sums and quotients of decimals: a few roundings.
constexpr double rounding = 1e-14;
/// Ten times what the runs stop at.
constexpr double agreement = 10.0 * running_tolerance;
/// Conjugate gradients of one load and another take the same iterations but for rounding, which residuals of 1e-12
/// bound.
constexpr double proportion = 1e-11;
/// Units of the last digit printed in errata.md Z7 and Z8: H/Δ to three digits, steps to four.
constexpr double printed_ratio = 1e-3, printed_step = 1e-6;
/// n steps leave at most 1/(2en) of the distance to the next mode: 5e-6 here.
constexpr long growth_steps = 40000;
constexpr double growth_tolerance = 1e-5;
constexpr double bisection_tolerance = 1e-5;

constexpr auto plain = KernelNormalisation::none, normalised = KernelNormalisation::sum;

void check_same_body(const Body<2>& body, const Body<2>& expected) {
  REQUIRE(body.size() == expected.size());
  CHECK(body.pairs.neighbour == expected.pairs.neighbour);
  for (int a = 0; a < body.size(); ++a) {
    CHECK((body.position[a] - expected.position[a]).norm() <= rounding * expected.position[a].norm());
    CHECK(body.mass(a) == Approx(expected.mass(a)).epsilon(rounding));
    CHECK((body.load[a] - expected.load[a]).norm() <= 10.0 * rounding * 1.0);  // loads of order 1 m/s²
  }
}

Scene<2> scene_of_file(const std::string& name) {
  Case input;
  input.set("scene", std::string(SPHSTAB_SCENES_FOLDER "/") + name);
  return io::read_scene<2>(io::with_scene_keys(input));
}

/// Relative error of the displacement of a plate of n × n particles with H = Δ.
double displacement_error(int n, bool normalise, bool load_too) {
  const double spacing = side / n;
  const auto posed = problem(spacing, normalise ? normalised : plain, Plane::stress, spacing);
  auto body = make_scene(stretched_plate(posed)).body;
  if (load_too) body = with_normalised_load(posed, body);
  const auto expected = rest_of(body, [&](const Vector<2>& x) { return study::solution(plate_theory(posed), x); });
  return errors(rest_by_theory(posed, body), expected).displacement;
}

}  // namespace

TEST_CASE("the scene files of Zhang's cases hold the bodies of the reports", "[fast]") {
  const auto plate = scene_of_file("zhang-case-1.toml");
  check_same_body(make_scene(stretched_plate(plate.problem)).body, plate.body);
  const auto annulus = scene_of_file("zhang-case-2.toml");
  check_same_body(make_scene(sheared_annulus(annulus.problem)).body, annulus.body);
}

TEST_CASE("the plate comes to the same rest by conjugate gradients and by running", "[fast]") {
  for (const auto normalisation : {plain, normalised})
    for (const double ratio : {0.7, 0.8, 1.0}) {
      const PlateKind kind{ratio, normalisation};
      const auto posed = plate_problem(kind);
      const auto body = plate_body(kind);
      const auto apart = errors(rest_by_running(posed, body), rest_by_theory(posed, body));
      CHECK(apart.displacement < agreement);
      CHECK(apart.von_mises < agreement);
    }
}

TEST_CASE(
    "the annulus comes to the same rest by conjugate gradients and by running once its soft rotation is not driven",
    "[fast]") {
  const auto posed = problem(particle_spacing, normalised);
  auto body = make_scene(sheared_annulus(posed)).body;
  const auto motions = nearly_rigid_motions(posed, body);
  CHECK(motions.size() == 3);
  body.load = without(motions, posed, body, body.load);
  const auto apart = errors(rest_by_running(posed, body, motions), rest_by_theory(posed, body, motions));
  CHECK(apart.displacement < agreement);
  CHECK(apart.von_mises < agreement);
}

TEST_CASE("the error of the plate falls with order one, unless sums are normalised and loads are not", "[fast]") {
  for (const bool normalise : {false, true}) {
    const double order = std::log2(displacement_error(20, normalise, true) / displacement_error(40, normalise, true));
    CHECK(order > 1.0);
    CHECK(order < 1.25);
  }
  // What is left is the load that N takes away at the edge: N = (1 + W₁(0) Δ)/2 with H = Δ.
  const double left = 0.5 * (1.0 - 1.0 / std::sqrt(std::numbers::pi));
  for (const int n : {10, 20, 40}) CHECK(displacement_error(n, true, false) == Approx(left).epsilon(0.04));
}

TEST_CASE("rest is in proportion to the load", "[fast]") {
  for (const auto normalisation : {plain, normalised}) {
    const PlateKind kind{0.8, normalisation};
    const auto posed = plate_problem(kind);
    auto expected = rest_by_theory(posed, plate_body(kind));
    for (auto& s : expected.displacement) s *= 50.0;
    for (auto& stress : expected.von_mises) stress *= 50.0;
    const auto apart = errors(rest_by_theory(posed, plate_body(kind, 50.0)), expected);
    CHECK(apart.largest_displacement < proportion);
    CHECK(apart.largest_von_mises < proportion);
  }
}

TEST_CASE("the critical step does not depend on the load with the density of rest, and falls with that of Eq. 6",
          "[ladder]") {
  for (const auto normalisation : {plain, normalised}) {
    const PlateKind kind{0.8, normalisation};
    const auto body = plate_body(kind, 8.0);
    auto posed = plate_problem(kind);
    const double expected = critical_step(kind);
    const auto frozen =
        bisect_loaded(posed, body, rest_by_theory(posed, body).displacement, bisection_tolerance).critical_time_step;
    REQUIRE(frozen);
    CHECK(*frozen == Approx(expected).epsilon(bisection_tolerance));
    posed.scheme.momentum_density = MomentumDensity::equation_of_state;
    const auto rest = nonlinear_rest(posed, body);
    REQUIRE(rest);
    const auto varying = bisect_loaded(posed, body, *rest, 1e-3, 200).critical_time_step;
    REQUIRE(varying);
    CHECK(*varying < 0.8 * expected);
    CHECK(growth_rate(posed, body, *rest, 5e-4, 20000));
  }
}

TEST_CASE("the critical step has its smallest values where the errata have them", "[ladder]") {
  const auto check = [](KernelNormalisation normalisation, double ratio, double step) {
    const auto found = smallest_critical_step(normalisation, Plane::stress);
    CHECK(std::abs(found.first - ratio) < printed_ratio);
    CHECK(std::abs(found.second - step) < printed_step);
  };
  check(plain, 0.744, 2.398e-3);
  check(normalised, 0.849, 2.264e-3);
  CHECK(std::abs(smallest_critical_step(plain, Plane::strain).second - 2.163e-3) < printed_step);
  CHECK(std::abs(smallest_critical_step(normalised, Plane::strain).second - 1.987e-3) < printed_step);
  CHECK(std::abs(crossing_of_normalisation(Plane::stress) - 0.722) < printed_ratio);
  CHECK(std::abs(crossing_of_normalisation(Plane::strain) - 0.699) < printed_ratio);
}

TEST_CASE("a plate that explodes grows as its spectrum says", "[ladder]") {
  const double time_step = 4e-3;
  for (const auto normalisation : {plain, normalised}) {
    const PlateKind kind{0.8, normalisation};
    const auto posed = plate_problem(kind);
    const auto body = plate_body(kind);
    const double measured =
        measured_growth_per_step(posed, body, rest_by_theory(posed, body).displacement, time_step, growth_steps);
    CHECK(std::abs(measured - growth_per_step(fastest_mode(posed, body).omega, time_step)) < growth_tolerance);
  }
}
