// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "model/lattice.hpp"

namespace sphstab {

/// A labelled wave vector of high symmetry, radians per length.
template <int Dim>
struct SymmetryPoint {
  std::string label;
  Vector<Dim> wave_vector;
};

/// Points joined by straight lines; a new stretch begins where the path jumps.
template <int Dim>
struct BandPath {
  std::vector<std::vector<SymmetryPoint<Dim>>> stretches;
};

/// What the lattice is by its shape, whatever its scale, its direction and the basis it is given in: two-fold axes,
/// lengths and angles count as those of a symmetric lattice within a relative 1e-9. In 2D "square", "hexagonal",
/// "rectangular", "centred rectangular", "oblique"; in 3D "simple cubic", "face-centred cubic", "body-centred cubic",
/// "simple tetragonal", "simple orthorhombic", "hexagonal", and without a path of their own "body-centred tetragonal",
/// "centred orthorhombic", "rhombohedral", "monoclinic", "triclinic"; in 1D "chain".
template <int Dim>
std::string_view bravais_name(const Lattice<Dim>& lattice);

/// Γ first, then the labelled points of the convention of W. Setyawan, S. Curtarolo, Comput. Mater. Sci. 49 (2010) 299,
/// Appendix A, all in or on the first zone. In 3D CUB, FCC, BCC, TET, ORC and HEX as published; every other lattice has
/// the seven points of TRI at the halves of reciprocal vectors, special points of any lattice (X, Y, Z of a reduced
/// basis from the shortest to the longest, then L = X + Y, M = Y + Z, N = X + Z, R = X + Y + Z up to reciprocal
/// vectors). In 2D the plane k_z = 0 of TET (square), HEX, ORC (rectangular) and ORCC (centred rectangular), and the
/// plane across the unique axis of MCL (oblique). Of the equivalent sets of points it gives the one whose sum lies
/// farthest along (1, 1/π), in 3D (1/π, 1, 1/π²): nearest to +x in 2D; in 3D the printed coordinates where the axes
/// of the lattice are x, y, z. Tested in tests/model/test_band_path.cpp.
template <int Dim>
std::vector<SymmetryPoint<Dim>> symmetry_points(const Lattice<Dim>& lattice);

/// The path of the same source; in a plane as much of it as lies there, closed at Γ.
template <int Dim>
BandPath<Dim> band_path(const Lattice<Dim>& lattice);

/// The path of `labels` such as "G-X-M-G" or "Γ-X|M-R": '-' joins two points, '|' jumps, G stands for Γ. Throws
/// InvalidInput (`path`) for a label that the lattice does not have, naming those it has, for a stretch of a single
/// point and for a point that follows itself.
template <int Dim>
BandPath<Dim> band_path(const Lattice<Dim>& lattice, std::string_view labels);

extern template std::string_view bravais_name(const Lattice<1>&);
extern template std::vector<SymmetryPoint<1>> symmetry_points(const Lattice<1>&);
extern template BandPath<1> band_path(const Lattice<1>&);
extern template BandPath<1> band_path(const Lattice<1>&, std::string_view);
extern template std::string_view bravais_name(const Lattice<2>&);
extern template std::vector<SymmetryPoint<2>> symmetry_points(const Lattice<2>&);
extern template BandPath<2> band_path(const Lattice<2>&);
extern template BandPath<2> band_path(const Lattice<2>&, std::string_view);
extern template std::string_view bravais_name(const Lattice<3>&);
extern template std::vector<SymmetryPoint<3>> symmetry_points(const Lattice<3>&);
extern template BandPath<3> band_path(const Lattice<3>&);
extern template BandPath<3> band_path(const Lattice<3>&, std::string_view);

}  // namespace sphstab
