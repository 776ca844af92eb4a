// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "study/request.hpp"

namespace sphstab::study {

/// A case that is easy to get wrong, and what must come out of it by an argument that knows nothing of how the theory
/// is computed: a closed form, a scaling law, an invariance. The value is the critical Courant number Δt_c c_p/Δp of a
/// periodic patch unless the name says otherwise. Checked in tests/hard/test_hard_cases.cpp.
struct HardCase {
  std::string_view group = {};
  std::string name;
  std::string_view expected_from;
  double expected;
  double theory;                   ///< of analysis/
  double theory_tolerance;         ///< relative, of theory to expected
  std::optional<double> run = {};  ///< measured on the solver, where there is something to run
  double run_tolerance = 1e-6;     ///< relative, of run to theory

  /// |theory − expected| and |run − theory| in terms of the expected value and of theory, where these are not 0.
  double theory_difference() const;
  std::optional<double> run_difference() const;
  bool holds() const;
};

struct HardCaseGroup {
  std::string_view name;
  std::vector<std::function<HardCase()>> cases;
};

/// The groups, in the order of the report.
std::vector<std::string_view> hard_case_groups();

/// Theory and runs of the cases of one group.
std::vector<HardCase> hard_cases(std::string_view group);

}  // namespace sphstab::study
