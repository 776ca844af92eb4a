// SPDX-License-Identifier: MIT
#include "model/scene.hpp"

#include <catch2/catch.hpp>
#include <numbers>

using namespace sphstab;

namespace {

constexpr double pi = std::numbers::pi;

/// Sums of some hundred doubles, relative to the terms.
constexpr double rounding = 1e-12;

Material material(double density) { return Material::from_young_modulus(density, 1.0, 0.3); }

/// One body of the shape on the square lattice of spacing 0.5, of density 2.
SceneDescription<2> scene_of(const Shape<2>& shape, const Arrangement<2>& arrangement = LatticeArrangement<2>{}) {
  const Placement<2> placement{.shape = shape, .arrangement = arrangement};
  return {.name = "scene",
          .problem = {.lattice = Lattice<2>(LatticeKind::square, 0.5),
                      .kernel = Kernel<2>(KernelFamily::cubic_spline, 0.65),
                      .material = material(2.0)},
          .materials = {material(2.0)},
          .parts = {ScenePart<2>{.name = "first", .placement = placement}}};
}

ScenePart<2> part(const std::string& name, const Box<2>& box, int material_index = 0) {
  const Placement<2> placement{.shape = box};
  return {name, placement, material_index};
}

const Box<2> plate{{0.0, 0.0}, {4.0, 2.0}};  // 8 × 4 particles

Vector<2> total_force(const Body<2>& body) {
  Vector<2> force = Vector<2>::Zero();
  for (int a = 0; a < body.size(); ++a) force += body.mass(a) * body.load[a];
  return force;
}

double torque(const Body<2>& body, double nearest, double farthest) {
  double sum = 0.0;
  for (int a = 0; a < body.size(); ++a) {
    const auto &x = body.position[a], &f = body.load[a];
    if (x.norm() > nearest && x.norm() < farthest) sum += body.mass(a) * (x[0] * f[1] - x[1] * f[0]);
  }
  return sum;
}

}  // namespace

TEST_CASE("a box without offset is the free plate of the command line", "[fast]") {
  const auto description = scene_of(Box<2>{{0.0, 0.0}, {3.0, 1.5}}, LatticeArrangement<2>{Vector<2>::Zero()});
  const auto body = make_scene(description).body;
  const auto expected = free_plate<2>(description.problem, {7, 4});
  REQUIRE(body.size() == expected.size());
  CHECK(body.position == expected.position);
  CHECK(body.volume == expected.volume);
  CHECK(body.material == expected.material);
  CHECK(body.site == expected.site);
  CHECK(body.pairs.first == expected.pairs.first);
  CHECK(body.clamped.empty());
  CHECK(body.load.empty());
}

TEST_CASE("bodies that touch are bonded, each of its own material", "[fast]") {
  auto description = scene_of(plate);
  description.materials.push_back(material(7.0));
  description.materials.push_back(material(9.0));
  description.parts.push_back(part("second", Box<2>{{4.0, 0.0}, {6.0, 2.0}}, 2));
  description.parts.push_back(part("third", Box<2>{{6.0, 0.0}, {8.0, 2.0}}, 2));
  const auto body = make_scene(description).body;
  REQUIRE(body.size() == 64);
  CHECK(body.materials.size() == 2);  // only those that are used, each once
  CHECK(body.material_of(31).density() == 2.0);
  CHECK(body.material_of(32).density() == 9.0);
  CHECK(body.material_of(63).density() == 9.0);
  CHECK(body.site[32] == LatticeIndex<2>(8, 0));
  // The same particles as one box, in another order.
  const auto whole = make_scene(scene_of(Box<2>{{0.0, 0.0}, {8.0, 2.0}})).body;
  CHECK(body.pairs.first.back() == whole.pairs.first.back());
}

TEST_CASE("lattice coordinates are there only where all particles are cells of one lattice", "[fast]") {
  auto apart = scene_of(plate);
  apart.parts.push_back(part("second", Box<2>{{20.0, -3.0}, {21.0, -2.0}}));
  CHECK(make_scene(apart).body.site[32] == LatticeIndex<2>(40, -6));
  apart.parts[1].placement.shape = Box<2>{{20.1, -3.0}, {21.1, -2.0}};
  CHECK(make_scene(apart).body.site.empty());
  auto jittered = scene_of(plate);
  jittered.parts[0].placement.jitter = Jitter{0.1, 1};
  CHECK(make_scene(jittered).body.site.empty());
  CHECK(make_scene(scene_of(Annulus<2>{Vector<2>::Zero(), 1.0, 2.0}, PolarArrangement{2, 16})).body.site.empty());
  auto far = scene_of(plate);
  far.parts.push_back(part("second", Box<2>{{1e30, 0.0}, {1e30, 2.0}}));
  CHECK(make_scene(far).body.site.empty());  // beyond the range of an index
}

TEST_CASE("clamps hold the particles of their regions in their directions", "[fast]") {
  auto description = scene_of(plate);
  description.clamps.push_back({Box<2>{{0.0, 0.0}, {0.5, 2.0}}, {true, false}});
  description.clamps.push_back({Box<2>{{0.0, 0.0}, {4.0, 0.5}}, {false, true}});
  const auto body = make_scene(description).body;
  REQUIRE(body.clamped.size() == 32);
  for (int a = 0; a < 32; ++a) {
    CHECK(body.clamped[a][0] == (a % 8 == 0));
    CHECK(body.clamped[a][1] == (a / 8 == 0));
  }
}

TEST_CASE("a traction adds up to its integral over the surface, gravity to the weight", "[fast]") {
  auto description = scene_of(plate);
  description.gravity = {0.0, -10.0};
  CHECK((total_force(make_scene(description).body) - Vector<2>(0.0, -10.0 * 2.0 * 8.0)).norm() < 160 * rounding);
  // t = (3 + (y − 1), −1) on the right edge, x = 4, 0 < y < 2: force (6, −2), moment about (0, 1) −8 − 2/3; a layer of
  // cells takes the mean of y t at their centres: 2/3 (1 − 1/4²).
  description.tractions.push_back(
      {Box<2>{{3.5, 0.0}, {4.0, 2.0}}, AffineField<2>{{3.0, -1.0}, Tensor<2>{{0.0, 1.0}, {0.0, 0.0}}, {0.0, 1.0}}});
  description.gravity.setZero();
  const auto body = make_scene(description).body;
  CHECK((total_force(body) - Vector<2>(6.0, -2.0)).norm() < 6 * rounding);
  double moment = 0.0;
  for (int a = 0; a < body.size(); ++a) moment -= body.mass(a) * (body.position[a][1] - 1.0) * body.load[a][0];
  CHECK(moment == Approx(-2.0 / 3.0 * (1.0 - 1.0 / 16.0)).epsilon(rounding));
  for (int a = 0; a < body.size(); ++a)
    if (a % 8 != 7) CHECK(body.load[a].isZero(0.0));
  description.tractions[0].layer = 0.25;
  CHECK((total_force(make_scene(description).body) - Vector<2>(12.0, -4.0)).norm() < 12 * rounding);
}

TEST_CASE("a total force is shared by the particles of its region in proportion to their mass", "[fast]") {
  auto description = scene_of(plate);
  description.tractions = {{Box<2>{{3.5, 0.0}, {4.0, 0.5}}, TotalForce<2>{{2.0, -7.0}}}};
  const auto body = make_scene(description).body;
  CHECK((total_force(body) - Vector<2>(2.0, -7.0)).norm() < 8 * rounding);
  int loaded = 0;
  for (int a = 0; a < body.size(); ++a) loaded += !body.load[a].isZero(0.0);
  CHECK(loaded == 1);
  description.tractions[0].region = Box<2>{{3.5, 0.0}, {4.0, 2.0}};
  CHECK((total_force(make_scene(description).body) - Vector<2>(2.0, -7.0)).norm() < 8 * rounding);
}

TEST_CASE("shear on both edges of an annulus is in balance and has the torque of the surface", "[fast]") {
  const Vector<2> zero = Vector<2>::Zero();
  auto description = scene_of(Annulus<2>{zero, 2.0, 5.0}, PolarArrangement{6, 18});
  constexpr double q = 0.7;
  description.tractions.push_back(
      {Annulus<2>{zero, 2.0, 2.5}, CentredTraction<2>{.centre = zero, .shear = -q / 4.0, .at_radius = 2.0}});
  description.tractions.push_back(
      {Annulus<2>{zero, 4.5, 5.0}, CentredTraction<2>{.centre = zero, .shear = q / 25.0, .at_radius = 5.0}});
  const auto body = make_scene(description).body;
  CHECK(total_force(body).norm() < rounding);
  CHECK(torque(body, 0.0, 2.5) == Approx(-2 * pi * q).epsilon(rounding));  // −q/a² · 2πa · a
  CHECK(torque(body, 4.5, 5.0) == Approx(2 * pi * q).epsilon(rounding));
  CHECK(torque(body, 2.5, 4.5) == 0.0);
  CHECK(body.load[0][1] < 0.0);  // at the angle 0 of the inner edge

  // Radial: the sum of the outward parts is p · 2πb; without at_radius that of the radius of the particles.
  auto inflated = scene_of(Annulus<2>{zero, 2.0, 5.0}, PolarArrangement{6, 18});
  inflated.tractions.push_back(
      {Annulus<2>{zero, 4.5, 5.0}, CentredTraction<2>{.centre = zero, .radial = 3.0, .at_radius = 5.0}});
  const auto outward = [](const Body<2>& b) {
    double sum = 0.0;
    for (int a = 0; a < b.size(); ++a) sum += b.mass(a) * b.load[a].dot(b.position[a].normalized());
    return sum;
  };
  CHECK(outward(make_scene(inflated).body) == Approx(3.0 * 10 * pi).epsilon(rounding));
  std::get<CentredTraction<2>>(inflated.tractions[0].stress).at_radius.reset();
  CHECK(outward(make_scene(inflated).body) == Approx(3.0 * 9.5 * pi).epsilon(rounding));
}

TEST_CASE("a probe takes the nearest particle, the first of several", "[fast]") {
  auto description = scene_of(plate);
  description.probes = {{"corner", {-1.0, -1.0}}, {"between four", {1.0, 1.0}}, {"near", {3.9, 0.3}}};
  const auto probes = make_scene(description).probes;
  REQUIRE(probes.size() == 3);
  CHECK(probes[0].name == "corner");
  CHECK(probes[0].particle == 0);
  CHECK(probes[1].particle == 8 + 1);
  CHECK(probes[2].particle == 7);
  description.probes[2].name = "corner";
  CHECK_THROWS_WITH(make_scene(description), "probe 3: name: 'corner' is given twice");
}

TEST_CASE("nearest neighbours of a body on a lattice are those of the lattice", "[fast]") {
  auto description = scene_of(plate);
  description.problem.neighbour_rule = NeighbourRule::nearest;
  CHECK(make_scene(description).body.pairs.first.back() == 2 * (7 * 4 + 8 * 3));
  description.parts[0].placement.jitter = Jitter{0.1, 1};
  CHECK_THROWS_WITH(make_scene(description), Catch::StartsWith("neighbours: nearest"));
}

TEST_CASE("scenes that cannot be are refused with the number of the table", "[fast]") {
  const Box<2> outside{{50.0, 0.0}, {60.0, 2.0}};
  auto nothing = scene_of(plate);
  nothing.parts.clear();
  CHECK_THROWS_WITH(make_scene(nothing), "body: missing (or patch)");
  auto overlap = scene_of(plate);
  overlap.parts.push_back(part("second", Box<2>{{3.5, 1.5}, {4.5, 2.0}}));
  CHECK_THROWS_WITH(make_scene(overlap),
                    "particle 31 of body 1 ('first') at [3.75, 1.75] is in the same place as particle 32 of body 2 "
                    "('second') at [3.75, 1.75]");
  auto lonely = scene_of(plate);
  lonely.parts.push_back(part("second", Box<2>{{50.0, 0.0}, {50.5, 0.5}}));
  CHECK_THROWS_WITH(make_scene(lonely),
                    "particle 32 of body 2 ('second') at [50.25, 0.25] has no neighbour within the support, 1.3");
  auto clamp = scene_of(plate);
  clamp.clamps = {{plate, {true, true}}, {outside, {true, true}}};
  CHECK_THROWS_WITH(make_scene(clamp), "clamp 2: region: holds no particle");
  auto traction = scene_of(plate);
  traction.tractions = {{outside, AffineField<2>{{1.0, 0.0}}}};
  CHECK_THROWS_WITH(make_scene(traction), "traction 1: region: holds no particle");
  traction.tractions = {{plate, CentredTraction<2>{.centre = {0.25, 0.25}, .shear = 1.0}}};
  CHECK_THROWS_WITH(make_scene(traction),
                    "traction 1: centre: particle 0 of body 1 ('first') at [0.25, 0.25] lies on it");
  auto many = scene_of(Box<2>{{0.0, 0.0}, {1500.0, 1500.0}});
  many.problem.kernel = Kernel<2>(KernelFamily::cubic_spline, 5.0);
  CHECK_THROWS_WITH(make_scene(many), Catch::StartsWith("body: has about 1.1e+10 pairs of neighbours"));
  many.parts.push_back(part("second", Box<2>{{2000.0, 0.0}, {2450.0, 1500.0}}));
  CHECK_THROWS_WITH(make_scene(many),
                    "body 2: shape: makes 11700000 particles in all, more than the 10000000 that are allowed");
  auto incompressible = scene_of(plate);
  incompressible.materials[0] = Material::from_young_modulus(1.0, 1.0, 0.5);
  CHECK_THROWS_WITH(make_scene(incompressible), "body 1: material: poisson_ratio: 0.5 is not below 0.5 (plane strain)");
}

TEST_CASE("a description with periodic cells makes a patch that is held, moved and probed like a body", "[fast]") {
  auto description = scene_of(Box<2>{{0.0, 0.0}, {1.0, 1.0}});
  description.parts.clear();
  description.periodic_cells = LatticeIndex<2>(6, 5);
  description.gravity = {0.0, -2.0};
  description.clamps = {{Box<2>{{0.0, 0.0}, {0.0, 0.0}}, Directions<2>(true, false)}};
  description.velocities = {{Box<2>{{0.0, 0.0}, {10.0, 10.0}}, AffineField<2>{.value = {3.0, 4.0}}}};
  description.probes = {{"middle", {1.1, 1.4}}};
  const auto scene = make_scene(description);
  const auto patch = periodic_patch(description.problem, LatticeIndex<2>(6, 5));
  CHECK(scene.periodic_cells == description.periodic_cells);
  CHECK(scene.body.position == patch.position);
  CHECK(scene.body.pairs.neighbour == patch.pairs.neighbour);
  CHECK(scene.body.load[7] == Vector<2>(0.0, -2.0));
  CHECK(scene.velocity[0] == Vector<2>(0.0, 4.0));
  CHECK(scene.velocity[7] == Vector<2>(3.0, 4.0));
  CHECK(scene.probes.front().particle == 2 + 6 * 3);

  description.periodic_cells = LatticeIndex<2>(4000, 4000);
  CHECK_THROWS_WITH(make_scene(description), Catch::StartsWith("patch: 16000000 particles are more than"));
}

TEST_CASE("a cantilever starts in its first mode: flat at the root, free at the tip, bent by its own inertia between",
          "[fast]") {
  // 200 columns of particles: the first at half a spacing, d = 1/200 of the length apart.
  auto description = scene_of(Box<2>{{0.0, 0.0}, {100.0, 1.0}});
  description.velocities = {{Box<2>{{0.0, 0.0}, {100.0, 1.0}}, CantileverMode{0.0, 100.0, 0.5}}};
  const auto velocity = make_scene(description).velocity;
  constexpr int columns = 200;
  constexpr double d = 1.0 / columns;
  std::vector<double> Y;
  for (int i = 0; i < columns; ++i) {
    Y.push_back(velocity[i][1] / 0.5);
    CHECK(velocity[i][0] == 0.0);
    CHECK(velocity[columns + i] == velocity[i]);  // the row above
  }
  // Y = ½ Y''(0) x² + O(x³) near the root, 1 + Y'(1) (x − 1) near the tip.
  constexpr double second_order = 100.0 * d * d;
  CHECK(Y[1] / Y[0] == Approx(9.0).epsilon(2.0 * d));
  CHECK(1.5 * Y[columns - 1] - 0.5 * Y[columns - 2] == Approx(1.0).epsilon(second_order));
  // Y'''' = (kL)⁴ Y by differences over five columns: to (5d)²/6 (kL)⁴ max |Y''|.
  constexpr int stride = 5;
  constexpr double span = stride * d, truncation = 12.4 / 6.0 * 7.1 * span * span;
  const auto bending = [&](int i) { return (Y[i - stride] - 2.0 * Y[i] + Y[i + stride]) / (span * span); };
  CHECK(std::abs(bending(columns - 1 - stride)) < truncation);
  for (int i = 2 * stride; i < columns - 2 * stride; i += 7) {
    const double fourth = (bending(i - stride) - 2.0 * bending(i) + bending(i + stride)) / (span * span);
    CHECK(fourth == Approx(std::pow(1.8751040687, 4) * Y[i]).epsilon(0.0).margin(truncation));
  }
}
