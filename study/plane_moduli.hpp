// SPDX-License-Identifier: MIT
#pragma once

#include "model/material.hpp"

namespace sphstab::study {

/// E and ν for formulas of plane stress: those of the material in plane stress; E/(1−ν²) and ν/(1−ν) in plane strain.
struct PlaneModuli {
  double young_modulus;
  double poisson_ratio;
};

inline PlaneModuli plane_moduli(const Material& material, Plane plane) {
  const double nu = material.poisson_ratio();
  const double plane_nu = plane == Plane::strain ? nu / (1.0 - nu) : nu;
  return {2.0 * material.shear_modulus() * (1.0 + plane_nu), plane_nu};
}

}  // namespace sphstab::study
