// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "analysis/sine_series.hpp"

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

/// The half zone θ ∈ [0, 2π)^(Dim−1) × [0, π] cut into cells^Dim / 2 boxes, and D · Q D at the centre of each, from
/// tables of multiples of one angle: one sum per axis, no trigonometric call per box. D is odd, so half a zone tells
/// all.
template <int Dim>
class ZoneGrid {
 public:
  /// Boxes such that type · half_width ≤ `resolution`.
  ZoneGrid(const SineSeries<Dim>& series, const Tensor<Dim>& form, double resolution);

  const std::vector<double>& values() const { return values_; }
  double half_width() const { return half_width_; }
  PhaseBox<Dim> box(std::size_t index) const;

 private:
  std::size_t cells_;
  double half_width_;
  std::vector<double> values_;
};

/// θ, shifted by multiples of 2π into [−π, π).
template <int Dim>
Vector<Dim> wrapped(const Vector<Dim>& phases);

extern template struct PhaseBox<1>;
extern template class ZoneGrid<1>;
extern template Vector<1> wrapped<1>(const Vector<1>&);
extern template struct PhaseBox<2>;
extern template class ZoneGrid<2>;
extern template Vector<2> wrapped<2>(const Vector<2>&);
extern template struct PhaseBox<3>;
extern template class ZoneGrid<3>;
extern template Vector<3> wrapped<3>(const Vector<3>&);

}  // namespace sphstab::analysis
