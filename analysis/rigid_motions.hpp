// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/body.hpp"

namespace sphstab::analysis {

/// The particles of each part of a body that no pair connects to the others.
template <int Dim>
std::vector<std::vector<int>> connected_parts(const NeighbourPairs<Dim>& pairs);

/// Displacements that move each connected part as a rigid one, translations and infinitesimal rotations, a column each,
/// linearly independent: those that leave clamped components where they are. No sum feels a translation; those of Eq. 9
/// feel rotations near a free edge, where Σ V r ⊗ ∇W is no multiple of I, and renormalised ones (finite strain) do not.
/// Tested in tests/analysis/test_body_modes.cpp.
template <int Dim>
Eigen::MatrixXd rigid_motions(const Body<Dim>& body);

extern template std::vector<std::vector<int>> connected_parts(const NeighbourPairs<1>&);
extern template std::vector<std::vector<int>> connected_parts(const NeighbourPairs<2>&);
extern template std::vector<std::vector<int>> connected_parts(const NeighbourPairs<3>&);
extern template Eigen::MatrixXd rigid_motions(const Body<1>&);
extern template Eigen::MatrixXd rigid_motions(const Body<2>&);
extern template Eigen::MatrixXd rigid_motions(const Body<3>&);

}  // namespace sphstab::analysis
