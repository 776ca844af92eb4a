// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "study/request.hpp"

namespace sphstab::study {

/// A report: text for the terminal, files for its folder, and every claim that did not hold, a line each.
struct Report {
  std::string summary;
  std::vector<std::pair<std::string, std::string>> files;  ///< name and content
  std::vector<std::string> failures;
};

struct ReportMaker {
  std::string_view name;  ///< of the report and its folder
  Report (*make)(const Progress& progress);
};

/// The report of that name. Throws InvalidInput that names the reports there are.
const ReportMaker& find_report(std::string_view name);

/// Zhang's Case 1: Eq. 15, the exact bulk limit and bisection on a periodic patch and on the free 20×20 plate, with and
/// without kernel normalisation, against H/Δ.
Report zhang_plate_report(const Progress& progress);

/// Cases that are easy to get wrong (study/hard_cases.hpp): expected value, theory and run of each.
Report hard_cases_report(const Progress& progress);

}  // namespace sphstab::study
