// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "model/problem.hpp"

namespace sphstab::study {

/// c_p of the unstressed material, the unit of Courant numbers: √((λ+2G)/ρ0) of the plane, √((K+4G/3)/ρ0) in `ul`,
/// whose material may be a fluid.
template <int Dim>
double p_wave_speed(const Problem<Dim>& problem) {
  const Material& material = problem.material;
  const bool updated = problem.scheme.formulation == Formulation::updated_lagrangian;
  const double modulus = updated ? material.p_wave_modulus() : material.lame(problem.plane).p_wave_modulus();
  return std::sqrt(modulus / material.density());
}

}  // namespace sphstab::study
