// SPDX-License-Identifier: MIT
#include "analysis/dynamics.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace sphstab::analysis {

template <int Dim>
Vector<Dim, std::complex<double>> squared_frequencies(const Tensor<Dim>& M, double rounding) {
  using Complex = std::complex<double>;
  Vector<Dim, Complex> values;
  if constexpr (Dim == 2) {
    const double mean = 0.5 * M.trace(), half_difference = 0.5 * (M(0, 0) - M(1, 1)), product = M(0, 1) * M(1, 0);
    const double discriminant = half_difference * half_difference + product;
    const double noise = rounding * (std::abs(half_difference) + std::abs(M(0, 1)) + std::abs(M(1, 0)) + rounding);
    const double root = std::abs(discriminant) <= noise ? 0.0 : std::sqrt(std::abs(discriminant));
    if (discriminant < 0.0) {
      values << Complex(mean, -root), Complex(mean, root);
    } else {
      // det = λ₁ λ₂ gives the smaller one without cancellation.
      const double larger = mean + std::copysign(root, mean);
      const double smaller = larger == 0.0 ? 0.0 : (M(0, 0) * M(1, 1) - product) / larger;
      values << std::min(larger, smaller), std::max(larger, smaller);
    }
  } else if ((M - M.transpose()).cwiseAbs().maxCoeff() <= rounding) {
    const Tensor<Dim> symmetric = 0.5 * (M + M.transpose());
    const Vector<Dim> real = symmetric.template selfadjointView<Eigen::Lower>().eigenvalues();
    values = real.template cast<Complex>();
  } else {
    const Vector<Dim, Complex> complex = M.eigenvalues();
    const double noise = rounding * M.norm();
    std::transform(complex.begin(), complex.end(), values.begin(),
                   [=](Complex value) { return value.imag() * value.imag() <= noise ? Complex(value.real()) : value; });
  }
  for (Complex& value : values)
    if (std::abs(value) <= rounding) value = 0.0;
  std::sort(values.begin(), values.end(), [](const Complex& a, const Complex& b) {
    return a.real() != b.real() ? a.real() < b.real() : a.imag() < b.imag();
  });
  return values;
}

double growth_rate_of(std::complex<double> omega_squared) { return std::abs(std::sqrt(-omega_squared).real()); }

template Vector<1, std::complex<double>> squared_frequencies(const Tensor<1>&, double);
template Vector<2, std::complex<double>> squared_frequencies(const Tensor<2>&, double);
template Vector<3, std::complex<double>> squared_frequencies(const Tensor<3>&, double);

}  // namespace sphstab::analysis
