// SPDX-License-Identifier: MIT
#pragma once

#include "analysis/critical_step.hpp"
#include "model/body.hpp"

namespace sphstab::analysis {

/// The operator K of a finite body, d²s/dt² = −K s, s = (s_1, s_2, …) with the components of a particle adjacent:
///   K = N⁻¹ Bᵀ C N⁻¹ B for each particle's strain-displacement rows B (theory.md §2), N = 1 or the kernel normalisation.
/// Dense: for bodies of up to about a thousand particles. `density_in_momentum` frozen only.
template <int Dim>
Eigen::MatrixXd dense_operator(const Problem<Dim>& problem, const Body<Dim>& body);

/// Largest angular frequency of the body and its limit. K is symmetrised in its right inner product (N^½ K N^−½), so
/// that the symmetric eigen-solver applies. The bracket is the eigenvalue's backward error, n ε ‖K‖.
template <int Dim>
struct BodyLimit {
  double critical_time_step;
  Bracket bracket;
  double omega_max;
  std::vector<double> omega;  ///< all angular frequencies, ascending; those of rigid and zero-energy modes are near 0
};

template <int Dim>
BodyLimit<Dim> dense_body_limit(const Problem<Dim>& problem, const Body<Dim>& body);

}  // namespace sphstab::analysis
