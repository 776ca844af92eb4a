// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace sphstab::solver {

/// x + x' ε with ε² = 0: a value and its derivative along one direction. What a run does with duals is what it does
/// with their values, and the derivative is exact to rounding, also where a complex step could not be compared.
/// Checked in tests/solver/test_updated_derivatives.cpp.
struct Dual {
  double value;
  double derivative;

  Dual() = default;
  Dual(double x, double dx = 0.0) : value(x), derivative(dx) {}

  Dual operator-() const { return {-value, -derivative}; }
  Dual& operator+=(const Dual& y) { return *this = {value + y.value, derivative + y.derivative}; }
  Dual& operator-=(const Dual& y) { return *this = {value - y.value, derivative - y.derivative}; }
  Dual& operator*=(const Dual& y) { return *this = {value * y.value, derivative * y.value + value * y.derivative}; }
  Dual& operator/=(const Dual& y) {
    const double quotient = value / y.value;
    return *this = {quotient, (derivative - quotient * y.derivative) / y.value};
  }
};

inline Dual operator+(Dual x, const Dual& y) { return x += y; }
inline Dual operator-(Dual x, const Dual& y) { return x -= y; }
inline Dual operator*(Dual x, const Dual& y) { return x *= y; }
inline Dual operator/(Dual x, const Dual& y) { return x /= y; }
inline bool operator<(const Dual& x, const Dual& y) { return x.value < y.value; }
inline bool operator>(const Dual& x, const Dual& y) { return x.value > y.value; }

inline Dual sqrt(const Dual& x) {
  const double root = std::sqrt(x.value);
  return {root, x.derivative / (2.0 * root)};
}
inline Dual exp(const Dual& x) {
  const double power = std::exp(x.value);
  return {power, power * x.derivative};
}
inline Dual pow(const Dual& x, double n) {
  return {std::pow(x.value, n), n * std::pow(x.value, n - 1.0) * x.derivative};
}
inline Dual sin(const Dual& x) { return {std::sin(x.value), std::cos(x.value) * x.derivative}; }
inline Dual cos(const Dual& x) { return {std::cos(x.value), -std::sin(x.value) * x.derivative}; }

/// The number that decides: a double for every scalar.
inline double value_of(double x) { return x; }
inline double value_of(const Dual& x) { return x.value; }

inline bool isfinite(const Dual& x) { return std::isfinite(x.value) && std::isfinite(x.derivative); }

}  // namespace sphstab::solver

namespace Eigen {

template <>
struct NumTraits<sphstab::solver::Dual> : NumTraits<double> {
  using Real = sphstab::solver::Dual;
  using NonInteger = sphstab::solver::Dual;
  using Nested = sphstab::solver::Dual;
  using Literal = sphstab::solver::Dual;
};

}  // namespace Eigen
