// SPDX-License-Identifier: MIT
#include "study/report.hpp"

#include <algorithm>
#include <array>

namespace sphstab::study {

const ReportMaker& find_report(std::string_view name) {
  static constexpr std::array<ReportMaker, 4> makers{{{"zhang-plate", zhang_plate_report},
                                                      {"bands", band_report},
                                                      {"stability-tables", stability_tables_report},
                                                      {"hard-cases", hard_cases_report}}};
  const auto found = std::find_if(makers.begin(), makers.end(), [&](const auto& maker) { return maker.name == name; });
  if (found != makers.end()) return *found;
  std::array<std::string_view, makers.size()> names;
  std::transform(makers.begin(), makers.end(), names.begin(), [](const auto& maker) { return maker.name; });
  throw unknown_word("report", name, names);
}

}  // namespace sphstab::study
