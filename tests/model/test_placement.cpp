// SPDX-License-Identifier: MIT
#include "model/placement.hpp"

#include <catch2/catch.hpp>
#include <numbers>
#include <numeric>

#include "model/errors.hpp"

using namespace sphstab;

namespace {

constexpr double pi = std::numbers::pi;

/// Sums of a few hundred doubles, relative to the sum.
constexpr double rounding = 1e-13;

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

const Lattice<2> square(LatticeKind::square, 0.25);

/// Sites o + Σ n_i a_i within the shape, found by trying all with |n_i| ≤ 40.
int brute_force_count(const Shape<2>& shape, const Lattice<2>& lattice, const Vector<2>& origin) {
  int found = 0;
  for (int i = -40; i <= 40; ++i)
    for (int j = -40; j <= 40; ++j) found += contains<2>(shape, origin + lattice.site({i, j}), 0.0);
  return found;
}

}  // namespace

TEST_CASE("a box of n spacings holds n particles an axis, in the centres of their cells, of its volume", "[fast]") {
  const Box<2> box{{3.0, -1.0}, {3.0 + 7 * 0.25, -1.0 + 4 * 0.25}};
  const auto particles = place_particles<2>({.shape = box}, square);
  REQUIRE(particles.position.size() == 28);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 7; ++i)
      CHECK((particles.position[7 * j + i] - Vector<2>(3.0 + (i + 0.5) * 0.25, -1.0 + (j + 0.5) * 0.25)).norm() <
            rounding);
  CHECK(sum(particles.volume) == Approx(7 * 4 * 0.0625).epsilon(rounding));
  CHECK(particles.layer == 0.25);

  const Lattice<1> chain(LatticeKind::chain, 0.1);  // 0.1 is no double: the count must not depend on rounding
  for (int n = 1; n <= 300; ++n)
    CHECK(place_particles<1>({.shape = Box<1>{Vector<1>(0.0), Vector<1>(n * 0.1)}}, chain).position.size() ==
          static_cast<std::size_t>(n));

  const Lattice<3> cubic(LatticeKind::cubic, 0.5);
  const auto block = place_particles<3>({.shape = Box<3>{{0.0, 0.0, 0.0}, {1.0, 1.5, 2.0}}}, cubic);
  REQUIRE(block.position.size() == 2 * 3 * 4);
  CHECK((block.position[2 * 3 + 2 + 1] - Vector<3>(0.75, 0.75, 0.75)).norm() < rounding);
  CHECK(sum(block.volume) == Approx(3.0).epsilon(rounding));
}

TEST_CASE("with no offset the first particle is in the corner and the last on the far side", "[fast]") {
  const Placement<2> plate{.shape = Box<2>{{0.0, 0.0}, {6 * 0.25, 3 * 0.25}},
                           .arrangement = LatticeArrangement<2>{Vector<2>::Zero()}};
  const auto particles = place_particles<2>(plate, square);
  REQUIRE(particles.position.size() == 28);
  CHECK(particles.position.front() == Vector<2>(0.0, 0.0));
  CHECK(particles.position[7] == Vector<2>(0.0, 0.25));
  CHECK(particles.position.back() == Vector<2>(1.5, 0.75));
}

TEST_CASE("every site of the lattice within the shape has a particle, and no other", "[fast]") {
  const Vector<2> centre(0.3, -0.7);
  for (const auto kind : {LatticeKind::square, LatticeKind::hexagonal, LatticeKind::staggered})
    for (const Shape<2>& shape : {Shape<2>(Ball<2>{centre, 1.9}), Shape<2>(Annulus<2>{centre, 1.1, 2.3})}) {
      INFO(name_of(kind));
      const Lattice<2> lattice(kind, 0.25);
      const auto particles = place_particles<2>({.shape = shape}, lattice);
      CHECK(static_cast<int>(particles.position.size()) ==
            brute_force_count(shape, lattice, centre + Vector<2>(0.125, 0.125)));
      CHECK(sum(particles.volume) ==
            Approx(static_cast<double>(particles.position.size()) * lattice.cell_volume()).epsilon(rounding));
    }
  // A square lattice about the centre of a ball is symmetric: the mean position is the centre.
  Vector<2> mean = Vector<2>::Zero();
  const auto ball = place_particles<2>({.shape = Ball<2>{centre, 1.9}}, square);
  for (const auto& x : ball.position) mean += x / static_cast<double>(ball.position.size());
  CHECK((mean - centre).norm() < rounding);
}

TEST_CASE("what is cut away is missing and nothing else", "[fast]") {
  const Box<2> box{{0.0, 0.0}, {5.0, 5.0}};
  const Ball<2> hole{{2.5, 2.5}, 1.0};
  const Box<2> corner{{0.0, 0.0}, {1.0, 0.5}};
  const auto particles = place_particles<2>({.shape = box, .cut = {hole, corner}}, square);
  const int missing = brute_force_count(hole, square, {2.5 + 0.125, 2.5 + 0.125}) + 4 * 2;
  CHECK(static_cast<int>(particles.position.size()) == 400 - missing);
  for (const auto& x : particles.position) {
    CHECK_FALSE(contains<2>(hole, x, 0.0));
    CHECK_FALSE(contains<2>(corner, x, 0.0));
  }
}

TEST_CASE("rings and sectors have the middle radius, equal angles and the exact area", "[fast]") {
  const Vector<2> centre(1.0, 2.0);
  const auto particles = place_particles<2>(
      {.shape = Annulus<2>{centre, 2.0, 5.0}, .arrangement = PolarArrangement{.rings = 6, .sectors = 12}}, square);
  REQUIRE(particles.position.size() == 72);
  CHECK(particles.layer == 0.5);
  CHECK(sum(particles.volume) == Approx(pi * (25.0 - 4.0)).epsilon(rounding));
  for (int ring = 0; ring < 6; ++ring) {
    const double inner = 2.0 + 0.5 * ring, outer = inner + 0.5;
    for (int sector = 0; sector < 12; ++sector) {
      const int a = 12 * ring + sector;
      const Vector<2> arm = particles.position[a] - centre;
      CHECK(arm.norm() == Approx(inner + 0.25).epsilon(rounding));
      CHECK(std::remainder(std::atan2(arm[1], arm[0]) - pi / 6 * sector, 2 * pi) == Approx(0.0).margin(rounding));
      CHECK(particles.volume[a] == Approx(pi * (outer * outer - inner * inner) / 12).epsilon(rounding));
    }
  }
  const auto disc = place_particles<2>(
      {.shape = Ball<2>{centre, 3.0}, .arrangement = PolarArrangement{.rings = 3, .sectors = 7}}, square);
  CHECK(sum(disc.volume) == Approx(9.0 * pi).epsilon(rounding));
}

TEST_CASE("jitter is uniform within its bounds and the same everywhere", "[fast]") {
  const Lattice<1> chain(LatticeKind::chain, 1.0);
  Placement<1> line{.shape = Box<1>{Vector<1>(0.0), Vector<1>(10000.0)}};
  const auto still = place_particles<1>(line, chain);
  line.jitter = Jitter{.fraction = 0.2, .seed = 5489};
  const auto moved = place_particles<1>(line, chain);
  REQUIRE(moved.position.size() == 10000);
  double mean = 0.0, square_sum = 0.0, largest = 0.0;
  for (int a = 0; a < 10000; ++a) {
    const double shift = moved.position[a][0] - still.position[a][0];
    mean += shift / 10000;
    square_sum += shift * shift / 10000;
    largest = std::max(largest, std::abs(shift));
  }
  // Four standard errors: of the mean 0.2/√3/100, of the variance 0.04/3 with √(4/5)/100 of it.
  CHECK(std::abs(mean) < 4 * 0.2 / std::sqrt(3.0) / 100);
  CHECK(square_sum == Approx(0.04 / 3).epsilon(4 * std::sqrt(0.8) / 100));
  CHECK(largest < 0.2);
  CHECK(largest > 0.1999);
  // The standard says that the 10000th number of this generator from its default seed is 9981545732273789042.
  const double uniform = 9981545732273789042.0 / 18446744073709551616.0;
  CHECK(moved.position[9999][0] - still.position[9999][0] == Approx(0.2 * (2.0 * uniform - 1.0)).margin(1e-11));
  CHECK(place_particles<1>(line, chain).position == moved.position);
  line.jitter->seed = 5490;
  CHECK(place_particles<1>(line, chain).position != moved.position);
  CHECK(moved.volume == still.volume);
}

TEST_CASE("every component of a jittered position moves on its own", "[fast]") {
  Placement<2> plate{.shape = Box<2>{{0.0, 0.0}, {5.0, 5.0}}};
  const auto still = place_particles<2>(plate, square);
  plate.jitter = Jitter{.fraction = 0.4, .seed = 3};
  const auto moved = place_particles<2>(plate, square);
  Vector<2> largest = Vector<2>::Zero();
  double product = 0.0;
  for (std::size_t a = 0; a < moved.position.size(); ++a) {
    const Vector<2> shift = moved.position[a] - still.position[a];
    largest = largest.cwiseMax(shift.cwiseAbs());
    product += shift[0] * shift[1] / 400;
  }
  CHECK(largest.maxCoeff() < 0.1);  // 0.4 of the spacing
  CHECK(largest.minCoeff() > 0.098);
  CHECK(std::abs(product) < 4 * 0.01 / 3 / 20);  // four standard errors of a covariance of 0
}

TEST_CASE("shapes that are none, empty or too large are refused", "[fast]") {
  const auto place = [](const Shape<2>& shape, const Arrangement<2>& arrangement = LatticeArrangement<2>{}) {
    return place_particles<2>({.shape = shape, .arrangement = arrangement}, square);
  };
  const Vector<2> zero = Vector<2>::Zero();
  CHECK_THROWS_WITH(place(Box<2>{{0.0, 1.0}, {1.0, 0.0}}), "shape: box: from 1 to 0 along y is empty");
  CHECK_THROWS_WITH(place(Ball<2>{zero, 0.0}), "shape: ball: radius: 0 is not a positive finite number");
  CHECK_THROWS_WITH(place(Annulus<2>{zero, 1.0, 1.0}), "shape: annulus: outer: 1 is not above inner, 1");
  CHECK_THROWS_WITH(place(Annulus<2>{zero, -0.5, 1.0}), "shape: annulus: inner: -0.5 is not at least 0");
  CHECK_THROWS_WITH(place(Box<2>{zero, {0.1, 5.0}}), "shape: holds no particle");
  CHECK_THROWS_WITH(place(Box<2>{zero, {1e6, 1e6}}),
                    "shape: holds about 1.6e+13 particles, more than the 10000000 that are allowed; a larger spacing "
                    "makes fewer");
  CHECK_THROWS_WITH(place(Ball<2>{zero, 1.0}, PolarArrangement{100000, 100000}),
                    Catch::StartsWith("shape: holds about 1e+10 particles"));
  CHECK_THROWS_WITH(place(Box<2>{zero, {1.0, 1.0}}, PolarArrangement{2, 4}),
                    "arrangement: polar needs a ball or an annulus in 2 dimensions");
  CHECK_THROWS_WITH(
      place_particles<3>({.shape = Ball<3>{Vector<3>::Zero(), 1.0}, .arrangement = PolarArrangement{2, 4}},
                         Lattice<3>(LatticeKind::cubic, 0.25)),
      "arrangement: polar needs a ball or an annulus in 2 dimensions");
  CHECK_THROWS_WITH(place_particles<2>({.shape = Ball<2>{zero, 1.0}, .cut = {Ball<2>{zero, 2.0}}}, square),
                    "shape: holds no particle");
}
