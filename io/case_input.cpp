// SPDX-License-Identifier: MIT
#include "io/case_input.hpp"

#include <fmt/format.h>

namespace sphstab::io {

using Json = nlohmann::ordered_json;

namespace {

template <class Type, class Value>
Json as(const std::optional<Value>& value) {
  return value ? Json(static_cast<Type>(*value)) : Json();
}

template <class Type>
Json as_list(const std::optional<std::vector<double>>& values) {
  return values ? Json(std::vector<Type>(values->begin(), values->end())) : Json();
}

}  // namespace

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

Json to_json(const Case& input, const Key& key) {
  switch (key.kind) {
    case KeyKind::number:
      return as<double>(input.number(key.name));
    case KeyKind::integer:
      return as<int>(input.number(key.name));
    case KeyKind::numbers:
      return as_list<double>(input.numbers(key.name));
    case KeyKind::integers:
      return as_list<int>(input.numbers(key.name));
    case KeyKind::word:
    case KeyKind::text:
      return as<std::string>(input.word(key.name));
  }
  return {};
}

void set_from_json(Case& input, const Json& object) {
  if (!object.is_object()) throw InvalidInput("case: is not an object of keys and values");
  for (const auto& [key, value] : object.items()) {
    find_key(key);  // an unknown key comes before a value of a wrong kind
    input.set(key, to_value(key, value));
  }
}

}  // namespace sphstab::io
