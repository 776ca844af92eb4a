// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>
#include <span>

#include "model/lattice.hpp"
#include "solver/dual.hpp"
#include "solver/state.hpp"

namespace sphstab::solver {

/// A particle b > a that is or may soon be within the support of a, at r_b + shift of its image.
struct NeighbourCandidate {
  int particle;
  int image;  ///< which shift
};

/// The list reaches this part of the support farther than the support.
inline constexpr double skin_fraction = 0.1;

/// Candidates for neighbours, each pair (and each image of it) once: all pairs closer than the support plus a skin when
/// the list was built. It stays complete until two particles together have moved by the skin, so it is built again when
/// one has moved by more than half of it. Pairs of a particle and its own images are left out: their forces and
/// gradients cancel. The order of the candidates does not depend on where the list was built, so that neither do sums
/// over them. Found by the cells of model/body.hpp among the particles and those of their periodic images that the
/// support reaches. Checked against brute force in tests/solver/test_updated_neighbours.cpp.
template <int Dim>
class NeighbourList {
 public:
  /// The columns of `box` are the periods of a periodic body; none: it is free.
  NeighbourList(double support, const std::optional<Tensor<Dim>>& box);

  /// Builds the list if it no longer holds, and says whether it did. Positions that are no numbers, or infinite, leave
  /// it as it is.
  template <class Scalar>
  bool update(const Field<Dim, Scalar>& position) {
    if (holds(position)) return false;
    built_at_.clear();
    for (const auto& r : position) built_at_.push_back(values_of(r));
    build();
    return true;
  }

  std::span<const NeighbourCandidate> candidates(int a) const {
    return {candidates_.data() + first_[a], candidates_.data() + first_[a + 1]};
  }
  int size() const { return static_cast<int>(candidates_.size()); }
  /// What is added to the position of b to place its image, in the coordinates of positions that are never folded back.
  const Vector<Dim>& shift(int image) const { return shifts_[image]; }

 private:
  template <class Scalar>
  static Vector<Dim> values_of(const Vector<Dim, Scalar>& r) {
    return r.unaryExpr([](const Scalar& x) { return value_of(x); });
  }

  template <class Scalar>
  bool holds(const Field<Dim, Scalar>& position) const {
    if (built_at_.empty()) return false;
    double farthest = 0.0;
    for (std::size_t a = 0; a < position.size(); ++a)
      farthest = std::max(farthest, (values_of(position[a]) - built_at_[a]).squaredNorm());
    return 4.0 * farthest <= skin_ * skin_ || !std::isfinite(farthest);
  }

  void build();
  int image_of(const LatticeIndex<Dim>& periods);

  double reach_;
  double skin_;
  std::optional<Tensor<Dim>> box_;
  Field<Dim> built_at_;
  std::vector<int> first_;
  std::vector<NeighbourCandidate> candidates_;
  std::vector<LatticeIndex<Dim>> periods_;  ///< of each image
  Field<Dim> shifts_;                       ///< of each image, a length
};

extern template class NeighbourList<1>;
extern template class NeighbourList<2>;
extern template class NeighbourList<3>;

}  // namespace sphstab::solver
