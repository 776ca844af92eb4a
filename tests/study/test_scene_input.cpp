// SPDX-License-Identifier: MIT
// What a case makes of the keys plate, patch, scene and initial_noise.
#include "study/scene_input.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "io/files.hpp"
#include "io/scene_input.hpp"
#include "io/scratch_folder.hpp"

using namespace sphstab;
using namespace sphstab::study;

namespace {

Case updated_case() {
  Case input;
  input.set("scheme", "ul");
  input.set("sound_speed", 2.0);
  input.set("shear_modulus", 3.0);
  return input;
}

Case with(Case input, const std::string& key, const KeyValue& value) {
  input.set(key, value);
  return input;
}

const std::vector<double> six_by_five{6.0, 5.0};

Scene<2> scene_of(const Case& input) { return study::make_scene<2>(io::with_scene_keys(input)); }

/// The scene of a file with this text, below the keys of a case of `ul`.
Scene<2> scene_of_file(const std::string& text) {
  const ScratchFolder folder;
  io::write_file(folder / "test.toml", "scheme = \"ul\"\nsound_speed = 2.0\nshear_modulus = 3.0\n" + text);
  Case input;
  input.set("scene", (folder / "test.toml").string());
  return scene_of(input);
}

}  // namespace

TEST_CASE("the key patch makes periodic cells, which may be stressed", "[fast]") {
  Case input = with(with(updated_case(), "patch", six_by_five), "pressure", 0.1);
  input.set("gravity", std::vector<double>{0.0, -1.0});
  const auto scene = scene_of(input);
  REQUIRE(scene.periodic_cells);
  CHECK(*scene.periodic_cells == LatticeIndex<2>(6, 5));
  CHECK(scene.body.size() == 30);
  CHECK(scene.body.load[3] == Vector<2>(0.0, -1.0));
  CHECK(scene.velocity.empty());
  CHECK(body_name(input) == Json{{"patch", {6, 5}}});
}

TEST_CASE("a scene file with patch and no body is a periodic patch with its probes, velocities and clamps", "[fast]") {
  const auto scene = scene_of_file(R"(
    patch = [6, 5]
    pressure = -0.05
    [[probe]]
    name = "middle"
    position = [3.1, 2.1]
    [[velocity]]
    region.box = { from = [0.0, 0.0], to = [0.0, 9.0] }
    velocity = [0.5, 0.25]
    [[clamp]]
    region.box = { from = [0.0, 0.0], to = [0.0, 0.0] }
    directions = ["x"]
  )");
  REQUIRE(scene.periodic_cells);
  CHECK(scene.body.size() == 30);
  CHECK(scene.probes.front().particle == 2 * 6 + 3);
  CHECK(scene.velocity[0] == Vector<2>(0.0, 0.25));
  CHECK(scene.velocity[6] == Vector<2>(0.5, 0.25));
  CHECK(scene.velocity[7].isZero(0.0));
}

TEST_CASE("initial noise is uniform in p-wave speeds, adds to velocities, and leaves held particles alone", "[fast]") {
  const std::string plate = R"(
    initial_noise = 1e-3
    [[body]]
    shape.box = { from = [0.0, 0.0], to = [40.0, 30.0] }
    [[velocity]]
    region.box = { from = [0.0, 0.0], to = [40.0, 30.0] }
    velocity = [7.0, 0.0]
    [[clamp]]
    region.box = { from = [0.0, 0.0], to = [1.0, 30.0] }
    directions = ["y"]
  )";
  const auto scene = scene_of_file(plate);
  const double largest = 1e-3 * std::sqrt(2.0 * 2.0 + 4.0 / 3.0 * 3.0);
  double mean_square = 0.0, highest = 0.0;
  for (int a = 0; a < scene.body.size(); ++a) {
    if (scene.body.clamped[a][1]) CHECK(scene.velocity[a][1] == 0.0);
    const double noise = scene.velocity[a][0] - 7.0;
    mean_square += noise * noise / scene.body.size();
    highest = std::max(highest, std::abs(noise));
  }
  constexpr double rounding = 1e-12;  // of 7 + noise, over the noise
  CHECK(highest <= largest * (1.0 + rounding));
  CHECK(highest > 0.99 * largest);  // of 1200 numbers one is beyond but for e^{-12}
  // A uniform number has the variance 1/3; that of the mean of 1200 squares is 4/45 over 1200: five deviations.
  CHECK(std::abs(mean_square / (largest * largest) - 1.0 / 3.0) < 5.0 * std::sqrt(4.0 / 45.0 / 1200.0));
  CHECK(scene_of_file(plate).velocity == scene.velocity);
  CHECK(scene_of_file("noise_seed = 2\n" + plate).velocity != scene.velocity);
}

TEST_CASE("a body of ul with free surfaces takes no stress", "[fast]") {
  const Case plate = with(updated_case(), "plate", six_by_five);
  CHECK(scene_of(plate).body.size() == 30);
  CHECK_THROWS_WITH(
      scene_of(with(plate, "pressure", 0.1)),
      "pressure: a body with free surfaces is in no equilibrium under a stress; only a periodic patch is");
  CHECK_THROWS_WITH(scene_of(with(plate, "deviatoric_stress", std::vector<double>{0.1, 0.0, 0.0})),
                    Catch::StartsWith("deviatoric_stress: a body with free surfaces"));
}

TEST_CASE("two bodies, or none, are refused", "[fast]") {
  CHECK_THROWS_WITH(scene_of(updated_case()), "scene: missing (or plate or patch)");
  CHECK_THROWS_WITH(scene_of(with(with(updated_case(), "plate", six_by_five), "patch", six_by_five)),
                    "plate: cannot be given with patch");
  CHECK_THROWS_WITH(scene_of(with(updated_case(), "patch", std::vector<double>{1e4, 1e4})),
                    Catch::StartsWith("patch: 10000,10000 multiply to more than"));
  CHECK_THROWS_WITH(scene_of_file("patch = [3, 3]\n[[body]]\nshape.box = { from = [0.0, 0.0], to = [4.0, 4.0] }\n"),
                    Catch::EndsWith("test.toml: patch: cannot be given with bodies"));
  CHECK_THROWS_WITH(scene_of_file("patch = [3, 3]\n[[traction]]\nregion.box = { from = [0.0, 0.0], to = [4.0, 4.0] }\n"
                                  "traction = [1.0, 0.0]\n"),
                    Catch::EndsWith("test.toml: traction: a periodic patch has no surface"));
}
