// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>

namespace sphstab {

/// Column vector of `Dim` components.
template <int Dim, class Scalar = double>
using Vector = Eigen::Matrix<Scalar, Dim, 1>;

/// Second-order tensor in `Dim` dimensions; component (i, j) at row i, column j.
template <int Dim, class Scalar = double>
using Tensor = Eigen::Matrix<Scalar, Dim, Dim>;

/// Independent components of a symmetric tensor.
template <int Dim>
inline constexpr int symmetric_size = Dim*(Dim + 1) / 2;

/// Their places in the order of the interface: xx; xx, yy, xy; xx, yy, zz, xy, yz, xz.
template <int Dim>
inline constexpr auto symmetric_places = [] {
  std::array<std::pair<int, int>, symmetric_size<Dim>> places;
  for (int c = 0; c < Dim; ++c) places[c] = {c, c};
  for (int c = Dim; c < symmetric_size<Dim>; ++c) places[c] = {c - Dim, c - Dim + 1};
  if constexpr (Dim == 3) places[5] = {0, 2};
  return places;
}();

/// The symmetric tensor of these components.
template <int Dim, class Scalar>
Tensor<Dim, Scalar> symmetric_tensor(const Vector<symmetric_size<Dim>, Scalar>& components) {
  Tensor<Dim, Scalar> tensor;
  for (int c = 0; c < symmetric_size<Dim>; ++c) {
    const auto [i, j] = symmetric_places<Dim>[c];
    tensor(i, j) = tensor(j, i) = components[c];
  }
  return tensor;
}

/// The components of a symmetric tensor.
template <int Dim, class Scalar>
Vector<symmetric_size<Dim>, Scalar> symmetric_components(const Tensor<Dim, Scalar>& tensor) {
  Vector<symmetric_size<Dim>, Scalar> components;
  for (int c = 0; c < symmetric_size<Dim>; ++c) {
    const auto [i, j] = symmetric_places<Dim>[c];
    components[c] = tensor(i, j);
  }
  return components;
}

/// One truth value a direction.
template <int Dim>
using Directions = Eigen::Array<bool, Dim, 1>;

/// Integer coordinates of a lattice site: the coefficients n_i of x = Σ n_i a_i.
template <int Dim>
using LatticeIndex = Eigen::Matrix<int, Dim, 1>;

}  // namespace sphstab
