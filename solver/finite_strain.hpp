// SPDX-License-Identifier: MIT
#pragma once

#include "solver/polar.hpp"
#include "solver/stress.hpp"

/// Stresses and energies of a deformation gradient F: E = (FᵀF − I)/2, C = FᵀF, J = det F. Two dimensions are plane
/// strain, one is uniaxial strain: the stretch out of the modelled directions is 1. Checked in
/// tests/solver/test_finite_strain_stress.cpp.
namespace sphstab::solver {

/// Which stress the force is the divergence of.
enum class StressMeasure {
  corotated,              ///< R S, S of Saint Venant-Kirchhoff
  saint_venant_kirchhoff, ///< F S
  neo_hookean             ///< F S
};

}  // namespace sphstab::solver
