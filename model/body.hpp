// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "model/problem.hpp"

namespace sphstab {

/// Neighbours of every particle in compressed rows: those of a are entries first[a] … first[a+1] − 1. Self excluded.
template <int Dim>
struct NeighbourPairs {
  std::vector<int> first;
  std::vector<int> neighbour;           ///< b
  std::vector<Vector<Dim>> separation;  ///< r_ab = r_a − r_b in the reference state, of this image of b

  int particles() const { return static_cast<int>(first.size()) - 1; }
};

/// Particles in their reference state with their neighbours; nothing of a scheme, nothing that moves.
template <int Dim>
struct Body {
  std::vector<Vector<Dim>> position;
  std::vector<double> volume;
  /// Lattice coordinates of the particle: bodies cut from a lattice keep them, so that lattice methods apply.
  std::vector<LatticeIndex<Dim>> site;
  NeighbourPairs<Dim> pairs;

  int size() const { return static_cast<int>(position.size()); }
};

/// n_1 × … × n_Dim cells of the lattice with periodic images. Every image within the support counts, so a patch may be
/// smaller than the support. Particle order: first lattice direction fastest. Throws InvalidInput (`patch`) unless
/// every count is at least 1.
template <int Dim>
Body<Dim> periodic_patch(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells);

/// A free rectangular plate of n_x × n_y particles on the square lattice, particle (i, j) at (iΔp, jΔp), x fastest.
/// Throws InvalidInput (`plate`) unless the lattice is square and every count is at least 2.
template <int Dim>
Body<Dim> free_plate(const Problem<Dim>& problem, const LatticeIndex<Dim>& particles);

extern template struct NeighbourPairs<1>;
extern template Body<1> periodic_patch(const Problem<1>&, const LatticeIndex<1>&);
extern template Body<1> free_plate(const Problem<1>&, const LatticeIndex<1>&);
extern template struct NeighbourPairs<2>;
extern template Body<2> periodic_patch(const Problem<2>&, const LatticeIndex<2>&);
extern template Body<2> free_plate(const Problem<2>&, const LatticeIndex<2>&);
extern template struct NeighbourPairs<3>;
extern template Body<3> periodic_patch(const Problem<3>&, const LatticeIndex<3>&);
extern template Body<3> free_plate(const Problem<3>&, const LatticeIndex<3>&);

}  // namespace sphstab
