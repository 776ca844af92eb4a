// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <random>

namespace sphstab {

/// A number from [−1, 1), the same on every platform: the 53 upper bits of the next number of the generator, which the
/// standard fixes, as it does not its distributions.
inline double uniform_number(std::mt19937_64& generator) {
  return std::ldexp(static_cast<double>(generator() >> 11), -52) - 1.0;
}

}  // namespace sphstab
