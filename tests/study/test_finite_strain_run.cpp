// SPDX-License-Identifier: MIT
// Scenes of tl-corotated and tl-pk1: fixed and followed steps, growth that is recognised, rest, beams.
#include <catch2/catch.hpp>
#include <cmath>
#include <tuple>

#include "study/beams.hpp"
#include "study/elastica.hpp"
#include "study/scene_run.hpp"

using namespace sphstab;
using namespace sphstab::study;

namespace {

using namespace beams;

constexpr double soft = 0.5e6, bar_spacing = 5e-3;

Scene<2> bar(int method) { return make_scene(bar_scene({soft, bar_spacing}, methods()[method])); }

/// Without its clamp.
Scene<2> free_bar(const Vector<2>& gravity) {
  SceneDescription<2> description = bar_scene({soft, bar_spacing}, methods()[1]);
  description.clamps.clear();
  description.gravity = gravity;
  return make_scene(description);
}

/// A periodic patch in a state of uniaxial strain, at rest.
Scene<2> strained_patch(int method, double stretch, double poisson_ratio = 0.3) {
  SceneDescription<2> description = bar_scene({soft, bar_spacing}, methods()[method]);
  description.parts.clear();
  description.clamps.clear();
  description.gravity.setZero();
  description.periodic_cells = LatticeIndex<2>(12, 6);
  description.problem.material = Material::from_young_modulus(1.0, 1.0, poisson_ratio);
  description.materials = {description.problem.material};
  description.problem.deformation_gradient = Tensor<2>{{stretch, 0.0}, {0.0, 1.0}};
  return make_scene(description);
}

constexpr double patch_step = 0.3 * bar_spacing;  // of waves of speed 1 or so

SceneRunResult<2> run_of(const Scene<2>& patch) {
  return run_scene<2>(patch, {.time_step = patch_step, .duration = 1000 * patch_step});
}

/// A free plate of 8 × 8 in tl-pk1 that is thrown apart along one diagonal and together along the other; of size 1 it
/// is strained by about 0.2.
Scene<2> vibrating_plate(double size) {
  Problem<2> problem{.lattice = Lattice<2>(LatticeKind::square, 1.0),
                     .kernel = Kernel<2>(KernelFamily::cubic_spline, 1.3),
                     .material = Material::from_young_modulus(1.0, 1.0, 0.3)};
  problem.scheme.formulation = Formulation::total_lagrangian_pk1;
  Scene<2> scene{.name = "plate", .problem = problem, .body = free_plate<2>(problem, {8, 8}), .probes = {}};
  const Tensor<2> gradient{{0.02, 0.15}, {0.11, -0.03}};
  for (const auto& x : scene.body.position) scene.velocity.push_back(size * gradient * (x - Vector<2>(3.5, 3.5)));
  return scene;
}

}  // namespace

TEST_CASE("a followed run of a swinging truss keeps its energy and its answer", "[fast]") {
  const auto scene = make_scene(beam_scene(truss(7000.0, bar_spacing), methods()[1]));
  const double limit = step_of(scene, 1.0);
  constexpr double duration = 0.4;  // some twenty periods
  const auto run = [&](std::optional<double> followed, double fraction) {
    return run_scene<2>(scene, {.time_step = fraction * limit, .followed_fraction = followed, .duration = duration});
  };
  const auto followed = run(0.9, 0.9), bold = run(0.98, 0.98), fixed = run({}, 0.45);
  REQUIRE(followed.summary.following);
  const auto& following = *followed.summary.following;
  CHECK(following.work.updates > 2);
  CHECK(following.smallest_step < 0.999 * following.largest_step);
  CHECK(following.largest_step < 0.901 * limit);
  CHECK(followed.summary.time == Approx(duration).epsilon(1e-3));
  CHECK(5 * followed.summary.steps < 4 * fixed.summary.steps);
  for (const auto* result : {&followed, &bold, &fixed}) {
    CHECK_FALSE(result->growth);
    CHECK_FALSE(result->failure);
    const auto& summary = result->summary;
    // Leapfrog: the energy errs by (ωΔt)² of what swings slowly, and by much of what the front of the sudden load sends
    // through the particles as short waves.
    CHECK(summary.kinetic_energy + summary.strain_energy == Approx(summary.work).epsilon(0.02));
    const auto& u = result->last.displacement.back();
    CHECK((u - fixed.last.displacement.back()).norm() < 0.05 * fixed.last.displacement.back().norm());
  }
}

TEST_CASE("a falling body keeps to its momentum when its step changes", "[fast]") {
  auto scene = free_bar({0.0, -100.0});
  // Its ends fly apart at a sixteenth of the p-wave speed: waves that may take some of the limit.
  for (const auto& x : scene.body.position) scene.velocity.push_back({20.0 * x[0], 0.0});
  const auto result = run_scene<2>(scene, {.time_step = 1.0, .followed_fraction = 0.9, .duration = 0.03});
  CHECK(result.summary.following->smallest_step < 0.95 * result.summary.following->largest_step);
  // The sum over some hundred particles, relative; a wrong half step would be 1e-4 of it.
  CHECK(*result.summary.momentum_drift < 1e-11);
}

TEST_CASE("a body that falls and flies takes the step of one at rest", "[fast]") {
  auto scene = free_bar({0.0, -1000.0});
  scene.velocity.assign(scene.body.size(), {100.0, 0.0});  // twice the p-wave speed
  const auto result = run_scene<2>(scene, {.time_step = 1.0, .followed_fraction = 0.9, .duration = 0.03});
  CHECK(result.summary.following->smallest_step == Approx(step_of(scene, 0.9)).epsilon(1e-6));  // as it is converged
  CHECK(result.summary.following->smallest_step == result.summary.following->largest_step);
}

TEST_CASE("a run above its limit is stopped, and the step is named", "[fast]") {
  for (const auto& [method, fraction] : {std::pair(0, 1.05), {1, 1.05}, {1, 1.01}}) {
    const auto scene = bar(method);
    const auto result = run_scene<2>(scene, {.time_step = step_of(scene, fraction), .duration = 2.0, .snapshots = 3});
    REQUIRE(result.growth);
    CHECK(result.growth->cause == GrowthCause::time_step);
    CHECK(result.summary.time < 1.0);
    for (const auto& u : result.last.displacement) CHECK(u.allFinite());
  }
}

TEST_CASE("growth of less than five hundred steps is seen at the end", "[fast]") {
  auto scene = vibrating_plate(0.0);
  for (std::size_t a = 0; a < scene.velocity.size(); ++a) scene.velocity[a] = {a % 2 == 0 ? 1e-9 : -1e-9, 1e-9};
  constexpr int steps = 33;
  const auto run_at = [&](double fraction) {
    const double time_step = step_of(scene, fraction);
    return run_scene<2>(scene, {.time_step = time_step, .duration = steps * time_step});
  };
  const auto grown = run_at(1.02).growth;
  REQUIRE(grown);
  CHECK(grown->step == steps);
  CHECK(grown->cause == GrowthCause::time_step);
  // Below the limit the fastest modes swing: they hold up to 1/(1 − 0.997²) = 170 times their share.
  const auto swinging = run_at(0.997);
  CHECK(swinging.summary.kinetic_energy + swinging.summary.strain_energy >
        2.0 * energy_of_growth * swinging.summary.initial_energy);
  CHECK_FALSE(swinging.growth);
}

TEST_CASE("a compressed patch without waves is watched for ten looks, and the loss of ellipticity is named", "[fast]") {
  // Uniaxial strain: lost below 0.469 (tl-corotated) and 0.706 (tl-pk1) at ν = 0.3, theory.md §5.
  for (const auto& [method, lost, kept] : {std::tuple(0, 0.46, 0.48), {1, 0.70, 0.72}}) {
    const auto beyond = run_of(strained_patch(method, lost));
    REQUIRE(beyond.growth);
    CHECK(beyond.growth->cause == GrowthCause::loss_of_ellipticity);
    CHECK(beyond.growth->step == 450);
    CHECK_FALSE(beyond.summary.is_elliptic);
    const auto before = run_of(strained_patch(method, kept));
    CHECK_FALSE(before.growth);
    CHECK(before.summary.is_elliptic);
  }
}

TEST_CASE("every particle is judged by its own material", "[fast]") {
  // tl-pk1: uniaxially lost below 0.706 at ν = 0.3 and 0.906 at 0.45. The problem's material is nowhere in the body.
  const Material firm = Material::from_young_modulus(1.0, 1.0, 0.3),
                 yielding = Material::from_young_modulus(1.0, 1.0, 0.45);
  auto kept = strained_patch(1, 0.8);
  kept.problem.material = yielding;
  CHECK_FALSE(run_of(kept).growth);
  auto lost = strained_patch(1, 0.8, 0.45);
  lost.problem.material = firm;
  CHECK(run_of(lost).growth);
  // Held everywhere, so that the firm part does not relieve the other; which counts where it is wider than the support.
  lost.body.clamped.assign(lost.body.size(), Directions<2>::Constant(true));
  lost.body.materials = {firm, yielding};
  for (int a = 0; a < lost.body.size(); ++a) lost.body.material[a] = a % 12 < 9 ? 1 : 0;
  CHECK(run_of(lost).growth);
  for (int a = 0; a < lost.body.size(); ++a) lost.body.material[a] = a % 12 < 3 ? 1 : 0;
  CHECK_FALSE(run_of(lost).growth);
}

TEST_CASE("a large vibration that keeps its energy takes particles beyond the loss of ellipticity and is not stopped",
          "[fast]") {
  const auto scene = vibrating_plate(0.7);
  for (const std::optional<double> followed : {std::optional<double>(), std::optional(0.9)}) {
    const auto result =
        run_scene<2>(scene, {.time_step = step_of(scene, 0.25), .followed_fraction = followed, .duration = 3000.0});
    CHECK_FALSE(result.growth);
    CHECK_FALSE(result.failure);
    CHECK(result.summary.kinetic_energy + result.summary.strain_energy ==
          Approx(result.summary.initial_energy).epsilon(0.1));
  }
}

TEST_CASE("a body that is torn below its limit by its step has not lost ellipticity before", "[fast]") {
  // The fastest mode of a vibration of 4 % turns once in three steps (docs/finite-strain.md).
  const auto scene = vibrating_plate(0.2);
  const auto result = run_scene<2>(scene, {.time_step = step_of(scene, 0.866), .duration = 1600.0});
  REQUIRE(result.growth);
  CHECK_FALSE(result.growth->cause);
}

TEST_CASE("a followed step is for bodies of finite strain", "[fast]") {
  const auto scene = make_scene(beam_scene(cantilever(1.0, 5e-3), methods()[2]));
  CHECK_THROWS_WITH(run_scene<2>(scene, {.time_step = 1e-5, .followed_fraction = 0.9, .duration = 1e-4}),
                    "time_step: auto follows the limit of tl-corotated and tl-pk1, which changes, not of ul");
}

TEST_CASE("a pulled strip is as long as its law says, a bent one drops like a strip with shear", "[fast]") {
  for (const int method : {0, 1}) {
    const double spacing = 2e-3;
    const Beam pulled = truss(7000.0, spacing), bent = cantilever(75.0, spacing);
    const auto rest = [&](const Beam& beam) {
      const auto scene = make_scene(beam_scene(beam, methods()[method]));
      const Rest found = rest_of(scene, 1e-6);
      REQUIRE(found.converged);
      return reading_at(scene, {beam.length, 0.5 * beam.height})(found.displacement);
    };
    // R·S: (l² − 1)/2 = F/(AE); F·S: l (l² − 1)/2. Of the ends, where the load is half a spacing inside and clamps
    // give way by about as much, a part of Δx/L is left.
    const double stress = 7000.0 / (0.05 * 2e6), corotated = std::sqrt(1.0 + 2.0 * stress) - 1.0;
    double pk1 = stress;
    for (int i = 0; i < 30; ++i) pk1 = 2.0 * stress / ((1.0 + pk1) * (2.0 + pk1));
    CHECK(rest(pulled)[0] / pulled.length == Approx(method == 0 ? corotated : pk1).epsilon(spacing / pulled.length));
    const double drop = shearable_elastica({bent.length, bent.height, bent.young_modulus}, bent.force_y).drop;
    // Ten spacings across; clamp and end are of first order too, and four times as much in a drop.
    CHECK(-rest(bent)[1] / bent.length == Approx(drop).epsilon(8.0 * spacing / bent.length));
  }
}

TEST_CASE("the displacement of a point is exact where it is affine", "[fast]") {
  const auto scene = bar(1);
  const auto reading = reading_at(scene, bar_end);
  const Tensor<2> gradient{{0.3, -0.2}, {0.7, 0.1}};
  std::vector<Vector<2>> displacement;
  for (const auto& x : scene.body.position) displacement.push_back(gradient * x + Vector<2>(1.0, -2.0));
  CHECK((reading(displacement) - (gradient * bar_end + Vector<2>(1.0, -2.0))).norm() < 1e-13);
  CHECK_THROWS_WITH(reading_at(scene, {3.0, 3.0}), "position: fewer than three particles are near it");
}
