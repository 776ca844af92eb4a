// SPDX-License-Identifier: MIT
#pragma once

#include "model/errors.hpp"

namespace sphstab::analysis {

/// Extreme units can under- or overflow a double on the way; an answer that is none must not look like one. Throws
/// InvalidInput unless `sound`. Tested in tests/analysis/test_critical_step.cpp and test_dispersion.cpp.
inline void require_in_range(bool sound) {
  if (!sound)
    throw InvalidInput("spacing, density and moduli: together they leave the range of a double; choose other units");
}

}  // namespace sphstab::analysis
