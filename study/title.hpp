// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "model/problem.hpp"

namespace sphstab::study {

/// What a figure is of, for its title: lattice, kernel, scheme and base state.
template <int Dim>
std::string title_of(const Problem<Dim>& problem);

}  // namespace sphstab::study
