// SPDX-License-Identifier: MIT
#include "solver/polar.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "solver/finite_strain_cases.hpp"
#include "solver/mueller_rotation.hpp"

using namespace sphstab;
using namespace sphstab::solver;
using namespace sphstab::solver::test;

namespace {

/// A singular value decomposition and a product, over a sum of two stretches of at least 1/32 of the largest: 20 · 32 ·
/// 2.2e-16.
constexpr double rounding = 1.4e-13;
/// Central differences of third derivatives along directions of length 1.7 over stretches whose sums are at least 0.5,
/// 6 · (1.7 / 0.5)³ = 240: 240 · (1e-5)² / 6, and 2e-16 / 1e-5.
constexpr double difference_step = 1e-5, difference_tolerance = 4e-9;

constexpr double pi = 3.14159265358979323846;

/// Products Q U of a rotation and a symmetric positive stretch, of all angles, stretches between 1/8 and 8.
template <class Check>
void for_each_deformation(const Check& check) {
  Numbers numbers(8);
  for (const double angle : {0.0, 1e-9, 0.3, 1.5, 2.9, pi - 1e-9, pi})
    for (const double largest : {1.0, 1.01, 3.0, 8.0})
      for (int repeat = 0; repeat < 5; ++repeat) {
        const Vector<3> axis = numbers.vector<3>().normalized(), other_axis = numbers.vector<3>().normalized();
        const Tensor<3> Q = Eigen::AngleAxis<double>(angle, axis).toRotationMatrix();
        const Tensor<3> B = Eigen::AngleAxis<double>(1.0, other_axis).toRotationMatrix();
        const Vector<3> stretches(largest, std::pow(largest, numbers.next()), 1.0 / largest);
        check(Q, Tensor<3>(B * stretches.asDiagonal() * B.transpose()));
      }
}

}  // namespace

TEST_CASE("the rotation of a rotated stretch is that rotation, for every angle", "[fast]") {
  for_each_deformation([](const Tensor<3>& Q, const Tensor<3>& U) {
    CHECK((rotation(Tensor<3>(Q * U)) - Q).norm() < rounding);
    CHECK((rotation(Tensor<3>(U * Q)) - Q).norm() < rounding);
  });
  for (const double angle : {0.0, 0.3, 1.5, 2.9, pi, -2.0}) {
    const Tensor<2> Q = turn<2>(angle);
    CHECK((rotation(Tensor<2>(Q * stretch<2>())) - Q).norm() < rounding);
    CHECK((rotation(Tensor<2>(20.0 * Q)) - Q).norm() < rounding);
  }
  CHECK(rotation(Tensor<1>(3.0))(0, 0) == 1.0);
}

TEST_CASE("the rotation is that of the paper's iteration, for large rotations and stretches", "[fast]") {
  for_each_deformation([](const Tensor<3>& Q, const Tensor<3>& U) {
    const Tensor<3> F = Q * U;
    CHECK((rotation(F) - mueller_rotation(F)).norm() < rounding);
  });
}

TEST_CASE("in a plane, two and three dimensions have the same rotation", "[fast]") {
  for (const double angle : {0.3, 2.9, -2.0}) {
    const Tensor<2> F = turn<2>(angle) * stretch<2>();
    Tensor<3> in_space = Tensor<3>::Identity();
    in_space.topLeftCorner<2, 2>() = F;
    CHECK((rotation(in_space).topLeftCorner<2, 2>() - rotation(F)).norm() < rounding);
  }
}

TEST_CASE("a particle turned inside out keeps a rotation, which does not jump where its volume vanishes", "[fast]") {
  const Tensor<3> Q = turn<3>(1.0);
  for (const double thinnest : {1e-6, 0.0, -1e-6, -0.3}) {
    const Tensor<3> U = Vector<3>(1.3, 0.8, thinnest).asDiagonal();
    CHECK((rotation(Tensor<3>(Q * U)) - Q).norm() < rounding);
    const Tensor<2> flat = turn<2>(1.0) * Vector<2>(1.3, thinnest).asDiagonal();
    CHECK((rotation(flat) - turn<2>(1.0)).norm() < rounding);
  }
  CHECK(rotation(Tensor<1>(-0.3))(0, 0) == 1.0);
}

TEST_CASE("the rotation of what is no number is no number", "[fast]") {
  Tensor<3> F = Tensor<3>::Identity();
  F(1, 2) = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(rotation(F).allFinite());
  CHECK_FALSE(rotation(Tensor<2>(F.bottomRightCorner<2, 2>())).allFinite());
}

TEST_CASE("the complex step gives the derivative of the rotation", "[fast]") {
  Numbers numbers(9);
  const auto check = [&](const auto& F, const auto& D) {
    using Real = std::decay_t<decltype(F)>;
    using Complex = decltype((F * std::complex<double>(1.0)).eval());
    const Complex carrying = F + std::complex<double>(0.0, 1e-30) * D;
    const Real derivative = rotation(carrying).imag() / 1e-30;
    const Real above = rotation(Real(F + difference_step * D)), below = rotation(Real(F - difference_step * D));
    CHECK((derivative - (above - below) / (2.0 * difference_step)).norm() < difference_tolerance);
    CHECK((rotation(carrying).real() - rotation(F)).norm() < rounding);
  };
  for (int repeat = 0; repeat < 5; ++repeat) {
    Tensor<3> D;
    for (int column = 0; column < 3; ++column) D.col(column) = numbers.vector<3>();
    check(large_deformation<3>(), D);
    check(Tensor<3>(large_deformation<3>() * Vector<3>(1.0, 1.0, -0.3).asDiagonal()), D);
    check(large_deformation<2>(), Tensor<2>(D.topLeftCorner<2, 2>()));
  }
}
