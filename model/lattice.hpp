// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "model/names.hpp"
#include "model/tensor.hpp"

namespace sphstab {

enum class LatticeKind { chain, square, hexagonal, staggered, cubic, bcc, fcc, custom };

template <>
struct Names<LatticeKind> {
  static constexpr std::array<Named<LatticeKind>, 8> table{{{LatticeKind::chain, "chain"},
                                                            {LatticeKind::square, "square"},
                                                            {LatticeKind::hexagonal, "hexagonal"},
                                                            {LatticeKind::staggered, "staggered"},
                                                            {LatticeKind::cubic, "cubic"},
                                                            {LatticeKind::bcc, "bcc"},
                                                            {LatticeKind::fcc, "fcc"},
                                                            {LatticeKind::custom, "custom"}}};
};

/// The named lattices of a dimension: all but `custom`, which can live in any.
std::vector<LatticeKind> lattices_of(int dimension);

/// Which lattice sites within the support interact.
enum class NeighbourRule {
  support,  ///< every site strictly inside the support
  nearest   ///< of those only the shell at the smallest distance (Zhang's four on the square lattice)
};

template <>
struct Names<NeighbourRule> {
  static constexpr std::array<Named<NeighbourRule>, 2> table{
      {{NeighbourRule::support, "support"}, {NeighbourRule::nearest, "nearest"}}};
};

/// A Bravais lattice: sites x = Σ n_i a_i.
template <int Dim>
class Lattice {
 public:
  /// The primitive vectors of `kind` times `spacing` (a length): chain (1); square (1,0),(0,1); hexagonal
  /// (1,0),(1/2,√3/2); staggered (1,0),(1/2,1), the "face-centred cells" of Gray et al.; cubic (1,0,0),(0,1,0),(0,0,1);
  /// bcc (−1,1,1),(1,−1,1),(1,1,−1) over √3 and fcc (0,1,1),(1,0,1),(1,1,0) over √2, so that spacing is the distance of
  /// nearest neighbours. Throws InvalidInput if spacing is not positive or the kind does not live in `Dim` dimensions.
  Lattice(LatticeKind kind, double spacing);
  /// A `custom` lattice: the columns times `spacing` are its primitive vectors, in any order, of either handedness and
  /// however skewed. Throws InvalidInput (`primitive_vectors`) if they are linearly dependent: if their cell is smaller
  /// than 1e-6 of a box of the same lengths.
  Lattice(const Tensor<Dim>& primitive_in_spacings, double spacing);

  /// Its sites moved to F x; the spacing stays what it was. Throws InvalidInput (`deformation_gradient`) unless
  /// det F > 0.
  Lattice deformed(const Tensor<Dim>& deformation_gradient) const;

  LatticeKind kind() const { return kind_; }
  double spacing() const { return spacing_; }
  /// Columns a_i, lengths.
  const Tensor<Dim>& primitive_vectors() const { return primitive_; }
  /// Columns b_i with a_i · b_j = 2π δ_ij, radians per length.
  const Tensor<Dim>& reciprocal_vectors() const { return reciprocal_; }
  /// Volume of a cell, the volume V of one particle (area in 2-D, length in 1-D).
  double cell_volume() const { return cell_volume_; }
  Vector<Dim> site(const LatticeIndex<Dim>& n) const { return primitive_ * n.template cast<double>(); }

 private:
  Lattice(LatticeKind kind, const Tensor<Dim>& primitive_in_spacings, double spacing);

  LatticeKind kind_;
  double spacing_;
  Tensor<Dim> primitive_;
  Tensor<Dim> reciprocal_;
  double cell_volume_;
};

/// One neighbour of the particle at the origin.
template <int Dim>
struct LatticeNeighbour {
  LatticeIndex<Dim> index;  ///< n of the neighbour's site
  Vector<Dim> position;     ///< Σ n_i a_i
  double distance;
};

/// The supports of two particles end here: r < support · (1 − tie_margin), so that sites on the support do not count.
inline constexpr double tie_margin = 1e-12;

/// The neighbours of a lattice site, itself excluded, ordered by distance, then by index. Both n and −n are present.
/// The search costs the same in whatever basis the lattice is given. Throws InvalidInput naming `smoothing_length` if
/// there is none, or if there are millions.
template <int Dim>
std::vector<LatticeNeighbour<Dim>> lattice_neighbours(const Lattice<Dim>& lattice, double support, NeighbourRule rule);

extern template class Lattice<1>;
extern template class Lattice<2>;
extern template class Lattice<3>;
extern template std::vector<LatticeNeighbour<1>> lattice_neighbours(const Lattice<1>&, double, NeighbourRule);
extern template std::vector<LatticeNeighbour<2>> lattice_neighbours(const Lattice<2>&, double, NeighbourRule);
extern template std::vector<LatticeNeighbour<3>> lattice_neighbours(const Lattice<3>&, double, NeighbourRule);

}  // namespace sphstab
