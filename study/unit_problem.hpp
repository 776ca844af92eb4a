// SPDX-License-Identifier: MIT
#pragma once

#include "model/problem.hpp"

namespace sphstab::study {

/// The scheme `ul` in units ρ0 = c0 = Δp = 1 with μ = 0.3, under a pressure alone.
template <int Dim>
Problem<Dim> unit_problem(LatticeKind lattice, KernelFamily kernel, double h, double pressure,
                          Integrator integrator = Integrator::leapfrog) {
  constexpr double shear_modulus = 0.3;
  Problem<Dim> problem{.lattice = Lattice<Dim>(lattice, 1.0),
                       .kernel = Kernel<Dim>(kernel, h),
                       .material = Material::from_sound_speed(1.0, 1.0, shear_modulus),
                       .integrator = integrator,
                       .pressure = pressure};
  problem.scheme.formulation = Formulation::updated_lagrangian;
  return problem;
}

/// The same with Gray's artificial stress, n = 4.
template <int Dim>
Problem<Dim> with_artificial_stress(Problem<Dim> problem, double epsilon) {
  problem.scheme.artificial_stress = ArtificialStress{.epsilon = epsilon};
  return problem;
}

}  // namespace sphstab::study
