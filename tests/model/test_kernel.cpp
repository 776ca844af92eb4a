// SPDX-License-Identifier: MIT
#include "model/kernel.hpp"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

using namespace sphstab;

namespace {

using Precise = boost::multiprecision::cpp_bin_float_50;

/// Knots and coefficients are doubles, so a precise integral of W differs from 1 by the rounding of `normalisation`
/// only.
constexpr double normalisation_tolerance = 1e-14;
/// The differences (50 digits, step 1e-12) are exact to 1e-24. What is measured is the rounding of the double result:
/// the powers of 2 − q of Wendland C6 are up to 70 times their sum and its curvature multiplies them by 10 · 9.
constexpr double derivative_tolerance = 1e-12;
/// A few roundings of the closed integral of each term.
constexpr double constant_tolerance = 4e-15;
constexpr double gaussian_full_cutoff = 12.0;  // exp(-144): nothing is cut off in 50 digits worth speaking of

std::vector<double> knots(KernelFamily family) {
  switch (family) {
    case KernelFamily::cubic_spline:
      return {0, 1, 2};
    case KernelFamily::quartic_spline:
      return {0, 0.5, 1.5, 2.5};
    case KernelFamily::quintic_spline:
      return {0, 1, 2, 3};
    case KernelFamily::gaussian:
      return {0, 3, gaussian_full_cutoff};
    case KernelFamily::wendland_c2:
    case KernelFamily::wendland_c4:
    case KernelFamily::wendland_c6:
    case KernelFamily::sinc_5:
      return {0, 2};
  }
  return {};
}

template <int Dim>
double integral_over_space(const Kernel<Dim>& kernel) {
  const double surface = Dim == 1 ? 2.0 : Dim == 2 ? 2.0 * std::numbers::pi : 4.0 * std::numbers::pi;
  const auto q = knots(kernel.family());
  Precise sum = 0;
  for (std::size_t i = 0; i + 1 < q.size(); ++i)
    sum += boost::math::quadrature::gauss_kronrod<Precise, 61>::integrate(
        [&](const Precise& r) -> Precise { return Precise(kernel.value(r) * pow(r, Dim - 1)); },
        Precise(q[i] * kernel.smoothing_length()), Precise(q[i + 1] * kernel.smoothing_length()), 5, 1e-20);
  return surface * static_cast<double>(sum);
}

template <int Dim>
void check_normalisation() {
  for (const auto& [family, name] : Names<KernelFamily>::table) {
    INFO(name << " in " << Dim << "D");
    const Kernel<Dim> kernel(family, 0.7, gaussian_full_cutoff);
    CHECK(std::abs(integral_over_space(kernel) - 1.0) < normalisation_tolerance);
  }
}

template <int Dim>
void check_derivatives() {
  const Precise step = 1e-12;
  for (const auto& [family, name] : Names<KernelFamily>::table) {
    const Kernel<Dim> kernel(family, 0.7);
    const double scale = kernel.value(0.0);
    // Never at a knot; from well inside to well outside the support; both sides of the switch to the series of sinc-5.
    for (const double q : {0.05, 0.12, 0.13, 0.37, 0.81, 1.23, 1.77, 1.99, 2.31, 2.74, 3.2}) {
      INFO(name << " in " << Dim << "D at q = " << q);
      const double r = q * kernel.smoothing_length();
      const Precise above = Precise(r) + step, below = Precise(r) - step;
      CHECK(std::abs(kernel.slope(r) - static_cast<double>((kernel.value(above) - kernel.value(below)) / (2 * step))) <
            derivative_tolerance * scale / kernel.smoothing_length());
      CHECK(std::abs(kernel.curvature(r) -
                     static_cast<double>((kernel.slope(above) - kernel.slope(below)) / (2 * step))) <
            derivative_tolerance * scale / std::pow(kernel.smoothing_length(), 2));
    }
  }
}

}  // namespace

TEST_CASE("every kernel integrates to one in one, two and three dimensions", "[fast]") {
  check_normalisation<1>();
  check_normalisation<2>();
  check_normalisation<3>();
}

TEST_CASE("slope and curvature of every kernel are the derivatives of its value", "[fast]") {
  check_derivatives<1>();
  check_derivatives<2>();
  check_derivatives<3>();
}

TEST_CASE("kernels vanish from their support on and are flat at the origin", "[fast]") {
  for (const auto& [family, name] : Names<KernelFamily>::table) {
    INFO(name);
    const Kernel<2> kernel(family, 1.3);
    CHECK(kernel.value(kernel.support()) == 0.0);
    CHECK(kernel.slope(kernel.support()) == 0.0);
    CHECK(kernel.curvature(kernel.support()) == 0.0);
    CHECK(kernel.value(0.999 * kernel.support()) > 0.0);
    CHECK(std::abs(kernel.slope(0.0)) < derivative_tolerance * kernel.value(0.0));
  }
}

TEST_CASE("the published normalisation constants come out of the table", "[fast]") {
  constexpr double pi = std::numbers::pi;
  CHECK(Kernel<1>(KernelFamily::cubic_spline, 1).normalisation() == Approx(2.0 / 3.0).epsilon(constant_tolerance));
  CHECK(Kernel<2>(KernelFamily::cubic_spline, 1).normalisation() ==
        Approx(10.0 / (7.0 * pi)).epsilon(constant_tolerance));
  CHECK(Kernel<3>(KernelFamily::cubic_spline, 1).normalisation() == Approx(1.0 / pi).epsilon(constant_tolerance));
  CHECK(Kernel<2>(KernelFamily::quartic_spline, 1).normalisation() ==
        Approx(96.0 / (1199.0 * pi)).epsilon(constant_tolerance));
  CHECK(Kernel<2>(KernelFamily::quintic_spline, 1).normalisation() ==
        Approx(7.0 / (478.0 * pi)).epsilon(constant_tolerance));
  CHECK(Kernel<2>(KernelFamily::wendland_c2, 1).normalisation() ==
        Approx(7.0 / (4.0 * pi)).epsilon(constant_tolerance));
  CHECK(Kernel<2>(KernelFamily::wendland_c4, 1).normalisation() ==
        Approx(9.0 / (4.0 * pi)).epsilon(constant_tolerance));
  CHECK(Kernel<2>(KernelFamily::wendland_c6, 1).normalisation() ==
        Approx(78.0 / (28.0 * pi)).epsilon(constant_tolerance));
}

TEST_CASE("a kernel refuses a smoothing length that is not positive and finite", "[fast]") {
  CHECK_THROWS_AS(Kernel<2>(KernelFamily::gaussian, 0.0), InvalidInput);
  CHECK_THROWS_AS(Kernel<2>(KernelFamily::gaussian, std::nan("")), InvalidInput);
  CHECK_THROWS_AS(Kernel<2>(KernelFamily::gaussian, 1.0, -3.0), InvalidInput);
}
