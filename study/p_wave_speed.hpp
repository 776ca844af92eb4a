// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "model/problem.hpp"

namespace sphstab::study {

/// c_p of an unstressed material: √((λ+2G)/ρ0) of the plane, √((K+4G/3)/ρ0) in `ul`, where it may be a fluid.
template <int Dim>
double p_wave_speed(const Problem<Dim>& problem, const Material& material) {
  const bool updated = problem.scheme.formulation == Formulation::updated_lagrangian;
  const double modulus = updated ? material.p_wave_modulus() : material.lame(problem.plane).p_wave_modulus();
  return std::sqrt(modulus / material.density());
}

/// That of the problem's material, the unit of Courant numbers.
template <int Dim>
double p_wave_speed(const Problem<Dim>& problem) {
  return p_wave_speed(problem, problem.material);
}

}  // namespace sphstab::study
