// SPDX-License-Identifier: MIT
#include "study/step_follower.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "analysis/spectrum.hpp"
#include "study/beams.hpp"
#include "study/p_wave_speed.hpp"

using namespace sphstab;
using namespace sphstab::study;

namespace {

constexpr double spacing = 5e-3;
/// The limits are converged to 1e-6 of ω², bodies' to 1e-10.
constexpr double converged = 1e-6;
/// What an estimate may be above the limit: a step of 0.98 of it is still safe.
constexpr double estimated = 0.01;

/// Sums over some hundred particles.
constexpr double rounding = 1e-12;

/// A truss that is stretched by some 7 %.
Scene<2> truss_of(int method) {
  return make_scene(beams::beam_scene(beams::truss(7000.0, spacing), beams::methods()[method]));
}

}  // namespace

TEST_CASE("a followed step starts from the spectrum of the body at rest", "[fast]") {
  for (const int method : {0, 1}) {
    const auto scene = truss_of(method);
    const StepFollower<2> follower(scene);
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
    StepFollower<2> follower(scene);
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
  StepFollower<2> follower(scene);
  const long first = follower.interval();
  const auto rest = beams::rest_of(scene, 1e-3);
  follower.update(rest.displacement);
  CHECK(follower.interval() < first);
  for (int i = 0; i < 8; ++i) follower.update(rest.displacement);
  CHECK(follower.interval() > first);
}

TEST_CASE("a body that is turned inside out keeps its last limit", "[fast]") {
  const auto scene = truss_of(1);
  StepFollower<2> follower(scene);
  const double before = *follower.critical_step();
  std::vector<Vector<2>> inverted;
  for (const auto& x : scene.body.position) inverted.push_back({-2.0 * x[0], 0.0});
  follower.update(inverted);
  CHECK(*follower.critical_step() == before);
  CHECK_FALSE(limit_about<2>(scene.problem, scene.body, inverted));
}

TEST_CASE("waves take of the limit what strains, and neither the fall nor the turning of a free body", "[fast]") {
  auto scene = truss_of(1);
  const double c_p = p_wave_speed(scene.problem);
  const Vector<2> g(0.0, -100.0);
  scene.body.load.assign(scene.body.size(), g);
  const std::vector<Vector<2>> at_rest(scene.body.size(), Vector<2>::Zero());
  std::vector<Vector<2>> turning, stretching;
  for (const auto& x : scene.body.position) {
    turning.push_back(Vector<2>(7.0, 0.0) + 30.0 * Vector<2>(-x[1], x[0]));
    stretching.push_back({5.0 * x[0], 0.0});
  }
  const double of_turning = std::max_element(turning.begin(), turning.end(), [](const auto& left, const auto& right) {
                              return left.norm() < right.norm();
                            })->norm();

  const StepFollower<2> held(scene);
  CHECK(held.room_for_loads() == Approx(1.0 + 3.0 * g.norm() * spacing / (c_p * c_p)).epsilon(rounding));
  CHECK(held.room_for_waves(at_rest, turning) == Approx(1.0 + 3.0 * of_turning / c_p).epsilon(rounding));

  scene.body.clamped.clear();
  const StepFollower<2> falling(scene);
  CHECK(falling.room_for_loads() == Approx(1.0).epsilon(rounding));
  CHECK(falling.room_for_waves(at_rest, turning) == Approx(1.0).epsilon(rounding));
  const auto& x = scene.body.position;
  const double half_a_length = 0.5 * (x.back()[0] - x.front()[0]);
  CHECK(falling.room_for_waves(at_rest, stretching) == Approx(1.0 + 3.0 * 5.0 * half_a_length / c_p).epsilon(rounding));
}
