// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "model/errors.hpp"

namespace sphstab {

/// One enumerator beside the word that users write for it.
template <class Enum>
struct Named {
  Enum value;
  std::string_view name;
};

/// The words of an enumeration. Specialised beside each enumeration with a constexpr std::array<Named<Enum>, n>
/// `table`.
template <class Enum>
struct Names;

/// The parts of a text between separators, empty ones too: one more than there are separators.
std::vector<std::string_view> split(std::string_view text, char separator);

/// The error for a word that is not among those allowed: names what it stands for, and suggests the nearest one.
InvalidInput unknown_word(std::string_view what, std::string_view word, std::span<const std::string_view> allowed);

/// All words of an enumeration, in the order of its table.
template <class Enum>
inline constexpr auto all_names = [] {
  std::array<std::string_view, Names<Enum>::table.size()> words{};
  for (std::size_t i = 0; i < words.size(); ++i) words[i] = Names<Enum>::table[i].name;
  return words;
}();

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
  for (const auto& entry : Names<Enum>::table)
    if (entry.name == word) return entry.value;
  throw unknown_word(key, word, all_names<Enum>);
}

}  // namespace sphstab
