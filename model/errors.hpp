// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>

namespace sphstab {

/// Wrong input by the user. The message is one line that names the key, the value given and what is allowed.
class InvalidInput : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace sphstab
