// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <numbers>

#include "solver/updated_cases.hpp"
#include "solver/updated_stress.hpp"

using namespace sphstab;
using namespace sphstab::solver;
using namespace sphstab::solver::test;

namespace {

/// Ten or so roundings of 1.1e-16, and the 1e-15 of an eigen-solver.
constexpr double rounding = 1e-14;
/// Central differences with steps of 1e-5: 1e-10 of truncation and 1e-11 of rounding, both times derivatives of
/// order 10.
constexpr double difference_error = 1e-8;

/// Q diag(principal) Qᵀ.
template <int Dim>
Tensor<Dim> with_axes(const Tensor<Dim>& Q, const Vector<Dim>& principal) {
  return Q * principal.asDiagonal() * Q.transpose();
}

Tensor<2> rotation(double angle) { return Eigen::Rotation2Dd(angle).toRotationMatrix(); }
Tensor<3> some_rotation() { return Eigen::AngleAxisd(0.7, Vector<3>(1.0, 2.0, -0.5).normalized()).toRotationMatrix(); }

template <int Dim>
Tensor<Dim, Dual> along(const Tensor<Dim>& value, const Tensor<Dim>& derivative) {
  return value.binaryExpr(derivative, [](double x, double dx) { return Dual(x, dx); });
}

template <int Dim>
Tensor<Dim> derivative_of(const Tensor<Dim, Dual>& tensor) {
  return tensor.unaryExpr([](const Dual& x) { return x.derivative; });
}

template <int Dim>
void check_derivative(const Tensor<Dim>& sigma, const Tensor<Dim>& direction) {
  constexpr double step = 1e-5;
  const Tensor<Dim> plus = sigma + step * direction, minus = sigma - step * direction;
  const Tensor<Dim> difference = (positive_part(plus) - positive_part(minus)) / (2.0 * step);
  const Tensor<Dim> derivative = derivative_of<Dim>(positive_part(along<Dim>(sigma, direction)));
  CHECK((derivative - difference).norm() < difference_error);
}

}  // namespace

TEST_CASE("ul: the example of the errata is diagonal in its axes, with the minus sign that (6.3) lacks", "[fast]") {
  // tan 2θ = 2 σxy/(σxx − σyy): 3-4-5 triangle, principal stresses 0.75 ± 2.5, axes at half of atan(4/3).
  const Tensor<2> sigma = (Tensor<2>() << 2.25, 2.0, 2.0, -0.75).finished();
  // c² = (1 + 3/5)/2, s² = (1 − 3/5)/2, sc = (4/5)/2; only 3.25 is positive.
  const Tensor<2> expected = 3.25 * (Tensor<2>() << 0.8, 0.4, 0.4, 0.2).finished();
  CHECK((positive_part(sigma) - expected).norm() < rounding);
  const double density = 2.0, epsilon = 0.3;
  CHECK((artificial_stress<double, 2>(sigma, density, epsilon) + 0.3 / 4.0 * expected).norm() < rounding);
}

TEST_CASE("ul: artificial stress has the axes of the stress and only its tensions", "[fast]") {
  for (const double angle : {0.0, 0.3, 0.25 * std::numbers::pi, 1.2, 0.5 * std::numbers::pi, 2.5})
    for (const Vector<2>& principal : {Vector<2>(2.0, 1.0), Vector<2>(2.0, -1.0), Vector<2>(-2.0, 1.0),
                                       Vector<2>(-2.0, -1.0), Vector<2>(1.0, 0.0), Vector<2>(-1.0, 0.0)}) {
      const Tensor<2> Q = rotation(angle);
      const Tensor<2> expected = with_axes<2>(Q, principal.cwiseMax(0.0));
      CHECK((positive_part(with_axes<2>(Q, principal)) - expected).norm() < rounding);
    }
  for (const Vector<3>& principal : {Vector<3>(2.0, 1.0, 0.5), Vector<3>(2.0, -1.0, 0.5), Vector<3>(-2.0, -1.0, 0.0)}) {
    const Tensor<3> Q = some_rotation();
    CHECK((positive_part(with_axes<3>(Q, principal)) - with_axes<3>(Q, principal.cwiseMax(0.0))).norm() < rounding);
  }
  CHECK(positive_part(Tensor<1>(0.5))[0] == 0.5);
  CHECK(positive_part(Tensor<1>(-0.5))[0] == 0.0);
}

TEST_CASE("ul: equal principal stresses need no axes", "[fast]") {
  CHECK(positive_part(Tensor<2>(0.5 * Tensor<2>::Identity())) == 0.5 * Tensor<2>::Identity());
  CHECK(positive_part(Tensor<2>(-0.5 * Tensor<2>::Identity())) == Tensor<2>::Zero());
  CHECK(positive_part(Tensor<2>(Tensor<2>::Zero())) == Tensor<2>::Zero());
  // Nearly equal: axes are ill-conditioned, the tensor is not.
  const Tensor<2> nearly = (Tensor<2>() << 0.5, 1e-17, 1e-17, 0.5 + 1e-16).finished();
  CHECK((positive_part(nearly) - nearly).norm() == 0.0);
  const Tensor<2, Dual> isotropic = along<2>(0.5 * Tensor<2>::Identity(), (Tensor<2>() << 1, 2, 2, 3).finished());
  CHECK(derivative_of<2>(positive_part(isotropic)) == (Tensor<2>() << 1, 2, 2, 3).finished());
}

TEST_CASE("ul: derivatives of the artificial stress are its differences, turning axes included", "[fast]") {
  Noise noise(1);
  for (int i = 0; i < 20; ++i) {
    check_derivative<1>(Tensor<1>(noise()), Tensor<1>(noise()));
    check_derivative<2>(with_axes<2>(rotation(noise()), {noise() + 1.2, noise() - 1.2}), noise.symmetric<2>());
    check_derivative<2>(with_axes<2>(rotation(noise()), {noise() + 1.2, noise() + 1.2}), noise.symmetric<2>());
    check_derivative<3>(with_axes<3>(some_rotation(), {noise() + 1.2, noise() - 1.2, noise() + 2.0}),
                        noise.symmetric<3>());
    check_derivative<3>(with_axes<3>(some_rotation(), {noise() - 1.2, noise() - 1.2, noise() + 2.0}),
                        noise.symmetric<3>());
  }
}

TEST_CASE("ul: under a spin the stress turns with the material", "[fast]") {
  // S(t) = Q(t) S Q(t)ᵀ with Q(t) = I + ω t + … has the derivative of a rate that does not strain.
  const Tensor<3> spin = (Tensor<3>() << 0.0, -0.3, 0.2, 0.3, 0.0, -0.5, -0.2, 0.5, 0.0).finished();
  const Tensor<3> S = Noise(2).symmetric<3>();
  const Tensor<3, Dual> Q = along<3>(Tensor<3>::Identity(), spin);
  const Tensor<3, Dual> turned = Q * along<3>(S, Tensor<3>::Zero()) * Q.transpose();
  CHECK((jaumann_rate<double, 3>(spin, S, mu) - derivative_of<3>(turned)).norm() < rounding);
}

TEST_CASE("ul: Jaumann rates integrated over a full turn bring the stress back, with first order by Euler steps",
          "[fast]") {
  const Tensor<2> S = (Tensor<2>() << 0.3, 0.2, 0.2, -0.3).finished();
  const Tensor<2> spin = (Tensor<2>() << 0.0, -1.0, 1.0, 0.0).finished();
  const auto error = [&](int steps) {
    Tensor<2> turned = S;
    for (int n = 0; n < steps; ++n)
      turned += 2.0 * std::numbers::pi / steps * jaumann_rate<double, 2>(spin, turned, mu);
    return (turned - S).norm() / S.norm();
  };
  // The deviator turns twice as fast: |1 + 2iω Δt|ⁿ − 1 → 8π²/n, the next term of the order of its square.
  CHECK(error(100000) == Approx(8.0 * std::numbers::pi * std::numbers::pi / 100000).epsilon(0.05));
  CHECK(std::abs(std::log2(error(50000) / error(100000)) - 1.0) < 0.01);
}

TEST_CASE("ul: strain rates give the deviatoric stress of Hooke's law with a third of the trace in every dimension",
          "[fast]") {
  CHECK(jaumann_rate<double, 1>(Tensor<1>(0.3), Tensor<1>(0.7), mu)[0] ==
        Approx(4.0 / 3.0 * mu * 0.3).epsilon(rounding));
  const Tensor<2> shear = (Tensor<2>() << 0.0, 0.2, 0.2, 0.0).finished();
  CHECK((jaumann_rate<double, 2>(shear, Tensor<2>::Zero(), mu) - 2.0 * mu * shear).norm() < rounding);
  const Tensor<2> expansion = 0.3 * Tensor<2>::Identity();
  CHECK((jaumann_rate<double, 2>(expansion, Tensor<2>::Zero(), mu) - 2.0 / 3.0 * mu * expansion).norm() < rounding);
  CHECK(jaumann_rate<double, 3>(0.3 * Tensor<3>::Identity(), Tensor<3>::Zero(), mu).norm() < rounding);
}

TEST_CASE("ul: pressure follows the density, and tension is positive", "[fast]") {
  CHECK(pressure(2.0, 1.5, 4.0) == 2.0);
  const Tensor<2> S = (Tensor<2>() << 0.3, 0.2, 0.2, -0.1).finished();
  CHECK(total_stress<double, 2>(2.0, S) == (Tensor<2>() << -1.7, 0.2, 0.2, -2.1).finished());
}
