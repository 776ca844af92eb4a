// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "model/problem.hpp"
#include "study/growth_cases.hpp"

namespace sphstab::ladder {

template <int Dim>
struct NamedProblem {
  std::string name;
  Problem<Dim> problem;
};

/// Every kernel on every lattice (in 3D on the cubic one, two on the others), and on every lattice every term of the
/// scheme switched on; moduli, density and spacing are no round numbers, so that no factor is 1 by accident.
template <int Dim>
std::vector<NamedProblem<Dim>> every_variant();

/// A problem in plane strain without any optional term.
template <int Dim>
Problem<Dim> basic_problem(LatticeKind lattice, KernelFamily kernel, double h_over_spacing);

/// L = −V Σ d ⊗ ∇W over the neighbours, summed here: SPH sees H L for the gradient of u = H x, and L k for a long wave
/// k.
template <int Dim>
Tensor<Dim> consistency(const Problem<Dim>& problem);

/// Periodic patches that admit zone centre, boundary and corners, and modes that are none of these.
template <int Dim>
std::vector<LatticeIndex<Dim>> patches();

/// One of them for dense matrices, and one with a few more modes for runs.
template <int Dim>
LatticeIndex<Dim> small_patch();
template <int Dim>
LatticeIndex<Dim> running_patch();

/// What was measured and how far it is from theory.
std::string describe(const study::GrowthCase& found);

}  // namespace sphstab::ladder
