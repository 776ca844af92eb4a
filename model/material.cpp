// SPDX-License-Identifier: MIT
#include "model/material.hpp"

#include <fmt/format.h>

#include <cmath>

namespace sphstab {
Material::Material(double density, double bulk_modulus, double shear_modulus, double poisson_ratio,
                   double one_minus_two_nu)
    : density_(density),
      bulk_modulus_(bulk_modulus),
      shear_modulus_(shear_modulus),
      poisson_ratio_(poisson_ratio),
      one_minus_two_nu_(one_minus_two_nu) {
  const auto in_range = [&](double modulus) { return std::isnormal(modulus / density); };
  if (!in_range(shear_modulus) && !(shear_modulus == 0.0 && in_range(bulk_modulus)))
    throw InvalidInput(
        fmt::format("density: {} with this modulus makes a wave speed that leaves the range of a double", density));
}

Material Material::from_young_modulus(double density, double young_modulus, double poisson_ratio) {
  require_positive("density", density);
  require_positive("young_modulus", young_modulus);
  if (!(poisson_ratio > -1.0)) throw InvalidInput(fmt::format("poisson_ratio: {} is not above -1", poisson_ratio));
  if (!(poisson_ratio <= 0.5)) throw InvalidInput(fmt::format("poisson_ratio: {} is above 0.5", poisson_ratio));
  const double one_minus_two_nu = 1.0 - 2.0 * poisson_ratio;
  return {density, young_modulus / (3.0 * one_minus_two_nu), young_modulus / (2.0 * (1.0 + poisson_ratio)),
          poisson_ratio, one_minus_two_nu};
}

Material Material::from_bulk_modulus(double density, double bulk_modulus, double shear_modulus) {
  require_positive("density", density);
  require_positive("bulk_modulus", bulk_modulus);
  require_positive("shear_modulus", shear_modulus);
  return from_moduli(density, bulk_modulus, shear_modulus);
}

Material Material::from_sound_speed(double density, double sound_speed, double shear_modulus) {
  require_positive("density", density);
  require_positive("sound_speed", sound_speed);
  if (!(shear_modulus >= 0.0)) throw InvalidInput(fmt::format("shear_modulus: {} is not at least 0", shear_modulus));
  return from_moduli(density, density * sound_speed * sound_speed, shear_modulus);
}

Material Material::from_moduli(double density, double bulk_modulus, double shear_modulus) {
  const double sum = 3.0 * bulk_modulus + shear_modulus;
  return {density, bulk_modulus, shear_modulus, (1.5 * bulk_modulus - shear_modulus) / sum, 3.0 * shear_modulus / sum};
}

LameConstants Material::lame(Plane plane) const {
  const double two_g_nu = 2.0 * shear_modulus_ * poisson_ratio_;
  switch (plane) {
    case Plane::strain:
      if (!(one_minus_two_nu_ > 0.0))
        throw InvalidInput(fmt::format("poisson_ratio: {} is not below 0.5 (plane strain)", poisson_ratio_));
      return {two_g_nu / one_minus_two_nu_, shear_modulus_, 1.0};
    case Plane::stress:
      return {two_g_nu / (1.0 - poisson_ratio_), shear_modulus_, one_minus_two_nu_ / (1.0 - poisson_ratio_)};
  }
  return {};
}

}  // namespace sphstab
