// SPDX-License-Identifier: MIT
#include "study/step_follower.hpp"

#include <catch2/catch.hpp>

#include "analysis/spectrum.hpp"
#include "study/beams.hpp"

using namespace sphstab;
using namespace sphstab::study;

namespace {

constexpr double spacing = 5e-3;
/// The limits are converged to 1e-6 of ω², bodies' to 1e-10.
constexpr double converged = 1e-6;
/// What an estimate may be above the limit: a step of 0.98 of it is still safe.
constexpr double estimated = 0.01;

/// A truss that is stretched by some 7 %.
Scene<2> truss_of(int method) {
  return make_scene(beams::beam_scene(beams::truss(7000.0, spacing), beams::methods()[method]));
}

}  // namespace

TEST_CASE("a followed step starts from the spectrum of the body at rest", "[fast]") {
  for (const int method : {0, 1}) {
    const auto scene = truss_of(method);
    const StepFollower<2> follower(scene.problem, scene.body);
    CHECK(*follower.critical_step() ==
          Approx(analysis::body_limit(scene.problem, scene.body).critical_time_step).epsilon(converged));
    CHECK(follower.work().updates == 1);
  }
}

TEST_CASE("a few applications follow the limit of a truss that is stretched", "[fast]") {
  for (const int method : {0, 1}) {
    const auto scene = truss_of(method);
    const auto rest = beams::rest_of(scene, 1e-3);
    REQUIRE(rest.converged);
    const double exact = *limit_about<2>(scene.problem, scene.body, rest.displacement)->critical_time_step;
    StepFollower<2> follower(scene.problem, scene.body);
    const double before = *follower.critical_step();
    CHECK(std::abs(exact / before - 1.0) > 0.005);  // stretching changes it
    const long applications = follower.work().applications;
    follower.update(rest.displacement);
    CHECK(follower.work().applications == applications + 8);
    follower.update(rest.displacement);
    CHECK(follower.work().updates == 3);
    CHECK(*follower.critical_step() == Approx(exact).epsilon(estimated));
  }
}

TEST_CASE("updates are due more often while the limit changes and less often when it rests", "[fast]") {
  const auto scene = truss_of(1);
  StepFollower<2> follower(scene.problem, scene.body);
  const long first = follower.interval();
  const auto rest = beams::rest_of(scene, 1e-3);
  follower.update(rest.displacement);
  CHECK(follower.interval() < first);
  for (int i = 0; i < 8; ++i) follower.update(rest.displacement);
  CHECK(follower.interval() > first);
}

TEST_CASE("a body that is turned inside out keeps its last limit", "[fast]") {
  const auto scene = truss_of(1);
  StepFollower<2> follower(scene.problem, scene.body);
  const double before = *follower.critical_step();
  std::vector<Vector<2>> inverted;
  for (const auto& x : scene.body.position) inverted.push_back({-2.0 * x[0], 0.0});
  follower.update(inverted);
  CHECK(*follower.critical_step() == before);
  CHECK_FALSE(limit_about<2>(scene.problem, scene.body, inverted));
}
