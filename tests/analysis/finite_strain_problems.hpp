// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "model/problem.hpp"

namespace sphstab {

/// K = 2, G = 0.5, so that λ = 5/3; ρ0 = 0.9.
template <int Dim>
Problem<Dim> finite_strain_problem(Formulation formulation, const Lattice<Dim>& lattice, KernelFamily kernel,
                                   double h_over_spacing,
                                   const Tensor<Dim>& deformation_gradient = Tensor<Dim>::Identity()) {
  Problem<Dim> problem{.lattice = lattice,
                       .kernel = Kernel<Dim>(kernel, h_over_spacing * lattice.spacing()),
                       .material = Material::from_bulk_modulus(0.9, 2.0, 0.5)};
  problem.scheme.formulation = formulation;
  problem.deformation_gradient = deformation_gradient;
  return problem;
}

inline Tensor<2> rotation(double angle) {
  Tensor<2> R;
  R << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return R;
}

/// Stretched, sheared and turned.
template <int Dim>
Tensor<Dim> sheared() {
  Tensor<3> F;
  F << 1.1, 0.25, -0.1, -0.15, 0.85, 0.2, 0.05, -0.3, 1.3;
  return F.topLeftCorner<Dim, Dim>();
}

}  // namespace sphstab
