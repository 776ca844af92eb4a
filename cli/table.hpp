// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/case_options.hpp"

namespace sphstab::cli {

struct TableOptions {
  CaseOptions base;
  std::vector<std::string> sweep;
  std::string answer = "dt";
  std::string columns;
  std::optional<std::string> output;
  bool overwrite = false;

  void add_to(CLI::App& app);
};

/// `table`: answers every case of a sweep and prints the rows, or writes them to `output`. While it writes to `output`
/// the finished rows stand in the journal `output`.journal: the same command after an interruption goes on from there.
int run_table(const TableOptions& options, const std::string& format);

}  // namespace sphstab::cli
