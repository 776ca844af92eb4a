// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "model/tensor.hpp"

namespace sphstab::solver {

/// The real type of a scalar: double for double and std::complex<double>, float for float.
template <class Scalar>
using Real = typename Eigen::NumTraits<Scalar>::Real;

/// One vector a particle. The components of a particle are adjacent, because a pair loop gathers them together.
template <int Dim, class Scalar = double>
using Field = std::vector<Vector<Dim, Scalar>>;

/// What moves: a structure of arrays, each indexed by particle.
template <int Dim, class Scalar = double>
struct State {
  /// At rest in the base state.
  explicit State(int particles)
      : displacement(particles, Vector<Dim, Scalar>::Zero()), velocity(particles, Vector<Dim, Scalar>::Zero()) {}

  int particles() const { return static_cast<int>(displacement.size()); }

  Field<Dim, Scalar> displacement;  ///< s, from the base state: the total displacement is H x + s
  Field<Dim, Scalar> velocity;      ///< v
};

}  // namespace sphstab::solver
