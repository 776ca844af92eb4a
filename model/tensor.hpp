// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace sphstab {

/// Column vector of `Dim` components.
template <int Dim, class Scalar = double>
using Vector = Eigen::Matrix<Scalar, Dim, 1>;

/// Second-order tensor in `Dim` dimensions; component (i, j) at row i, column j.
template <int Dim, class Scalar = double>
using Tensor = Eigen::Matrix<Scalar, Dim, Dim>;

/// One truth value a direction.
template <int Dim>
using Directions = Eigen::Array<bool, Dim, 1>;

/// Integer coordinates of a lattice site: the coefficients n_i of x = Σ n_i a_i.
template <int Dim>
using LatticeIndex = Eigen::Matrix<int, Dim, 1>;

}  // namespace sphstab
