// SPDX-License-Identifier: MIT
#pragma once

#include "model/integrator.hpp"
#include "model/kernel.hpp"
#include "model/lattice.hpp"
#include "model/material.hpp"
#include "model/scheme.hpp"

namespace sphstab {

/// Everything that a stability question needs to know: what is discretised, by what, and about which base state.
template <int Dim>
struct Problem {
  Lattice<Dim> lattice;
  Kernel<Dim> kernel;
  NeighbourRule neighbour_rule = NeighbourRule::support;
  Material material;
  Plane plane = Plane::strain;
  Scheme scheme = {};
  Integrator integrator = Integrator::leapfrog;
  /// Base state of `tl-linear`: displacement u(x) = H x; perturbations are added to it.
  Tensor<Dim> displacement_gradient = Tensor<Dim>::Zero();
  /// Base state of `tl-corotated` and `tl-pk1`: x = F0 X; perturbations are added to it.
  Tensor<Dim> deformation_gradient = Tensor<Dim>::Identity();
  /// Base state of `ul`, σ = −P I + S. The lattice is that of the stressed state, whose density ρ0 + P/c0² a particle
  /// of one cell has.
  double pressure = 0.0;
  Tensor<Dim> deviatoric_stress = Tensor<Dim>::Zero();  ///< S, its components in the modelled directions
};

}  // namespace sphstab
