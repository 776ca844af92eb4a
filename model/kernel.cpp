// SPDX-License-Identifier: MIT
#include "model/kernel.hpp"

#include <fmt/format.h>

#include <numbers>

namespace sphstab {
namespace {

constexpr std::array<TruncatedPower, 2> cubic{{{0.25, 2.0, 3}, {-1.0, 1.0, 3}}};
constexpr std::array<TruncatedPower, 3> quartic{{{1.0, 2.5, 4}, {-5.0, 1.5, 4}, {10.0, 0.5, 4}}};
constexpr std::array<TruncatedPower, 3> quintic{{{1.0, 3.0, 5}, {-6.0, 2.0, 5}, {15.0, 1.0, 5}}};

/// (1 − q/2)ⁿ (1 + p₁q + p₂q² + p₃q³) rewritten in powers of 2 − q, so that it vanishes at the support without
/// rounding.
template <std::size_t Terms>
constexpr std::array<TruncatedPower, Terms> wendland(int n, const std::array<double, Terms>& p) {
  std::array<TruncatedPower, Terms> powers{};
  double scale = 1.0;
  for (int i = 0; i < n; ++i) scale *= 0.5;
  for (std::size_t m = 0; m < Terms; ++m) {
    double coefficient = 0.0;  // of (2−q)^m in Σ p_j (2 − (2−q))^j: Σ_j p_j binom(j, m) 2^(j−m) (−1)^m
    for (std::size_t j = m; j < Terms; ++j) {
      double binomial = 1.0;
      for (std::size_t i = 0; i < m; ++i) binomial = binomial * static_cast<double>(j - i) / static_cast<double>(i + 1);
      double power_of_two = 1.0;
      for (std::size_t i = m; i < j; ++i) power_of_two *= 2.0;
      coefficient += p[j] * binomial * power_of_two * (m % 2 == 0 ? 1.0 : -1.0);
    }
    powers[m] = {scale * coefficient, 2.0, n + static_cast<int>(m)};
  }
  return powers;
}

// One-dimensional family (first) and the family for two and three dimensions (second): Wendland 1995, Dehnen & Aly
// 2012.
constexpr auto c2_line = wendland<2>(3, {1.0, 1.5});
constexpr auto c2_space = wendland<2>(4, {1.0, 2.0});
constexpr auto c4_line = wendland<3>(5, {1.0, 2.5, 2.0});
constexpr auto c4_space = wendland<3>(6, {1.0, 3.0, 35.0 / 12.0});
constexpr auto c6_line = wendland<4>(7, {1.0, 3.5, 19.0 / 4.0, 21.0 / 8.0});
constexpr auto c6_space = wendland<4>(8, {1.0, 4.0, 25.0 / 4.0, 4.0});

/// Surface of the unit sphere in d dimensions: ∫ f(|x|) d^dx = surface · ∫ f(r) r^(d−1) dr.
double unit_sphere_surface(int dimension) {
  switch (dimension) {
    case 1:
      return 2.0;
    case 2:
      return 2.0 * std::numbers::pi;
    default:
      return 4.0 * std::numbers::pi;
  }
}

/// ∫ w(q) d^dq of a piecewise polynomial: ∫ (c−q)₊ⁿ q^(d−1) dq = c^(n+d) (d−1)! n! / (n+d)!.
double integral_of_shape(std::span<const TruncatedPower> powers, int dimension) {
  double sum = 0.0;
  for (const auto& term : powers) {
    double integral = term.coefficient;
    for (int i = 0; i < term.exponent + dimension; ++i) integral *= term.knot;
    for (int i = 1; i <= dimension; ++i) integral *= (i < dimension ? i : 1) / static_cast<double>(term.exponent + i);
    sum += integral;
  }
  return unit_sphere_surface(dimension) * sum;
}

/// 1 / ∫ sinc⁵(πq/2) d^dq over q < 2, by quadrature with 50 digits (repeated in tests/model/test_kernel.cpp). Tran-Duc
/// et al. print 0.7103 for d = 2, without the factor 1/h² (errata.md T4).
constexpr std::array<double, 3> sinc_5_normalisation{0.834353713837600304, 0.710379463738679282, 0.617012654222634393};

double support_in_smoothing_lengths(KernelFamily family, double gaussian_cutoff) {
  switch (family) {
    case KernelFamily::gaussian:
      return gaussian_cutoff;
    case KernelFamily::quartic_spline:
      return 2.5;
    case KernelFamily::quintic_spline:
      return 3.0;
    case KernelFamily::cubic_spline:
    case KernelFamily::wendland_c2:
    case KernelFamily::wendland_c4:
    case KernelFamily::wendland_c6:
    case KernelFamily::sinc_5:
      return 2.0;
  }
  return 0.0;
}

}  // namespace

std::span<const TruncatedPower> truncated_powers(KernelFamily family, int dimension) {
  const bool line = dimension == 1;
  switch (family) {
    case KernelFamily::cubic_spline:
      return cubic;
    case KernelFamily::quartic_spline:
      return quartic;
    case KernelFamily::quintic_spline:
      return quintic;
    case KernelFamily::wendland_c2:
      return line ? std::span<const TruncatedPower>(c2_line) : c2_space;
    case KernelFamily::wendland_c4:
      return line ? std::span<const TruncatedPower>(c4_line) : c4_space;
    case KernelFamily::wendland_c6:
      return line ? std::span<const TruncatedPower>(c6_line) : c6_space;
    case KernelFamily::gaussian:
    case KernelFamily::sinc_5:
      return {};
  }
  return {};
}

template <int Dim>
Kernel<Dim>::Kernel(KernelFamily family, double smoothing_length, double gaussian_cutoff)
    : family_(family),
      smoothing_length_(smoothing_length),
      support_in_h_(support_in_smoothing_lengths(family, gaussian_cutoff)),
      powers_(truncated_powers(family, Dim)) {
  require_positive("smoothing_length", smoothing_length);
  require_positive("gaussian_cutoff", gaussian_cutoff);
  const double h_to_d = kernel_shape::integer_power(smoothing_length, Dim);
  if (family == KernelFamily::gaussian)
    normalisation_ = 1.0 / (std::pow(std::numbers::pi, 0.5 * Dim) * h_to_d);
  else if (family == KernelFamily::sinc_5)
    normalisation_ = sinc_5_normalisation[Dim - 1] / h_to_d;
  else
    normalisation_ = 1.0 / (integral_of_shape(powers_, Dim) * h_to_d);
  if (!std::isnormal(normalisation_ / (smoothing_length * smoothing_length)))
    throw InvalidInput(
        fmt::format("smoothing_length: {} makes a kernel that leaves the range of a double", smoothing_length));
}

template class Kernel<1>;
template class Kernel<2>;
template class Kernel<3>;

}  // namespace sphstab
