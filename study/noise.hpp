// SPDX-License-Identifier: MIT
#pragma once

#include "model/uniform.hpp"
#include "solver/state.hpp"

namespace sphstab::study {

/// Uniform numbers in [−1, 1), the same for a seed on every machine.
template <int Dim>
solver::Field<Dim> noise(int particles, unsigned noise_seed) {
  std::mt19937_64 generator(noise_seed);
  solver::Field<Dim> field(particles);
  for (auto& vector : field)
    for (int i = 0; i < Dim; ++i) vector[i] = uniform_number(generator);
  return field;
}

}  // namespace sphstab::study
