// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>

#include "cli/command.hpp"
#include "model/case.hpp"

namespace sphstab::cli {

/// "--smoothing-length" of smoothing_length.
std::string flag_name(std::string_view key);

/// The flags of a command, made from the key table: one for every key of its groups, and --case.
class CaseOptions {
 public:
  void add_to(CLI::App& app, const std::vector<KeyGroup>& groups);

  /// The members of the case file; none without one.
  Json file() const;

  /// The members of a case file with the flags that were given over them.
  Case over(const Json& members) const;

  /// The case for a single answer. Throws InvalidInput where the file describes a sweep.
  Case read() const;

 private:
  std::string case_file_;
  std::map<const Key*, std::string> texts_;
  std::map<const Key*, CLI::Option*> options_;
};

}  // namespace sphstab::cli
