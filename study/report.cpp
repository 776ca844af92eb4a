// SPDX-License-Identifier: MIT
#include "study/report.hpp"

#include <algorithm>
#include <array>

namespace sphstab::study {

namespace {

constexpr auto makers = std::to_array<ReportMaker>({{"zhang-plate", zhang_plate_report},
                                                    {"zhang-case-1", zhang_case_1_report},
                                                    {"zhang-case-2", zhang_case_2_report},
                                                    {"bands", band_report},
                                                    {"stability-tables", stability_tables_report},
                                                    {"hard-cases", hard_cases_report},
                                                    {"bodies", body_report},
                                                    {"natural-frequencies", natural_frequency_report},
                                                    {"gray-printed-numbers", gray_numbers_report},
                                                    {"swegle", swegle_report},
                                                    {"tension", tension_report},
                                                    {"gray-plate", gray_plate_report},
                                                    {"gray-array", gray_array_report},
                                                    {"softening", softening_report},
                                                    {"growth-runs", growth_runs_report},
                                                    {"tran-duc", tran_duc_report},
                                                    {"turek-hron", turek_hron_report},
                                                    {"free-edges", free_edge_report},
                                                    {"conservation", conservation_report},
                                                    {"speed-vs-error", speed_report}});

}  // namespace

std::vector<std::string_view> report_names() {
  std::vector<std::string_view> names;
  for (const auto& maker : makers) names.push_back(maker.name);
  return names;
}

const ReportMaker& find_report(std::string_view name) {
  const auto found = std::find_if(makers.begin(), makers.end(), [&](const auto& maker) { return maker.name == name; });
  if (found == makers.end()) throw unknown_word("report", name, report_names());
  return *found;
}

}  // namespace sphstab::study
