// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string_view>

namespace sphstab {

/// Wrong input by the user. The message is one line that names the key, the value given and what is allowed.
class InvalidInput : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws InvalidInput naming the key unless the value is positive and finite.
void require_positive(std::string_view key, double value);

}  // namespace sphstab
