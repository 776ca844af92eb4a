// SPDX-License-Identifier: MIT
#include "io/case_input.hpp"

#include <fmt/format.h>

namespace sphstab::io {
namespace {

using Json = nlohmann::ordered_json;

KeyValue to_value(const std::string& key, const Json& json) {
  if (json.is_number()) return json.get<double>();
  if (json.is_string()) return json.get<std::string>();
  if (json.is_array()) {
    std::vector<double> numbers;
    for (const Json& component : json) {
      if (!component.is_number()) throw InvalidInput(fmt::format("{}: {} is not a number", key, component.dump()));
      numbers.push_back(component.get<double>());
    }
    return numbers;
  }
  throw InvalidInput(fmt::format("{}: {} is no number, word or list of numbers", key, json.dump()));
}

}  // namespace

void set_from_json(Case& input, const Json& object) {
  if (!object.is_object()) throw InvalidInput("case: is not an object of keys and values");
  for (const auto& [key, value] : object.items()) {
    find_key(key);  // an unknown key comes before a value of a wrong kind
    input.set(key, to_value(key, value));
  }
}

}  // namespace sphstab::io
