// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "model/errors.hpp"

namespace sphstab {

enum class KeyKind { number, integer, word, numbers, integers, text };

/// What a key describes. A command offers the keys of the groups that it reads.
enum class KeyGroup {
  discretisation,
  material,
  scheme,
  mode,
  path,
  time,
  growth,
  body,
  noise,
  search,
  spectrum,
  run,
  distance,
  artificial_stress
};

/// The interval of the numbers allowed for a key (of every component of a list).
struct Limits {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_allowed = true;
};

/// One key of a case: everything that flags, TOML, JSON and help say about it.
struct Key {
  std::string_view name;  ///< in TOML and JSON; the flag is --name with dashes
  KeyKind kind;
  KeyGroup group;
  std::string_view default_value;  ///< as written on the command line; empty: none
  std::string_view help;
  Limits limits = {};
  std::span<const std::string_view> words = {};
};

/// Every key, in the order of the documentation.
std::span<const Key> key_table();

/// The key of that name. Throws InvalidInput that suggests the nearest name.
const Key& find_key(std::string_view name);

/// A number (integers too), a word or text, or a list of numbers.
using KeyValue = std::variant<double, std::string, std::vector<double>>;

/// The value of a key from its text on the command line; lists are comma-separated. Throws InvalidInput naming the key.
KeyValue parse_value(const Key& key, std::string_view text);

/// Throws InvalidInput naming key, value and what is allowed unless the value has the key's kind and lies in its
/// limits.
void check_value(const Key& key, const KeyValue& value);

}  // namespace sphstab
