// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "analysis/spectrum.hpp"
#include "model/scene.hpp"
#include "study/beam_theory.hpp"

namespace sphstab::study {

/// A displacement at every place.
using ShapeFunction = std::function<Vector<2>(const Vector<2>& position)>;

/// A mode that was recognised by its shape.
struct RecognisedMode {
  int index;         ///< among the modes, from 0: how many are slower
  double frequency;  ///< Hz
  double likeness;   ///< share of Σ V |s|² of the mode that combinations of the shapes have, at most 1
  analysis::BodyModeKind kind;
};

/// The mode that is most like combinations of the shapes and no rigid one. Zero-energy modes alternate from particle to
/// particle and are like no smooth shape, so that vibrations are found among any number of them.
RecognisedMode recognise(const Body<2>& body, const std::vector<analysis::BodyMode>& modes,
                         const std::vector<ShapeFunction>& shapes);

/// Deflection w of a beam along x, 0 ≤ x ≤ L, in the bending mode of Euler and Bernoulli, w = cosh βx ± cos βx −
/// σ (sinh βx ± sin βx), + for free ends and − for a clamped one at x = 0, β of `euler_bernoulli_root`; and the
/// rotation −y w' of its sections, y from the middle of the beam, which lies in 0 ≤ y ≤ height.
std::vector<ShapeFunction> bending_shapes(const Beam& beam, int mode);

/// A rectangle of particles on the square lattice, `across` over the height of the beam, which lies in 0 ≤ x ≤ L, with
/// h = `h_over_spacing` spacings. A clamped end goes on to x < 0 by as many columns as the kernel reaches, all held:
/// the first particle that moves is half a spacing inside x = 0, the last one that does not half a spacing outside.
Scene<2> beam_of_particles(const Beam& beam, int across, KernelFamily kernel, double h_over_spacing,
                           KernelNormalisation normalisation);

/// What SPH makes of the frequency of a long wave inside a body, whatever its resolution: L/N with L δ_ij =
/// −Σ V x_i ∂_j W of Eq. 9 and Eq. 7 alike, and N the kernel normalisation or 1. Square lattice.
double long_wave_factor(const Problem<2>& problem);

}  // namespace sphstab::study
