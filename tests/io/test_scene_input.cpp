// SPDX-License-Identifier: MIT
#include "io/scene_input.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <numbers>

#include "io/files.hpp"
#include "io/scratch_folder.hpp"

using namespace sphstab;
using namespace sphstab::io;
using Catch::Matchers::StartsWith;

namespace {

/// Sums of some hundred doubles, relative to the terms.
constexpr double rounding = 1e-12;

const std::string keys_of_case = "scheme = \"tl-linear\"\nyoung_modulus = 1.0\npoisson_ratio = 0.3\nspacing = 0.5\n";
const std::string plate = "[[body]]\nname = \"plate\"\nshape.box = { from = [0.0, 0.0], to = [4.0, 2.0] }\n";

Case case_of(const std::filesystem::path& path) {
  Case input;
  input.set("scene", path.string());
  return input;
}

template <int Dim>
Scene<Dim> scene_at(const std::filesystem::path& path) {
  return read_scene<Dim>(with_scene_keys(case_of(path)));
}

template <int Dim = 2>
Scene<Dim> scene_of(const std::string& text) {
  const ScratchFolder folder;
  write_file(folder / "test.toml", text);
  return scene_at<Dim>(folder / "test.toml");
}

/// What reading the text complains of, without the name of the file.
std::string complaint(const std::string& text) {
  const ScratchFolder folder;
  const auto path = folder / "test.toml";
  write_file(path, text);
  try {
    scene_at<2>(path);
  } catch (const InvalidInput& error) {
    const std::string message = error.what(), name = path.string() + ": ";
    REQUIRE_THAT(message, StartsWith(name));
    return message.substr(name.size());
  }
  return "";
}

std::string complaint_of(const std::string& tables) { return complaint(keys_of_case + plate + tables); }

Scene<2> scene_named(const std::string& name) {
  return scene_at<2>(std::filesystem::path(SPHSTAB_SCENES_FOLDER) / name);
}

Vector<2> force(const Body<2>& body, int a) { return body.mass(a) * body.load[a]; }

double torque(const Body<2>& body, int a) {
  const auto &x = body.position[a], f = force(body, a);
  return x[0] * f[1] - x[1] * f[0];
}

}  // namespace

TEST_CASE("every table and key of a scene file reaches the scene", "[fast]") {
  const ScratchFolder folder;
  const std::string text = keys_of_case + "density = 2.0\ngravity = [0.0, -3.0]\n" + R"(
    [[material]]
    name = "heavy"
    density = 5.0
    bulk_modulus = 2.0
    shear_modulus = 0.75

    [[body]]
    shape.box = { from = [0.0, 0.0], to = [4.0, 2.0] }
    cut = [{ ball = { centre = [2.25, 1.25], radius = 0.1 } }, { box = { from = [3.5, 1.5], to = [4.0, 2.0] } }]

    [[body]]
    name = "disc"
    material = "heavy"
    shape.ball = { centre = [10.0, 0.0], radius = 0.5 }
    arrangement = "polar"
    rings = 2
    sectors = 12

    [[body]]
    shape.annulus = { centre = [20.0, 0.0], inner = 0.5, outer = 1.5 }
    arrangement = "lattice"
    offset = [0.25, 0.0]
    jitter = 0.125
    jitter_seed = 7

    [[clamp]]
    region.box = { from = [0.0, 0.0], to = [0.5, 2.0] }
    directions = ["y"]

    [[clamp]]
    region.annulus = { centre = [10.0, 0.0], inner = 0.3, outer = 0.4 }

    [[traction]]
    region.box = { from = [0.0, 1.5], to = [4.0, 2.0] }
    traction = [1.0, 2.0]
    gradient = [0.0, 0.0, 4.0, 0.0]
    origin = [0.25, 0.0]
    layer = 0.1

    [[traction]]
    region.annulus = { centre = [10.0, 0.0], inner = 0.25, outer = 0.5 }
    centre = [10.0, 0.0]
    shear = 0.3
    radial = 0.2
    at_radius = 0.5

    [[probe]]
    name = "outer"
    position = [11.0, 0.0]
  )";
  write_file(folder / "my scene.toml", text);
  const auto scene = scene_at<2>(folder / "my scene.toml");
  const auto& body = scene.body;
  CHECK(scene.name == "my scene");
  CHECK(scene.problem.lattice.spacing() == 0.5);
  const int disc = 30, shell = disc + 24;
  REQUIRE(body.size() > shell);
  CHECK(body.position[20] == Vector<2>(2.75, 1.25));  // after the hole at (2.25, 1.25)
  CHECK(body.material_of(disc - 1).density() == 2.0);
  CHECK(body.material_of(disc).bulk_modulus() == Approx(2.0));
  CHECK((body.position[disc + 12] - Vector<2>(10.375, 0.0)).norm() < rounding);
  CHECK(body.volume[disc + 12] == Approx(std::numbers::pi * 0.1875 / 12));
  for (int a = shell; a < body.size(); ++a) {
    const Vector<2> cell = (body.position[a] - Vector<2>(20.125, 0.0)) / 0.5;
    CHECK((cell - cell.array().round().matrix()).cwiseAbs().maxCoeff() <= 0.125);
  }
  CHECK((body.clamped[0] == Directions<2>(false, true)).all());
  CHECK((body.clamped[disc + 12] == Directions<2>(true, true)).all());
  CHECK_FALSE(body.clamped[disc].any());
  // Gravity and (1, 2 + 4 (x − 1/4)) / (ρ 0.1) at (3/4, 7/4).
  CHECK((body.load[24] - Vector<2>(5.0, 20.0 - 3.0)).norm() < 20 * rounding);
  CHECK((body.load[disc + 12] - Vector<2>(0.2 / 0.75, 0.3 / 0.5625) / (5.0 * 0.25) - Vector<2>(0.0, -3.0)).norm() <
        rounding);
  REQUIRE(scene.probes.size() == 1);
  CHECK(scene.probes[0].name == "outer");
  CHECK(scene.probes[0].particle == disc + 12);
}

TEST_CASE("keys given beside the file come before those in it", "[fast]") {
  const ScratchFolder folder;
  write_file(folder / "a.toml", keys_of_case + "density = 2.0\nduration = 3.0\n" + plate);
  Case input = case_of(folder / "a.toml");
  input.set("density", 7.0);
  const Case merged = with_scene_keys(input);
  CHECK(merged.number("duration") == 3.0);
  CHECK(merged.number("density") == 7.0);
  CHECK(read_scene<2>(merged).body.material_of(0).density() == 7.0);
  CHECK_FALSE(with_scene_keys(Case()).has("duration"));
}

TEST_CASE("scenes have one and three dimensions too", "[fast]") {
  const auto bar = scene_of<1>(keys_of_case + "dimension = 1\n[[body]]\nshape.box = { from = [0.0], to = [5.0] }\n" +
                               "[[clamp]]\nregion.box = { from = [0.0], to = [0.5] }\ndirections = [\"x\"]\n");
  CHECK(bar.body.size() == 10);
  CHECK(bar.body.clamped[0][0]);
  CHECK_FALSE(bar.body.clamped[1][0]);
  const auto ball =
      scene_of<3>(keys_of_case + "dimension = 3\n[[body]]\nshape.ball = { centre = [0.0, 0.0, 0.0], radius = 1.0 }\n");
  CHECK(ball.body.size() == 32);  // of the 4 × 4 × 4 cells around the centre all but those at edges and corners
}

TEST_CASE("a mistake in a scene file is named by table, number, key and value", "[fast]") {
  CHECK(complaint_of("[[probe]]\nname = \"a\"\n") == "probe 1: position: missing");
  CHECK(complaint_of("[[clamp]]\ndirections = [\"x\"]\n") == "clamp 1: region: missing");
  CHECK_THAT(complaint_of("[[clamps]]\n"), StartsWith("table: 'clamps' is not known; did you mean 'clamp'?"));
  CHECK_THAT(complaint("kernl = 1\n" + plate), StartsWith("key: 'kernl' is not known; did you mean 'kernel'?"));
  CHECK_THAT(complaint_of("[[clamp]]\nregon.box = { from = [0.0, 0.0], to = [1.0, 1.0] }\n"),
             StartsWith("clamp 1: key: 'regon' is not known; did you mean 'region'?"));
  CHECK(complaint_of("[[clamp]]\nregion.bal = { centre = [0.0, 0.0], radius = 1.0 }\n") ==
        "clamp 1: region: key: 'bal' is not known; did you mean 'ball'? Allowed: box, ball, annulus");
  CHECK(complaint_of("[[clamp]]\nregion.ball = { centre = [0.0], radius = 1.0 }\n") ==
        "clamp 1: region: ball: centre: has 1 components, but 2 are needed");
  CHECK(complaint_of("[[clamp]]\nregion.ball = { centre = [9.0, 9.0], radius = 1.0 }\n") ==
        "clamp 1: region: holds no particle");
  CHECK(complaint_of("[[clamp]]\nregion.box = { from = [0.0, 0.0], to = [1.0, 1.0] }\ndirections = [\"z\"]\n") ==
        "clamp 1: directions: 'z' is not known; did you mean 'x'? Allowed: x, y");
  CHECK(complaint_of(plate + "jitter = 0.7\n") == "body 2: jitter: 0.7 is not at most 0.5");
  CHECK(complaint_of(plate + "jitter_seed = 7\n") == "body 2: jitter_seed: only with jitter");
  CHECK(complaint_of(plate + "rings = 7\n") == "body 2: rings: only with the arrangement polar");
  CHECK_THAT(complaint_of(plate + "arrangement = \"grid\"\n"), StartsWith("body 2: arrangement: 'grid' is not known"));
  CHECK(complaint_of(plate + "material = \"steel\"\n") ==
        "body 2: material: 'steel' is not known; the file has no table material");
  CHECK_THAT(complaint_of("[[material]]\nname = \"lead\"\nbulk_modulus = 1.0\nshear_modulus = 1.0\n" + plate +
                          "material = \"steel\"\n"),
             StartsWith("body 2: material: 'steel' is not known; did you mean 'lead'?"));
  CHECK(
      complaint_of("[[material]]\nname = \"lead\"\nyoung_modulus = 1.0\n").find("material 1: poisson_ratio: missing") ==
      0);
  CHECK(complaint_of("[[material]]\nname = \"lead\"\nyoung_modulus = -1.0\npoisson_ratio = 0.0\n") ==
        "material 1: young_modulus: -1 is not above 0");
  CHECK(complaint_of("[[body]]\nshape = 3\n") == "body 2: shape: 3 is no table");
  CHECK(complaint_of("[[body]]\nshape = {}\n") == "body 2: shape: is not one of box, ball and annulus");
  CHECK(complaint_of("[[body]]\nname = 3\n" + plate.substr(plate.find("shape"))) == "body 2: name: is not a word");
  CHECK(complaint_of(plate + "cut = 3\n") == "body 2: cut: is no list of shapes");
  const std::string edge = "[[traction]]\nregion.box = { from = [0.0, 0.0], to = [0.5, 2.0] }\n";
  CHECK(complaint_of(edge) == "traction 1: traction: missing (or force, or radial or shear with centre)");
  CHECK(complaint_of(edge + "shear = 1.0\n") == "traction 1: centre: missing");
  CHECK(complaint_of(edge + "shear = 1.0\norigin = [0.0, 0.0]\n") == "traction 1: origin: only with traction");
  CHECK(complaint_of(edge + "traction = [1.0, 0.0]\nshear = 1.0\n") ==
        "traction 1: shear: cannot be given with traction");
  CHECK(complaint_of(edge + "traction = [1.0, 0.0]\nlayer = 0.0\n") == "traction 1: layer: 0 is not above 0");
  CHECK(complaint(keys_of_case) == "body: missing (or patch)");
  CHECK(complaint(keys_of_case + "body = 3\n") == "body: is no array of tables, [[body]]");
  CHECK(complaint("scene = \"other.toml\"\n" + plate) == "scene: a scene file names no other scene");
  CHECK_THROWS_WITH(scene_of(keys_of_case + "gravity = [1.0]\n" + plate),
                    "gravity: has 1 components, but 2 are needed");
  CHECK_THROWS_WITH(with_scene_keys(case_of("missing.toml")), "missing.toml: No such file or directory");
}

TEST_CASE("the loads of the paper's plate pull its sides apart and turn nothing", "[fast]") {
  const auto scene = scene_named("zhang-case-1.toml");
  const auto& body = scene.body;
  REQUIRE(body.size() == 400);
  constexpr double k = 50.0, h = 5e-4, edge_force = k * h * h / 2;
  Vector<2> left = Vector<2>::Zero(), right = Vector<2>::Zero();
  double moment = 0.0;
  for (int a = 0; a < body.size(); ++a) {
    (a % 20 == 0 ? left : right) += force(body, a);
    moment += torque(body, a);
  }
  CHECK((left - Vector<2>(-edge_force, 0.0)).norm() < rounding * edge_force);
  CHECK((right - Vector<2>(edge_force, 0.0)).norm() < rounding * edge_force);
  CHECK(std::abs(moment) < rounding * edge_force * h);
  CHECK(force(body, 19)[0] > force(body, 399)[0]);  // largest at the bottom
  CHECK(force(body, 10).isZero(0.0));
  CHECK(scene.probes[0].particle == 0);
}

TEST_CASE("the shear of the paper's annulus is in balance", "[fast]") {
  const auto body = scene_named("zhang-case-2.toml").body;
  REQUIRE(body.size() == 360);
  constexpr double torque_of_q = 2 * std::numbers::pi * 1.7227e-9;  // τ · 2πr · r
  double inner = 0.0, outer = 0.0;
  Vector<2> total = Vector<2>::Zero();
  for (int a = 0; a < body.size(); ++a) {
    (a < 36 ? inner : outer) += torque(body, a);
    total += force(body, a);
  }
  CHECK(inner == Approx(-torque_of_q).epsilon(rounding));
  CHECK(outer == Approx(torque_of_q).epsilon(rounding));
  CHECK(total.norm() < rounding * torque_of_q / 2.5e-4);
}

TEST_CASE("the plate of Gray et al. moves between layers that do not", "[fast]") {
  const auto scene = scene_named("gray-plate.toml");
  const auto& body = scene.body;
  REQUIRE_FALSE(body.site.empty());  // plate and layers are of one lattice
  int held = 0;
  Vector<2> low(100.0, 100.0), high(-100.0, -100.0);
  for (int a = 0; a < body.size(); ++a) {
    const auto& x = body.position[a];
    const bool in_layer = std::abs(x[1]) > 1.0;
    CHECK(body.clamped[a].all() == in_layer);
    CHECK(body.clamped[a].any() == in_layer);
    CHECK((!in_layer || x[0] < 0.0));
    CHECK(scene.velocity[a][0] == 0.0);
    CHECK((scene.velocity[a][1] > 0.0) == (x[0] > 0.0));
    held += in_layer;
    if (in_layer) continue;
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  CHECK(held == 2 * 20 * 4);
  CHECK((high - low - Vector<2>(21.9, 1.9)).norm() < rounding);
  const int end = scene.probes.front().particle;
  CHECK((body.position[end] - Vector<2>(19.95, -0.05)).norm() < rounding);
  // V_f at the end, half a spacing behind the probe, where the mode is a line of slope 1.377/L.
  CHECK(scene.velocity[end][1] == Approx(0.01 * (1.0 - 1.377 * 0.05 / 20.0)).epsilon(1e-5));
}

TEST_CASE("a file with patch is a periodic patch, and a fluid of ul needs no Poisson's ratio", "[fast]") {
  const std::string fluid = "scheme = \"ul\"\nsound_speed = 1.0\nshear_modulus = 0.0\n";
  const auto patch = scene_of(fluid + "patch = [5, 4]\n[[probe]]\nname = \"one\"\nposition = [1.2, 0.9]\n");
  REQUIRE(patch.periodic_cells);
  CHECK(patch.body.size() == 20);
  CHECK(patch.probes.front().particle == 6);
  const auto body = scene_of(fluid + plate + "material = \"oil\"\n[[material]]\nname = \"oil\"\ndensity = 0.9\n" +
                             "sound_speed = 0.5\nshear_modulus = 0.0\n")
                        .body;
  CHECK(body.material_of(0).bulk_modulus() == Approx(0.9 * 0.25).epsilon(rounding));
  CHECK(body.material_of(0).shear_modulus() == 0.0);
}

TEST_CASE("every scene that is shipped can be read", "[fast]") {
  const std::pair<const char*, int> sizes[] = {{"zhang-case-1", 400},
                                               {"zhang-case-2", 360},
                                               {"clamped-beam", 320},
                                               {"free-beam", 320},
                                               {"jittered-plate", 400},
                                               {"two-materials", 320},
                                               {"nearly-incompressible-plate", 400},
                                               {"zhang-table-2-annulus", 180},
                                               {"zhang-table-2-rectangle", 200},
                                               {"gray-plate", 4560},
                                               {"gray-thin-plate", 2360},
                                               {"gray-array", 400},
                                               {"tension-patch", 400},
                                               {"transverse-patch", 400},
                                               {"cantilever", 1030},
                                               {"cantilever-ul", 1030},
                                               {"truss", 2575},
                                               {"turek-hron", 460}};
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(SPHSTAB_SCENES_FOLDER)) {
    ++files;
    CHECK(entry.path().extension() == ".toml");
  }
  CHECK(files == static_cast<int>(std::size(sizes)));
  for (const auto& [name, size] : sizes) {
    INFO(name);
    CHECK(scene_named(std::string(name) + ".toml").body.size() == size);
  }
}
