// SPDX-License-Identifier: MIT
#include "model/lattice.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace sphstab;

namespace {

/// Products of a handful of doubles of order one.
constexpr double rounding = 1e-14;

int count(LatticeKind kind, double support, NeighbourRule rule = NeighbourRule::support) {
  return static_cast<int>(lattice_neighbours(Lattice<2>(kind, 1.0), support, rule).size());
}

}  // namespace

TEST_CASE("primitive and reciprocal vectors are dual to each other", "[fast]") {
  for (const LatticeKind kind : lattices_of(2)) {
    INFO(name_of(kind));
    const Lattice<2> lattice(kind, 0.3);
    const Tensor<2> products = lattice.primitive_vectors().transpose() * lattice.reciprocal_vectors();
    CHECK((products - 2.0 * std::numbers::pi * Tensor<2>::Identity()).norm() < rounding);
  }
}

TEST_CASE("the volume of a particle is that of the cell", "[fast]") {
  CHECK(Lattice<2>(LatticeKind::square, 0.3).cell_volume() == Approx(0.09).epsilon(rounding));
  CHECK(Lattice<2>(LatticeKind::hexagonal, 1.0).cell_volume() == Approx(std::numbers::sqrt3 / 2).epsilon(rounding));
  CHECK(Lattice<2>(LatticeKind::staggered, 2.0).cell_volume() == Approx(4.0).epsilon(rounding));
}

TEST_CASE("the neighbours within a support are those of a brute-force search", "[fast]") {
  constexpr int reach = 12;
  for (const LatticeKind kind : lattices_of(2))
    for (const double support : {1.01, 1.3, 2.0, 2.6, 3.9, 5.05}) {
      INFO(name_of(kind) << " support " << support);
      const Lattice<2> lattice(kind, 1.0);
      const auto found = lattice_neighbours(lattice, support, NeighbourRule::support);
      int expected = 0;
      for (int i = -reach; i <= reach; ++i)
        for (int j = -reach; j <= reach; ++j) {
          const double distance = lattice.site({i, j}).norm();
          if ((i == 0 && j == 0) || distance >= support * (1.0 - tie_margin)) continue;
          ++expected;
          CHECK(std::count_if(found.begin(), found.end(),
                              [&](const auto& neighbour) { return neighbour.index == LatticeIndex<2>(i, j); }) == 1);
        }
      CHECK(static_cast<int>(found.size()) == expected);
    }
}

TEST_CASE("sites exactly on the support are no neighbours", "[fast]") {
  CHECK(count(LatticeKind::square, 2.0) == 8);
  CHECK(count(LatticeKind::square, 2.0 * (1.0 + 1e-9)) == 12);
  CHECK(count(LatticeKind::square, 2.6) == 20);
  CHECK(count(LatticeKind::hexagonal, 2.6) == 18);
}

TEST_CASE("the nearest shell has four, six and two sites", "[fast]") {
  CHECK(count(LatticeKind::square, 3.0, NeighbourRule::nearest) == 4);
  CHECK(count(LatticeKind::hexagonal, 3.0, NeighbourRule::nearest) == 6);
  CHECK(count(LatticeKind::staggered, 3.0, NeighbourRule::nearest) == 2);
}

TEST_CASE("a support without neighbours and a spacing that is not positive are refused", "[fast]") {
  CHECK_THROWS_WITH(lattice_neighbours(Lattice<2>(LatticeKind::square, 1.0), 1.0, NeighbourRule::support),
                    Catch::StartsWith("smoothing_length: no neighbour"));
  CHECK_THROWS_WITH(Lattice<2>(LatticeKind::square, -1.0), Catch::StartsWith("spacing: -1"));
}

TEST_CASE("in one and three dimensions spacing is the distance of nearest neighbours, with the right shells",
          "[fast]") {
  const auto shells = [](const auto& neighbours, double distance) {
    return std::count_if(neighbours.begin(), neighbours.end(),
                         [&](const auto& n) { return std::abs(n.distance - distance) < rounding * 10; });
  };
  const auto chain = lattice_neighbours(Lattice<1>(LatticeKind::chain, 0.5), 1.2, NeighbourRule::support);
  CHECK(chain.size() == 4);
  CHECK(shells(chain, 0.5) == 2);
  struct Crystal {
    LatticeKind kind;
    int nearest, second;
    double second_distance, volume;
  };
  // Coordination numbers, second shells and atomic volumes of crystallography, in nearest-neighbour distances.
  for (const auto& crystal : {Crystal{LatticeKind::cubic, 6, 12, std::sqrt(2.0), 1.0},
                              Crystal{LatticeKind::bcc, 8, 6, 2.0 / std::sqrt(3.0), 4.0 / (3.0 * std::sqrt(3.0))},
                              Crystal{LatticeKind::fcc, 12, 6, std::sqrt(2.0), 1.0 / std::sqrt(2.0)}}) {
    INFO(name_of(crystal.kind));
    const Lattice<3> lattice(crystal.kind, 1.0);
    const auto neighbours = lattice_neighbours(lattice, 1.5, NeighbourRule::support);
    CHECK(static_cast<int>(neighbours.size()) == crystal.nearest + crystal.second);
    CHECK(shells(neighbours, 1.0) == crystal.nearest);
    CHECK(shells(neighbours, crystal.second_distance) == crystal.second);
    CHECK(lattice.cell_volume() == Approx(crystal.volume).epsilon(rounding));
  }
  CHECK_THROWS_WITH(Lattice<3>(LatticeKind::square, 1.0), "lattice: square has 2 dimensions, not 3");
  CHECK_THROWS_WITH(Lattice<2>(LatticeKind::chain, 1.0), "lattice: chain has 1 dimension, not 2");
}

TEST_CASE("a custom lattice is the named one with the same primitive vectors", "[fast]") {
  for (const LatticeKind kind : lattices_of(3)) {
    const Lattice<3> named(kind, 0.7), custom(Lattice<3>(kind, 1.0).primitive_vectors(), 0.7);
    CHECK(custom.kind() == LatticeKind::custom);
    CHECK(custom.primitive_vectors() == named.primitive_vectors());
    CHECK(custom.reciprocal_vectors() == named.reciprocal_vectors());
    CHECK(custom.cell_volume() == named.cell_volume());
  }
  CHECK(lattices_of(1).size() + lattices_of(2).size() + lattices_of(3).size() + 1 == Names<LatticeKind>::table.size());
}

TEST_CASE("a skewed or left-handed basis has the same neighbours, numbered in that basis", "[fast]") {
  const Lattice<2> square(LatticeKind::square, 0.5);
  for (const Tensor<2>& vectors : {Tensor<2>{{1.0, 100.0}, {0.0, 1.0}}, Tensor<2>{{0.0, 1.0}, {1.0, 0.0}},
                                   Tensor<2>{{-101.0, 10.0}, {-10.0, 1.0}}}) {
    const Lattice<2> skewed(vectors, 0.5);
    CHECK(skewed.cell_volume() == Approx(square.cell_volume()));
    const auto expected = lattice_neighbours(square, 1.3, NeighbourRule::support);
    const auto found = lattice_neighbours(skewed, 1.3, NeighbourRule::support);
    REQUIRE(found.size() == expected.size());
    for (const auto& neighbour : found) {
      CHECK((skewed.site(neighbour.index) - neighbour.position).norm() < rounding * vectors.norm() * vectors.norm());
      CHECK(neighbour.distance == Approx(neighbour.position.norm()).epsilon(rounding));
      CHECK(std::count_if(expected.begin(), expected.end(), [&](const auto& other) {
              return (other.position - neighbour.position).norm() < rounding * vectors.norm();
            }) == 1);
    }
  }
}

TEST_CASE("dependent primitive vectors are refused, thin cells are not", "[fast]") {
  const auto lattice = [](const Tensor<2>& vectors) { return Lattice<2>(vectors, 1.0); };
  CHECK_THROWS_WITH(lattice(Tensor<2>{{1.0, 2.0}, {0.5, 1.0}}), "primitive_vectors: 1,0.5,2,1 are linearly dependent");
  CHECK_THROWS_WITH(lattice(Tensor<2>{{1.0, 0.0}, {0.0, 0.0}}), Catch::EndsWith("are linearly dependent"));
  CHECK_THROWS_WITH(lattice(Tensor<2>{{1e-9, 1e-9}, {0.0, 1e-16}}), Catch::EndsWith("are linearly dependent"));
  CHECK_NOTHROW(lattice(Tensor<2>{{1e-9, 0.0}, {0.0, 1.0}}));
  CHECK_THROWS_WITH(Lattice<3>(LatticeKind::custom, 1.0), Catch::StartsWith("primitive_vectors: missing"));
  CHECK_THROWS_WITH(lattice_neighbours(lattice(Tensor<2>{{1e-4, 0.0}, {0.0, 1e-4}}), 1.0, NeighbourRule::support),
                    Catch::StartsWith("smoothing_length: the support 1"));
}
