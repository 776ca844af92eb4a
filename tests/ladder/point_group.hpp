// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <vector>

#include "analysis/amplification.hpp"
#include "model/lattice.hpp"
#include "model/lattice_index.hpp"

namespace sphstab::ladder {

/// The rotations and reflections that map a lattice to itself, R = A N A⁻¹ with integers N, of these bases −1, 0 or 1.
template <int Dim>
std::vector<Tensor<Dim>> point_group(const Lattice<Dim>& lattice) {
  const Tensor<Dim>&A = lattice.primitive_vectors(), A_inverse = A.inverse();
  std::vector<Tensor<Dim>> group;
  using Entries = Eigen::Matrix<int, Dim * Dim, 1>;
  for_each_index<Dim * Dim>(-Entries::Ones(), Entries::Ones(), [&](const Entries& entries) {
    const Tensor<Dim> N = Eigen::Map<const Tensor<Dim, int>>(entries.data()).template cast<double>();
    const Tensor<Dim> R = A * N * A_inverse;
    if ((R * R.transpose() - Tensor<Dim>::Identity()).norm() < 1e-12) group.push_back(R);
  });
  return group;
}

inline std::size_t order_of_point_group(LatticeKind lattice) {
  switch (lattice) {
    case LatticeKind::chain:
      return 2;
    case LatticeKind::square:
      return 8;
    case LatticeKind::hexagonal:
      return 12;
    case LatticeKind::staggered:
      return 4;
    case LatticeKind::cubic:
    case LatticeKind::bcc:
    case LatticeKind::fcc:
      return 48;
    case LatticeKind::custom:
      break;
  }
  return 0;
}

/// The largest error at k of what the dynamical matrix owes to the lattice: waves k and −k are one, so are k and k plus
/// reciprocal vectors, and M turns with the elements R of the point group, under which turn(R, problem) turns the base
/// state.
template <int Dim, class Turn>
double symmetry_error(const Problem<Dim>& problem, const Vector<Dim>& k, const Turn& turn) {
  using analysis::dynamical_matrix;
  const Tensor<Dim> M = dynamical_matrix<Dim>(problem, k);
  double worst = (dynamical_matrix<Dim>(problem, -k) - M).norm();
  for (const Tensor<Dim>& R : point_group(problem.lattice)) {
    auto turned = problem;
    turn(R, turned);
    worst = std::max(worst, (dynamical_matrix<Dim>(turned, R * k) - R * M * R.transpose()).norm());
  }
  for (int axis = 0; axis < Dim; ++axis)
    for (const double shift : {1.0, -2.0}) {
      const Vector<Dim> other = k + shift * problem.lattice.reciprocal_vectors().col(axis);
      worst = std::max(worst, (dynamical_matrix<Dim>(problem, other) - M).norm());
    }
  return worst;
}

}  // namespace sphstab::ladder
