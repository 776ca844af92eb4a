// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <cmath>

#include "model/material.hpp"

namespace sphstab {

/// Throws InvalidInput (`poisson_ratio`) for a material without bulk modulus: `ul` knows pressures from densities only.
inline void require_compressible(const Material& material) {
  if (!std::isfinite(material.bulk_modulus()))
    throw InvalidInput(fmt::format("poisson_ratio: {} is not below 0.5 (scheme ul)", material.poisson_ratio()));
}

}  // namespace sphstab
