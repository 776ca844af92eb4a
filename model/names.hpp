// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "model/errors.hpp"

namespace sphstab {

/// One enumerator beside the word that users write for it.
template <class Enum>
struct Named {
  Enum value;
  std::string_view name;
};

/// The words of an enumeration. Specialised beside each enumeration with a constexpr std::array<Named<Enum>, n> `table`.
template <class Enum>
struct Names;

/// The word users write for `value`.
template <class Enum>
constexpr std::string_view name_of(Enum value) {
  for (const auto& entry : Names<Enum>::table)
    if (entry.value == value) return entry.name;
  return {};
}

/// The enumerator of a word. Throws InvalidInput naming `key`, the word given and the words allowed.
template <class Enum>
Enum from_name(std::string_view key, std::string_view word) {
  std::string allowed;
  for (const auto& entry : Names<Enum>::table) {
    if (entry.name == word) return entry.value;
    allowed += (allowed.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw InvalidInput(std::string(key) + ": '" + std::string(word) + "' is not one of " + allowed);
}

/// All words of an enumeration, in the order of its table.
template <class Enum>
constexpr auto all_names() {
  std::array<std::string_view, Names<Enum>::table.size()> words{};
  for (std::size_t i = 0; i < words.size(); ++i) words[i] = Names<Enum>::table[i].name;
  return words;
}

}  // namespace sphstab
