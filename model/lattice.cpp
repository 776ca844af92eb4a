// SPDX-License-Identifier: MIT
#include "model/lattice.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace sphstab {
namespace {

/// Distances that agree to this relative difference form one shell; rounding of Σ n_i a_i is four orders below.
constexpr double shell_tolerance = 1e-10;

Tensor<2> unit_primitive_vectors(LatticeKind kind) {
  Tensor<2> a;
  switch (kind) {
    case LatticeKind::square:
      a << 1.0, 0.0, 0.0, 1.0;
      return a;
    case LatticeKind::hexagonal:
      a << 1.0, 0.5, 0.0, 0.5 * std::numbers::sqrt3;
      return a;
    case LatticeKind::staggered:
      a << 1.0, 0.5, 0.0, 1.0;
      return a;
  }
  return a;
}

/// Sites that a search for neighbours may look at; more than a million neighbours are a mistake.
constexpr double largest_search = 4e6;

/// Calls visit(n) for every index with |n_i| ≤ reach_i.
template <int Dim, class Visit>
void for_each_index(const LatticeIndex<Dim>& reach, const Visit& visit) {
  LatticeIndex<Dim> n = -reach;
  for (;;) {
    visit(n);
    int axis = 0;
    while (axis < Dim && n[axis] == reach[axis]) n[axis] = -reach[axis], ++axis;
    if (axis == Dim) return;
    ++n[axis];
  }
}

template <int Dim>
bool before(const LatticeNeighbour<Dim>& left, const LatticeNeighbour<Dim>& right) {
  if (std::abs(left.distance - right.distance) > shell_tolerance * right.distance)
    return left.distance < right.distance;
  return std::lexicographical_compare(left.index.data(), left.index.data() + Dim, right.index.data(),
                                      right.index.data() + Dim);
}

}  // namespace

template <int Dim>
Lattice<Dim>::Lattice(LatticeKind kind, double spacing) : kind_(kind), spacing_(spacing) {
  require_positive("spacing", spacing);
  primitive_ = spacing * unit_primitive_vectors(kind);
  reciprocal_ = 2.0 * std::numbers::pi * primitive_.inverse().transpose();
  cell_volume_ = std::abs(primitive_.determinant());
  if (!std::isnormal(cell_volume_))
    throw InvalidInput(fmt::format("spacing: {} makes a cell whose volume leaves the range of a double", spacing));
}

template <int Dim>
std::vector<LatticeNeighbour<Dim>> lattice_neighbours(const Lattice<Dim>& lattice, double support, NeighbourRule rule) {
  // |n_i| = |b_i · x| / 2π ≤ |b_i| support / 2π.
  const Vector<Dim> bounds = lattice.reciprocal_vectors().colwise().norm() * support / (2.0 * std::numbers::pi);
  if (!((2.0 * bounds.array() + 1.0).prod() <= largest_search))
    throw InvalidInput(fmt::format("smoothing_length: the support {:g} is {:.3g} spacings, too many neighbours",
                                   support, support / lattice.spacing()));
  const LatticeIndex<Dim> reach = bounds.array().floor().template cast<int>();
  std::vector<LatticeNeighbour<Dim>> neighbours;
  for_each_index<Dim>(reach, [&](const LatticeIndex<Dim>& n) {
    if (n.isZero()) return;
    const Vector<Dim> position = lattice.site(n);
    const double distance = position.norm();
    if (distance < support * (1.0 - tie_margin)) neighbours.push_back({n, position, distance});
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

template class Lattice<2>;
template std::vector<LatticeNeighbour<2>> lattice_neighbours(const Lattice<2>&, double, NeighbourRule);

}  // namespace sphstab
