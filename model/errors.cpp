// SPDX-License-Identifier: MIT
#include "model/errors.hpp"

#include <fmt/format.h>

#include <cmath>

namespace sphstab {

void require_positive(std::string_view key, double value) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw InvalidInput(fmt::format("{}: {} is not a positive finite number", key, value));
}

}  // namespace sphstab
