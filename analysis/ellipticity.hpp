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

/// Whether a material strained by F has waves in every direction: whether `weakest_direction` would be above 0, to 1e-7
/// of the moduli, without a search. Along the principal axes of U, F = R U, Q(n) of an isotropic law is a diagonal
/// matrix and n_i n_k a_ik, which reflections n_i → −n_i leave alike: det Q is a polynomial of degree Dim in the
/// squares p_i = n_i², which are a segment or a triangle. The eigenvalues being real (acoustic_tensor), they are all
/// positive if and only if they are along the axes and det Q > 0 everywhere; and a polynomial is between the least and
/// the largest of its Bernstein coefficients, the closer the smaller the parts into which the triangle is cut. False
/// where det F is not above 0 or F is no number. Tested in tests/analysis/test_ellipticity.cpp.
template <int Dim>
bool is_elliptic(const Scheme& scheme, const LameConstants& lame, const Tensor<Dim>& F);

extern template WeakestDirection<1> weakest_direction(const Problem<1>&);
extern template bool is_elliptic(const Scheme&, const LameConstants&, const Tensor<1>&);
extern template WeakestDirection<2> weakest_direction(const Problem<2>&);
extern template bool is_elliptic(const Scheme&, const LameConstants&, const Tensor<2>&);
extern template WeakestDirection<3> weakest_direction(const Problem<3>&);
extern template bool is_elliptic(const Scheme&, const LameConstants&, const Tensor<3>&);

}  // namespace sphstab::analysis
