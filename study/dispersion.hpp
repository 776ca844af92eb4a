// SPDX-License-Identifier: MIT
#pragma once

#include "io/figure.hpp"
#include "study/request.hpp"

namespace sphstab::study {

/// `dispersion`: the waves at one k (wave_vector, or mode and box), on a grid of the whole zone (grid), or, otherwise,
/// along a path of labelled points (path, path_points). Throws InvalidInput if two of these are given, where a grid has
/// more than a million points, and where path_points do not reach every labelled point.
/// Tested in tests/study/test_dispersion.cpp.
Json dispersion_answer(const Case& input, const Request& request);

/// The answer with a row a point and plain columns: kx …; distance and label along a path; growth_rate; and for each
/// branch i, in the order of omega_squared, branch_i, omega_squared_i (real part), omega_squared_i_im, phase_speed_i,
/// group_speed_i and group_velocity_i_x ….
Json dispersion_rows(const Json& answer);

/// The band figure of a path: ω Δp/c_p of each branch against the length of the path, the growth rate of a branch that
/// grows below zero, and the waves of the continuum with the same base state. Throws InvalidInput where the case asks
/// for no path.
io::LineFigure band_figure(const Case& input);

}  // namespace sphstab::study
