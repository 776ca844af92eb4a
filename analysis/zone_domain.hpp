// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "model/tensor.hpp"

namespace sphstab::analysis {

/// A cube of phases: every θ with max |θ_i − centre_i| ≤ half_width.
template <int Dim>
struct PhaseBox {
  Vector<Dim> centre;
  double half_width;

  double radius() const { return half_width * std::sqrt(static_cast<double>(Dim)); }
  /// The cubes of half the width, 2^Dim of them.
  std::array<PhaseBox, 1u << Dim> children() const;
};

/// Phases with normal · θ ≤ offset.
template <int Dim>
struct PhaseHalfSpace {
  Vector<Dim> normal;
  double offset;
};

/// A convex set of phases that holds, of every θ, an equivalent one: under shifts of any phase by 2π and under a group
/// of linear maps that leave unchanged what is searched for.
template <int Dim>
class ZoneDomain {
 public:
  /// The half zone θ ∈ [0, 2π]^(Dim−1) × [0, π] with inversion alone: enough for every odd series.
  ZoneDomain();

  /// The intersection of half-spaces, which spans [low, high].
  ZoneDomain(std::vector<PhaseHalfSpace<Dim>> half_spaces, const Vector<Dim>& low, const Vector<Dim>& high,
             std::vector<Tensor<Dim>> group);

  const Vector<Dim>& low() const { return low_; }
  const Vector<Dim>& high() const { return high_; }
  const std::vector<Tensor<Dim>>& group() const { return group_; }

  /// False only if the box, or the ball about `centre`, lies outside.
  bool touches(const PhaseBox<Dim>& box) const;
  bool touches(const Vector<Dim>& centre, double radius) const;

  /// The centre of every different ball of this radius that is equivalent to the one about `centre` and touches the
  /// domain.
  std::vector<Vector<Dim>> images(const Vector<Dim>& centre, double radius) const;

 private:
  std::vector<PhaseHalfSpace<Dim>> half_spaces_;
  Vector<Dim> low_;
  Vector<Dim> high_;
  std::vector<Tensor<Dim>> group_;
};

/// θ, shifted by multiples of 2π into [−π, π).
template <int Dim>
Vector<Dim> wrapped(const Vector<Dim>& phases);

extern template struct PhaseBox<1>;
extern template class ZoneDomain<1>;
extern template Vector<1> wrapped<1>(const Vector<1>&);
extern template struct PhaseBox<2>;
extern template class ZoneDomain<2>;
extern template Vector<2> wrapped<2>(const Vector<2>&);
extern template struct PhaseBox<3>;
extern template class ZoneDomain<3>;
extern template Vector<3> wrapped<3>(const Vector<3>&);

}  // namespace sphstab::analysis
