// SPDX-License-Identifier: MIT
#pragma once

#include "model/material.hpp"

namespace sphstab::study {

enum class BeamEnds { clamped_free, free_free };

/// A uniform beam of rectangular section and unit width that bends in its plane, with the moduli of
/// study/plane_moduli.hpp.
struct Beam {
  double length;
  double height;
  Material material;
  Plane plane;
  BeamEnds ends;
};

/// The `mode`-th positive root x of cos x cosh x = −1 (clamped and free) or 1 (both ends free), counted from 1 without
/// the rigid motions; to rounding for any mode. Tested in tests/study/test_beam_theory.cpp against published roots.
double euler_bernoulli_root(BeamEnds ends, int mode);

/// Natural frequency [Hz] of a slender beam: 2πf = (x/L)² √(EI/ρA) with the root x above, I/A = h²/12.
double euler_bernoulli_frequency(const Beam& beam, int mode);

/// κ = 10(1+ν)/(12+11ν) of a rectangular section: Cowper (1966), The shear coefficient in Timoshenko's beam theory.
double cowper_shear_coefficient(const Material& material, Plane plane);

/// Natural frequency [Hz], `mode` counted from 1 without the rigid motions, of Timoshenko's beam (1921) with deflection
/// w and rotation φ of the section:
///   ρA ẅ = (κGA (w' − φ))',   ρI φ̈ = (EI φ')' + κGA (w' − φ),
/// clamped: w = φ = 0, free: φ' = w' − φ = 0. Both of its spectra count. Bisected on the exact number of modes below a
/// frequency, so that none is missed however close they lie; accurate to 1e-12. Throws InvalidInput
/// unless lengths and κ are positive and the mode is at least 1. Tested in tests/study/test_beam_theory.cpp against the
/// Ritz method, the characteristic equations of Huang (1961) and the limit of slender beams.
double timoshenko_frequency(const Beam& beam, int mode, double shear_coefficient);

/// The same with Cowper's shear coefficient.
double timoshenko_frequency(const Beam& beam, int mode);

}  // namespace sphstab::study
