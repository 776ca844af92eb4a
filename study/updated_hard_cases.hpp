// SPDX-License-Identifier: MIT
#pragma once

#include "study/hard_cases.hpp"

namespace sphstab::study {

/// The groups of the scheme `ul`, in units ρ0 = c0 = Δp = 1: what is marginal, degenerate or switched. Expected values
/// come from theory.md's formulas with the lattice sums written out, or from another state that must have the same.
std::vector<HardCaseGroup> updated_hard_cases();

}  // namespace sphstab::study
