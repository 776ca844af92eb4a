// SPDX-License-Identifier: MIT
#pragma once

#include "model/problem.hpp"

namespace sphstab::analysis {

/// The direction of reference space along which long waves are slowest.
template <int Dim>
struct WeakestDirection {
  Vector<Dim> direction;  ///< a unit vector n
  double squared_speed;   ///< least eigenvalue of Q(n)/ρ0, length² / time²; below 0 where ellipticity is lost
};

/// The least eigenvalue of the acoustic tensor of a finite strain state (`tl-corotated`, `tl-pk1`) over all directions.
/// As ω² is homogeneous in D~, a state grows if and only if it is negative: material instability, a loss of ellipticity
/// that every discretisation of this law shares, and no instability of the particles (theory.md §5). By a scan of the
/// half-sphere whose lowest points are polished; right to rounding of the moduli. Tested in
/// tests/analysis/test_finite_strain.cpp.
template <int Dim>
WeakestDirection<Dim> weakest_direction(const Problem<Dim>& problem);

extern template WeakestDirection<1> weakest_direction(const Problem<1>&);
extern template WeakestDirection<2> weakest_direction(const Problem<2>&);
extern template WeakestDirection<3> weakest_direction(const Problem<3>&);

}  // namespace sphstab::analysis
