// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <random>
#include <string_view>
#include <vector>

#include "model/lattice.hpp"

namespace sphstab {

/// A lattice by its primitive vectors (columns), and what crystallography says of it.
template <int Dim>
struct Shape {
  std::string_view name;
  Tensor<Dim> vectors;
  int symmetries;  ///< order of the holohedry
  int facets;      ///< of the first Brillouin zone

  Lattice<Dim> lattice(double spacing = 1.0) const { return Lattice<Dim>(vectors, spacing); }
};

inline std::vector<Shape<1>> shapes(std::integral_constant<int, 1>) { return {{"chain", Tensor<1>(1.0), 2, 2}}; }

inline std::vector<Shape<2>> shapes(std::integral_constant<int, 2>) {
  return {{"square", Tensor<2>::Identity(), 8, 4},
          {"hexagonal", Tensor<2>{{1.0, 0.5}, {0.0, 0.5 * std::numbers::sqrt3}}, 12, 6},
          {"centred rectangular", Tensor<2>{{1.0, 0.5}, {0.0, 1.0}}, 4, 6},
          {"centred rectangular", Tensor<2>{{0.3, -0.3}, {1.0, 1.0}}, 4, 6},
          {"rectangular", Tensor<2>{{1.0, 0.0}, {0.0, 2.0}}, 4, 4},
          {"oblique", Tensor<2>{{1.0, 0.3}, {0.0, 1.7}}, 2, 6}};
}

inline std::vector<Shape<3>> shapes(std::integral_constant<int, 3>) {
  const double h = 0.5 * std::numbers::sqrt3;
  const Tensor<3> bcc{{-1.0, 1.0, 1.0}, {1.0, -1.0, 1.0}, {1.0, 1.0, -1.0}};
  const Tensor<3> fcc{{0.0, 1.0, 1.0}, {1.0, 0.0, 1.0}, {1.0, 1.0, 0.0}};
  const Vector<3> stretch(1.0, 1.0, 1.3), orthorhombic(1.0, 1.2, 1.5);
  return {{"simple cubic", Tensor<3>::Identity(), 48, 6},
          {"body-centred cubic", bcc, 48, 12},
          {"face-centred cubic", fcc, 48, 14},
          {"simple tetragonal", stretch.asDiagonal().toDenseMatrix(), 16, 6},
          {"simple tetragonal", Vector<3>(1.0, 0.6, 1.0).asDiagonal().toDenseMatrix(), 16, 6},
          {"body-centred tetragonal", stretch.asDiagonal() * bcc, 16, 14},
          {"simple orthorhombic", orthorhombic.asDiagonal().toDenseMatrix(), 8, 6},
          {"centred orthorhombic", orthorhombic.asDiagonal() * bcc, 8, 14},
          {"centred orthorhombic", Tensor<3>{{0.5, -0.5, 0.0}, {0.7, 0.7, 0.0}, {0.0, 0.0, 1.1}}, 8, 8},
          {"hexagonal", Tensor<3>{{1.0, 0.5, 0.0}, {0.0, h, 0.0}, {0.0, 0.0, 1.6}}, 24, 8},
          {"hexagonal", Tensor<3>{{1.0, 0.5, 0.0}, {0.0, h, 0.0}, {0.0, 0.0, std::numbers::sqrt3}}, 24, 8},
          {"rhombohedral", Tensor<3>{{1.0, 0.2, 0.2}, {0.2, 1.0, 0.2}, {0.2, 0.2, 1.0}}, 12, 14},
          {"monoclinic", Tensor<3>{{1.0, 0.3, 0.0}, {0.0, 1.2, 0.0}, {0.0, 0.0, 1.4}}, 4, 8},
          {"triclinic", Tensor<3>{{1.0, 0.2, -0.1}, {0.0, 1.3, 0.35}, {0.0, 0.0, 1.7}}, 2, 14}};
}

template <int Dim>
std::vector<Shape<Dim>> shapes() {
  return shapes(std::integral_constant<int, Dim>());
}

/// Another basis of the same lattice: random multiples of the vectors added to each other, one of them turned round.
template <int Dim>
Tensor<Dim> skewed(Tensor<Dim> vectors, std::mt19937& random) {
  std::uniform_int_distribution<int> multiple(-3, 3);
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j)
      if (i != j) vectors.col(i) += multiple(random) * vectors.col(j);
  vectors.col(Dim - 1) *= -1.0;
  return vectors;
}

/// A rotation without any special direction.
template <int Dim>
Tensor<Dim> rotation() {
  Tensor<Dim> result = Tensor<Dim>::Identity();
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < i; ++j) {
      const double angle = 0.4 + 0.35 * i + 0.2 * j;
      Tensor<Dim> turn = Tensor<Dim>::Identity();
      turn(i, i) = turn(j, j) = std::cos(angle);
      turn(i, j) = std::sin(angle);
      turn(j, i) = -std::sin(angle);
      result = turn * result;
    }
  return result;
}

}  // namespace sphstab
