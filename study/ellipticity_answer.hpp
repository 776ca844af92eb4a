// SPDX-License-Identifier: MIT
#pragma once

#include "analysis/ellipticity.hpp"
#include "study/json_values.hpp"

namespace sphstab::study {

/// Of finite strain: whether the law has waves in every direction of the base state. As nothing else can make it grow
/// (analysis/ellipticity.hpp), the answer tells a loss of ellipticity from an instability of the particles.
template <int Dim>
Json ellipticity_answer(const Problem<Dim>& problem) {
  const auto weakest = analysis::weakest_direction(problem);
  return {{"lost", weakest.squared_speed < 0.0},
          {"weakest_direction", components<Dim>(weakest.direction)},
          {"squared_speed", weakest.squared_speed}};
}

}  // namespace sphstab::study
