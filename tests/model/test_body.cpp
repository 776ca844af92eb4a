// SPDX-License-Identifier: MIT
#include "model/body.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace sphstab;

namespace {

/// Differences of positions that are sums of a few doubles of order ten.
constexpr double rounding = 1e-13;

Problem<2> problem(LatticeKind kind, double smoothing_length) {
  return {.lattice = Lattice<2>(kind, 0.5),
          .kernel = Kernel<2>(KernelFamily::cubic_spline, smoothing_length),
          .material = Material::from_young_modulus(1.0, 1.0, 0.3)};
}

/// How often b is a neighbour of a with separation r_ab.
int occurrences(const Body<2>& body, int a, int b, const Vector<2>& separation) {
  int found = 0;
  for (int entry = body.pairs.first[a]; entry < body.pairs.first[a + 1]; ++entry)
    found += body.pairs.neighbour[entry] == b && (body.pairs.separation[entry] - separation).norm() < rounding;
  return found;
}

}  // namespace

TEST_CASE("a plate has exactly the pairs that brute force finds", "[fast]") {
  const auto p = problem(LatticeKind::square, 0.65);
  const auto plate = free_plate<2>(p, {7, 4});
  REQUIRE(plate.size() == 28);
  CHECK((plate.position[7 * 2 + 3] - Vector<2>(1.5, 1.0)).norm() == 0.0);  // x fastest
  int pairs = 0;
  for (int a = 0; a < plate.size(); ++a)
    for (int b = 0; b < plate.size(); ++b) {
      const Vector<2> separation = plate.position[a] - plate.position[b];
      const bool expected = a != b && separation.norm() < p.kernel.support() * (1.0 - tie_margin);
      CHECK(occurrences(plate, a, b, separation) == (expected ? 1 : 0));
      pairs += expected;
    }
  CHECK(pairs == plate.pairs.first.back());
}

TEST_CASE("a periodic patch has every image within the support, also where it is smaller than the support", "[fast]") {
  constexpr int images = 6;
  for (const auto kind : {LatticeKind::square, LatticeKind::hexagonal, LatticeKind::staggered})
    for (const LatticeIndex<2>& cells : {LatticeIndex<2>(5, 4), LatticeIndex<2>(2, 3), LatticeIndex<2>(1, 1)}) {
      INFO(name_of(kind) << " " << cells.transpose());
      const auto p = problem(kind, 0.8);
      const auto patch = periodic_patch<2>(p, cells);
      int pairs = 0;
      for (int a = 0; a < patch.size(); ++a)
        for (int b = 0; b < patch.size(); ++b)
          for (int i = -images; i <= images; ++i)
            for (int j = -images; j <= images; ++j) {
              const Vector<2> shift = p.lattice.site({i * cells[0], j * cells[1]});
              const Vector<2> separation = patch.position[a] - (patch.position[b] + shift);
              if (separation.norm() < rounding || separation.norm() >= p.kernel.support() * (1.0 - tie_margin))
                continue;
              CHECK(occurrences(patch, a, b, separation) == 1);
              ++pairs;
            }
      CHECK(pairs == patch.pairs.first.back());
    }
}

TEST_CASE("plates need the square lattice and at least two particles each way", "[fast]") {
  CHECK_THROWS_WITH(free_plate<2>(problem(LatticeKind::hexagonal, 0.8), {4, 4}),
                    Catch::StartsWith("plate: a free plate"));
  CHECK_THROWS_WITH(free_plate<2>(problem(LatticeKind::square, 0.8), {4, 1}),
                    Catch::StartsWith("plate: 4,1 has a count"));
  CHECK_THROWS_WITH(periodic_patch<2>(problem(LatticeKind::square, 0.8), {4, 0}), Catch::StartsWith("patch: 4,0"));
}

TEST_CASE("a periodic patch of a skewed basis is one of the same lattice", "[fast]") {
  constexpr double rounding_of_skewed = 1e-12;  // basis vectors of length ten
  auto p = problem(LatticeKind::square, 0.8);
  const Tensor<2> shear{{1.0, 10.0}, {0.0, 1.0}};
  p.lattice = Lattice<2>(p.lattice.primitive_vectors() / p.lattice.spacing() * shear, p.lattice.spacing());
  const auto patch = periodic_patch<2>(p, {4, 3});
  for (int a = 0; a < patch.size(); ++a)
    for (int entry = patch.pairs.first[a]; entry < patch.pairs.first[a + 1]; ++entry) {
      const auto& separation = patch.pairs.separation[entry];
      CHECK(separation.norm() < p.kernel.support());
      const Vector<2> apart = patch.position[a] - patch.position[patch.pairs.neighbour[entry]] - separation;
      const Vector<2> periods = (p.lattice.primitive_vectors().inverse() * apart).cwiseQuotient(Vector<2>(4.0, 3.0));
      CHECK((periods - periods.array().round().matrix()).norm() < rounding_of_skewed);
    }
}

TEST_CASE("the pairs of scattered particles are those that brute force finds, each seen from both sides", "[fast]") {
  // Linear congruences fill a box evenly enough and leave some cells empty; a lone particle is far away.
  std::vector<Vector<2>> position{{1e4, -3e3}};
  for (int i = 0; i < 400; ++i) position.push_back({(i * 37 % 401) * 0.05 - 7.0, (i * 101 % 397) * 0.05});
  constexpr double support = 1.3;
  const auto pairs = find_pairs<2>(position, support);
  REQUIRE(pairs.particles() == static_cast<int>(position.size()));
  for (int a = 0; a < pairs.particles(); ++a) {
    std::vector<int> expected;
    for (int b = 0; b < pairs.particles(); ++b)
      if (b != a && (position[a] - position[b]).norm() < support) expected.push_back(b);
    CHECK(std::vector<int>(pairs.neighbour.begin() + pairs.first[a], pairs.neighbour.begin() + pairs.first[a + 1]) ==
          expected);
    for (int entry = pairs.first[a]; entry < pairs.first[a + 1]; ++entry)
      CHECK((pairs.separation[entry] - (position[a] - position[pairs.neighbour[entry]])).norm() == 0.0);
  }
  CHECK(pairs.first[1] == 0);
}

TEST_CASE("particles at any distance have their own neighbours only", "[fast]") {
  constexpr double support = 0.5;
  const double beyond_the_cells = std::ldexp(support, 21);  // where a cell shares its key with one at the origin
  std::vector<Vector<3>> position;
  for (const double far : {0.0, beyond_the_cells, -beyond_the_cells, 1e12, -1e12, 1e300, -1e308})
    for (const auto& direction : {Vector<3>(1.0, 0.0, 0.0), Vector<3>(0.0, 1.0, 0.0), Vector<3>(0.0, 0.0, -1.0)}) {
      if (far == 0.0 && direction[0] == 0.0) continue;
      position.push_back(far * direction);
      position.push_back(far * direction + Vector<3>(0.25, 0.25, 0.25));
    }
  const auto pairs = find_pairs<3>(position, support);
  for (int a = 0; a < pairs.particles(); ++a) {
    REQUIRE(pairs.first[a + 1] - pairs.first[a] == 1);
    CHECK(pairs.neighbour[pairs.first[a]] == (a ^ 1));
  }
}
