// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "model/lattice.hpp"

namespace sphstab {

/// The wave vectors k with normal · k ≤ offset.
template <int Dim>
struct HalfSpace {
  Vector<Dim> normal;
  double offset;
};

/// The first Brillouin zone of a lattice: the wave vectors that are no farther from 0 than from any reciprocal vector.
/// Wave vectors in radians per length. Tested in tests/model/test_brillouin_zone.cpp.
template <int Dim>
class BrillouinZone {
 public:
  explicit BrillouinZone(const Lattice<Dim>& lattice);

  /// Its facets k · G ≤ |G|²/2. G is among them exactly if ±G are the only shortest vectors of their class modulo twice
  /// the reciprocal lattice (Voronoi; J. H. Conway, N. J. A. Sloane, Proc. R. Soc. Lond. A 436 (1992) 55, Theorem 3).
  const std::vector<HalfSpace<Dim>>& half_spaces() const { return half_spaces_; }

  /// Every orthogonal matrix that maps the lattice, and with it the zone, on itself; −I is always among them.
  const std::vector<Tensor<Dim>>& point_group() const { return point_group_; }

  /// The wave vectors of smallest length that differ from k by reciprocal vectors: one inside the zone, several on its
  /// boundary, where lengths within 1e-9 of the reciprocal vectors count as equal.
  std::vector<Vector<Dim>> shortest_equivalents(const Vector<Dim>& wave_vector) const;

  /// Of these the one with the largest first component, then second, then third: one for each class of equivalent k.
  Vector<Dim> in_first_zone(const Vector<Dim>& wave_vector) const;

 private:
  Tensor<Dim> reciprocal_;  ///< a reduced basis, columns
  double tolerance_;        ///< components within it count as equal
  std::vector<HalfSpace<Dim>> half_spaces_;
  std::vector<Tensor<Dim>> point_group_;
};

/// The part of the zone that a subgroup of its point group takes to all the rest, once: those k of the zone whose
/// component along the fixed direction (1, 1/π, 1/π²) no element of the group can raise (a Dirichlet domain), which is
/// convex. With the whole point group that is k_x ≥ k_y ≥ k_z ≥ 0 for the square and the cubic lattices, and Γ, M, K
/// with K on the x axis for the hexagonal one. Tested in tests/model/test_brillouin_zone.cpp.
template <int Dim>
class IrreducibleWedge {
 public:
  /// `group` must be a group and part of zone.point_group().
  IrreducibleWedge(const BrillouinZone<Dim>& zone, std::vector<Tensor<Dim>> group);

  /// Facets of the zone as there and the planes that bound the Dirichlet domain, of offset 0 and unit normal; those
  /// that do not touch the wedge in a facet are left out.
  const std::vector<HalfSpace<Dim>>& half_spaces() const { return half_spaces_; }
  /// Its corners, in no order.
  const std::vector<Vector<Dim>>& vertices() const { return vertices_; }
  /// The k of the wedge that is equivalent to `wave_vector` under the group and reciprocal vectors. Where the boundary
  /// of the wedge has several, the one with the largest component along the fixed direction, then the first axis …
  Vector<Dim> in_wedge(const Vector<Dim>& wave_vector) const;
  const std::vector<Tensor<Dim>>& group() const { return group_; }

 private:
  BrillouinZone<Dim> zone_;
  double tolerance_ = 0.0;  ///< components within it count as equal
  std::vector<Tensor<Dim>> group_;
  std::vector<HalfSpace<Dim>> half_spaces_;
  std::vector<Vector<Dim>> vertices_;
};

extern template class BrillouinZone<1>;
extern template class IrreducibleWedge<1>;
extern template class BrillouinZone<2>;
extern template class IrreducibleWedge<2>;
extern template class BrillouinZone<3>;
extern template class IrreducibleWedge<3>;

}  // namespace sphstab
