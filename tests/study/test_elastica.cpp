// SPDX-License-Identifier: MIT
#include "study/elastica.hpp"

#include <array>
#include <boost/numeric/odeint/integrate/integrate_n_steps.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <catch2/catch.hpp>
#include <cmath>

#include "model/errors.hpp"

using namespace sphstab;
using namespace sphstab::study;

namespace {

/// θ, θ', x, y along the beam from the free end, where θ' = 0.
using State = std::array<double, 4>;

State integrated(double load, double end_angle) {
  State state{end_angle, 0.0, 0.0, 0.0};
  const auto rates = [load](const State& s, State& rate, double) {
    rate = {s[1], -load * std::cos(s[0]), std::cos(s[0]), std::sin(s[0])};
  };
  using namespace boost::numeric::odeint;
  integrate_n_steps(runge_kutta_fehlberg78<State>(), rates, state, 0.0, 1e-3, 1000);
  return state;
}

}  // namespace

TEST_CASE("the elastica obeys its equation, the clamp and the free end", "[fast]") {
  for (const double load : {0.01, 0.03, 0.75, 3.0, 10.0, 100.0}) {
    INFO(load);
    const Elastica found = elastica(load);
    const State at_clamp = integrated(load, found.end_angle);
    // The equation amplifies an error of the end angle by cosh √α at most.
    const double tolerance = 1e-11 * std::cosh(std::sqrt(load));
    CHECK(std::abs(at_clamp[0]) < tolerance);
    CHECK(std::abs(found.shortening - (1.0 - at_clamp[2])) < tolerance);
    CHECK(std::abs(found.drop - at_clamp[3]) < tolerance);
  }
}

TEST_CASE("a weak load bends a cantilever as linear theory says", "[fast]") {
  // The next order is α² smaller.
  for (const double load : {1e-2, 1e-3}) {
    CHECK(elastica(load).drop == Approx(load / 3.0).epsilon(load * load));
    CHECK(elastica(load).end_angle == Approx(0.5 * load).epsilon(load * load));
  }
}

TEST_CASE("a strip with shear and stretch becomes the elastica when it is thin", "[fast]") {
  const double load = 0.75, exact = elastica(load).drop;
  double before = 0.0;
  for (const double height : {0.04, 0.02, 0.01}) {
    const double force = load * std::pow(height, 3) / 12.0;
    const Elastica found = shearable_elastica({1.0, height, 1.0}, -force);
    const double excess = found.drop / exact - 1.0;
    CHECK(excess > 0.0);
    if (before != 0.0) CHECK(before / excess == Approx(4.0).epsilon(0.01));  // of the order (H/L)²
    before = excess;
  }
  // Small deflection: F L³/(3EI) + F L/(κGA).
  const double force = 1e-9, bending = force / (3.0 / 12.0 * 1e-3), shear = force / (5.0 / 12.0 * 0.1);
  CHECK(shearable_elastica({1.0, 0.1, 1.0}, -force).drop == Approx(bending + shear).epsilon(1e-8));
}

TEST_CASE("the paper's numbers for its largest load are those of the elastica", "[fast]") {
  const Elastica found = elastica(0.75);  // L = 0.2 m: 47.12 mm and 6.792 mm, θ_B = 0.358
  CHECK(0.2 * found.drop == Approx(0.04712).margin(0.000005));
  CHECK(0.2 * found.shortening == Approx(0.006792).margin(0.000002));  // theirs is that of the series 3.3
  CHECK(found.end_angle == Approx(0.358).margin(0.0005));
  CHECK(printed_end_angle(0.75) == Approx(found.end_angle).margin(1e-4));
  CHECK_THROWS_WITH(elastica(0.0), "load: 0 is not above 0 and at most 200");
}
