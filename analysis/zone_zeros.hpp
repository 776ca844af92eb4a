// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "analysis/sine_series.hpp"
#include "analysis/zone_domain.hpp"

namespace sphstab::analysis {

/// The phases θ ≠ 0 in [−π, π)^Dim where every component of a series vanishes.
template <int Dim>
struct ZoneZeros {
  std::vector<Vector<Dim>> phases;
  /// No other zero exists. False where the zeros are lines (neighbours along one direction only), where the series is
  /// below its rounding on whole regions, or when a fixed budget of work or memory is spent; the zeros listed are
  /// certain all the same.
  bool complete;
};

/// All zeros by exclusion over `domain`, whose group must map zeros on zeros. A box about c, of half-width w and radius
/// ρ, is done if
///   |f(c)| > F sin(σ w), F = max |f|: no zero (Duffin and Schaeffer; on the coarse grid), or
///   |J⁻¹f(c)| > ρ + ½|J⁻¹| K ρ² or |f(c)| > |J| ρ + ½ K ρ²: no zero, or
///   |J⁻¹| K r < 1 with r = 2ρ and the Newton iteration from c ends within r: that zero is the only one within r,
/// where |∂²f| ≤ K = |∂²f(c)| + G r within r, G a bound on |∂³f|; otherwise it is split. A zero counts as found where
/// it is certain in spite of rounding δ: σ_min(J)² > 4 K δ (Kantorovich). The points θ_i ∈ {0, π} are zeros of every
/// such series. Tested in tests/analysis/test_zero_energy_modes.cpp.
template <int Dim>
ZoneZeros<Dim> zone_zeros(const SineSeries<Dim>& series, const ZoneDomain<Dim>& domain = {});

extern template ZoneZeros<1> zone_zeros(const SineSeries<1>&, const ZoneDomain<1>&);
extern template ZoneZeros<2> zone_zeros(const SineSeries<2>&, const ZoneDomain<2>&);
extern template ZoneZeros<3> zone_zeros(const SineSeries<3>&, const ZoneDomain<3>&);

}  // namespace sphstab::analysis
