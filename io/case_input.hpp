// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include "model/case.hpp"

namespace sphstab::io {

/// Sets every member of a JSON object (a batch line, or a TOML file read into JSON) in the case. Throws InvalidInput
/// for whatever is no key, number, word or list of numbers.
void set_from_json(Case& input, const nlohmann::ordered_json& object);

/// The value of the key of that name in such an object, not yet checked against the key. Throws InvalidInput for what
/// is no number, word or list of numbers.
KeyValue to_value(const std::string& key, const nlohmann::ordered_json& json);

/// The reverse: the value that the case has for the key, its default, or null.
nlohmann::ordered_json to_json(const Case& input, const Key& key);

}  // namespace sphstab::io
