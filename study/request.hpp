// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "io/files.hpp"
#include "model/case.hpp"

namespace sphstab::study {

/// A result in the keys of the interface, in a fixed order.
using Json = nlohmann::ordered_json;

/// Told now and then which fraction of long work is done, in [0, 1].
using Progress = std::function<void(double fraction)>;

/// What an answer is asked for besides its case.
struct Request {
  Progress progress = nullptr;
  std::vector<std::string> results = {};  ///< the top-level keys that are wanted; empty: all
  io::OutputFolder* folder = nullptr;     ///< for the files that belong to the answer, if they are wanted

  /// Whether a result that costs work of its own is wanted.
  bool wants(std::string_view key) const {
    return results.empty() || std::find(results.begin(), results.end(), key) != results.end();
  }
};

}  // namespace sphstab::study
