// SPDX-License-Identifier: MIT
#pragma once

#include "analysis/critical_step.hpp"
#include "model/body.hpp"

namespace sphstab::analysis {

/// The operator K of a finite body, d²s/dt² = −K s, s = (s_1, s_2, …) with the components of a particle adjacent:
///   K = N⁻¹ B* C N⁻¹ B / ρ0, B the sum of Zhang's Eq. 9 (strain of each particle), C σ = 2G ε + γ tr ε, B* the adjoint
///   of
/// B under the particle volumes (minus the sum of Eq. 7), N = 1 or the kernel normalisation V Σ W, W(0) included.
/// Dense: for bodies of up to about a thousand particles. Throws InvalidInput for `density_in_momentum`
/// equation-of-state about a strained state. Tested in tests/analysis/test_body_operator.cpp.
template <int Dim>
Eigen::MatrixXd dense_operator(const Problem<Dim>& problem, const Body<Dim>& body);

/// Largest angular frequency of the body and its limit. (N V)^½ K (N V)^−½ is symmetric, so that the symmetric
/// eigen-solver applies; the bracket is its backward error, n ε ‖K‖. Throws InvalidInput if no particle feels a force.
struct BodyLimit {
  double critical_time_step;
  Bracket bracket;
  double omega_max;
  std::vector<double> omega;  ///< all angular frequencies, ascending; those of rigid and zero-energy modes are near 0
};

template <int Dim>
BodyLimit dense_body_limit(const Problem<Dim>& problem, const Body<Dim>& body);

/// The displacement of the mode of the largest frequency, up to a factor; ordered like s.
template <int Dim>
Eigen::VectorXd critical_displacement(const Problem<Dim>& problem, const Body<Dim>& body);

extern template Eigen::VectorXd critical_displacement(const Problem<1>&, const Body<1>&);
extern template Eigen::MatrixXd dense_operator(const Problem<1>&, const Body<1>&);
extern template BodyLimit dense_body_limit(const Problem<1>&, const Body<1>&);
extern template Eigen::VectorXd critical_displacement(const Problem<2>&, const Body<2>&);
extern template Eigen::MatrixXd dense_operator(const Problem<2>&, const Body<2>&);
extern template BodyLimit dense_body_limit(const Problem<2>&, const Body<2>&);
extern template Eigen::VectorXd critical_displacement(const Problem<3>&, const Body<3>&);
extern template Eigen::MatrixXd dense_operator(const Problem<3>&, const Body<3>&);
extern template BodyLimit dense_body_limit(const Problem<3>&, const Body<3>&);

}  // namespace sphstab::analysis
