// SPDX-License-Identifier: MIT
#include "model/lattice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/lattice_index.hpp"
#include "model/lattice_reduction.hpp"

namespace sphstab {
namespace {

/// Distances that agree to this relative difference form one shell; rounding of Σ n_i a_i is four orders below.
constexpr double shell_tolerance = 1e-10;

/// A cell smaller than this part of a box with edges of the same lengths is none. The rounding of a reduced basis, a
/// unit roundoff over it, then stays below `shape_tolerance`.
constexpr double dependence_tolerance = 1e-6;

/// Columns a_i for unit spacing; none for a custom lattice.
Eigen::MatrixXd unit_primitive_vectors(LatticeKind kind) {
  using std::numbers::sqrt2;
  using std::numbers::sqrt3;
  switch (kind) {
    case LatticeKind::chain:
      return Eigen::MatrixXd::Identity(1, 1);
    case LatticeKind::square:
      return Eigen::MatrixXd::Identity(2, 2);
    case LatticeKind::hexagonal:
      return Tensor<2>{{1.0, 0.5}, {0.0, 0.5 * sqrt3}};
    case LatticeKind::staggered:
      return Tensor<2>{{1.0, 0.5}, {0.0, 1.0}};
    case LatticeKind::cubic:
      return Eigen::MatrixXd::Identity(3, 3);
    case LatticeKind::bcc:
      return Tensor<3>{{-1.0, 1.0, 1.0}, {1.0, -1.0, 1.0}, {1.0, 1.0, -1.0}} / sqrt3;
    case LatticeKind::fcc:
      return Tensor<3>{{0.0, 1.0, 1.0}, {1.0, 0.0, 1.0}, {1.0, 1.0, 0.0}} / sqrt2;
    case LatticeKind::custom:
      break;
  }
  return {};
}

int dimension_of(LatticeKind kind) { return static_cast<int>(unit_primitive_vectors(kind).rows()); }

template <int Dim>
Tensor<Dim> named_vectors(LatticeKind kind) {
  if (kind == LatticeKind::custom) throw InvalidInput("primitive_vectors: missing, which the lattice custom needs");
  if (dimension_of(kind) != Dim)
    throw InvalidInput(fmt::format("lattice: {} has {} dimension{}, not {}", name_of(kind), dimension_of(kind),
                                   dimension_of(kind) == 1 ? "" : "s", Dim));
  return unit_primitive_vectors(kind);
}

template <int Dim>
void require_independent(const Tensor<Dim>& vectors) {
  Tensor<Dim> directions = vectors;
  for (int i = 0; i < Dim; ++i) directions.col(i).stableNormalize();
  if (std::abs(directions.determinant()) > dependence_tolerance) return;
  throw InvalidInput(fmt::format("primitive_vectors: {} are linearly dependent",
                                 fmt::join(vectors.data(), vectors.data() + vectors.size(), ",")));
}

/// Sites that a search for neighbours may look at; more than a million neighbours are a mistake.
constexpr double largest_search = 4e6;

template <int Dim>
bool before(const LatticeNeighbour<Dim>& left, const LatticeNeighbour<Dim>& right) {
  if (std::abs(left.distance - right.distance) > shell_tolerance * right.distance)
    return left.distance < right.distance;
  return std::lexicographical_compare(left.index.data(), left.index.data() + Dim, right.index.data(),
                                      right.index.data() + Dim);
}

}  // namespace

std::vector<LatticeKind> lattices_of(int dimension) {
  std::vector<LatticeKind> kinds;
  for (const auto& [kind, name] : Names<LatticeKind>::table)
    if (dimension_of(kind) == dimension) kinds.push_back(kind);
  return kinds;
}

template <int Dim>
Lattice<Dim>::Lattice(LatticeKind kind, double spacing) : Lattice(kind, named_vectors<Dim>(kind), spacing) {}

template <int Dim>
Lattice<Dim>::Lattice(const Tensor<Dim>& primitive_in_spacings, double spacing)
    : Lattice(LatticeKind::custom, primitive_in_spacings, spacing) {}

template <int Dim>
Lattice<Dim>::Lattice(LatticeKind kind, const Tensor<Dim>& primitive_in_spacings, double spacing)
    : kind_(kind), spacing_(spacing), primitive_(spacing * primitive_in_spacings) {
  require_positive("spacing", spacing);
  require_independent<Dim>(primitive_in_spacings);
  reciprocal_ = 2.0 * std::numbers::pi * primitive_.inverse().transpose();
  cell_volume_ = std::abs(primitive_.determinant());
  if (!std::isnormal(cell_volume_))
    throw InvalidInput(fmt::format("spacing: {} makes a cell whose volume leaves the range of a double", spacing));
}

template <int Dim>
Lattice<Dim> Lattice<Dim>::deformed(const Tensor<Dim>& deformation_gradient) const {
  if (deformation_gradient == Tensor<Dim>::Identity()) return *this;
  if (!(deformation_gradient.determinant() > 0.0))
    throw InvalidInput(
        fmt::format("deformation_gradient: its determinant {} is not above 0", deformation_gradient.determinant()));
  return Lattice(deformation_gradient * primitive_ / spacing_, spacing_);
}

template <int Dim>
std::vector<LatticeNeighbour<Dim>> lattice_neighbours(const Lattice<Dim>& lattice, double support, NeighbourRule rule) {
  const Tensor<Dim> basis = reduced_basis<Dim>(lattice.primitive_vectors());
  // |n_i| = |b_i · x| / 2π ≤ |b_i| support / 2π, the least for a reduced basis.
  const Vector<Dim> bounds = basis.inverse().rowwise().norm() * support;
  if (!((2.0 * bounds.array() + 1.0).prod() <= largest_search))
    throw InvalidInput(fmt::format("smoothing_length: the support {:g} is {:.3g} spacings, too many neighbours",
                                   support, support / lattice.spacing()));
  const LatticeIndex<Dim> reach = bounds.array().floor().template cast<int>();
  std::vector<LatticeNeighbour<Dim>> neighbours;
  for_each_index<Dim>(-reach, reach, [&](const LatticeIndex<Dim>& n) {
    if (n.isZero()) return;
    const Vector<Dim> position = basis * n.template cast<double>();
    const double distance = position.norm();
    if (distance < support * (1.0 - tie_margin))
      neighbours.push_back({lattice_coordinates<Dim>(lattice.primitive_vectors(), position), position, distance});
  });
  if (neighbours.empty())
    throw InvalidInput(
        fmt::format("smoothing_length: no neighbour lies strictly inside the support {:g} ({} lattice, spacing {:g})",
                    support, name_of(lattice.kind()), lattice.spacing()));
  std::sort(neighbours.begin(), neighbours.end(), before<Dim>);
  if (rule == NeighbourRule::nearest) {
    const double shell = neighbours.front().distance * (1.0 + shell_tolerance);
    std::erase_if(neighbours, [&](const auto& neighbour) { return neighbour.distance > shell; });
  }
  return neighbours;
}

template class Lattice<1>;
template class Lattice<2>;
template class Lattice<3>;
template std::vector<LatticeNeighbour<1>> lattice_neighbours(const Lattice<1>&, double, NeighbourRule);
template std::vector<LatticeNeighbour<2>> lattice_neighbours(const Lattice<2>&, double, NeighbourRule);
template std::vector<LatticeNeighbour<3>> lattice_neighbours(const Lattice<3>&, double, NeighbourRule);

}  // namespace sphstab
