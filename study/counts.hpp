// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <string_view>

#include "model/case.hpp"

namespace sphstab::study {

/// Bodies, boxes and grids stay far from the range of an int, and from hours of work.
inline constexpr int largest_count = 1000000;

/// The counts of a body, a box or a grid. Throws InvalidInput where they multiply to more than `most`.
template <int Dim>
std::optional<LatticeIndex<Dim>> make_size(const Case& input, std::string_view key, int most = largest_count) {
  const auto counts = make_counts<Dim>(input, key);
  if (counts && counts->template cast<double>().prod() > most)
    throw InvalidInput(fmt::format("{}: {} multiply to more than {}", key,
                                   fmt::join(counts->data(), counts->data() + Dim, ","), most));
  return counts;
}

}  // namespace sphstab::study
