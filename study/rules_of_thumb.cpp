// SPDX-License-Identifier: MIT
#include "study/rules_of_thumb.hpp"

#include <cmath>

namespace sphstab::study {

std::vector<RuleOfThumb> rules_of_thumb(const Material& material, double smoothing_length, int dimension) {
  const double K = material.bulk_modulus(), G = material.shear_modulus(), rho = material.density();
  const double bulk = smoothing_length / std::sqrt(K / rho);
  const double bulk_in_dimension = smoothing_length / std::sqrt(K * 3.0 / dimension / rho);
  const double p_wave = smoothing_length / std::sqrt((K + 4.0 * G / 3.0) / rho);
  return {{"SPHinXsys AcousticTimeStep", "h / sqrt(K/rho)", bulk, 0.6},
          {"TrixiParticles StepsizeCallback", "h / sqrt(K/rho), K = E/(d(1-2nu))", bulk_in_dimension, std::nullopt},
          {"DualSPHysics FlexStruc", "h / sqrt((K+4G/3)/rho)", p_wave, 0.2},
          {"Radioss SPH cell step", "h / sqrt((K+4G/3)/rho)", p_wave, 0.3}};
}

}  // namespace sphstab::study
