// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <complex>
#include <optional>

#include "model/integrator.hpp"
#include "model/scheme.hpp"

namespace sphstab::analysis {

/// Coefficients of 1, x, x², x³.
using Cubic = std::array<double, 4>;

/// One mode of angular frequency ω under one time step x = Δt: a 2×2 map of (v, s) with trace T and determinant P. The
/// only place where integrator, damping rate c and ω² meet; eigenvalues, limits and growth follow from the two
/// polynomials
///   p = 1 − P  and  τ = 1 − T + P,  so that  λ = 1 − (p+τ)/2 ± √(((p+τ)/2)² − τ)  without cancellation:
///   leapfrog (velocity in −c v the old one)    p = c x           τ = ω²x²
///   verlet (old velocity, then half-step one)  p = c x − c²x²/4  τ = ω²x² (1 − c x/4)
/// Tested in tests/analysis/test_mode_step.cpp.
class ModeStep {
 public:
  ModeStep(Integrator integrator, const std::optional<Damping>& damping, double omega_squared);

  /// The pair of eigenvalues; of a complex pair the modulus is √P to the last digit.
  std::array<std::complex<double>, 2> eigenvalues(double time_step) const;
  double spectral_radius(double time_step) const;
  /// A double eigenvalue on the unit circle, to a few roundings. It is defective always: the map is then no multiple of
  /// I.
  bool defective(double time_step) const;

  /// The largest Δt such that every smaller one has a spectral radius of at most 1 + growth_per_step (Jury's
  /// conditions, scaled); nothing if every Δt has. With growth_per_step = 0 defined for ω² ≥ 0 only. The stable set of
  /// `verlet` with damping need not be an interval: this is its first exit.
  std::optional<double> limit(double growth_per_step = 0.0) const;

  /// Rate of e^{rt} of an unstable mode in continuous time, r² + c r + ω² = 0; zero if ω² ≥ 0.
  double continuous_growth_rate() const;

 private:
  struct Pair {
    double mean;          ///< T/2
    double determinant;   ///< P
    double discriminant;  ///< T²/4 − P
    double tau;
  };
  Pair pair(double time_step) const;

  double damping_rate_;
  double omega_squared_;
  Cubic p_;
  Cubic tau_;
};

}  // namespace sphstab::analysis
