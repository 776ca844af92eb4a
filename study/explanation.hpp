// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "model/case.hpp"

namespace sphstab::study {

/// `dt --explain`: ten lines that lead from the scheme to its limit with the numbers of this case: material,
/// neighbours, symbol (or, in `ul`, base state), worst mode with a drawing of its wave, frequency, integrator, limit or
/// law of growth, and what would help: another kernel, smoothing length or integrator. Fewer where no step is stable.
/// Throws InvalidInput as `dt` does.
std::vector<std::string> explain_time_step(const Case& input);

}  // namespace sphstab::study
