// SPDX-License-Identifier: MIT
#pragma once

#include "model/problem.hpp"

namespace sphstab {

/// The scheme `ul` with ρ0 = c0 = Δp = 1.
template <int Dim>
Problem<Dim> updated_problem(LatticeKind lattice, KernelFamily kernel, double smoothing_length, double shear_modulus,
                             double pressure) {
  Problem<Dim> problem{Lattice<Dim>(lattice, 1.0),
                       Kernel<Dim>(kernel, smoothing_length),
                       NeighbourRule::support,
                       Material::from_sound_speed(1.0, 1.0, shear_modulus),
                       Plane::strain,
                       Scheme{},
                       Integrator::predictor_corrector};
  problem.scheme.formulation = Formulation::updated_lagrangian;
  problem.pressure = pressure;
  return problem;
}

}  // namespace sphstab
