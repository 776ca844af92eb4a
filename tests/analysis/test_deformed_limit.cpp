// SPDX-License-Identifier: MIT
#include "analysis/deformed_limit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "analysis/finite_strain.hpp"
#include "analysis/spectrum.hpp"
#include "tests/analysis/plain_finite_strain.hpp"

using namespace sphstab;
using namespace sphstab::analysis;

namespace {

/// What is asked of the residuals, times the condition of an eigenvalue; relative to the largest.
constexpr double residual_tolerance = 1e-11, value_tolerance = 1e-9;
/// The other end is crowded, rigid motions and what is hardly felt: what is found of it is near one of many.
constexpr double crowded_tolerance = 1e-6;
/// Sums over up to 60 neighbours with kernel slopes right to 1e-15, and a dense spectrum of 60 unknowns.
constexpr double spectrum_tolerance = 1e-11;

/// By real part, then imaginary part, of 0 where it is the rounding of a dense solver.
std::vector<std::complex<double>> sorted(const Eigen::VectorXcd& values) {
  std::vector<std::complex<double>> result(values.begin(), values.end());
  std::sort(result.begin(), result.end(), [](auto x, auto y) { return x.real() < y.real(); });
  return result;
}

template <int Dim>
void check_against_dense(const Problem<Dim>& problem, const Body<Dim>& body, double strain) {
  DeformedBodyOperator<Dim> op(problem, body);
  op.set_state(bodies::bent(body, strain));
  const auto& unknowns = op.unknowns();
  const auto expected = sorted(Eigen::MatrixXd(bodies::applied(op)(unknowns, unknowns)).eigenvalues());
  const double largest = expected.back().real();
  const auto limit = deformed_limit(op, {.tolerance = residual_tolerance, .leftmost = true});
  CHECK(std::abs(limit.largest.omega_squared.real() - largest) < value_tolerance * largest);
  CHECK(std::abs(std::abs(limit.largest.omega_squared.imag()) - std::abs(expected.back().imag())) <
        value_tolerance * largest);
  CHECK(std::abs(limit.leftmost->omega_squared.real() - expected.front().real()) < crowded_tolerance * largest);
  CHECK(limit.largest.residual < residual_tolerance);
  CHECK(limit.critical_time_step.has_value() == (limit.largest.omega_squared.imag() == 0.0));
}

}  // namespace

TEST_CASE("both ends of the spectrum of a deformed body are those of the dense matrix", "[fast]") {
  for (const auto& scheme : bodies::finite_strain_schemes)
    for (const double strain : {0.0, 0.1, 0.4}) {
      INFO(name_of(scheme.formulation) << ", " << name_of(scheme.law) << ", " << strain);
      const auto in_plane = bodies::finite_strain_problem<2>(scheme);
      check_against_dense<2>(in_plane, bodies::block<2>(in_plane, {9, 7}), strain);
      check_against_dense<2>(in_plane, bodies::mixed_block<2>(in_plane, {9, 7}, 0.1), strain);
      const auto in_space = bodies::finite_strain_problem<3>(scheme);
      check_against_dense<3>(in_space, bodies::mixed_block<3>(in_space, {4, 4, 3}, 0.1), strain);
    }
}

TEST_CASE("the limit of an undeformed body is that of its certified spectrum, for every integrator and damping",
          "[fast]") {
  auto problem = bodies::finite_strain_problem<2>(bodies::finite_strain_schemes[0]);
  const auto body = bodies::block<2>(problem, {12, 10}, 0.2);
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet})
    for (const double rate : {0.0, 0.3}) {
      problem.integrator = integrator;
      problem.scheme.damping.reset();
      if (rate > 0.0) problem.scheme.damping = Damping{rate};
      DeformedBodyOperator<2> op(problem, body);
      CHECK(*deformed_limit(op).critical_time_step ==
            Approx(body_limit(problem, body).critical_time_step).epsilon(1e-9));
    }
}

TEST_CASE("the spectrum of a periodic patch about any uniform deformation is that of its wave vectors", "[fast]") {
  Tensor<2> F0;
  F0 << 1.3, 0.4, -0.2, 0.85;
  for (const auto& scheme : bodies::finite_strain_schemes)
    for (const LatticeKind lattice : lattices_of(2)) {
      INFO(name_of(scheme.formulation) << ", " << name_of(scheme.law) << ", " << name_of(lattice));
      auto problem = bodies::finite_strain_problem<2>(scheme, KernelFamily::quintic_spline, 1.1);
      problem.lattice = Lattice<2>(lattice, 1.0);
      problem.deformation_gradient = F0;
      const LatticeIndex<2> cells(6, 5);
      const FiniteStrain<2> waves(problem);
      Eigen::VectorXcd expected(2 * cells.prod());
      for (int i = 0, n = 0; i < cells[0]; ++i)
        for (int j = 0; j < cells[1]; ++j, n += 2) {
          const Vector<2> k = problem.lattice.reciprocal_vectors() *
                              Vector<2>(static_cast<double>(i) / cells[0], static_cast<double>(j) / cells[1]);
          expected.segment<2>(n) = waves.dynamics(k).omega_squared();
        }
      const auto of_waves = sorted(expected);
      const auto body = periodic_patch(problem, cells);
      DeformedBodyOperator<2> op(problem, body);
      const auto found = sorted(bodies::applied(op).eigenvalues());
      const double largest = of_waves.back().real();
      for (std::size_t i = 0; i < found.size(); ++i)
        CHECK(std::abs(found[i].real() - of_waves[i].real()) < spectrum_tolerance * largest);
      CHECK(std::abs(deformed_limit(op).largest.omega_squared - largest) < value_tolerance * largest);
    }
}

TEST_CASE("compression beyond the loss of ellipticity shows as a negative ω² that a stretch does not have", "[fast]") {
  // Uniaxial compression of R·S at ν = 0.3: below λ = 0.469096 (theory.md §5), for the waves of a patch a little lower.
  auto problem = bodies::finite_strain_problem<2>(bodies::finite_strain_schemes[0]);
  problem.material = Material::from_young_modulus(1.0, 1.3, 0.3);
  const auto leftmost = [&](double stretch) {
    problem.deformation_gradient(0, 0) = stretch;
    const auto patch = periodic_patch<2>(problem, {12, 12});
    DeformedBodyOperator<2> op(problem, patch);
    const auto limit = deformed_limit(op, {.leftmost = true});
    return limit.leftmost->omega_squared.real() / limit.largest.omega_squared.real();
  };
  constexpr double zero = 1e-7;  // the residual, of null vectors without a gap
  CHECK(leftmost(1.5) > -zero);
  CHECK(leftmost(0.48) > -zero);
  CHECK(leftmost(0.45) < -1e-3);
  CHECK(leftmost(0.40) < -1e-2);
}

TEST_CASE("a few applications from the mode of a state before follow the largest eigenvalue as a body deforms",
          "[fast]") {
  // The modes of the four corners of a plate differ by less than 4e-3 of ω² while it bends, 2e-3 of the step, and which
  // is the largest changes.
  constexpr int applications = 6;
  constexpr double of_an_estimate = 4e-3;
  for (const auto& scheme : bodies::finite_strain_schemes) {
    INFO(name_of(scheme.formulation) << ", " << name_of(scheme.law));
    const auto problem = bodies::finite_strain_problem<2>(scheme);
    const auto body = bodies::block<2>(problem, {30, 10});
    DeformedBodyOperator<2> op(problem, body);
    DeformedLimitOptions few{.dimension = applications, .most = applications};
    few.start = deformed_limit(op).largest.vector;
    for (int i = 1; i <= 20; ++i) {
      op.set_state(bodies::bent(body, 0.002 * i));
      const auto followed = deformed_limit(op, few);
      CHECK(followed.applications == applications);
      const double expected = deformed_limit(op).largest.omega_squared.real();
      CHECK(followed.largest.omega_squared.real() > (1.0 - of_an_estimate) * expected);
      CHECK(followed.largest.omega_squared.real() < (1.0 + value_tolerance) * expected);
      few.start = followed.largest.vector;
    }
    few.start = {};
    CHECK(deformed_limit(op, few).largest.omega_squared.real() <
          (1.0 - 2.0 * of_an_estimate) * deformed_limit(op).largest.omega_squared.real());
  }
}

TEST_CASE("a body that is held everywhere has no limit", "[fast]") {
  const auto problem = bodies::finite_strain_problem<2>(bodies::finite_strain_schemes[0]);
  auto body = bodies::block<2>(problem, {3, 3});
  body.clamped.assign(9, Directions<2>::Constant(true));
  DeformedBodyOperator<2> op(problem, body);
  CHECK_THROWS_WITH(deformed_limit(op), "clamp: holds every particle, so that nothing moves");
}
