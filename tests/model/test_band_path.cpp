// SPDX-License-Identifier: MIT
#include "model/band_path.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "model/brillouin_zone.hpp"
#include "tests/model/shapes.hpp"

using namespace sphstab;
using std::numbers::pi;
using std::numbers::sqrt3;

namespace {

/// Components of order ten with a few dozen roundings, of vectors that skewed bases make up to 1e4 times longer.
constexpr double rounding = 1e-9;

template <int Dim>
Vector<Dim> point(const Lattice<Dim>& lattice, std::string_view label) {
  for (const auto& p : symmetry_points(lattice))
    if (p.label == label) return p.wave_vector;
  throw std::out_of_range(std::string(label));
}

template <int Dim>
void check_point(const Lattice<Dim>& lattice, std::string_view label, const Vector<Dim>& expected) {
  INFO(label << " at " << point<Dim>(lattice, label).transpose() << ", not " << expected.transpose());
  CHECK((point<Dim>(lattice, label) - expected).norm() < rounding);
}

template <int Dim>
std::string text(const BandPath<Dim>& path) {
  std::string result;
  for (const auto& stretch : path.stretches) {
    result += result.empty() ? "" : "|";
    for (const auto& p : stretch) result += (&p == &stretch.front() ? "" : "-") + p.label;
  }
  return result;
}

template <int Dim>
bool is_reciprocal(const Lattice<Dim>& lattice, const Vector<Dim>& k) {
  const Vector<Dim> coordinates = lattice.primitive_vectors().transpose() * k / (2.0 * pi);
  return (coordinates - coordinates.array().round().matrix()).norm() < rounding * lattice.primitive_vectors().norm();
}

/// Symmetries that take k to an equivalent of itself.
template <int Dim>
std::vector<Tensor<Dim>> little_group(const Lattice<Dim>& lattice, const Vector<Dim>& k) {
  auto group = BrillouinZone<Dim>(lattice).point_group();
  std::erase_if(group, [&](const Tensor<Dim>& R) { return !is_reciprocal<Dim>(lattice, R * k - k); });
  return group;
}

template <int Dim>
void check_all_shapes() {
  std::mt19937 random(11);
  for (const auto& shape : shapes<Dim>()) {
    INFO(shape.name);
    const Lattice<Dim> plain = shape.lattice();
    for (const Lattice<Dim>& lattice :
         {plain, shape.lattice(0.3), Lattice<Dim>(skewed<Dim>(shape.vectors, random), 1.0),
          Lattice<Dim>(rotation<Dim>() * skewed<Dim>(shape.vectors, random), 1.7)}) {
      CHECK(bravais_name(lattice) == shape.name);
      CHECK(text(band_path(lattice)) == text(band_path(plain)));
      const BrillouinZone<Dim> zone(lattice);
      const auto points = symmetry_points(lattice), of_plain = symmetry_points(plain);
      CHECK(points.front().label == "Γ");
      CHECK(points.front().wave_vector.isZero(0.0));
      REQUIRE(points.size() == of_plain.size());
      for (std::size_t i = 0; i < points.size(); ++i) {
        INFO(points[i].label);
        const auto& k = points[i].wave_vector;
        CHECK(points[i].label == of_plain[i].label);
        CHECK(k.norm() * lattice.spacing() == Approx(of_plain[i].wave_vector.norm()).margin(rounding));
        CHECK(little_group<Dim>(lattice, k).size() == little_group<Dim>(plain, of_plain[i].wave_vector).size());
        for (const auto& side : zone.half_spaces())  // a convex zone that has both ends of a line has the line
          CHECK(side.normal.dot(k) <= side.offset * (1.0 + rounding));
      }
    }
  }
}

/// That k lies on as many facets of the zone as meet in a corner or more.
template <int Dim>
bool is_corner(const Lattice<Dim>& lattice, const Vector<Dim>& k) {
  const BrillouinZone<Dim> zone(lattice);
  return std::count_if(zone.half_spaces().begin(), zone.half_spaces().end(), [&](const auto& side) {
           return std::abs(side.normal.dot(k) - side.offset) < rounding * side.offset;
         }) >= Dim;
}

}  // namespace

TEST_CASE("name, labels and path follow from the shape, not from scale, direction or basis", "[fast]") {
  check_all_shapes<1>();
  check_all_shapes<2>();
  check_all_shapes<3>();
}

TEST_CASE("the default paths are those of the convention", "[fast]") {
  const auto path_of = [](auto kind, auto dim) { return text(band_path(Lattice<decltype(dim)::value>(kind, 1.0))); };
  const std::integral_constant<int, 1> line;
  const std::integral_constant<int, 2> plane;
  const std::integral_constant<int, 3> space;
  CHECK(path_of(LatticeKind::chain, line) == "Γ-X");
  CHECK(path_of(LatticeKind::square, plane) == "Γ-X-M-Γ");
  CHECK(path_of(LatticeKind::hexagonal, plane) == "Γ-M-K-Γ");
  CHECK(path_of(LatticeKind::staggered, plane) == "Γ-X-S-X1-Y-Γ");
  CHECK(path_of(LatticeKind::cubic, space) == "Γ-X-M-Γ-R-X|M-R");
  CHECK(path_of(LatticeKind::bcc, space) == "Γ-H-N-Γ-P-H|P-N");
  CHECK(path_of(LatticeKind::fcc, space) == "Γ-X-W-K-Γ-L-U-W-L-K|U-X");
  for (const auto& shape : shapes<2>()) {
    if (shape.name == "rectangular") CHECK(text(band_path(shape.lattice())) == "Γ-X-S-Y-Γ");
    if (shape.name == "oblique") CHECK(text(band_path(shape.lattice())) == "Γ-Y-H-C-H1-X-Γ");
  }
  for (const auto& shape : shapes<3>()) {
    const std::string path = text(band_path(shape.lattice()));
    if (shape.name == "simple tetragonal") CHECK(path == "Γ-X-M-Γ-Z-R-A-Z|X-R|M-A");
    if (shape.name == "simple orthorhombic") CHECK(path == "Γ-X-S-Y-Γ-Z-U-R-T-Z|Y-T|U-X|S-R");
    if (shape.name == "hexagonal") CHECK(path == "Γ-M-K-Γ-A-L-H-A|L-M|K-H");
    if (shape.name == "triclinic") CHECK(path == "X-Γ-Y|L-Γ-Z|N-Γ-M|R-Γ");
  }
}

TEST_CASE("points in the plane lie where textbooks draw them, towards +x", "[fast]") {
  check_point<1>(Lattice<1>(LatticeKind::chain, 0.5), "X", Vector<1>(2.0 * pi));
  const Lattice<2> square(LatticeKind::square, 0.5);
  check_point<2>(square, "X", {2.0 * pi, 0.0});
  check_point<2>(square, "M", {2.0 * pi, 2.0 * pi});
  const Lattice<2> hexagonal(LatticeKind::hexagonal, 1.0);
  check_point<2>(hexagonal, "K", {4.0 * pi / 3.0, 0.0});
  check_point<2>(hexagonal, "M", {pi, pi / sqrt3});
  const Lattice<2> rectangular(Tensor<2>{{1.0, 0.0}, {0.0, 2.0}}, 1.0);
  check_point<2>(rectangular, "X", {pi, 0.0});
  check_point<2>(rectangular, "S", {pi, 0.5 * pi});
  check_point<2>(rectangular, "Y", {0.0, 0.5 * pi});
}

TEST_CASE("points in space have the coordinates of the literature in units of 2 pi over the cube's edge", "[fast]") {
  const Lattice<3> cubic(LatticeKind::cubic, 1.0);
  check_point<3>(cubic, "X", {0.0, pi, 0.0});
  check_point<3>(cubic, "M", {pi, pi, 0.0});
  check_point<3>(cubic, "R", {pi, pi, pi});
  const Lattice<3> bcc(LatticeKind::bcc, 0.5 * sqrt3);
  check_point<3>(bcc, "H", 2.0 * pi * Vector<3>(0.0, 1.0, 0.0));
  check_point<3>(bcc, "P", 2.0 * pi * Vector<3>(0.5, 0.5, 0.5));
  check_point<3>(bcc, "N", 2.0 * pi * Vector<3>(0.5, 0.5, 0.0));
  const Lattice<3> fcc(LatticeKind::fcc, 1.0 / std::numbers::sqrt2);
  check_point<3>(fcc, "X", 2.0 * pi * Vector<3>(0.0, 1.0, 0.0));
  check_point<3>(fcc, "L", 2.0 * pi * Vector<3>(0.5, 0.5, 0.5));
  check_point<3>(fcc, "W", 2.0 * pi * Vector<3>(0.5, 1.0, 0.0));
  check_point<3>(fcc, "K", 2.0 * pi * Vector<3>(0.75, 0.75, 0.0));
  check_point<3>(fcc, "U", 2.0 * pi * Vector<3>(0.25, 1.0, 0.25));
  const Lattice<3> tetragonal(Vector<3>(1.0, 1.0, 1.3).asDiagonal().toDenseMatrix(), 1.0);
  check_point<3>(tetragonal, "X", {0.0, pi, 0.0});
  check_point<3>(tetragonal, "R", {0.0, pi, pi / 1.3});
  check_point<3>(tetragonal, "A", {pi, pi, pi / 1.3});
  const Lattice<3> orthorhombic(Vector<3>(1.0, 1.2, 1.5).asDiagonal().toDenseMatrix(), 1.0);
  check_point<3>(orthorhombic, "S", {pi, pi / 1.2, 0.0});
  check_point<3>(orthorhombic, "T", {0.0, pi / 1.2, pi / 1.5});
  check_point<3>(orthorhombic, "U", {pi, 0.0, pi / 1.5});
}

TEST_CASE("the halves of reciprocal vectors are their own opposites", "[fast]") {
  const auto check = [](const auto& lattice, std::string_view labels) {
    for (const auto& p : symmetry_points(lattice))
      if (labels.find(p.label) != std::string_view::npos) {
        INFO(bravais_name(lattice) << " " << p.label);
        CHECK_FALSE(is_reciprocal(lattice, p.wave_vector));
        CHECK(is_reciprocal(lattice, (2.0 * p.wave_vector).eval()));
      }
  };
  for (const auto& shape : shapes<2>()) {
    const bool centred = shape.name == "centred rectangular", oblique = shape.name == "oblique";
    check(shape.lattice(), centred ? "SY" : oblique ? "XYC" : shape.name == "hexagonal" ? "M" : "XMSY");
  }
  for (const auto& shape : shapes<3>())
    check(shape.lattice(), shape.name == "hexagonal"            ? "AML"
                           : shape.name == "face-centred cubic" ? "XL"
                           : shape.name == "body-centred cubic" ? "HN"
                                                                : "XYZLMNRASTU");
}

TEST_CASE("each corner point is a corner of the zone", "[fast]") {
  for (const auto& shape : shapes<2>()) {
    const Lattice<2> lattice = shape.lattice();
    for (const auto& p : symmetry_points(lattice)) {
      INFO(shape.name << " " << p.label);
      const bool centred = shape.name == "centred rectangular", oblique = shape.name == "oblique";
      const bool corner = centred ? p.label[0] == 'X' : oblique ? p.label[0] == 'H' : p.label.find_first_of("MSK") == 0;
      CHECK(is_corner<2>(lattice, p.wave_vector) == (corner && !(shape.name == "hexagonal" && p.label == "M")));
    }
  }
  const auto corner = [](LatticeKind kind, std::string_view label) {
    const Lattice<3> lattice(kind, 1.0);
    return is_corner<3>(lattice, point<3>(lattice, label));
  };
  CHECK(corner(LatticeKind::cubic, "R"));
  CHECK(corner(LatticeKind::bcc, "H"));
  CHECK(corner(LatticeKind::bcc, "P"));
  CHECK(corner(LatticeKind::fcc, "W"));
  for (const auto label : {"K", "L", "U", "X"}) CHECK_FALSE(corner(LatticeKind::fcc, label));
}

TEST_CASE("points have the symmetries of their little groups", "[fast]") {
  const auto order = [](const auto& lattice, std::string_view label) {
    return little_group(lattice, point(lattice, label)).size();
  };
  const Lattice<2> hexagonal(LatticeKind::hexagonal, 1.0);
  CHECK(order(hexagonal, "K") == 6);  // 3m
  CHECK(order(hexagonal, "M") == 4);  // 2mm
  const Lattice<3> fcc(LatticeKind::fcc, 1.0), bcc(LatticeKind::bcc, 1.0);
  CHECK(order(fcc, "X") == 16);  // 4/mmm
  CHECK(order(fcc, "L") == 12);  // -3m
  CHECK(order(fcc, "W") == 8);   // -42m
  CHECK(order(fcc, "K") == 4);   // 2mm
  CHECK(order(fcc, "U") == 4);
  CHECK(order(bcc, "H") == 48);  // m-3m
  CHECK(order(bcc, "P") == 24);  // -43m
  CHECK(order(bcc, "N") == 8);   // mmm
}

TEST_CASE("a path is read from its labels", "[fast]") {
  const Lattice<3> cubic(LatticeKind::cubic, 1.0);
  const auto path = band_path(cubic, "G-X|M-R-Γ");
  REQUIRE(path.stretches.size() == 2);
  CHECK(text(path) == "Γ-X|M-R-Γ");
  CHECK(path.stretches[0][0].wave_vector.isZero(0.0));
  CHECK(path.stretches[1][1].wave_vector == point<3>(cubic, "R"));
}

TEST_CASE("labels that the lattice does not have and paths of one point are refused", "[fast]") {
  const Lattice<2> square(LatticeKind::square, 1.0);
  CHECK_THROWS_WITH(band_path(square, "G-Q"), "path: 'Q' is no point of the square lattice, which has Γ, X, M");
  CHECK_THROWS_WITH(band_path(square, ""), Catch::StartsWith("path: '' is no point"));
  CHECK_THROWS_WITH(band_path(square, "G-X|"), Catch::StartsWith("path: '' is no point"));
  CHECK_THROWS_WITH(band_path(square, "G-X|M"), "path: 'M' is a single point");
  CHECK_THROWS_WITH(band_path(square, "G-X-X"), "path: 'G-X-X' joins X to itself");
}
