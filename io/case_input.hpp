// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include "model/case.hpp"

namespace sphstab::io {

/// Sets every member of a JSON object (a batch line, or a TOML file read into JSON) in the case. Throws InvalidInput
/// for whatever is no key, number, word or list of numbers.
void set_from_json(Case& input, const nlohmann::ordered_json& object);

}  // namespace sphstab::io
