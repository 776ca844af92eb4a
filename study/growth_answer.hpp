// SPDX-License-Identifier: MIT
#pragma once

#include <variant>

#include "io/figure.hpp"
#include "study/request.hpp"

namespace sphstab::study {

/// `growth`: how fast the base state grows in continuous time, without damping and viscosity, over the whole zone; of
/// `ul` also what artificial stress makes of it: without it, every ε that stabilises, the smallest of them, and what it
/// leaves of the tension modulus. Where a principal stress is zero both one-sided states. Tested in
/// tests/study/test_growth_answer.cpp.
Json growth_answer(const Case& input, const Request& request);

/// The growth rate of each wave vector over the first Brillouin zone.
io::MapFigure growth_map(const Problem<2>& problem);

/// That map of a case in 2-D, a curve over half the zone in 1-D. Throws InvalidInput (`figure`) in 3-D.
std::variant<io::LineFigure, io::MapFigure> growth_figure(const Case& input);

}  // namespace sphstab::study
