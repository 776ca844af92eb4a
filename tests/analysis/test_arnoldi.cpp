// SPDX-License-Identifier: MIT
#include "analysis/arnoldi.hpp"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <random>

using namespace sphstab::analysis;

namespace {

/// The residual that is asked for here, times the condition of an eigenvalue of these matrices, relative to the
/// largest.
constexpr double residual_tolerance = 1e-11, value_tolerance = 1e-9;

Eigen::VectorXd random_vector(int size, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Eigen::VectorXd vector(size);
  for (auto& component : vector) component = normal(random);
  return vector;
}

Eigen::MatrixXd random_matrix(int size, unsigned seed) { return random_vector(size * size, seed).reshaped(size, size); }

LinearOperator product(const Eigen::MatrixXd& A) {
  return [&A](const Eigen::VectorXd& x, Eigen::VectorXd& y) { y.noalias() = A * x; };
}

/// The eigenvalue wanted, of a pair the upper one.
std::complex<double> dense(const Eigen::MatrixXd& A, Extreme extreme) {
  const auto rank = [extreme](std::complex<double> value) {
    return extreme == Extreme::outermost   ? std::abs(value)
           : extreme == Extreme::rightmost ? value.real()
                                           : -value.real();
  };
  const Eigen::VectorXcd values = A.eigenvalues();
  std::complex<double> best = values[0];
  for (const auto value : values)
    if (rank(value) > rank(best)) best = value;
  return {best.real(), std::abs(best.imag())};
}

}  // namespace

TEST_CASE("the ends and the rim of the spectra of random matrices are those of the dense solver, pairs and single ones",
          "[fast]") {
  int pairs = 0, single = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Eigen::MatrixXd A = random_matrix(120, seed);
    for (const auto extreme : {Extreme::rightmost, Extreme::leftmost, Extreme::outermost}) {
      const auto expected = dense(A, extreme);
      const auto found =
          arnoldi(product(A), random_vector(120, 99), {.extreme = extreme, .tolerance = residual_tolerance});
      CHECK(std::abs(found.value - expected) < value_tolerance * std::abs(expected));
      CHECK((A * found.vector - found.value * found.vector).norm() < 2.0 * residual_tolerance * found.largest);
      CHECK(found.vector.norm() == Approx(1.0).epsilon(1e-12));
      (expected.imag() > 0.0 ? pairs : single)++;
      CHECK((found.vector.imag().norm() > 0.0) == (expected.imag() > 0.0));
    }
  }
  CHECK(pairs > 5);
  CHECK(single > 5);
}

TEST_CASE("an estimate from few applications has the residual that it states", "[fast]") {
  const Eigen::MatrixXd A = random_matrix(80, 5), B = A * A.transpose() + 5.0 * A;
  for (const int applications : {4, 9, 17}) {
    const auto found = arnoldi(product(B), random_vector(80, 1), {.dimension = 10, .most = applications});
    CHECK(found.applications == applications);
    const double residual = (B * found.vector - found.value * found.vector).norm();
    CHECK(residual > 1e-6 * found.largest);
    CHECK(found.residual == Approx(residual).epsilon(1e-9));
  }
}

TEST_CASE("an eigenvector for a start ends at the first application, a small space as soon as it is exhausted",
          "[fast]") {
  Eigen::MatrixXd A = Eigen::VectorXd::LinSpaced(50, 1.0, 50.0).asDiagonal();
  const auto from_eigenvector = arnoldi(product(A), Eigen::VectorXd::Unit(50, 49), {});
  CHECK(from_eigenvector.applications == 1);
  CHECK(from_eigenvector.value == 50.0);
  const Eigen::MatrixXd small = random_matrix(3, 7);
  const auto whole = arnoldi(product(small), random_vector(3, 1), {.tolerance = 0.0});
  CHECK(whole.applications == 3);
  CHECK(std::abs(whole.value - dense(small, Extreme::rightmost)) < 1e-13);
}
