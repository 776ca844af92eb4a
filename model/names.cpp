// SPDX-License-Identifier: MIT
#include "model/names.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace sphstab {
namespace {

/// Levenshtein distance: the fewest insertions, deletions and substitutions that turn one word into the other.
std::size_t edit_distance(std::string_view from, std::string_view to) {
  std::vector<std::size_t> row(to.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < from.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < to.size(); ++j) {
      const std::size_t substitution = diagonal + (from[i] == to[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substitution, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const auto end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

InvalidInput unknown_word(std::string_view what, std::string_view word, std::span<const std::string_view> allowed) {
  const auto nearest = std::min_element(allowed.begin(), allowed.end(), [&](auto left, auto right) {
    return edit_distance(word, left) < edit_distance(word, right);
  });
  return InvalidInput(fmt::format("{}: '{}' is not known; did you mean '{}'? Allowed: {}", what, word, *nearest,
                                  fmt::join(allowed, ", ")));
}

}  // namespace sphstab
