// SPDX-License-Identifier: MIT
#pragma once

#include "model/tensor.hpp"

namespace sphstab {

/// Lengths and products of lattice vectors that agree to this, relative to the lengths, count as equal: rounding of a
/// reduced basis stays below it (see `dependence_tolerance`), and nobody builds two lattices so close.
inline constexpr double shape_tolerance = 1e-9;

/// Coefficients of a reduced basis need not be searched beyond ± this: a Minkowski-reduced basis of up to three vectors
/// reaches every shortest representative of a class modulo the lattice from [−½, ½] of it, every image of its vectors
/// under a symmetry, and every two-fold axis (Y. Le Page, J. Appl. Cryst. 15 (1982) 255).
/// Tested in tests/model/test_brillouin_zone.cpp against a search twice as wide.
inline constexpr int reduced_reach = 2;

/// A basis (columns) of the lattice that the columns of `vectors` span, made of shortest vectors: none can be shortened
/// by adding ± the others (Lagrange and Gauss in 2D; in 3D Minkowski's conditions, which give the successive minima:
/// P. Q. Nguyen, D. Stehlé, ACM Trans. Algorithms 5 (2009) 46). A basis that is reduced to `shape_tolerance` is
/// returned unchanged. Ends because every step shortens a vector. Tested in tests/model/test_lattice_reduction.cpp.
template <int Dim>
Tensor<Dim> reduced_basis(const Tensor<Dim>& vectors);

/// n with x = Σ n_i a_i for a site x of the lattice of the columns a_i, rounded to whole numbers.
template <int Dim>
LatticeIndex<Dim> lattice_coordinates(const Tensor<Dim>& vectors, const Vector<Dim>& site);

extern template Tensor<1> reduced_basis(const Tensor<1>&);
extern template LatticeIndex<1> lattice_coordinates(const Tensor<1>&, const Vector<1>&);
extern template Tensor<2> reduced_basis(const Tensor<2>&);
extern template LatticeIndex<2> lattice_coordinates(const Tensor<2>&, const Vector<2>&);
extern template Tensor<3> reduced_basis(const Tensor<3>&);
extern template LatticeIndex<3> lattice_coordinates(const Tensor<3>&, const Vector<3>&);

}  // namespace sphstab
