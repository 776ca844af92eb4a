// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "model/problem.hpp"

namespace sphstab::ladder {

struct NamedProblem {
  std::string name;
  Problem<2> problem;
};

/// Every kernel on every lattice, and on every lattice every term of the scheme switched on; moduli, density and
/// spacing are no round numbers, so that no factor is 1 by accident.
std::vector<NamedProblem> every_variant();

/// A problem in plane strain without any optional term.
Problem<2> basic_problem(LatticeKind lattice, KernelFamily kernel, double h_over_spacing);

}  // namespace sphstab::ladder
