// SPDX-License-Identifier: MIT
#include "study/scene_run.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

#include "solver/simulation.hpp"
#include "study/bodies.hpp"

using namespace sphstab;
using namespace sphstab::study;
using namespace sphstab::study::test;
using Catch::Matchers::StartsWith;

namespace {

/// A fifth of the critical step of this kernel and material.
constexpr double time_step = 0.3;
/// 200 steps with an error of 2.2e-16 each, of sums of 40 particles.
constexpr double rounding = 1e-13;
/// Observed orders differ from the integer by the next term of the error.
constexpr double order_margin = 0.1;

Scene<2> scene_of(const Body<2>& body, Integrator integrator = Integrator::leapfrog) {
  Problem<2> problem = plain_problem();
  problem.integrator = integrator;
  return {"test", problem, body, {{"tip", body.size() - 1}, {"root", 0}}};
}

Body<2> plate() { return free_plate(plain_problem(), LatticeIndex<2>(8, 5)); }
Body<2> beam() { return loaded(clamped_at_left(plate()), {0.01, -0.02}); }

solver::State<2> advanced(const Scene<2>& scene, double dt, long steps) {
  solver::State<2> state(scene.body.size());
  solver::Simulation<2>(scene.problem, scene.body).advance(state, dt, steps);
  return state;
}

}  // namespace

TEST_CASE("a run ends where the solver alone ends, bit by bit, however it is watched", "[fast]") {
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet}) {
    const auto scene = scene_of(beam(), integrator);
    const auto expected = advanced(scene, time_step, 173);
    SceneRunOptions<2> options{.time_step = time_step, .duration = 173 * time_step};
    for (const long snapshots : {0, 1, 7, 500}) {
      options.snapshots = snapshots;
      options.probe_samples = snapshots + 1;
      const auto run = run_scene(scene, options);
      CHECK(run.summary.steps == 173);
      CHECK(run.summary.time == Approx(173 * time_step));
      CHECK_FALSE(run.failure);
      CHECK(run.last.displacement == expected.displacement);
      CHECK(run.last.velocity == expected.velocity);
    }
  }
}

TEST_CASE("a run goes on to the first step at or after its duration", "[fast]") {
  const auto scene = scene_of(beam());
  CHECK(run_scene<2>(scene, {.time_step = 0.1, .duration = 0.3}).summary.steps == 3);
  CHECK(run_scene<2>(scene, {.time_step = 0.1, .duration = 0.31}).summary.steps == 4);
  CHECK(run_scene<2>(scene, {.time_step = 0.1, .duration = 0.01}).summary.steps == 1);
}

TEST_CASE("a duration of more steps than can be counted is refused", "[fast]") {
  CHECK_THROWS_WITH(run_scene<2>(scene_of(beam()), {.time_step = 0.1, .duration = 1e300}),
                    StartsWith("duration: 1e+300"));
  CHECK_THROWS_WITH(run_scene<2>(scene_of(beam()), {.time_step = 1e-300, .duration = 1.0}), StartsWith("duration: 1 "));
}

TEST_CASE("snapshots are taken at equal intervals from the first state to the last", "[fast]") {
  const auto scene = scene_of(beam());
  const solver::Simulation<2> simulation(scene.problem, scene.body);
  std::vector<long> steps;
  SceneRunOptions<2> options{.time_step = time_step, .duration = 100 * time_step, .snapshots = 8};
  options.visit = [&](const Snapshot<2>& snapshot) {
    steps.push_back(snapshot.step);
    CHECK(snapshot.time == Approx(static_cast<double>(snapshot.step) * time_step));
    const auto expected = advanced(scene, time_step, snapshot.step);
    CHECK(snapshot.displacement == expected.displacement);
    CHECK(snapshot.velocity == expected.velocity);
    REQUIRE(snapshot.stress.size() == 40);
    REQUIRE(snapshot.von_mises_stress.size() == 40);
    for (int a = 0; a < scene.body.size(); ++a) {
      CHECK(snapshot.stress[a] == simulation.stress(expected, a));
      CHECK(snapshot.von_mises_stress[a] == simulation.von_mises_stress(expected, a));
    }
  };
  run_scene(scene, options);
  CHECK(steps == std::vector<long>{0, 13, 25, 38, 50, 63, 75, 88, 100});

  steps.clear();
  options.duration = 3 * time_step;
  options.visit = [&](const Snapshot<2>& snapshot) { steps.push_back(snapshot.step); };
  run_scene(scene, options);
  CHECK(steps == std::vector<long>{0, 1, 2, 3});
}

TEST_CASE("probes record every step, or every so many that there are no more samples than asked for", "[fast]") {
  const auto scene = scene_of(beam());
  SceneRunOptions<2> options{.time_step = time_step, .duration = 100 * time_step};
  const auto every = run_scene(scene, options);
  REQUIRE(every.sample_times.size() == 101);
  REQUIRE(every.probes.size() == 2);
  CHECK(every.probes[0].name == "tip");
  CHECK(every.probes[0].displacement[100] == every.last.displacement[39]);
  CHECK(every.probes[0].velocity[100] == every.last.velocity[39]);
  CHECK(every.probes[0].stress[100] ==
        solver::Simulation<2>(scene.problem, scene.body).stress(advanced(scene, time_step, 100), 39));
  CHECK(every.probes[1].displacement[100].isZero(0.0));  // clamped

  options.probe_samples = 30;
  const auto thinned = run_scene(scene, options);
  REQUIRE(thinned.sample_times.size() == 26);  // every fourth
  for (std::size_t n = 0; n < thinned.sample_times.size(); ++n) {
    CHECK(thinned.sample_times[n] == Approx(4.0 * static_cast<double>(n) * time_step));
    CHECK(thinned.probes[0].displacement[n] == every.probes[0].displacement[4 * n]);
  }

  options.duration = 102 * time_step;
  const auto ended = run_scene(scene, options);
  REQUIRE(ended.sample_times.size() == 27);
  CHECK(ended.sample_times.back() == ended.summary.time);
  CHECK(ended.probes[0].displacement.back() == ended.last.displacement[39]);
}

TEST_CASE("a free plate falls as a point does, damped or not, without stress", "[fast]") {
  const Vector<2> g(0.25, -0.5);
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet})
    for (const bool damped : {false, true}) {
      auto scene = scene_of(loaded(plate(), g), integrator);
      if (damped) scene.problem.scheme.damping = Damping{0.04};
      const auto run = run_scene<2>(scene, {.time_step = time_step, .duration = 200 * time_step});
      Vector<2> v = Vector<2>::Zero();
      const double kicks = integrator == Integrator::leapfrog ? 1.0 : 2.0;
      for (int n = 0; n < 200 * kicks; ++n) v += time_step / kicks * (g - (damped ? 0.04 : 0.0) * v);
      for (const auto& velocity : run.last.velocity) CHECK((velocity - v).norm() < rounding * v.norm());
      CHECK(run.summary.largest_velocity == Approx(v.norm()).epsilon(rounding));
      CHECK(run.summary.largest_von_mises_stress < rounding);
      REQUIRE(run.summary.momentum_drift);
      CHECK(*run.summary.momentum_drift < rounding);
      if (!damped) CHECK(run.summary.largest_displacement == Approx(0.5 * g.norm() * 3600.0).epsilon(0.01));
    }
}

TEST_CASE("kinetic and strain energy are the work of the loads to second order, with either integrator", "[fast]") {
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet}) {
    const auto defect = [&](int steps) {
      const auto summary =
          run_scene<2>(scene_of(beam(), integrator), {.time_step = 20.0 / steps, .duration = 20.0}).summary;
      CHECK(summary.work > 0.0);
      return std::abs((summary.kinetic_energy + summary.strain_energy) / summary.work - 1.0);
    };
    const double coarse = defect(200), fine = defect(400);
    CHECK(std::abs(std::log2(coarse / fine) - 2.0) < order_margin);
  }
}

TEST_CASE("momentum drifts only by rounding where nothing is clamped, and is not asked for elsewhere", "[fast]") {
  auto body = jittered(loaded(plate(), {0.01, -0.02}), plain_problem(), 4);
  for (int a = 0; a < body.size(); ++a) body.load[a] *= std::sin(a);
  const SceneRunOptions<2> options{.time_step = time_step, .duration = 200 * time_step};
  REQUIRE(run_scene(scene_of(body), options).summary.momentum_drift);
  CHECK(*run_scene(scene_of(body), options).summary.momentum_drift < rounding);

  body.clamped.assign(body.size(), Directions<2>::Constant(false));
  body.clamped[0][0] = true;
  REQUIRE(run_scene(scene_of(body), options).summary.momentum_drift);
  CHECK(*run_scene(scene_of(body), options).summary.momentum_drift < rounding);
  body.clamped[0][1] = true;
  CHECK_FALSE(run_scene(scene_of(body), options).summary.momentum_drift);
}

TEST_CASE("the summary holds the largest values that were looked at", "[fast]") {
  const auto scene = scene_of(beam());
  const auto summary = run_scene<2>(scene, {.time_step = time_step, .duration = 120 * time_step}).summary;
  const solver::Simulation<2> simulation(scene.problem, scene.body);
  double displacement = 0.0, velocity = 0.0, von_mises = 0.0;
  for (const long step : {50, 100, 120}) {
    const auto state = advanced(scene, time_step, step);
    for (int a = 0; a < state.particles(); ++a) {
      displacement = std::max(displacement, state.displacement[a].norm());
      velocity = std::max(velocity, state.velocity[a].norm());
      von_mises = std::max(von_mises, simulation.von_mises_stress(state, a));
    }
  }
  CHECK(summary.largest_displacement == displacement);
  CHECK(summary.largest_velocity == velocity);
  CHECK(summary.largest_von_mises_stress == von_mises);
}

TEST_CASE("an unstable run stops at the exact step of its first number that is none and keeps the state before",
          "[fast]") {
  const auto scene = scene_of(beam());
  // Beyond the critical step, which is below 2; velocities pass a limit before displacements if Δt < 1.
  const double unstable = 2.4;
  std::vector<Vector<2>> shown;
  const auto run = run_scene<2>(
      scene,
      {.time_step = unstable, .duration = 1e5, .snapshots = 2, .probe_samples = 10, .visit = [&](const auto& snapshot) {
         shown = snapshot.displacement;
       }});
  REQUIRE(run.failure);
  CHECK(shown == run.last.displacement);
  CHECK(run.probes[0].displacement.back() == run.last.displacement[39]);
  CHECK(run.failure->field == "displacement");
  CHECK(run.failure->time == Approx(static_cast<double>(run.failure->step) * unstable));
  CHECK(run.summary.steps == run.failure->step - 1);

  const auto last = advanced(scene, unstable, run.failure->step - 1);
  const auto next = advanced(scene, unstable, run.failure->step);
  CHECK(run.last.displacement == last.displacement);
  CHECK(run.last.velocity == last.velocity);
  const auto first_beyond = [](const solver::Field<2>& field) {
    return std::find_if(field.begin(), field.end(), [](const Vector<2>& y) { return y.cwiseAbs().maxCoeff() > 1e40; }) -
           field.begin();
  };
  const int none = scene.body.size();
  CHECK(first_beyond(last.velocity) == none);
  CHECK(first_beyond(last.displacement) == none);
  CHECK(first_beyond(next.velocity) == none);
  CHECK(first_beyond(next.displacement) == run.failure->particle);
  CHECK(run.failure->particle < none);
  CHECK(std::isfinite(run.summary.kinetic_energy));
  CHECK(std::isfinite(run.summary.strain_energy));
}

TEST_CASE("a run that explodes in its first step names the velocity and keeps the state of rest", "[fast]") {
  auto scene = scene_of(plate());
  scene.body.load.assign(scene.body.size(), Vector<2>::Zero());
  scene.body.load[7][1] = std::numeric_limits<double>::infinity();
  const auto run = run_scene<2>(scene, {.time_step = time_step, .duration = 1.0});
  REQUIRE(run.failure);
  CHECK(run.failure->step == 1);
  CHECK(run.failure->particle == 7);
  CHECK(run.failure->field == "velocity");
  CHECK(run.summary.steps == 0);
  CHECK(run.last.displacement == solver::State<2>(scene.body.size()).displacement);
}

TEST_CASE("a time step or duration that is not positive is refused", "[fast]") {
  CHECK_THROWS_AS(run_scene<2>(scene_of(beam()), {.time_step = 0.0, .duration = 1.0}), InvalidInput);
  CHECK_THROWS_AS(run_scene<2>(scene_of(beam()), {.time_step = 1.0, .duration = -1.0}), InvalidInput);
}
