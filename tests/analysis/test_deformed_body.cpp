// SPDX-License-Identifier: MIT
#include "analysis/deformed_body.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>

#include "analysis/body_operator.hpp"
#include "tests/analysis/plain_finite_strain.hpp"

using namespace sphstab;
using namespace sphstab::analysis;
using bodies::applied;
using Catch::Matchers::StartsWith;

namespace {

/// Kernel slopes right to 1e-15 of W(0)/h, renormalised by tensors of condition up to some ten, sums over up to 60
/// terms, products of strained moduli; relative to the largest eigenvalue.
constexpr double rounding_tolerance = 1e-12;
/// Of a spectrum with condition numbers up to some hundred, of 60 unknowns.
constexpr double spectrum_tolerance = 1e-10;
/// Of the strains: F from 0.7 to 1.3 and turned by as much.
constexpr double strain = 0.3;

template <int Dim>
void check_against_differences(const LatticeIndex<Dim>& counts) {
  for (const auto& scheme : bodies::finite_strain_schemes) {
    INFO(Dim << "D, " << name_of(scheme.formulation) << ", " << name_of(scheme.law));
    const auto problem = bodies::finite_strain_problem<Dim>(scheme);
    const auto body = bodies::mixed_block<Dim>(problem, counts, 0.1);
    const Eigen::VectorXd s = bodies::bent(body, strain);
    const Eigen::MatrixXd expected = bodies::PlainFiniteStrain<Dim>(problem, body).stiffness(s);
    DeformedBodyOperator<Dim> op(problem, body);
    op.set_state(s);
    CHECK((applied(op) - expected).norm() < rounding_tolerance * expected.norm());
  }
}

std::vector<std::complex<double>> sorted_spectrum(const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXcd values = matrix.eigenvalues();
  std::vector<std::complex<double>> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end(), [](auto x, auto y) { return x.real() < y.real(); });
  return sorted;
}

}  // namespace

TEST_CASE("the operator about a deformed state is the derivative of the nonlinear force, with 50 digits", "[fast]") {
  check_against_differences<1>(LatticeIndex<1>(12));
  check_against_differences<2>(LatticeIndex<2>(5, 4));
  check_against_differences<3>(LatticeIndex<3>(3, 3, 2));
}

TEST_CASE("about the undeformed state it is the operator of a body", "[fast]") {
  for (const auto& scheme : bodies::finite_strain_schemes) {
    const auto problem = bodies::finite_strain_problem<2>(scheme);
    const auto body = bodies::mixed_block<2>(problem, {6, 5}, 0.2);
    BodyOperator<2> at_rest(problem, body);
    DeformedBodyOperator<2> op(problem, body);
    CHECK((applied(op) - applied(at_rest)).norm() < 2.0 * at_rest.rounding() * std::sqrt(60.0));
    op.set_state(bodies::bent(body, strain));
    CHECK((applied(op) - applied(at_rest)).norm() > 0.01 * applied(at_rest).norm());
  }
}

TEST_CASE("the operator about a deformed state is symmetric where the force has an energy, and not for R·S", "[fast]") {
  for (const auto& scheme : bodies::finite_strain_schemes) {
    const auto problem = bodies::finite_strain_problem<2>(scheme);
    const auto body = bodies::mixed_block<2>(problem, {6, 5}, 0.1);
    DeformedBodyOperator<2> op(problem, body);
    op.set_state(bodies::bent(body, strain));
    const Eigen::MatrixXd K = applied(op);
    const double asymmetry = (K - K.transpose()).norm() / K.norm();
    if (scheme.formulation == Formulation::total_lagrangian_pk1)
      CHECK(asymmetry < rounding_tolerance);
    else
      CHECK(asymmetry > 1e-3);
  }
}

TEST_CASE("a rotation of the whole state leaves its spectrum, in the plane and in space", "[fast]") {
  const auto check = [](auto dimension, const auto& counts, const auto& Q) {
    constexpr int Dim = decltype(dimension)::value;
    for (const auto& scheme : bodies::finite_strain_schemes) {
      INFO(Dim << "D, " << name_of(scheme.formulation) << ", " << name_of(scheme.law));
      const auto problem = bodies::finite_strain_problem<Dim>(scheme);
      const auto body = bodies::block<Dim>(problem, counts, 0.1);
      Eigen::VectorXd s = bodies::bent(body, strain);
      DeformedBodyOperator<Dim> op(problem, body);
      op.set_state(s);
      const auto before = sorted_spectrum(applied(op));
      for (int a = 0; a < body.size(); ++a) {
        const Vector<Dim>& X = body.position[a];
        s.segment<Dim>(a * Dim) = Q * (X + s.segment<Dim>(a * Dim)) - X;
      }
      op.set_state(s);
      const auto after = sorted_spectrum(applied(op));
      for (std::size_t i = 0; i < before.size(); ++i)
        CHECK(std::abs(after[i].real() - before[i].real()) < spectrum_tolerance * before.back().real());
    }
  };
  const Eigen::AngleAxisd turn(2.5, Eigen::Vector3d(1.0, -2.0, 0.5).normalized());
  check(std::integral_constant<int, 2>(), LatticeIndex<2>(6, 5), Eigen::Rotation2Dd(2.5).toRotationMatrix());
  check(std::integral_constant<int, 3>(), LatticeIndex<3>(3, 3, 2), turn.toRotationMatrix());
}

TEST_CASE("a base state is as good as the displacement that makes it", "[fast]") {
  for (const auto& scheme : bodies::finite_strain_schemes) {
    auto problem = bodies::finite_strain_problem<2>(scheme);
    const auto body = bodies::block<2>(problem, {6, 5}, 0.2);
    Tensor<2> F0;
    F0 << 1.2, 0.3, -0.1, 0.9;
    DeformedBodyOperator<2> displaced(problem, body);
    Eigen::VectorXd s(60);
    for (int a = 0; a < body.size(); ++a) s.segment<2>(2 * a) = (F0 - Tensor<2>::Identity()) * body.position[a];
    displaced.set_state(s);
    problem.deformation_gradient = F0;
    DeformedBodyOperator<2> based(problem, body);
    CHECK((applied(based) - applied(displaced)).norm() < rounding_tolerance * applied(based).norm());
  }
}

TEST_CASE("a particle turned inside out is named, and schemes of small strain are refused", "[fast]") {
  auto problem = bodies::finite_strain_problem<2>(bodies::finite_strain_schemes[0]);
  const auto body = bodies::block<2>(problem, {6, 5});
  DeformedBodyOperator<2> op(problem, body);
  Eigen::VectorXd s = Eigen::VectorXd::Zero(60);
  for (int a = 0; a < body.size(); ++a)
    if (body.position[a][0] < 2.5) s[2 * a] = -2.0 * body.position[a][0];
  CHECK_THROWS_WITH(op.set_state(s), StartsWith("displacement: particle 0 is turned inside out, its det F is -"));
  problem.scheme.formulation = Formulation::total_lagrangian_linear;
  CHECK_THROWS_WITH(DeformedBodyOperator<2>(problem, body),
                    "scheme: the spectrum of a deformed body is for tl-corotated and tl-pk1, not tl-linear");
}
