// SPDX-License-Identifier: MIT
#include "study/beam_theory.hpp"

#include <Eigen/Eigenvalues>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/special_functions/legendre.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "model/errors.hpp"

using namespace sphstab;
using study::Beam;
using study::BeamEnds;

namespace {

using std::numbers::pi;

Beam beam(BeamEnds ends, Plane plane, double slenderness) {
  return {.length = 0.5,
          .height = 0.5 / slenderness,
          .material = Material::from_young_modulus(1000.0, 650.0, 0.3),
          .plane = plane,
          .ends = ends};
}

/// E/ρ with E/(1−ν²) for E in plane strain, by the definition.
double squared_bar_speed(const Beam& b) {
  const double E = b.material.young_modulus(), nu = b.material.poisson_ratio();
  return (b.plane == Plane::strain ? E / (1.0 - nu * nu) : E) / b.material.density();
}

/// Frequencies [Hz] by Ritz: w and φ are Legendre polynomials in x, times x where they are clamped, and make
/// ∫ EI φ'² + κGA (w' − φ)² − ω² (ρA w² + ρI φ²) dx stationary. Long double keeps fourteen digits of the lowest.
std::vector<double> ritz_frequencies(const Beam& b, double kappa) {
  using Real = long double;
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  using Row = Eigen::Matrix<Real, 1, Eigen::Dynamic>;
  using Quadrature = boost::math::quadrature::gauss<Real, 40>;
  constexpr int functions = 36;
  const Real L = b.length, EI_over_A = squared_bar_speed(b) * b.height * b.height / 12.0;
  const Real kappa_G = kappa * b.material.shear_modulus() / b.material.density(), I_over_A = b.height * b.height / 12.0;
  Matrix stiffness = Matrix::Zero(2 * functions, 2 * functions), mass = stiffness;
  const auto add_point = [&](Real t, Real weight) {
    Row w = Row::Zero(2 * functions), dw = w, phi = w, dphi = w;
    for (int n = 0; n < functions; ++n) {
      const Real x = 0.5L * L * (1.0L + t), P = boost::math::legendre_p(n, t);
      const Real dP = n == 0 ? 0.0L : boost::math::legendre_p_prime(n, t) * 2.0L / L;
      const bool clamped = b.ends == BeamEnds::clamped_free;
      w[n] = phi[functions + n] = clamped ? x * P : P;
      dw[n] = dphi[functions + n] = clamped ? P + x * dP : dP;
    }
    stiffness += weight * (EI_over_A * dphi.transpose() * dphi + kappa_G * (dw - phi).transpose() * (dw - phi));
    mass += weight * (w.transpose() * w + I_over_A * phi.transpose() * phi);
  };
  for (std::size_t i = 0; i < Quadrature::abscissa().size(); ++i)
    for (const Real t : {Quadrature::abscissa()[i], -Quadrature::abscissa()[i]}) add_point(t, Quadrature::weights()[i]);
  const auto squares = Eigen::GeneralizedSelfAdjointEigenSolver<Matrix>(stiffness, mass, Eigen::EigenvaluesOnly);
  std::vector<double> frequencies;
  for (int n = b.ends == BeamEnds::free_free ? 2 : 0; n < 2 * functions; ++n)
    frequencies.push_back(static_cast<double>(std::sqrt(squares.eigenvalues()[n])) / (2.0 * pi));
  return frequencies;
}

/// The left side of the characteristic equation of T. C. Huang, The effect of rotatory inertia and of shear deformation
/// on the frequency and normal mode equations of uniform beams with simple end conditions (1961), divided by cosh bα.
/// Complex below its square root: beyond b r s = 1 the hyperbolic functions become circular.
double huang(const Beam& b, double kappa, double frequency) {
  using Complex = std::complex<double>;
  const double L = b.length, r2 = b.height * b.height / (12.0 * L * L);
  const double s2 = r2 * squared_bar_speed(b) * b.material.density() / (kappa * b.material.shear_modulus());
  const double p = 2.0 * pi * frequency * L / std::sqrt(squared_bar_speed(b) * r2);
  const double root = std::sqrt((r2 - s2) * (r2 - s2) + 4.0 / (p * p));
  const Complex alpha = std::sqrt(Complex(0.5 * (root - r2 - s2))), cosh = std::cosh(p * alpha);
  const double beta = std::sqrt(0.5 * (root + r2 + s2));
  const Complex sinh_over = std::sinh(p * alpha) / std::sqrt(Complex(1.0 - p * p * r2 * s2));
  const double c = std::cos(p * beta), s = std::sin(p * beta), d = p * p * (r2 - s2) * (r2 - s2);
  const Complex value = b.ends == BeamEnds::clamped_free
                            ? 2.0 + (d + 2.0) * cosh * c - p * (r2 + s2) * sinh_over * s
                            : 2.0 - 2.0 * cosh * c + p * (d * r2 + 3.0 * r2 - s2) * sinh_over * s;
  return (value / std::abs(cosh)).real();
}

constexpr BeamEnds both_ends[] = {BeamEnds::clamped_free, BeamEnds::free_free};
constexpr Plane both_planes[] = {Plane::strain, Plane::stress};

}  // namespace

TEST_CASE("the roots of slender beams are the published ones", "[fast]") {
  constexpr double printed = 0.5e-8;
  CHECK(study::euler_bernoulli_root(BeamEnds::clamped_free, 1) == Approx(1.87510407).margin(printed));
  CHECK(study::euler_bernoulli_root(BeamEnds::clamped_free, 2) == Approx(4.69409113).margin(printed));
  CHECK(study::euler_bernoulli_root(BeamEnds::clamped_free, 3) == Approx(7.85475744).margin(printed));
  CHECK(study::euler_bernoulli_root(BeamEnds::free_free, 1) == Approx(4.73004074).margin(printed));
  CHECK(study::euler_bernoulli_root(BeamEnds::free_free, 2) == Approx(7.85320462).margin(printed));
}

TEST_CASE("the roots of high modes of slender beams go to odd multiples of π/2 and no further", "[fast]") {
  constexpr double rounding = 4e-13;  // of a root near 1600, in absolute terms
  CHECK(study::euler_bernoulli_root(BeamEnds::clamped_free, 500) == Approx(499.5 * pi).margin(rounding).epsilon(0.0));
  CHECK(study::euler_bernoulli_root(BeamEnds::free_free, 500) == Approx(500.5 * pi).margin(rounding).epsilon(0.0));
}

TEST_CASE("the frequency of a slender beam is that of the formula", "[fast]") {
  constexpr double printed_root = 1e-8;                              // of nine digits, squared
  const auto b = beam(BeamEnds::clamped_free, Plane::stress, 50.0);  // h = 0.01, √(E/12ρ) = √(650/12000)
  const double expected = 1.87510407 * 1.87510407 / 0.25 * 0.01 * std::sqrt(650.0 / 12000.0) / (2.0 * pi);
  CHECK(study::euler_bernoulli_frequency(b, 1) == Approx(expected).epsilon(printed_root));
}

TEST_CASE("Cowper's shear coefficient of a rectangle is 5/6 without Poisson's effect", "[fast]") {
  const auto cork = Material::from_young_modulus(1.0, 1.0, 0.0), steel = Material::from_young_modulus(1.0, 1.0, 0.25);
  CHECK(study::cowper_shear_coefficient(cork, Plane::stress) == Approx(5.0 / 6.0));
  CHECK(study::cowper_shear_coefficient(steel, Plane::stress) == Approx(50.0 / 59.0));  // ν = 1/4
  CHECK(study::cowper_shear_coefficient(steel, Plane::strain) == Approx(40.0 / 47.0));  // 1/3 for ν
}

TEST_CASE("the first twelve frequencies of Timoshenko's beam, of both spectra, are those of the Ritz method",
          "[fast]") {
  // The Ritz method loses 12 (L/h)² and a fourth power of the degree, 1e4 · 1e6, of the nineteen digits of long double.
  constexpr double conditioning = 1e-12;
  for (const auto ends : both_ends)
    for (const auto plane : both_planes)
      for (const double slenderness : {1.0, 2.0, 5.0, 20.0})
        for (const double kappa : {5.0 / 6.0, 0.5}) {
          INFO("ends " << int(ends) << ", plane " << int(plane) << ", L/h " << slenderness << ", kappa " << kappa);
          const auto b = beam(ends, plane, slenderness);
          const auto expected = ritz_frequencies(b, kappa);
          for (int mode = 1; mode <= 12; ++mode)
            CHECK(study::timoshenko_frequency(b, mode, kappa) == Approx(expected[mode - 1]).epsilon(conditioning));
        }
}

TEST_CASE("the characteristic equations of Huang change their sign at every frequency of Timoshenko's beam", "[fast]") {
  constexpr double apart = 1e-10;  // of roots, well beyond their rounding
  for (const auto ends : both_ends)
    for (const double slenderness : {1.0, 4.0, 30.0, 1e4})
      for (int mode = 1; mode <= 40; ++mode) {
        INFO("ends " << int(ends) << ", L/h " << slenderness << ", mode " << mode);
        const auto b = beam(ends, Plane::stress, slenderness);
        const double kappa = study::cowper_shear_coefficient(b.material, b.plane);
        const double frequency = study::timoshenko_frequency(b, mode);
        CHECK(huang(b, kappa, frequency * (1.0 - apart)) * huang(b, kappa, frequency * (1.0 + apart)) < 0.0);
      }
}

TEST_CASE("Timoshenko's beam tends to Euler and Bernoulli's with the square of h/L", "[fast]") {
  constexpr double next_order = 0.01;  // at L/h = 200 the next term of the third mode is 0.005 of the first
  for (const auto ends : both_ends)
    for (const auto plane : both_planes)
      for (const int mode : {1, 2, 3}) {
        INFO("ends " << int(ends) << ", plane " << int(plane) << ", mode " << mode);
        const auto deficit = [&](double slenderness) {
          const auto b = beam(ends, plane, slenderness);
          return 1.0 - study::timoshenko_frequency(b, mode) / study::euler_bernoulli_frequency(b, mode);
        };
        const double coarse = deficit(200.0), fine = deficit(400.0);
        CHECK(fine > 0.0);
        CHECK(std::log2(coarse / fine) == Approx(2.0).margin(next_order));
      }
}

TEST_CASE("Timoshenko's beam bends as finite elements do, even twice as long as high", "[fast]") {
  // reports/natural-frequencies/finite_elements.csv: the first two bending modes of Table 2's free rectangle.
  constexpr double theory_of_beams = 0.005;  // sections that stay plane cost up to 0.43 % at L/h = 2
  Beam rectangle = beam(BeamEnds::free_free, Plane::stress, 2.0);
  rectangle.length = 5e-4;
  rectangle.height = 2.5e-4;
  CHECK(study::timoshenko_frequency(rectangle, 1) == Approx(525.573).epsilon(theory_of_beams));
  CHECK(study::timoshenko_frequency(rectangle, 2) == Approx(878.9059).epsilon(theory_of_beams));
  rectangle.plane = Plane::strain;
  CHECK(study::timoshenko_frequency(rectangle, 1) == Approx(546.2386).epsilon(theory_of_beams));
  CHECK(study::timoshenko_frequency(rectangle, 2) == Approx(892.2145).epsilon(theory_of_beams));
}

TEST_CASE("beams without length, height, shear coefficient or mode are refused", "[fast]") {
  auto b = beam(BeamEnds::free_free, Plane::stress, 2.0);
  CHECK_THROWS_WITH(study::timoshenko_frequency(b, 0), "mode: 0 is not at least 1");
  CHECK_THROWS_WITH(study::euler_bernoulli_root(b.ends, -1), "mode: -1 is not at least 1");
  CHECK_THROWS_WITH(study::timoshenko_frequency(b, 1, 0.0), Catch::StartsWith("shear_coefficient: 0"));
  b.height = 0.0;
  CHECK_THROWS_WITH(study::euler_bernoulli_frequency(b, 1), Catch::StartsWith("height: 0"));
  b.length = -1.0;
  CHECK_THROWS_WITH(study::timoshenko_frequency(b, 1), Catch::StartsWith("length: -1"));
}
