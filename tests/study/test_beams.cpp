// SPDX-License-Identifier: MIT
// A beam that symmetry holds in place of a clamp.
#include <algorithm>
#include <catch2/catch.hpp>

#include "study/beams.hpp"

using namespace sphstab;
using namespace sphstab::study;

namespace {

using namespace beams;

constexpr double force = 0.5;

Beam small_bend(double spacing, Support support) {
  Beam beam = cantilever(force, spacing);
  beam.support = support;
  return beam;
}

Method linear() {
  Method method = methods()[0];
  method.scheme.formulation = Formulation::total_lagrangian_linear;
  return method;
}

/// Of the right end from x = 0.
double drop(const Beam& beam, const Method& method) {
  const auto scene = make_scene(beam_scene(beam, method));
  const Rest rest = rest_of(scene, 1e-6);
  REQUIRE(rest.converged);
  const auto at = [&](double x) { return reading_at(scene, {x, 0.5 * beam.height})(rest.displacement)[1]; };
  return (beam.support == Support::symmetry ? at(0.0) : 0.0) - at(beam.length);
}

}  // namespace

TEST_CASE("a beam that symmetry holds has no force and no torque left over", "[fast]") {
  const auto scene = make_scene(beam_scene(small_bend(2e-3, Support::symmetry), linear()));
  Vector<2> total = Vector<2>::Zero();
  double torque = 0.0, pushed_down = 0.0;
  for (int a = 0; a < scene.body.size(); ++a) {
    const Vector<2> pushed = scene.body.mass(a) * scene.body.load[a];
    total += pushed;
    torque += scene.body.position[a][0] * pushed[1] - scene.body.position[a][1] * pushed[0];
    pushed_down -= std::min(pushed[1], 0.0);
  }
  constexpr double rounding = 1e-12;
  CHECK(total.norm() < rounding * force);
  CHECK(std::abs(torque) < rounding * force * beam_length);
  CHECK(pushed_down == Approx(2.0 * force).epsilon(rounding));
  CHECK(std::none_of(scene.body.clamped.begin(), scene.body.clamped.end(),
                     [](const Directions<2>& held) { return held.any(); }));
}

TEST_CASE("a small bend with and without a clamp drops as an independent solution of the same sums", "[fast]") {
  // Assembled from the sums of the scheme and solved by sparse factorisation, in another language; [m], small strain.
  struct Solved {
    double spacing, free, clamped;
  };
  constexpr Solved truncated[] = {{5e-3, 1.1907136662262332e-4, 1.270305041928061e-4},
                                  {2e-3, 1.1520513867286184e-4, 1.1855126495916523e-4}};
  // To the tolerance of the rest, which is of the norm of all displacements.
  constexpr double at_rest = 1e-5;
  for (const auto& [spacing, free, clamped] : truncated) {
    CHECK(drop(small_bend(spacing, Support::symmetry), linear()) == Approx(free).epsilon(at_rest));
    CHECK(drop(small_bend(spacing, Support::clamp), linear()) == Approx(clamped).epsilon(at_rest));
  }
  // Renormalised edges, of finite strain: the slope of the end is 1e-3, what it changes is of its square.
  constexpr double of_slope = 1e-5;
  CHECK(drop(small_bend(5e-3, Support::symmetry), methods()[0]) == Approx(1.2958860427664705e-4).epsilon(of_slope));
  CHECK(drop(small_bend(5e-3, Support::clamp), methods()[0]) == Approx(1.385081834932509e-4).epsilon(of_slope));
}
