// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "analysis/critical_step.hpp"
#include "analysis/zone_scan.hpp"
#include "model/problem.hpp"

namespace sphstab::analysis {

/// How a base state grows in continuous time, without damping and viscosity, over the whole Brillouin zone.
template <int Dim>
struct GrowthRange {
  double growth_rate;         ///< max |Re √(−ω²)|, 1 / time; 0 where nothing grows beyond rounding
  CriticalMode<Dim> fastest;  ///< its mode, `omega` being the growth rate; where nothing grows that of the least ω²
  double omega_squared_min;   ///< of the real parts; at most 0, the value at Γ
  double omega_squared_max;
  CriticalMode<Dim> stiffest;  ///< the mode of omega_squared_max
};

/// Of total-Lagrangian schemes the range of BulkModes. Of `ul` by a scan of the zone (ZoneScan) whose local extrema
/// of the largest and the least ω², of the growth rate and of the discriminant of the characteristic polynomial of M
/// are polished: the last because complex ω² can live in tongues narrower than any grid (theory.md §3). Values are
/// right to a few 1e-13 where a maximum is smooth. Tested in tests/analysis/test_growth.cpp.
template <int Dim>
GrowthRange<Dim> growth_range(const Problem<Dim>& problem);

/// Of `ul`, `tl-corotated` and `tl-pk1` over the modes of a scan; of the latter two the cones of directions in which
/// ellipticity is lost (weakest_direction) are searched too, however narrow.
template <int Dim>
GrowthRange<Dim> growth_range(const Problem<Dim>& problem, const ZoneScan<Dim>& scan);

/// A closed interval of ε.
struct EpsilonInterval {
  double from;
  double to;
};

/// The largest ε that `stabilising_epsilon` looks at.
inline constexpr double largest_epsilon = 2.0;

/// A growth rate below this, in units of c_p/Δp, does not count as growth in `stabilising_epsilon`.
inline constexpr double negligible_growth = 1e-6;

/// The ε within [0, largest_epsilon] for which nothing grows, all else as in the problem (ArtificialStress's defaults
/// where it has none); the set need not be an interval (theory.md §3). Empty where none does. Tells how far it is. M is
/// linear in ε. Windows narrower than 0.01 (0.05 in 3-D) can be missed; edges are right to 1e-8. Tested in
/// tests/analysis/test_growth.cpp.
template <int Dim>
std::vector<EpsilonInterval> stabilising_epsilon(const Problem<Dim>& problem,
                                                 const std::function<void(double fraction)>& progress = nullptr);

extern template GrowthRange<1> growth_range(const Problem<1>&);
extern template GrowthRange<1> growth_range(const Problem<1>&, const ZoneScan<1>&);
extern template std::vector<EpsilonInterval> stabilising_epsilon(const Problem<1>&, const std::function<void(double)>&);
extern template GrowthRange<2> growth_range(const Problem<2>&);
extern template GrowthRange<2> growth_range(const Problem<2>&, const ZoneScan<2>&);
extern template std::vector<EpsilonInterval> stabilising_epsilon(const Problem<2>&, const std::function<void(double)>&);
extern template GrowthRange<3> growth_range(const Problem<3>&);
extern template GrowthRange<3> growth_range(const Problem<3>&, const ZoneScan<3>&);
extern template std::vector<EpsilonInterval> stabilising_epsilon(const Problem<3>&, const std::function<void(double)>&);

}  // namespace sphstab::analysis
