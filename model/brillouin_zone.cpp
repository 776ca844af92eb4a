// SPDX-License-Identifier: MIT
#include "model/brillouin_zone.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "model/lattice_index.hpp"
#include "model/lattice_reduction.hpp"

namespace sphstab {
namespace {

/// Lattice vectors Σ n_i a_i with |n_i| ≤ reduced_reach.
template <int Dim>
std::vector<Vector<Dim>> short_vectors(const Tensor<Dim>& basis) {
  std::vector<Vector<Dim>> vectors;
  const LatticeIndex<Dim> reach = LatticeIndex<Dim>::Constant(reduced_reach);
  for_each_index<Dim>(-reach, reach,
                      [&](const LatticeIndex<Dim>& n) { vectors.push_back(basis * n.template cast<double>()); });
  return vectors;
}

/// Whether vector j of `image` has the length of that of `basis` and the same products with those before it.
template <int Dim>
bool same_products(const Tensor<Dim>& image, const Tensor<Dim>& basis, int j) {
  for (int i = 0; i <= j; ++i) {
    const double difference = image.col(i).dot(image.col(j)) - basis.col(i).dot(basis.col(j));
    if (!(std::abs(difference) <= shape_tolerance * basis.col(i).norm() * basis.col(j).norm())) return false;
  }
  return true;
}

/// The symmetries of a lattice: its linear maps that keep every length and product of a reduced basis.
template <int Dim>
std::vector<Tensor<Dim>> symmetries(const Tensor<Dim>& basis) {
  const auto candidates = short_vectors<Dim>(basis);
  std::vector<Tensor<Dim>> images{Tensor<Dim>::Zero()};
  for (int j = 0; j < Dim; ++j) {
    std::vector<Tensor<Dim>> longer;
    for (Tensor<Dim> image : images)
      for (const auto& candidate : candidates) {
        image.col(j) = candidate;
        if (same_products<Dim>(image, basis, j)) longer.push_back(image);
      }
    images = std::move(longer);
  }
  for (auto& image : images) image *= basis.inverse();
  return images;
}

/// A direction that no symmetry but the identity keeps, unless by an unlikely accident.
template <int Dim>
Vector<Dim> generic_direction() {
  Vector<Dim> direction;
  for (int axis = 0; axis < Dim; ++axis) direction[axis] = std::pow(std::numbers::inv_pi, axis);
  return direction;
}

/// Order by the first component that differs.
template <int Dim>
bool before(const Vector<Dim>& left, const Vector<Dim>& right, double tolerance) {
  int axis = 0;
  while (axis < Dim - 1 && std::abs(left[axis] - right[axis]) <= tolerance) ++axis;
  return left[axis] < right[axis];
}

template <int Dim>
bool inside(const Vector<Dim>& point, const std::vector<HalfSpace<Dim>>& half_spaces, double tolerance) {
  return std::all_of(half_spaces.begin(), half_spaces.end(), [&](const HalfSpace<Dim>& side) {
    return side.normal.dot(point) - side.offset <= tolerance * side.normal.norm();
  });
}

/// Corners of the intersection of half-spaces: points of it where Dim of the planes meet.
template <int Dim>
std::vector<Vector<Dim>> corners(const std::vector<HalfSpace<Dim>>& half_spaces, double tolerance) {
  std::vector<Vector<Dim>> points;
  const LatticeIndex<Dim> last = LatticeIndex<Dim>::Constant(static_cast<int>(half_spaces.size()) - 1);
  for_each_index<Dim>(LatticeIndex<Dim>::Zero(), last, [&](const LatticeIndex<Dim>& planes) {
    if (std::adjacent_find(planes.begin(), planes.end(), std::greater_equal<>()) != planes.end()) return;
    Tensor<Dim> normals;
    Vector<Dim> offsets;
    for (int i = 0; i < Dim; ++i) {
      const auto& [normal, offset] = half_spaces[planes[i]];
      normals.row(i) = normal.normalized();
      offsets[i] = offset / normal.norm();
    }
    if (!(std::abs(normals.determinant()) > shape_tolerance)) return;
    const Vector<Dim> point = normals.inverse() * offsets;
    if (!inside<Dim>(point, half_spaces, tolerance)) return;
    if (std::none_of(points.begin(), points.end(),
                     [&](const Vector<Dim>& known) { return (known - point).norm() <= tolerance; }))
      points.push_back(point);
  });
  return points;
}

}  // namespace

template <int Dim>
BrillouinZone<Dim>::BrillouinZone(const Lattice<Dim>& lattice)
    : reciprocal_(reduced_basis<Dim>(lattice.reciprocal_vectors())),
      tolerance_(shape_tolerance * reciprocal_.norm()),
      point_group_(symmetries<Dim>(reduced_basis<Dim>(lattice.primitive_vectors()))) {
  for_each_index<Dim>(LatticeIndex<Dim>::Zero(), LatticeIndex<Dim>::Ones(), [&](const LatticeIndex<Dim>& parity) {
    if (parity.isZero()) return;
    const auto halves = shortest_equivalents(reciprocal_ * parity.template cast<double>() / 2.0);
    if (halves.size() > 2) return;
    for (const auto& half : halves) half_spaces_.push_back({2.0 * half, 2.0 * half.squaredNorm()});
  });
}

template <int Dim>
std::vector<Vector<Dim>> BrillouinZone<Dim>::shortest_equivalents(const Vector<Dim>& wave_vector) const {
  const Vector<Dim> coordinates = reciprocal_.inverse() * wave_vector;
  const Vector<Dim> nearby = wave_vector - reciprocal_ * coordinates.array().round().matrix();
  auto equivalents = short_vectors<Dim>(reciprocal_);
  for (auto& k : equivalents) k += nearby;
  const auto shorter = [](const Vector<Dim>& left, const Vector<Dim>& right) { return left.norm() < right.norm(); };
  const double longest = std::min_element(equivalents.begin(), equivalents.end(), shorter)->norm() + tolerance_;
  std::erase_if(equivalents, [&](const Vector<Dim>& k) { return k.norm() > longest; });
  return equivalents;
}

template <int Dim>
Vector<Dim> BrillouinZone<Dim>::in_first_zone(const Vector<Dim>& wave_vector) const {
  const auto equivalents = shortest_equivalents(wave_vector);
  return *std::max_element(equivalents.begin(), equivalents.end(),
                           [&](const auto& left, const auto& right) { return before<Dim>(left, right, tolerance_); });
}

template <int Dim>
IrreducibleWedge<Dim>::IrreducibleWedge(const BrillouinZone<Dim>& zone, std::vector<Tensor<Dim>> group)
    : zone_(zone), group_(std::move(group)), half_spaces_(zone.half_spaces()) {
  for (const auto& facet : half_spaces_) tolerance_ = std::max(tolerance_, shape_tolerance * facet.normal.norm());
  const Vector<Dim> direction = generic_direction<Dim>();
  std::vector<Vector<Dim>> normals;  // of R k · u ≤ k · u
  for (const auto& element : group_)
    if (const Vector<Dim> normal = element.transpose() * direction - direction; normal.norm() > shape_tolerance)
      normals.push_back(normal);
  // The nearest images of the direction bound its Dirichlet domain: with them first, most others cut nothing off.
  std::sort(normals.begin(), normals.end(),
            [](const auto& left, const auto& right) { return left.norm() < right.norm(); });

  vertices_ = corners<Dim>(half_spaces_, tolerance_);
  const auto touching = [&](const HalfSpace<Dim>& side) {
    return std::count_if(vertices_.begin(), vertices_.end(), [&](const Vector<Dim>& vertex) {
      return side.normal.dot(vertex) - side.offset >= -tolerance_ * side.normal.norm();
    });
  };
  for (const auto& normal : normals) {
    const HalfSpace<Dim> side{normal.normalized(), 0.0};
    if (std::all_of(vertices_.begin(), vertices_.end(),
                    [&](const Vector<Dim>& vertex) { return inside<Dim>(vertex, {side}, tolerance_); }))
      continue;
    half_spaces_.push_back(side);
    vertices_ = corners<Dim>(half_spaces_, tolerance_);
    std::erase_if(half_spaces_, [&](const HalfSpace<Dim>& other) { return touching(other) < Dim; });
  }
}

template <int Dim>
Vector<Dim> IrreducibleWedge<Dim>::in_wedge(const Vector<Dim>& wave_vector) const {
  const Vector<Dim> direction = generic_direction<Dim>();
  std::vector<Vector<Dim>> images;
  for (const auto& k : zone_.shortest_equivalents(wave_vector))
    for (const auto& element : group_) images.push_back(element * k);
  return *std::max_element(images.begin(), images.end(), [&](const Vector<Dim>& left, const Vector<Dim>& right) {
    const double difference = (right - left).dot(direction);
    return std::abs(difference) > tolerance_ ? difference > 0.0 : before<Dim>(left, right, tolerance_);
  });
}

template class BrillouinZone<1>;
template class IrreducibleWedge<1>;
template class BrillouinZone<2>;
template class IrreducibleWedge<2>;
template class BrillouinZone<3>;
template class IrreducibleWedge<3>;

}  // namespace sphstab
