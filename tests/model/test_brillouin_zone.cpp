// SPDX-License-Identifier: MIT
#include "model/brillouin_zone.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>

#include "model/lattice_index.hpp"
#include "model/lattice_reduction.hpp"
#include "tests/model/shapes.hpp"

using namespace sphstab;
using std::numbers::pi;

namespace {

/// Components of order ten with a few dozen roundings, in skewed bases a thousand times as many.
constexpr double rounding = 1e-10;
/// Rounding of random whole-number bases, which are up to 1e4 long, relative to their reduced vectors.
constexpr double rounding_of_skewed = 1e-9;

/// Corners on the plane of a side, in 3D in the order in which they go round it.
template <int Dim>
std::vector<Vector<Dim>> corners_on(const HalfSpace<Dim>& side, const std::vector<Vector<Dim>>& vertices) {
  std::vector<Vector<Dim>> corners;
  Vector<Dim> centre = Vector<Dim>::Zero();
  for (const auto& v : vertices)
    if (std::abs(side.normal.dot(v) - side.offset) < rounding * side.normal.norm()) corners.push_back(v), centre += v;
  if constexpr (Dim == 3) {
    centre /= static_cast<double>(corners.size());
    const Vector<3> x = (corners.front() - centre).normalized(), y = side.normal.normalized().cross(x);
    const auto angle = [&](const Vector<3>& v) { return std::atan2(y.dot(v - centre), x.dot(v - centre)); };
    std::sort(corners.begin(), corners.end(), [&](const auto& a, const auto& b) { return angle(a) < angle(b); });
  }
  return corners;
}

double area(const std::vector<Vector<1>>&) { return 1.0; }
double area(const std::vector<Vector<2>>& side) { return (side.at(1) - side.at(0)).norm(); }
double area(const std::vector<Vector<3>>& polygon) {
  double sum = 0.0;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    sum += 0.5 * (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]).norm();
  return sum;
}

/// Volume of a polytope that touches 0 as the sum of its pyramids over the sides: area times height over Dim.
template <int Dim>
double volume(const IrreducibleWedge<Dim>& wedge) {
  double sum = 0.0;
  for (const auto& side : wedge.half_spaces())
    sum += side.offset / side.normal.norm() * area(corners_on<Dim>(side, wedge.vertices())) / Dim;
  return sum;
}

template <int Dim>
std::vector<Vector<Dim>> random_wave_vectors(const Lattice<Dim>& lattice, int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-3.0, 3.0);
  std::vector<Vector<Dim>> points;
  for (int i = 0; i < count; ++i) {
    Vector<Dim> fraction;
    for (double& component : fraction) component = coordinate(random);
    points.push_back(lattice.reciprocal_vectors() * fraction);
  }
  return points;
}

/// k at whole and half and third reciprocal coordinates, many of them on the boundary of the zone.
template <int Dim>
std::vector<Vector<Dim>> special_wave_vectors(const Lattice<Dim>& lattice) {
  std::vector<Vector<Dim>> points;
  const LatticeIndex<Dim> reach = LatticeIndex<Dim>::Constant(6);
  for_each_index<Dim>(-reach, reach, [&](const auto& n) {
    points.push_back(lattice.reciprocal_vectors() * n.template cast<double>() / 6.0);
  });
  return points;
}

template <int Dim, class Visit>
void for_each_shape(const Visit& visit) {
  for (const auto& shape : shapes<Dim>()) {
    INFO(shape.name);
    visit(shape, shape.lattice(0.8));
    std::mt19937 random(3);
    visit(shape, Lattice<Dim>(rotation<Dim>() * skewed<Dim>(shape.vectors, random), 1.3));
  }
}

template <int Dim>
void check_group(const Shape<Dim>& shape, const Lattice<Dim>& lattice) {
  const auto group = BrillouinZone<Dim>(lattice).point_group();
  const auto contains = [&](const Tensor<Dim>& wanted) {
    return std::count_if(group.begin(), group.end(), [&](const auto& R) { return (R - wanted).norm() < rounding; });
  };
  CHECK(static_cast<int>(group.size()) == shape.symmetries);
  CHECK(contains(Tensor<Dim>::Identity()) == 1);
  CHECK(contains(-Tensor<Dim>::Identity()) == 1);
  for (const auto& R : group) {
    CHECK((R.transpose() * R - Tensor<Dim>::Identity()).norm() < rounding);
    CHECK(contains(R.transpose()) == 1);
    CHECK(std::all_of(group.begin(), group.end(), [&](const auto& S) { return contains(R * S) == 1; }));
    const Tensor<Dim> basis = reduced_basis<Dim>(lattice.primitive_vectors());
    const Tensor<Dim> coordinates = basis.inverse() * R * basis;
    CHECK((coordinates - coordinates.array().round().matrix()).norm() < rounding_of_skewed);
  }
}

template <int Dim>
void check_zone(const Shape<Dim>& shape, const Lattice<Dim>& lattice) {
  const BrillouinZone<Dim> zone(lattice);
  CHECK(static_cast<int>(zone.half_spaces().size()) == shape.facets);
  const double expected = std::pow(2.0 * pi, Dim) / lattice.cell_volume();
  const IrreducibleWedge<Dim> whole(zone, {Tensor<Dim>::Identity()});
  CHECK(static_cast<int>(whole.half_spaces().size()) == shape.facets);
  CHECK(volume(whole) == Approx(expected).epsilon(rounding));
  const IrreducibleWedge<Dim> wedge(zone, zone.point_group());
  CHECK(volume(wedge) == Approx(expected / shape.symmetries).epsilon(rounding));
}

template <int Dim>
void check_first_zone(const Shape<Dim>&, const Lattice<Dim>& lattice) {
  constexpr int twice_as_wide = 2 * reduced_reach;
  const BrillouinZone<Dim> zone(lattice);
  const Tensor<Dim> reciprocal = reduced_basis<Dim>(lattice.reciprocal_vectors());
  const LatticeIndex<Dim> reach = LatticeIndex<Dim>::Constant(twice_as_wide);
  auto points = random_wave_vectors<Dim>(lattice, 20);
  const auto special = special_wave_vectors<Dim>(lattice);
  points.insert(points.end(), special.begin(), special.end());
  for (const auto& k : points) {
    const Vector<Dim> found = zone.in_first_zone(k);
    const Vector<Dim> shift = reciprocal.inverse() * (found - k);
    CHECK((shift - shift.array().round().matrix()).norm() < rounding_of_skewed);
    double preference =
        0.0;  // of any other: how much shorter, or else how much larger its first component that differs
    for_each_index<Dim>(-reach, reach, [&](const auto& n) {
      const Vector<Dim> other = found + reciprocal * n.template cast<double>();
      double better = found.norm() - other.norm();
      for (int axis = 0; axis < Dim && std::abs(better) < rounding_of_skewed; ++axis)
        better = other[axis] - found[axis];
      preference = std::max(preference, better);
    });
    CHECK(preference < rounding_of_skewed);
  }
}

template <int Dim>
void check_wedge(const Shape<Dim>&, const Lattice<Dim>& lattice) {
  const BrillouinZone<Dim> zone(lattice);
  const IrreducibleWedge<Dim> wedge(zone, zone.point_group());
  const auto outside = [&](const Vector<Dim>& k) {
    double distance = 0.0;
    for (const auto& side : wedge.half_spaces())
      distance = std::max(distance, (side.normal.dot(k) - side.offset) / side.normal.norm());
    return distance;
  };
  auto points = random_wave_vectors<Dim>(lattice, 10);
  const auto special = special_wave_vectors<Dim>(lattice);
  for (std::size_t i = 0; i < special.size(); i += Dim == 3 ? 50 : 3) points.push_back(special[i]);
  for (const auto& vertex : wedge.vertices()) points.push_back(vertex);
  for (const auto& k : points) {
    const Vector<Dim> found = wedge.in_wedge(k);
    CHECK(outside(found) < rounding_of_skewed);
    CHECK((wedge.in_wedge(found) - found).norm() < rounding_of_skewed);
    for (const auto& R : wedge.group())
      for (const auto& b : lattice.reciprocal_vectors().colwise()) {
        const Vector<Dim> equivalent = R * k - b;
        CHECK((wedge.in_wedge(equivalent) - found).norm() < rounding_of_skewed);
      }
  }
}

template <int Dim>
bool has_vertex(const IrreducibleWedge<Dim>& wedge, const Vector<Dim>& k) {
  return std::any_of(wedge.vertices().begin(), wedge.vertices().end(),
                     [&](const auto& vertex) { return (vertex - k).norm() < rounding; });
}

template <int Dim>
IrreducibleWedge<Dim> whole_wedge(LatticeKind kind) {
  const BrillouinZone<Dim> zone(Lattice<Dim>(kind, 1.0));
  return IrreducibleWedge<Dim>(zone, zone.point_group());
}

}  // namespace

TEST_CASE("the point group of a lattice is a group of the order that crystallography gives", "[fast]") {
  for_each_shape<1>(check_group<1>);
  for_each_shape<2>(check_group<2>);
  for_each_shape<3>(check_group<3>);
}

TEST_CASE("zone and wedge have the right facets and fill the volume of a reciprocal cell", "[fast]") {
  for_each_shape<1>(check_zone<1>);
  for_each_shape<2>(check_zone<2>);
  for_each_shape<3>(check_zone<3>);
}

TEST_CASE("the representative in the zone is the shortest, then the one largest in the first component", "[fast]") {
  for_each_shape<1>(check_first_zone<1>);
  for_each_shape<2>(check_first_zone<2>);
  for_each_shape<3>(check_first_zone<3>);
}

TEST_CASE("every wave vector has one equivalent in the wedge, whatever shift or symmetry it comes by", "[fast]") {
  for_each_shape<1>(check_wedge<1>);
  for_each_shape<2>(check_wedge<2>);
  for_each_shape<3>(check_wedge<3>);
}

TEST_CASE("wedges have the corners of the literature", "[fast]") {
  const auto chain = whole_wedge<1>(LatticeKind::chain);
  CHECK(chain.vertices().size() == 2);
  CHECK(has_vertex<1>(chain, Vector<1>(pi)));

  const auto square = whole_wedge<2>(LatticeKind::square);
  CHECK(square.vertices().size() == 3);
  for (const Vector<2>& k : {Vector<2>(0.0, 0.0), Vector<2>(pi, 0.0), Vector<2>(pi, pi)})
    CHECK(has_vertex<2>(square, k));

  const auto hexagonal = whole_wedge<2>(LatticeKind::hexagonal);
  CHECK(hexagonal.vertices().size() == 3);
  CHECK(has_vertex<2>(hexagonal, {4.0 * pi / 3.0, 0.0}));
  CHECK(has_vertex<2>(hexagonal, {pi, pi / std::numbers::sqrt3}));

  const auto cubic = whole_wedge<3>(LatticeKind::cubic);
  CHECK(cubic.vertices().size() == 4);
  for (const Vector<3>& k : {Vector<3>(pi, 0.0, 0.0), Vector<3>(pi, pi, 0.0), Vector<3>(pi, pi, pi)})
    CHECK(has_vertex<3>(cubic, k));

  const double of_fcc = 2.0 * pi / std::numbers::sqrt2;  // 2π over the edge of the conventional cube
  const auto fcc = whole_wedge<3>(LatticeKind::fcc);
  CHECK(fcc.vertices().size() == 6);  // Γ, X, W, U, K, L
  for (const Vector<3>& k : {Vector<3>(1.0, 0.0, 0.0), Vector<3>(1.0, 0.5, 0.0), Vector<3>(0.75, 0.75, 0.0),
                             Vector<3>(0.5, 0.5, 0.5), Vector<3>(1.0, 0.25, 0.25)})
    CHECK(has_vertex<3>(fcc, of_fcc * k));

  const double of_bcc = pi * std::numbers::sqrt3;
  const auto bcc = whole_wedge<3>(LatticeKind::bcc);
  CHECK(bcc.vertices().size() == 4);  // Γ, H, N, P
  for (const Vector<3>& k : {Vector<3>(1.0, 0.0, 0.0), Vector<3>(0.5, 0.5, 0.0), Vector<3>(0.5, 0.5, 0.5)})
    CHECK(has_vertex<3>(bcc, of_bcc * k));
}

TEST_CASE("a smaller group leaves a larger wedge", "[fast]") {
  const BrillouinZone<2> square(Lattice<2>(LatticeKind::square, 1.0));
  const Tensor<2> mirror{{1.0, 0.0}, {0.0, -1.0}}, quarter{{0.0, -1.0}, {1.0, 0.0}}, half = -Tensor<2>::Identity();
  const Tensor<2> identity = Tensor<2>::Identity();
  const double zone = 4.0 * pi * pi;
  CHECK(volume(IrreducibleWedge<2>(square, {identity, half})) == Approx(zone / 2.0).epsilon(rounding));
  CHECK(volume(IrreducibleWedge<2>(square, {identity, half, mirror, -mirror})) == Approx(zone / 4.0).epsilon(rounding));
  CHECK(volume(IrreducibleWedge<2>(square, {identity, quarter, half, -quarter})) ==
        Approx(zone / 4.0).epsilon(rounding));
}
