// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/LU>
#include <vector>

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

}  // namespace sphstab::ladder
