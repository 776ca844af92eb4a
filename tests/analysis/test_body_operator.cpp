// SPDX-License-Identifier: MIT
#include "analysis/body_operator.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "analysis/amplification.hpp"
#include "analysis/critical_step.hpp"
#include "analysis/finite_strain.hpp"
#include "analysis/rigid_motions.hpp"
#include "tests/analysis/plain_finite_strain.hpp"
#include "tests/analysis/problems.hpp"

using namespace sphstab;
using namespace sphstab::analysis;
using bodies::applied;

namespace {

/// Kernel slopes right to 1e-15 of W(0)/h, differences of particles 1/2 to 3 apart, sums over up to 60 terms; relative
/// to the largest eigenvalue.
constexpr double rounding_tolerance = 1e-13;
/// Backward error n ε of the two eigen-solvers, n = 60, and the entries' own rounding.
constexpr double spectrum_tolerance = 1e-12;

/// The assembled matrix, over all components.
template <int Dim>
Eigen::MatrixXd assembled(const BodyOperator<Dim>& op) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(op.components(), op.components());
  const Eigen::SparseMatrix<double> all = op.matrix().template selfadjointView<Eigen::Lower>();
  result(op.unknowns(), op.unknowns()) = Eigen::MatrixXd(all);
  return result;
}

template <int Dim>
Eigen::MatrixXd printed_operator(const Problem<Dim>& problem, const Body<Dim>& body) {
  return is_finite_strain(problem.scheme.formulation)
             ? bodies::PlainFiniteStrain<Dim>(problem, body).stiffness(Eigen::VectorXd::Zero(body.size() * Dim))
             : bodies::printed_operator(problem, body);
}

template <int Dim>
void check_against_the_printed_sums(const Problem<Dim>& problem, const Body<Dim>& body) {
  const Eigen::MatrixXd printed = printed_operator(problem, body);
  const Eigen::VectorXd omega_squared = bodies::dense_eigenvalues(printed);
  const double largest = omega_squared.maxCoeff();
  REQUIRE(largest > 0.0);
  BodyOperator<Dim> op(problem, body);
  CHECK((applied(op) - printed).cwiseAbs().maxCoeff() < rounding_tolerance * largest);
  CHECK((assembled(op) - printed).cwiseAbs().maxCoeff() < rounding_tolerance * largest);
  CHECK((bodies::dense_eigenvalues(assembled(op)) - omega_squared).cwiseAbs().maxCoeff() <
        spectrum_tolerance * largest);
  // The stated rounding is that of the largest error seen, and not much more.
  CHECK((applied(op) - printed).operatorNorm() < op.rounding());
  CHECK(op.rounding() < 1e-11 * largest);
}

template <int Dim>
void check_all_bodies(const LatticeIndex<Dim>& counts) {
  for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum})
    for (const auto kernel : {KernelFamily::cubic_spline, KernelFamily::wendland_c2}) {
      const auto problem = bodies::problem<Dim>(kernel, 1.3, normalisation);
      check_against_the_printed_sums<Dim>(problem, bodies::block(problem, counts));
      check_against_the_printed_sums<Dim>(problem, bodies::mixed_block(problem, counts, 0.2));
    }
}

}  // namespace

TEST_CASE("the operator of a body is the printed sums over all pairs, with 50 digits", "[fast]") {
  check_all_bodies<1>(LatticeIndex<1>(20));
  check_all_bodies<2>(LatticeIndex<2>(6, 5));
  check_all_bodies<3>(LatticeIndex<3>(3, 3, 2));
  auto problem = bodies::problem<2>(KernelFamily::gaussian, 0.8, KernelNormalisation::sum);
  problem.plane = Plane::stress;
  check_against_the_printed_sums<2>(problem, bodies::mixed_block<2>(problem, {6, 5}, 0.2));
}

TEST_CASE("the operator of a body at rest is the derivative of the force of finite strain, with 50 digits", "[fast]") {
  for (const auto& scheme : bodies::finite_strain_schemes) {
    INFO(name_of(scheme.formulation) << ", " << name_of(scheme.law));
    const auto on_a_line = bodies::finite_strain_problem<1>(scheme);
    check_against_the_printed_sums<1>(on_a_line, bodies::mixed_block<1>(on_a_line, LatticeIndex<1>(12), 0.2));
    const auto in_plane = bodies::finite_strain_problem<2>(scheme, KernelFamily::wendland_c2, 1.6);
    check_against_the_printed_sums<2>(in_plane, bodies::mixed_block<2>(in_plane, {5, 4}, 0.2));
    const auto in_space = bodies::finite_strain_problem<3>(scheme);
    check_against_the_printed_sums<3>(in_space, bodies::mixed_block<3>(in_space, {3, 3, 2}, 0.2));
  }
}

TEST_CASE("renormalised gradients feel no rotation and measure a uniform strain exactly, at free edges too", "[fast]") {
  const auto problem = bodies::finite_strain_problem<3>(bodies::finite_strain_schemes[0]);
  auto body = bodies::mixed_block<3>(problem, {4, 4, 3}, 0.2);
  body.clamped.clear();
  BodyOperator<3> op(problem, body);
  const Eigen::MatrixXd motions = rigid_motions(body);
  REQUIRE(motions.cols() == 6);
  Eigen::VectorXd force(op.components());
  for (int i = 0; i < 6; ++i) {
    const Eigen::VectorXd x = motions.col(i).cwiseQuotient(op.root_inverse_mass());
    op.apply(x, force);
    CHECK(force.norm() < op.rounding() * x.norm());
  }
  // The energy of s = H X is that of the strain everywhere.
  Tensor<3> H;
  H << 0.3, -0.2, 0.5, 0.1, 0.7, -0.4, 0.2, 0.6, -0.1;
  const Tensor<3> strain = 0.5 * (H + H.transpose());
  Eigen::VectorXd x(op.components());
  double energy = 0.0;
  for (int a = 0; a < body.size(); ++a) {
    x.segment<3>(3 * a) = H * body.position[a];
    const auto lame = body.material_of(a).lame(problem.plane);
    energy += body.volume[a] *
              (2.0 * lame.shear_modulus * strain.squaredNorm() + lame.lambda * strain.trace() * strain.trace());
  }
  x = x.cwiseQuotient(op.root_inverse_mass());
  op.apply(x, force);
  CHECK(x.dot(force) == Approx(energy).epsilon(rounding_tolerance));
}

TEST_CASE("no translation is felt, and no component that is clamped", "[fast]") {
  const auto problem = bodies::problem<2>(KernelFamily::cubic_spline, 1.3, KernelNormalisation::sum);
  auto body = bodies::mixed_block<2>(problem, {6, 5}, 0.2);
  const BodyOperator<2> held(problem, body);
  CHECK(held.unknowns().size() == 60 - 3);
  CHECK(held.displacement(Eigen::VectorXd::Ones(60)).head<2>().isZero(0.0));
  CHECK(held.places().col(0) == body.position[1]);

  body.clamped.clear();
  BodyOperator<2> op(problem, body);
  Eigen::VectorXd force(60);
  op.apply(op.root_inverse_mass().cwiseInverse(), force);  // both components of all particles by 1
  CHECK(force.norm() < op.rounding() * op.root_inverse_mass().cwiseInverse().norm());
}

TEST_CASE("a periodic patch has exactly the frequencies of its wave vectors", "[fast]") {
  for (const LatticeKind lattice : lattices_of(2))
    for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum}) {
      INFO(name_of(lattice));
      auto problem = problem_2d(lattice, KernelFamily::quintic_spline, 1.1);  // the support exceeds half the patch
      problem.scheme.kernel_normalisation = normalisation;
      const LatticeIndex<2> cells(6, 5);
      std::vector<double> expected;
      for (int i = 0; i < cells[0]; ++i)
        for (int j = 0; j < cells[1]; ++j) {
          const Vector<2> k = problem.lattice.reciprocal_vectors() *
                              Vector<2>(static_cast<double>(i) / cells[0], static_cast<double>(j) / cells[1]);
          const Vector<2> squares = dynamical_matrix(problem, k).selfadjointView<Eigen::Lower>().eigenvalues();
          expected.insert(expected.end(), squares.begin(), squares.end());
        }
      std::sort(expected.begin(), expected.end());
      const auto body = periodic_patch(problem, cells);
      const Eigen::VectorXd found = bodies::dense_eigenvalues(assembled(BodyOperator<2>(problem, body)));
      REQUIRE(found.size() == static_cast<Eigen::Index>(expected.size()));
      for (std::size_t i = 0; i < expected.size(); ++i) CHECK(std::abs(found[i] - expected[i]) < rounding_tolerance);
    }
}

TEST_CASE("a periodic patch of finite strain has exactly the frequencies of its wave vectors", "[fast]") {
  for (const LatticeKind lattice : lattices_of(2)) {
    INFO(name_of(lattice));
    auto problem =
        bodies::finite_strain_problem<2>(bodies::finite_strain_schemes[0], KernelFamily::quintic_spline, 1.1);
    problem.lattice = Lattice<2>(lattice, 1.0);
    const LatticeIndex<2> cells(6, 5);
    const FiniteStrain<2> waves(problem);
    std::vector<double> expected;
    for (int i = 0; i < cells[0]; ++i)
      for (int j = 0; j < cells[1]; ++j) {
        const Vector<2> k = problem.lattice.reciprocal_vectors() *
                            Vector<2>(static_cast<double>(i) / cells[0], static_cast<double>(j) / cells[1]);
        const Vector<2> squares = waves.dynamics(k).omega_squared().real();
        expected.insert(expected.end(), squares.begin(), squares.end());
      }
    std::sort(expected.begin(), expected.end());
    const auto body = periodic_patch(problem, cells);
    const Eigen::VectorXd found = bodies::dense_eigenvalues(assembled(BodyOperator<2>(problem, body)));
    REQUIRE(found.size() == static_cast<Eigen::Index>(expected.size()));
    for (std::size_t i = 0; i < expected.size(); ++i) CHECK(std::abs(found[i] - expected[i]) < rounding_tolerance);
  }
}

TEST_CASE("a body of finite strain takes no base state, and neighbours that span the space", "[fast]") {
  auto problem = bodies::finite_strain_problem<2>(bodies::finite_strain_schemes[0]);
  auto body = bodies::block<2>(problem, {4, 3});
  problem.deformation_gradient(0, 1) = 0.1;
  CHECK_THROWS_WITH(BodyOperator<2>(problem, body),
                    "deformation_gradient: an operator about rest takes none");
  problem.deformation_gradient.setIdentity();
  body.position.push_back({40.0, 0.0});
  body.position.push_back({41.0, 0.0});
  body.volume.resize(14, 1.0);
  body.material.resize(14, 0);
  body.pairs = find_pairs(body.position, problem.kernel.support());
  CHECK_THROWS_WITH(
      BodyOperator<2>(problem, body),
      "smoothing_length: the neighbours of particle 12 do not span the space, so that tl-corotated has no "
      "gradient there");
  problem.scheme.formulation = Formulation::total_lagrangian_linear;
  CHECK_NOTHROW(BodyOperator<2>(problem, body));
}

TEST_CASE("a body refuses an equation of state about a strained state", "[fast]") {
  auto problem = problem_2d(LatticeKind::square, KernelFamily::cubic_spline, 1.3);
  const auto body = free_plate(problem, {3, 3});
  problem.scheme.momentum_density = MomentumDensity::equation_of_state;
  CHECK_NOTHROW(BodyOperator<2>(problem, body));
  problem.displacement_gradient(0, 1) = 0.1;
  CHECK_THROWS_AS(BodyOperator<2>(problem, body), InvalidInput);
}
