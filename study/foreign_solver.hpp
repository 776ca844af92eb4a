// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "study/bisection.hpp"

namespace sphstab::study {

/// A probe that runs somebody else's program: a shell command in which {time_step} and {steps} are replaced. It prints
/// one amplitude a step (a norm of the perturbation, > 0) as the last word of a line; lines that do not end on a number
/// are passed over. A run that grows, or prints a number that is not finite, may end early and with any status; any
/// other must print as many amplitudes as there are steps and end with status 0. Throws InvalidInput (`command`)
/// otherwise.
GrowthProbe foreign_solver(const std::string& command);

}  // namespace sphstab::study
