// SPDX-License-Identifier: MIT
#pragma once

#include "analysis/sine_series.hpp"
#include "analysis/zone_domain.hpp"

namespace sphstab::analysis {

/// The maximum of q(θ) = D · Q D over all phases, certified: it lies in [lower, upper], rounding errors included.
template <int Dim>
struct ZoneMaximum {
  Vector<Dim> phases;  ///< where `value` is taken, in the domain or within rounding of it
  double value;
  double lower;
  double upper;
  int evaluations;  ///< of q with its derivatives
};

/// Global maximisation by branch and bound over `domain`, whose group must leave q as it is. With m ≤ q ≤ M and D of
/// exponential type σ, q is at least m + (M − m) cos²(σ d) at max-norm distance d from its maximiser (for m = 0 M.
/// Riesz's bound on Q^½D), and its third derivative is at most 4 R³ (M − m) (Bernstein, q less its middle value being
/// of type 2R). So
///   1. a coarse tabulated grid leaves the boxes where q ≥ m + (best − m) cos²(σ w), w their half-width;
///   2. a Newton iteration gives a local maximum, and a ball about it that the third derivative keeps below it;
///   3. boxes outside such balls are bounded by their second-order expansion at the centre, and split.
/// When a fixed work budget is spent (q nearly constant on a ring, as for wide isotropic kernels) the bounds of the
/// boxes that are left widen `upper`. Otherwise (upper − lower) / value is a few 1e-13 or less. For an indefinite Q, m
/// follows from the maximum of |D|². Tested in tests/analysis/test_zone_maximum.cpp.
template <int Dim>
ZoneMaximum<Dim> zone_maximum(const SineSeries<Dim>& series, const Tensor<Dim>& form,
                              const ZoneDomain<Dim>& domain = {});

extern template ZoneMaximum<1> zone_maximum(const SineSeries<1>&, const Tensor<1>&, const ZoneDomain<1>&);
extern template ZoneMaximum<2> zone_maximum(const SineSeries<2>&, const Tensor<2>&, const ZoneDomain<2>&);
extern template ZoneMaximum<3> zone_maximum(const SineSeries<3>&, const Tensor<3>&, const ZoneDomain<3>&);

}  // namespace sphstab::analysis
