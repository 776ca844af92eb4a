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

/// Particles in their reference state: what each is made of, how it is held and loaded, and its neighbours; nothing of
/// a scheme, nothing that moves. Lists indexed by particle.
template <int Dim>
struct Body {
  std::vector<Vector<Dim>> position;
  std::vector<double> volume;
  std::vector<Material> materials;  ///< those that the body is made of
  std::vector<int> material;        ///< which of them
  /// In which directions it is held where it is; empty: no particle is held.
  std::vector<Directions<Dim>> clamped = {};
  /// Force per mass, of gravity and tractions; empty: none.
  std::vector<Vector<Dim>> load = {};
  /// Lattice coordinates: bodies cut from one lattice keep them, so that lattice methods apply; empty: no lattice.
  std::vector<LatticeIndex<Dim>> site = {};
  NeighbourPairs<Dim> pairs;

  int size() const { return static_cast<int>(position.size()); }
  const Material& material_of(int a) const { return materials[material[a]]; }
  double mass(int a) const { return volume[a] * material_of(a).density(); }
};

/// The pairs of all particles closer than `support` (tie_margin of model/lattice.hpp), by cells of that size: work and
/// memory in proportion to the pairs. Neighbours of a particle in ascending order. Tested against brute force in
/// tests/model/test_body.cpp.
template <int Dim>
NeighbourPairs<Dim> find_pairs(const std::vector<Vector<Dim>>& position, double support);

/// n_1 × … × n_Dim cells of the lattice with periodic images. Every image within the support counts, so a patch may be
/// smaller than the support. Particle order: first lattice direction fastest. Throws InvalidInput (`patch`) unless
/// every count is at least 1.
template <int Dim>
Body<Dim> periodic_patch(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells);

/// A free rectangular plate of n_x × n_y particles on the square lattice, particle (i, j) at (iΔp, jΔp), x fastest; in
/// 1-D a bar on the chain, in 3-D a block on the cubic lattice. Throws InvalidInput (`plate`) on other lattices and
/// unless every count is at least 2.
template <int Dim>
Body<Dim> free_plate(const Problem<Dim>& problem, const LatticeIndex<Dim>& particles);

extern template struct NeighbourPairs<1>;
extern template NeighbourPairs<1> find_pairs(const std::vector<Vector<1>>&, double);
extern template Body<1> periodic_patch(const Problem<1>&, const LatticeIndex<1>&);
extern template Body<1> free_plate(const Problem<1>&, const LatticeIndex<1>&);
extern template struct NeighbourPairs<2>;
extern template NeighbourPairs<2> find_pairs(const std::vector<Vector<2>>&, double);
extern template Body<2> periodic_patch(const Problem<2>&, const LatticeIndex<2>&);
extern template Body<2> free_plate(const Problem<2>&, const LatticeIndex<2>&);
extern template struct NeighbourPairs<3>;
extern template NeighbourPairs<3> find_pairs(const std::vector<Vector<3>>&, double);
extern template Body<3> periodic_patch(const Problem<3>&, const LatticeIndex<3>&);
extern template Body<3> free_plate(const Problem<3>&, const LatticeIndex<3>&);

}  // namespace sphstab
