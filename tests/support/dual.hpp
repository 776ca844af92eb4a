// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <complex>

namespace sphstab::test {

/// A real number and its derivative along a complex direction: a function of real numbers, written once as a template,
/// gives J u of a Bloch wave u without differences.
struct Dual {
  double value;
  std::complex<double> slope;

  Dual(double number = 0.0, std::complex<double> derivative = 0.0) : value(number), slope(derivative) {}

  Dual& operator+=(const Dual& other) { return *this = *this + other; }
  Dual& operator-=(const Dual& other) { return *this = *this - other; }
  Dual& operator*=(const Dual& other) { return *this = *this * other; }
  Dual& operator/=(const Dual& other) { return *this = *this / other; }

  friend Dual operator-(const Dual& a) { return {-a.value, -a.slope}; }
  friend Dual operator+(const Dual& a, const Dual& b) { return {a.value + b.value, a.slope + b.slope}; }
  friend Dual operator-(const Dual& a, const Dual& b) { return {a.value - b.value, a.slope - b.slope}; }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, a.slope * b.value + a.value * b.slope};
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    return {a.value / b.value, (a.slope - a.value / b.value * b.slope) / b.value};
  }
  friend bool operator<(const Dual& a, const Dual& b) { return a.value < b.value; }

  friend Dual sqrt(const Dual& a) { return {std::sqrt(a.value), 0.5 / std::sqrt(a.value) * a.slope}; }
  friend Dual exp(const Dual& a) { return {std::exp(a.value), std::exp(a.value) * a.slope}; }
  friend Dual sin(const Dual& a) { return {std::sin(a.value), std::cos(a.value) * a.slope}; }
  friend Dual cos(const Dual& a) { return {std::cos(a.value), -std::sin(a.value) * a.slope}; }
  friend Dual pow(const Dual& a, double n) { return {std::pow(a.value, n), n * std::pow(a.value, n - 1.0) * a.slope}; }
};

}  // namespace sphstab::test

template <>
struct Eigen::NumTraits<sphstab::test::Dual> : Eigen::GenericNumTraits<double> {
  using Real = sphstab::test::Dual;
  using NonInteger = sphstab::test::Dual;
  using Nested = sphstab::test::Dual;
  enum { RequireInitialization = 1 };
};

template <class Operation>
struct Eigen::ScalarBinaryOpTraits<sphstab::test::Dual, double, Operation> {
  using ReturnType = sphstab::test::Dual;
};
template <class Operation>
struct Eigen::ScalarBinaryOpTraits<double, sphstab::test::Dual, Operation> {
  using ReturnType = sphstab::test::Dual;
};
