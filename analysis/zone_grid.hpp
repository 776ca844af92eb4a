// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "analysis/sine_series.hpp"
#include "analysis/zone_domain.hpp"

namespace sphstab::analysis {

/// Boxes of a grid that fit into memory, at some 50 bytes each.
inline constexpr double largest_zone_grid = 3e7;

/// How many boxes a grid of this resolution has.
template <int Dim>
double zone_grid_size(const SineSeries<Dim>& series, const ZoneDomain<Dim>& domain, double resolution);

/// The cube of phases that spans a domain cut into boxes, and D · Q D at the centre of each, from tables of multiples
/// of one angle: one sum per axis, no trigonometric call per box.
template <int Dim>
class ZoneGrid {
 public:
  /// Boxes such that type · half_width ≤ `resolution`. Throws InvalidInput (`smoothing_length`) if they are more than
  /// largest_zone_grid.
  ZoneGrid(const SineSeries<Dim>& series, const Tensor<Dim>& form, const ZoneDomain<Dim>& domain, double resolution);

  const std::vector<double>& values() const { return values_; }
  double half_width() const { return half_width_; }
  PhaseBox<Dim> box(std::size_t index) const;

 private:
  double half_width_;
  std::array<long, Dim> first_;          ///< box j on an axis has its centre at (2 (first + j) + 1) half_width
  std::array<std::size_t, Dim> points_;  ///< boxes on each axis
  std::vector<double> values_;
};

extern template double zone_grid_size(const SineSeries<1>&, const ZoneDomain<1>&, double);
extern template class ZoneGrid<1>;
extern template double zone_grid_size(const SineSeries<2>&, const ZoneDomain<2>&, double);
extern template class ZoneGrid<2>;
extern template double zone_grid_size(const SineSeries<3>&, const ZoneDomain<3>&, double);
extern template class ZoneGrid<3>;

}  // namespace sphstab::analysis
