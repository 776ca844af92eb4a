// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "study/bisection.hpp"

namespace sphstab::study {

/// A probe that runs somebody else's program: a shell command in which {time_step} and {steps} are replaced. It prints
/// one amplitude a step (a norm of the perturbation, > 0) as the last word of a line; lines that do not end on a number
/// are passed over. Throws InvalidInput (`command`) if it fails, or prints too few amplitudes to be judged.
GrowthProbe foreign_solver(const std::string& command);

}  // namespace sphstab::study
