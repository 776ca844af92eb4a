// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <span>

#include "model/names.hpp"

namespace sphstab {

/// The smoothing kernels W(r, h) = (α_d / h^d) w(q), q = r / h.
enum class KernelFamily {
  cubic_spline,
  quartic_spline,
  quintic_spline,
  gaussian,
  wendland_c2,
  wendland_c4,
  wendland_c6,
  sinc_5
};

template <>
struct Names<KernelFamily> {
  static constexpr std::array<Named<KernelFamily>, 8> table{{{KernelFamily::cubic_spline, "cubic-spline"},
                                                             {KernelFamily::quartic_spline, "quartic-spline"},
                                                             {KernelFamily::quintic_spline, "quintic-spline"},
                                                             {KernelFamily::gaussian, "gaussian"},
                                                             {KernelFamily::wendland_c2, "wendland-c2"},
                                                             {KernelFamily::wendland_c4, "wendland-c4"},
                                                             {KernelFamily::wendland_c6, "wendland-c6"},
                                                             {KernelFamily::sinc_5, "sinc-5"}}};
};

/// The Gaussian is cut at this many smoothing lengths unless the case says otherwise.
inline constexpr double default_gaussian_cutoff = 3.0;

/// One term a (c − q)₊ⁿ of a piecewise polynomial kernel shape.
struct TruncatedPower {
  double coefficient;
  double knot;
  int exponent;
};

/// The terms of a spline or Wendland shape w(q) in `dimension` dimensions (1-D Wendland kernels are the one-dimensional
/// family); empty for the Gaussian and sinc-5, which are no piecewise polynomials.
std::span<const TruncatedPower> truncated_powers(KernelFamily family, int dimension);

/// A smoothing kernel with its smoothing length.
///
/// W(r) = normalisation() · w(r / h), w in the form the literature prints:
///   cubic     ¼(2−q)₊³ − (1−q)₊³                         quartic  (5/2−q)₊⁴ − 5(3/2−q)₊⁴ + 10(1/2−q)₊⁴
///   quintic   (3−q)₊⁵ − 6(2−q)₊⁵ + 15(1−q)₊⁵             gaussian exp(−q²), q < cutoff, not renormalised
///   Wendland  C2, C4, C6 with support 2h: (1−q/2)₊ⁿ p(q)  sinc-5   [sin(πq/2) / (πq/2)]⁵, q < 2 (Cabezón et al.)
/// All are zero from the support on. Accuracy of value, slope and curvature: 1e-12 of W(0), W(0)/h and W(0)/h²
/// (Wendland C6 near the origin; ten times better elsewhere).
/// Templates on the scalar so that duals and multiprecision numbers pass through. Tested in
/// tests/model/test_kernel.cpp.
template <int Dim>
class Kernel {
 public:
  /// Throws InvalidInput unless smoothing_length and gaussian_cutoff are positive and finite.
  Kernel(KernelFamily family, double smoothing_length, double gaussian_cutoff = default_gaussian_cutoff);

  KernelFamily family() const { return family_; }
  double smoothing_length() const { return smoothing_length_; }
  /// Radius of the support, a length.
  double support() const { return support_in_h_ * smoothing_length_; }
  /// α_d / h^d, in 1 / length^d.
  double normalisation() const { return normalisation_; }

  /// W(r), in 1 / length^d; r ≥ 0 is a distance.
  template <class Scalar>
  Scalar value(const Scalar& r) const {
    return normalisation_ * shape<0>(Scalar(r / smoothing_length_));
  }
  /// dW/dr.
  template <class Scalar>
  Scalar slope(const Scalar& r) const {
    return normalisation_ / smoothing_length_ * shape<1>(Scalar(r / smoothing_length_));
  }
  /// d²W/dr².
  template <class Scalar>
  Scalar curvature(const Scalar& r) const {
    return normalisation_ / (smoothing_length_ * smoothing_length_) * shape<2>(Scalar(r / smoothing_length_));
  }

 private:
  template <int Derivative, class Scalar>
  Scalar shape(const Scalar& q) const;

  KernelFamily family_;
  double smoothing_length_;
  double support_in_h_;
  double normalisation_;
  std::span<const TruncatedPower> powers_;
};

namespace kernel_shape {

template <class Scalar>
Scalar integer_power(const Scalar& base, int exponent) {
  Scalar product(1.0);
  for (int i = 0; i < exponent; ++i) product = product * base;
  return product;
}

/// d-th derivative (d = 0, 1, 2) of Σ a (c − q)₊ⁿ.
template <int Derivative, class Scalar>
Scalar piecewise_polynomial(std::span<const TruncatedPower> powers, const Scalar& q) {
  Scalar sum(0.0);
  for (const auto& term : powers) {
    if (!(q < term.knot)) continue;
    double factor = term.coefficient;
    for (int i = 0; i < Derivative; ++i) factor *= -static_cast<double>(term.exponent - i);
    sum = sum + factor * integer_power(Scalar(term.knot - q), term.exponent - Derivative);
  }
  return sum;
}

/// d-th derivative of exp(−q²).
template <int Derivative, class Scalar>
Scalar gaussian(const Scalar& q) {
  using std::exp;
  const Scalar w = exp(Scalar(-q * q));
  if constexpr (Derivative == 0) return w;
  if constexpr (Derivative == 1) return -2.0 * q * w;
  if constexpr (Derivative == 2) return (4.0 * q * q - 2.0) * w;
}

/// d-th derivative of s(x)⁵, s = sin x / x, x = πq/2. Below x = 0.2 the Taylor series of s to x¹⁰ (truncation < 1e-14)
/// replaces quotients that would cancel.
template <int Derivative, class Scalar>
Scalar sinc_5(const Scalar& q) {
  using std::cos;
  using std::sin;
  const double half_pi = std::acos(0.0);
  const Scalar x = half_pi * q;
  Scalar s, ds, d2s;
  if (x < 0.2) {
    const Scalar y = x * x;
    s = 1.0 - y / 6.0 * (1.0 - y / 20.0 * (1.0 - y / 42.0 * (1.0 - y / 72.0 * (1.0 - y / 110.0))));
    ds = -x / 3.0 * (1.0 - y / 10.0 * (1.0 - y / 28.0 * (1.0 - y / 54.0 * (1.0 - y / 88.0))));
    d2s = -1.0 / 3.0 *
          (1.0 - y * 3.0 / 10.0 * (1.0 - y * 5.0 / 84.0 * (1.0 - y * 7.0 / 270.0 * (1.0 - y / 68.444444444444443))));
  } else {
    s = sin(x) / x;
    ds = (cos(x) - s) / x;
    d2s = -s - 2.0 * ds / x;
  }
  const Scalar s3 = s * s * s;
  if constexpr (Derivative == 0) return s3 * s * s;
  if constexpr (Derivative == 1) return half_pi * 5.0 * s3 * s * ds;
  if constexpr (Derivative == 2) return half_pi * half_pi * 5.0 * s3 * (4.0 * ds * ds + s * d2s);
}

}  // namespace kernel_shape

template <int Dim>
template <int Derivative, class Scalar>
Scalar Kernel<Dim>::shape(const Scalar& q) const {
  if (!(q < support_in_h_)) return Scalar(0.0);
  switch (family_) {
    case KernelFamily::cubic_spline:
    case KernelFamily::quartic_spline:
    case KernelFamily::quintic_spline:
    case KernelFamily::wendland_c2:
    case KernelFamily::wendland_c4:
    case KernelFamily::wendland_c6:
      return kernel_shape::piecewise_polynomial<Derivative>(powers_, q);
    case KernelFamily::gaussian:
      return kernel_shape::gaussian<Derivative>(q);
    case KernelFamily::sinc_5:
      return kernel_shape::sinc_5<Derivative>(q);
  }
  return Scalar(0.0);
}

extern template class Kernel<1>;
extern template class Kernel<2>;
extern template class Kernel<3>;

}  // namespace sphstab
