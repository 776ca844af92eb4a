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

std::vector<std::string_view> report_names();

/// The report of that name. Throws InvalidInput that names the reports there are.
const ReportMaker& find_report(std::string_view name);

/// Zhang's Case 1: Eq. 15, the exact bulk limit and bisection on a periodic patch and on the free 20×20 plate, with and
/// without kernel normalisation, against H/Δ.
Report zhang_plate_report(const Progress& progress);

/// Validation Case 1 of Zhang et al. and the stability tests on its plate, Figs. 4-7 and 12-18.
Report zhang_case_1_report(const Progress& progress);

/// Validation Case 2 of Zhang et al., Figs. 9-11.
Report zhang_case_2_report(const Progress& progress);

/// The bands of every named lattice along its standard path, and of a compressed base state that grows.
Report band_report(const Progress& progress);

/// The critical step of tl-linear over kernel, h/Δp and lattice in 1D, 2D and 3D, as Courant numbers, with the rules of
/// thumb of other codes.
Report stability_tables_report(const Progress& progress);

/// Cases that are easy to get wrong (study/hard_cases.hpp): expected value, theory and run of each.
Report hard_cases_report(const Progress& progress);

/// The critical step of whole bodies by their spectrum and by running them; what disorder, edges, normalisation and
/// clamps do to the step of the infinite lattice.
Report body_report(const Progress& progress);

/// Natural frequencies of beams against Timoshenko's theory with observed order, and those of Table 2 of Zhang et al.
/// against finite elements.
Report natural_frequency_report(const Progress& progress);

/// Which lattice, h/Δp and ε of the artificial stress are stable in tension, and what the stress costs.
Report tension_report(const Progress& progress);

/// Swegle's criterion on a chain beside what all neighbours do at k = π/Δp and at any k.
Report swegle_report(const Progress& progress);

/// Growth, critical steps and damping of the running scheme `ul` beside theory: rungs 5 and 6 of the ladder.
Report growth_runs_report(const Progress& progress);

/// Every number, threshold and window of Secs. 4 and 5 of Gray, Monaghan & Swift beside ours, with a verdict.
Report gray_numbers_report(const Progress& progress);

/// Every row of Tables 1 and 2 of Gray et al., the oscillating plate, with and without artificial stress; Figs. 2-5.
Report gray_plate_report(const Progress& progress);

/// Compressed periodic arrays of particles, Fig. 1 and conclusion 4 of Gray et al.
Report gray_array_report(const Progress& progress);

/// The cantilever and the truss of Tran-Duc et al., Secs. 3.1 and 3.2, by four schemes.
Report tran_duc_report(const Progress& progress);

/// The bar of Turek & Hron, CSM1 to CSM3, with a step that follows the limit of the moving bar.
Report turek_hron_report(const Progress& progress);

/// What free, renormalised edges take of the critical step, and which rules of other codes are unsafe there.
Report free_edge_report(const Progress& progress);

/// What `tl-corotated` and `tl-pk1` keep: momentum, angular momentum, energy, and no force under rotations.
Report conservation_report(const Progress& progress);

/// CPU seconds against error, of scenes at rest and of ways to a critical step.
Report speed_report(const Progress& progress);

/// What artificial stress takes of the stiffness of a stretched bar and of a bent beam.
Report softening_report(const Progress& progress);

}  // namespace sphstab::study
