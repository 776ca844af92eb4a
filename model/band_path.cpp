// SPDX-License-Identifier: MIT
#include "model/band_path.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

#include "model/brillouin_zone.hpp"
#include "model/lattice_index.hpp"
#include "model/lattice_reduction.hpp"
#include "model/names.hpp"

namespace sphstab {
namespace {

/// What the convention says about one kind of lattice, laid on a given one.
template <int Dim>
struct Convention {
  std::string_view name;
  std::string_view path;
  /// The columns to whose reciprocal vectors the coordinates of the points refer.
  Tensor<Dim> primitive;
  std::vector<SymmetryPoint<Dim>> points;  ///< coordinates, without Γ
};

template <int Dim>
Tensor<Dim> reciprocal_of(const Tensor<Dim>& vectors) {
  return 2.0 * std::numbers::pi * vectors.inverse().transpose();
}

/// One of each pair ±v of shortest lattice vectors along the two-fold axes of the lattice, the shortest first. A half
/// turn about v (in 2D the reflection that keeps v) takes a to 2 (v·a)/|v|² v − a, which is a lattice vector if and
/// only if 2 v·a / |v|² is whole, v being no multiple of another one.
template <int Dim>
std::vector<Vector<Dim>> twofold_axes(const Tensor<Dim>& basis) {
  std::vector<Vector<Dim>> axes;
  const LatticeIndex<Dim> reach = LatticeIndex<Dim>::Constant(reduced_reach);
  for_each_index<Dim>(-reach, reach, [&](const LatticeIndex<Dim>& n) {
    const bool multiple = n.unaryExpr([](int component) { return component % 2; }).isZero();
    if (multiple || !in_upper_half<Dim>(n)) return;
    const Vector<Dim> v = basis * n.template cast<double>();
    for (const auto& a : basis.colwise()) {
      const double turns = 2.0 * v.dot(a) / v.squaredNorm();
      if (!(std::abs(turns - std::round(turns)) <= 2.0 * shape_tolerance * a.norm() / v.norm())) return;
    }
    axes.push_back(v);
  });
  std::sort(axes.begin(), axes.end(), [](const auto& left, const auto& right) { return left.norm() < right.norm(); });
  return axes;
}

template <int Dim>
bool perpendicular(const Vector<Dim>& left, const Vector<Dim>& right) {
  return std::abs(left.dot(right)) <= shape_tolerance * left.norm() * right.norm();
}

bool same_length(const Vector<3>& left, const Vector<3>& right) {
  return std::abs(left.norm() - right.norm()) <= shape_tolerance * left.norm();
}

/// The axes that are perpendicular to exactly `others` of the axes.
template <int Dim>
std::vector<Vector<Dim>> perpendicular_to(const std::vector<Vector<Dim>>& axes, std::ptrdiff_t others) {
  std::vector<Vector<Dim>> found;
  std::copy_if(axes.begin(), axes.end(), std::back_inserter(found), [&](const Vector<Dim>& v) {
    return std::count_if(axes.begin(), axes.end(), [&](const auto& axis) { return perpendicular<Dim>(v, axis); }) ==
           others;
  });
  return found;
}

/// The shortest axis and, of the others in its plane, the one perpendicular to it.
template <int Dim>
Eigen::Matrix<double, Dim, 2> rectangle(const std::vector<Vector<Dim>>& axes) {
  const auto cosine = [&](const Vector<Dim>& axis) { return std::abs(axis.dot(axes.front())) / axis.norm(); };
  Eigen::Matrix<double, Dim, 2> sides;
  sides.col(0) = axes.front();
  sides.col(1) = *std::min_element(axes.begin(), axes.end(), [&](const Vector<Dim>& left, const Vector<Dim>& right) {
    return cosine(left) < cosine(right);
  });
  return sides;
}

/// Lattice points of a conventional cell.
template <int Dim>
long points_of(const Tensor<Dim>& cell, const Tensor<Dim>& basis) {
  return std::lround(std::abs(cell.determinant() / basis.determinant()));
}

Convention<1> convention(const Tensor<1>& basis) { return {"chain", "Γ-X", basis, {{"X", Vector<1>(0.5)}}}; }

/// MCL: b ≤ c with an acute angle between them.
Convention<2> oblique(Tensor<2> basis) {
  if (basis.col(0).norm() > basis.col(1).norm()) basis.col(0).swap(basis.col(1));
  if (basis.col(0).dot(basis.col(1)) < 0.0) basis.col(1) *= -1.0;
  const double b = basis.col(0).norm(), c = basis.col(1).norm(), cosine = basis.col(0).dot(basis.col(1)) / (b * c);
  const double eta = (1.0 - b * cosine / c) / (2.0 * (1.0 - cosine * cosine));
  const double nu = 0.5 - eta * c * cosine / b;
  return {"oblique",
          "Γ-Y-H-C-H1-X-Γ",
          basis,
          {{"X", {0.5, 0.0}}, {"Y", {0.0, 0.5}}, {"C", {0.5, 0.5}}, {"H", {eta, 1.0 - nu}}, {"H1", {1.0 - eta, nu}}}};
}

Convention<2> convention(const Tensor<2>& basis) {
  const auto axes = twofold_axes<2>(basis);
  if (axes.size() < 2) return oblique(basis);
  const Tensor<2> cell = rectangle<2>(axes);
  const Tensor<2> centred = cell * Tensor<2>{{0.5, 0.5}, {-0.5, 0.5}};
  if (axes.size() == 4) return {"square", "Γ-X-M-Γ", cell, {{"X", {0.5, 0.0}}, {"M", {0.5, 0.5}}}};
  if (axes.size() == 6) return {"hexagonal", "Γ-M-K-Γ", centred, {{"M", {0.5, 0.0}}, {"K", {1.0 / 3.0, 1.0 / 3.0}}}};
  if (points_of<2>(cell, basis) == 1)
    return {"rectangular", "Γ-X-S-Y-Γ", cell, {{"X", {0.5, 0.0}}, {"S", {0.5, 0.5}}, {"Y", {0.0, 0.5}}}};
  const double zeta = 0.25 * (1.0 + cell.col(0).squaredNorm() / cell.col(1).squaredNorm());
  return {"centred rectangular",
          "Γ-X-S-X1-Y-Γ",
          centred,
          {{"X", {zeta, zeta}}, {"S", {0.0, 0.5}}, {"X1", {-zeta, 1.0 - zeta}}, {"Y", {-0.5, 0.5}}}};
}

Convention<3> cubic(const Tensor<3>& cell, const Tensor<3>& basis) {
  const Tensor<3> body_centred{{-0.5, 0.5, 0.5}, {0.5, -0.5, 0.5}, {0.5, 0.5, -0.5}};
  const Tensor<3> face_centred{{0.0, 0.5, 0.5}, {0.5, 0.0, 0.5}, {0.5, 0.5, 0.0}};
  if (points_of<3>(cell, basis) == 1)
    return {"simple cubic",
            "Γ-X-M-Γ-R-X|M-R",
            cell,
            {{"M", {0.5, 0.5, 0.0}}, {"R", {0.5, 0.5, 0.5}}, {"X", {0.0, 0.5, 0.0}}}};
  if (points_of<3>(cell, basis) == 2)
    return {"body-centred cubic",
            "Γ-H-N-Γ-P-H|P-N",
            cell * body_centred,
            {{"H", {0.5, -0.5, 0.5}}, {"P", {0.25, 0.25, 0.25}}, {"N", {0.0, 0.0, 0.5}}}};
  return {"face-centred cubic",
          "Γ-X-W-K-Γ-L-U-W-L-K|U-X",
          cell * face_centred,
          {{"K", {0.375, 0.375, 0.75}},
           {"L", {0.5, 0.5, 0.5}},
           {"U", {0.625, 0.25, 0.625}},
           {"W", {0.5, 0.25, 0.75}},
           {"X", {0.5, 0.0, 0.5}}}};
}

Convention<3> tetragonal(const Tensor<3>& cell) {
  return {"simple tetragonal",
          "Γ-X-M-Γ-Z-R-A-Z|X-R|M-A",
          cell,
          {{"A", {0.5, 0.5, 0.5}},
           {"M", {0.5, 0.5, 0.0}},
           {"R", {0.0, 0.5, 0.5}},
           {"X", {0.0, 0.5, 0.0}},
           {"Z", {0.0, 0.0, 0.5}}}};
}

Convention<3> orthorhombic(const Tensor<3>& cell) {
  return {"simple orthorhombic",
          "Γ-X-S-Y-Γ-Z-U-R-T-Z|Y-T|U-X|S-R",
          cell,
          {{"R", {0.5, 0.5, 0.5}},
           {"S", {0.5, 0.5, 0.0}},
           {"T", {0.0, 0.5, 0.5}},
           {"U", {0.5, 0.0, 0.5}},
           {"X", {0.5, 0.0, 0.0}},
           {"Y", {0.0, 0.5, 0.0}},
           {"Z", {0.0, 0.0, 0.5}}}};
}

Convention<3> hexagonal(const Tensor<3>& cell) {
  const Tensor<3> centred{{0.5, 0.5, 0.0}, {-0.5, 0.5, 0.0}, {0.0, 0.0, 1.0}};
  return {"hexagonal",
          "Γ-M-K-Γ-A-L-H-A|L-M|K-H",
          cell * centred,
          {{"A", {0.0, 0.0, 0.5}},
           {"H", {1.0 / 3.0, 1.0 / 3.0, 0.5}},
           {"K", {1.0 / 3.0, 1.0 / 3.0, 0.0}},
           {"L", {0.5, 0.0, 0.5}},
           {"M", {0.5, 0.0, 0.0}}}};
}

/// The points of TRI at the seven halves of reciprocal vectors, numbered so that adding is the exclusive or of numbers.
/// Of all ways to choose X, Y and Z the one that makes X, Y, Z, L, M, N, R in turn the shortest, whatever the basis; of
/// equivalent halves the one inside the zone, so that the lines from Γ stay there.
Convention<3> halves(std::string_view name, const Lattice<3>& lattice) {
  const BrillouinZone<3> zone(lattice);
  const Tensor<3>& reciprocal = lattice.reciprocal_vectors();
  std::array<Vector<3>, 8> half;
  for (unsigned i = 1; i < 8; ++i)
    half[i] = zone.in_first_zone(reciprocal * Vector<3>(i & 1u, i >> 1 & 1u, i >> 2) / 2.0);
  using Labelled = std::array<unsigned, 7>;
  const auto longer = [&](const Labelled& left, const Labelled& right) {
    std::size_t i = 0;
    while (i < 6 && same_length(half[left[i]], half[right[i]])) ++i;
    return half[left[i]].norm() > half[right[i]].norm();
  };
  Labelled best{1, 2, 4, 3, 6, 5, 7};
  for (unsigned x = 1; x < 8; ++x)
    for (unsigned y = 1; y < 8; ++y)
      for (unsigned z = 1; z < 8; ++z) {
        const Labelled candidate{x, y, z, x ^ y, y ^ z, x ^ z, x ^ y ^ z};
        const bool independent = std::find(candidate.begin(), candidate.end(), 0u) == candidate.end();
        if (independent && longer(best, candidate)) best = candidate;
      }
  Convention<3> result{name, "X-Γ-Y|L-Γ-Z|N-Γ-M|R-Γ", lattice.primitive_vectors(), {}};
  for (std::size_t i = 0; i < best.size(); ++i)
    result.points.push_back({std::string(1, "XYZLMNR"[i]), reciprocal.inverse() * half[best[i]]});
  return result;
}

/// The axes that a 3D lattice has: cubic 9, hexagonal 7, tetragonal 5, orthorhombic and rhombohedral 3, monoclinic 1.
Convention<3> convention(const Lattice<3>& lattice) {
  const auto basis = reduced_basis<3>(lattice.primitive_vectors());
  const auto axes = twofold_axes<3>(basis);
  const auto main_axes = perpendicular_to<3>(axes, axes.size() == 7 ? 6 : 4);
  if (axes.size() == 9 && main_axes.size() == 3)
    return cubic((Tensor<3>() << main_axes[0], main_axes[1], main_axes[2]).finished(), basis);
  if ((axes.size() == 7 || axes.size() == 5) && main_axes.size() == 1) {
    auto across = axes;
    std::erase(across, main_axes[0]);
    const Tensor<3> cell = (Tensor<3>() << rectangle<3>(across), main_axes[0]).finished();
    if (axes.size() == 7) return hexagonal(cell);
    return points_of<3>(cell, basis) == 1 ? tetragonal(cell) : halves("body-centred tetragonal", lattice);
  }
  if (axes.size() == 3) {
    if (perpendicular_to<3>(axes, 2).size() != 3) return halves("rhombohedral", lattice);
    const Tensor<3> cell = (Tensor<3>() << axes[0], axes[1], axes[2]).finished();
    return points_of<3>(cell, basis) == 1 ? orthorhombic(cell) : halves("centred orthorhombic", lattice);
  }
  return halves(axes.size() == 1 ? "monoclinic" : "triclinic", lattice);
}

template <int Dim>
Convention<Dim> convention(const Lattice<Dim>& lattice) {
  return convention(reduced_basis<Dim>(lattice.primitive_vectors()));
}

/// The direction towards which the points lie: see symmetry_points.
template <int Dim>
Vector<Dim> side_of_points() {
  using std::numbers::inv_pi;
  if constexpr (Dim == 1) return Vector<1>(1.0);
  if constexpr (Dim == 2) return {1.0, inv_pi};
  if constexpr (Dim == 3) return {inv_pi, 1.0, inv_pi * inv_pi};
}

/// The element of the point group that takes `sum` farthest along the direction.
template <int Dim>
Tensor<Dim> towards_side(const Lattice<Dim>& lattice, const Vector<Dim>& sum) {
  const BrillouinZone<Dim> zone(lattice);
  const auto along = [&](const Tensor<Dim>& element) { return (element * sum).dot(side_of_points<Dim>()); };
  return *std::max_element(zone.point_group().begin(), zone.point_group().end(),
                           [&](const auto& left, const auto& right) { return along(left) < along(right); });
}

template <int Dim>
SymmetryPoint<Dim> find_point(const Lattice<Dim>& lattice, const std::vector<SymmetryPoint<Dim>>& points,
                              std::string_view label) {
  const auto found = std::find_if(points.begin(), points.end(), [&](const auto& point) {
    return point.label == label || (label == "G" && point.label == "Γ");
  });
  if (found != points.end()) return *found;
  std::vector<std::string_view> labels;
  for (const auto& point : points) labels.push_back(point.label);
  throw InvalidInput(fmt::format("path: '{}' is no point of the {} lattice, which has {}", label, bravais_name(lattice),
                                 fmt::join(labels, ", ")));
}

}  // namespace

template <int Dim>
std::string_view bravais_name(const Lattice<Dim>& lattice) {
  return convention(lattice).name;
}

template <int Dim>
std::vector<SymmetryPoint<Dim>> symmetry_points(const Lattice<Dim>& lattice) {
  auto [name, path, primitive, points] = convention(lattice);
  const Tensor<Dim> reciprocal = reciprocal_of<Dim>(primitive);
  Vector<Dim> sum = Vector<Dim>::Zero();
  for (const auto& point : points) sum += reciprocal * point.wave_vector;
  const Tensor<Dim> frame = towards_side<Dim>(lattice, sum) * reciprocal;
  for (auto& point : points) {
    const Vector<Dim> k = frame * point.wave_vector;
    point.wave_vector = (k.array().abs() > shape_tolerance * frame.norm()).select(k, 0.0);
  }
  points.insert(points.begin(), {"Γ", Vector<Dim>::Zero()});
  return points;
}

template <int Dim>
BandPath<Dim> band_path(const Lattice<Dim>& lattice) {
  return band_path(lattice, convention(lattice).path);
}

template <int Dim>
BandPath<Dim> band_path(const Lattice<Dim>& lattice, std::string_view labels) {
  const auto points = symmetry_points(lattice);
  BandPath<Dim> path;
  for (const auto stretch : split(labels, '|')) {
    auto& corners = path.stretches.emplace_back();
    for (const auto label : split(stretch, '-')) {
      corners.push_back(find_point(lattice, points, label));
      if (corners.size() > 1 && corners.end()[-2].label == corners.back().label)
        throw InvalidInput(fmt::format("path: '{}' joins {} to itself", stretch, corners.back().label));
    }
    if (corners.size() == 1) throw InvalidInput(fmt::format("path: '{}' is a single point", stretch));
  }
  return path;
}

template std::string_view bravais_name(const Lattice<1>&);
template std::vector<SymmetryPoint<1>> symmetry_points(const Lattice<1>&);
template BandPath<1> band_path(const Lattice<1>&);
template BandPath<1> band_path(const Lattice<1>&, std::string_view);
template std::string_view bravais_name(const Lattice<2>&);
template std::vector<SymmetryPoint<2>> symmetry_points(const Lattice<2>&);
template BandPath<2> band_path(const Lattice<2>&);
template BandPath<2> band_path(const Lattice<2>&, std::string_view);
template std::string_view bravais_name(const Lattice<3>&);
template std::vector<SymmetryPoint<3>> symmetry_points(const Lattice<3>&);
template BandPath<3> band_path(const Lattice<3>&);
template BandPath<3> band_path(const Lattice<3>&, std::string_view);

}  // namespace sphstab
