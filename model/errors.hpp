// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace sphstab {

/// Wrong input by the user. The message is one line that names the key, the value given and what is allowed.
class InvalidInput : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Returns work(); what it throws as InvalidInput goes on with "context: " before its message.
template <class Work>
auto in_context(std::string_view context, const Work& work) {
  try {
    return work();
  } catch (const InvalidInput& error) {
    throw InvalidInput(std::string(context) + ": " + error.what());
  }
}

/// Throws InvalidInput naming the key unless the value is positive and finite.
void require_positive(std::string_view key, double value);

}  // namespace sphstab
