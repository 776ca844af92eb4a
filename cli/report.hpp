// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace sphstab::cli {

struct ReportOptions {
  std::string name = "zhang-plate";
  std::string output = "reports";
  bool overwrite = false;
  bool check = false;
};

/// `report`: makes a report, prints its table, and writes its folder below `output` unless it only checks. The exit
/// status says whether every claim holds.
int run_report(const ReportOptions& options);

}  // namespace sphstab::cli
