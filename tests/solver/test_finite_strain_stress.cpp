// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "solver/finite_strain.hpp"
#include "solver/finite_strain_cases.hpp"

using namespace sphstab;
using namespace sphstab::solver;
using namespace sphstab::solver::test;

namespace {

/// Some twenty products and an inverse of numbers of order 1: 50 · 2.2e-16.
constexpr double rounding = 2e-14;

constexpr std::integral_constant<StressMeasure, StressMeasure::corotated> R_S;
constexpr std::integral_constant<StressMeasure, StressMeasure::saint_venant_kirchhoff> F_S;
constexpr std::integral_constant<StressMeasure, StressMeasure::neo_hookean> F_S_neo_hookean;

const Material material = Material::from_young_modulus(density, young_modulus, poisson_ratio);
const double K = material.bulk_modulus(), G = material.shear_modulus();
const LameConstants lame = material.lame(Plane::strain);

/// S of the principal stretches of space, in the bulk modulus of the paper.
Vector<3> principal_stress(StressMeasure measure, const Vector<3>& stretches) {
  const Vector<3> squares = stretches.cwiseAbs2(), ones = Vector<3>::Ones();
  if (measure == StressMeasure::neo_hookean)
    return G * (ones - squares.cwiseInverse()) +
           (K - 2.0 / 3.0 * G) * std::log(stretches.prod()) * squares.cwiseInverse();
  const Vector<3> E = 0.5 * (squares - ones);
  return 2.0 * G * (E - E.sum() / 3.0 * ones) + K * E.sum() * ones;
}

/// Principal stresses of Cauchy, l R S or l F S over J.
Vector<3> principal_cauchy_stress(StressMeasure measure, const Vector<3>& stretches) {
  const Vector<3> weight = measure == StressMeasure::corotated ? stretches : stretches.cwiseAbs2();
  return weight.cwiseProduct(principal_stress(measure, stretches)) / stretches.prod();
}

/// Check(measure, Q, stretches): Q diag(stretches) is a deformation in Dim dimensions.
template <int Dim, class Check>
void for_each_state(const Check& check) {
  for (const auto& stretches : {Vector<3>(1.4, 0.7, 1.1), Vector<3>(0.5, 1.0, 2.0), Vector<3>(1.0, 1.0, 1.0)}) {
    Vector<3> of_the_plane = Vector<3>::Ones();
    of_the_plane.head<Dim>() = stretches.template head<Dim>();
    check(R_S, turn<Dim>(2.0), of_the_plane);
    check(F_S, turn<Dim>(2.0), of_the_plane);
    check(F_S_neo_hookean, turn<Dim>(2.0), of_the_plane);
  }
}

template <int Dim>
void check_cauchy_stress() {
  for_each_state<Dim>([](auto measure, const Tensor<Dim>& Q, const Vector<3>& stretches) {
    const Tensor<Dim> F = Q * stretches.head<Dim>().asDiagonal();
    const Vector<3> principal = principal_cauchy_stress(measure, stretches);
    Tensor<3> expected = principal.asDiagonal();
    expected.topLeftCorner<Dim, Dim>() = Q * principal.head<Dim>().asDiagonal() * Q.transpose();
    CHECK((cauchy_stress<measure>(F, lame) - expected).norm() < rounding * K);
  });
}

template <int Dim>
void check_energy() {
  for_each_state<Dim>([](auto measure, const Tensor<Dim>& Q, const Vector<3>& stretches) {
    if (measure == StressMeasure::corotated) return;
    const Tensor<Dim> F = Q * stretches.head<Dim>().asDiagonal() * turn<Dim>(0.7);
    Tensor<Dim> derivative;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) {
        Tensor<Dim, std::complex<double>> carrying = F.template cast<std::complex<double>>();
        carrying(i, j) += std::complex<double>(0.0, 1e-30);
        derivative(i, j) = energy_density<measure>(carrying, lame).imag() / 1e-30;
      }
    CHECK((first_piola_stress<measure>(F, lame) - derivative).norm() < rounding * K);
  });
}

}  // namespace

TEST_CASE("Cauchy's stress is that of the principal stretches of space, out of the plane too", "[fast]") {
  check_cauchy_stress<1>();
  check_cauchy_stress<2>();
  check_cauchy_stress<3>();
}

TEST_CASE("the stress of F S is the derivative of its energy, which is zero at rest", "[fast]") {
  check_energy<1>();
  check_energy<2>();
  check_energy<3>();
  CHECK(energy_density<F_S>(turn<3>(2.0), lame) == Approx(0.0).margin(rounding * K));
  CHECK(energy_density<F_S_neo_hookean>(turn<3>(2.0), lame) == Approx(0.0).margin(rounding * K));
}

TEST_CASE("the energy of a doubled length is 9/8 λ + 9/4 G, and of a neo-Hookean one 3/2 G − G ln 2 + λ/2 ln² 2",
          "[fast]") {
  const double lambda = K - 2.0 / 3.0 * G, log_2 = std::log(2.0);
  const Tensor<2> F = Vector<2>(1.0, 2.0).asDiagonal();
  CHECK(energy_density<R_S>(F, lame) == Approx(9.0 / 8.0 * lambda + 9.0 / 4.0 * G).epsilon(rounding));
  CHECK(energy_density<F_S_neo_hookean>(F, lame) ==
        Approx(1.5 * G - G * log_2 + 0.5 * lambda * log_2 * log_2).epsilon(rounding));
}

TEST_CASE("R S pushes a particle that is turned inside out back, without a jump; F S lets it pass", "[fast]") {
  const auto across = [](auto measure, double stretch_across) {
    return first_piola_stress<measure>(Tensor<2>(Vector<2>(1.0, stretch_across).asDiagonal()), lame)(1, 1);
  };
  const double flat = -0.5 * lame.p_wave_modulus();  // E_22 = −½ alone
  CHECK(across(R_S, 0.0) == Approx(flat).epsilon(rounding));
  CHECK(across(R_S, -0.1) == Approx(0.99 * flat).epsilon(rounding));
  CHECK(across(F_S, -0.1) == Approx(-0.099 * flat).epsilon(rounding));
}
