// SPDX-License-Identifier: MIT
#include "analysis/spectrum.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "analysis/body_operator.hpp"
#include "analysis/factorisation_bound.hpp"
#include "analysis/lanczos.hpp"
#include "tests/analysis/golden.hpp"
#include "tests/analysis/plain_finite_strain.hpp"
#include "tests/analysis/problems.hpp"

using namespace sphstab;
using namespace sphstab::analysis;

namespace {

/// Backward error n ε of the dense solver, n = 800, relative to the largest eigenvalue; a step has half of it.
constexpr double dense_tolerance = 2e-13;
/// The tolerance asked for and a factorisation of up to 800 unknowns with rounding, in the step.
constexpr double factorisation_width = 1e-9;

double dense_largest(const Eigen::SparseMatrix<double>& lower) {
  return bodies::dense_eigenvalues(Eigen::MatrixXd(lower)).maxCoeff();
}

/// The limit of leapfrog by the dense eigenvalues of the assembled matrix.
template <int Dim>
double dense_step(const Problem<Dim>& problem, const Body<Dim>& body) {
  return 2.0 / std::sqrt(dense_largest(BodyOperator<Dim>(problem, body).matrix()));
}

bool holds(const Bracket& bracket, double step) {
  return bracket.low <= step * (1.0 + dense_tolerance) && step * (1.0 - dense_tolerance) <= bracket.high;
}

template <int Dim>
void check_every_bound(const Problem<Dim>& problem, const Body<Dim>& body) {
  const double expected = dense_step(problem, body);
  for (const auto kind : {BoundKind::factorisation, BoundKind::norm_bound, BoundKind::probabilistic}) {
    const auto limit = body_limit(problem, body, {.bound = kind});
    INFO(name_of(kind) << ", " << body.size() << " particles");
    CHECK(limit.bracket_kind == kind);
    CHECK(std::abs(limit.critical_time_step - expected) < 1e-9 * expected);
    CHECK(holds(limit.bracket, expected));
    CHECK(limit.bracket.low <= limit.critical_time_step);
    CHECK(limit.critical_time_step < limit.bracket.high);  // by the rounding of the operator
    CHECK((limit.failure_probability > 0.0) == (kind == BoundKind::probabilistic));
    if (kind == BoundKind::factorisation)
      CHECK(limit.bracket.high - limit.bracket.low < factorisation_width * expected);
  }
  // Without a wish: the tightest, and no norm bound is below the truth.
  CHECK(body_limit(problem, body).bracket_kind == BoundKind::factorisation);
  CHECK(BodyOperator<Dim>(problem, body).norm_bound() >= 4.0 / (expected * expected) * (1.0 - dense_tolerance));
}

template <int Dim>
void check_bodies(const LatticeIndex<Dim>& counts) {
  const auto check = [&](const Problem<Dim>& problem) {
    check_every_bound<Dim>(problem, bodies::block(problem, counts));
    check_every_bound<Dim>(problem, bodies::block(problem, counts, 0.2));
    check_every_bound<Dim>(problem, bodies::mixed_block(problem, counts, 0.2));
  };
  for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum})
    check(bodies::problem<Dim>(KernelFamily::cubic_spline, 1.3, normalisation));
  check(bodies::finite_strain_problem<Dim>(bodies::finite_strain_schemes[0]));
}

}  // namespace

TEST_CASE("plate limits agree with the reference, with and without normalisation", "[fast]") {
  const auto references = golden::cases("spectrum");
  REQUIRE(references.size() == 4);
  for (const auto& reference : references) {
    INFO(reference["id"]);
    const auto problem = golden::problem(reference);
    const auto limit = body_limit(problem, free_plate(problem, golden::numbers<LatticeIndex<2>>(reference["plate"])));
    const double expected = reference["expect"]["critical_time_step"], tolerance = reference["tolerance"];
    CHECK(std::abs(limit.critical_time_step - expected) < tolerance * expected);
    CHECK(limit.omega_max == Approx(2.0 / limit.critical_time_step).epsilon(1e-14));
  }
}

TEST_CASE("limits of free patches of finite strain agree with the reference", "[fast]") {
  const auto references = golden::cases("spectrum", "tl_finite_strain_bodies");
  REQUIRE(references.size() == 3);
  for (const auto& reference : references)
    for (const auto formulation : {Formulation::total_lagrangian_corotated, Formulation::total_lagrangian_pk1}) {
      INFO(reference["id"] << ", " << name_of(formulation));  // without stress both have the same spectrum
      auto problem = golden::problem(reference);
      problem.scheme.formulation = formulation;
      problem.material =
          Material::from_bulk_modulus(reference["density"], reference["bulk_modulus"], reference["shear_modulus"]);
      const auto limit = body_limit(problem, free_plate(problem, golden::numbers<LatticeIndex<2>>(reference["plate"])));
      const double expected = reference["expect"]["critical_time_step"], tolerance = reference["tolerance"];
      CHECK(golden::difference(limit.critical_time_step, expected) < tolerance);
    }
}

TEST_CASE("every bound holds the largest dense eigenvalue: chains, plates, blocks, two materials, clamps", "[fast]") {
  check_bodies<1>(LatticeIndex<1>(100));
  check_bodies<2>(LatticeIndex<2>(17, 13));
  check_bodies<3>(LatticeIndex<3>(6, 5, 4));
}

TEST_CASE("frequencies that hardly differ are not taken for one", "[fast]") {
  // The modes of the four corners nearly coincide, and Lanczos sees their mean at first: 4e-7 too large a step. Whoever
  // asks for no factorisation has the residual: a hundred times the tolerance, half of it for the step.
  constexpr double of_the_residual = 0.5e-8;
  auto problem = bodies::problem<2>(KernelFamily::gaussian, 1.0, KernelNormalisation::sum);
  problem.kernel = Kernel<2>(KernelFamily::gaussian, 1.0, 7.0);
  problem.plane = Plane::stress;
  const auto plate = free_plate<2>(problem, {20, 20});
  const double expected = dense_step(problem, plate);
  for (unsigned seed = 1; seed <= 10; ++seed) {
    CHECK(body_limit(problem, plate, {.seed = seed}).critical_time_step ==
          Approx(expected).epsilon(factorisation_width));
    CHECK(body_limit(problem, plate, {.bound = BoundKind::norm_bound, .seed = seed}).critical_time_step ==
          Approx(expected).epsilon(of_the_residual));
  }
}

TEST_CASE("a factorisation does not believe an approximation that is too small", "[fast]") {
  const auto problem = bodies::problem<2>(KernelFamily::cubic_spline, 1.3, KernelNormalisation::sum);
  for (const double jitter : {0.0, 0.2}) {
    const auto body = bodies::block<2>(problem, {17, 13}, jitter);
    const BodyOperator<2> of_body(problem, body);
    FactorisationBound factorisation(of_body);
    const double largest = dense_largest(of_body.matrix());
    for (const double part : {0.5, 0.99, 1.0 - 1e-6, 1.0 - 1e-9, 1.0}) {
      const double bound = factorisation.above(part * largest, 1e-10).value;
      CHECK(bound >= largest * (1.0 - dense_tolerance));
      CHECK(bound <= largest * (part + 17.0 * (1.0 - part) + factorisation_width));
    }
  }
}

TEST_CASE("the random start may be any of fifty", "[fast]") {
  const auto problem = bodies::problem<2>(KernelFamily::cubic_spline, 1.3, KernelNormalisation::none);
  for (const double jitter : {0.0, 0.2}) {
    const auto body = bodies::block<2>(problem, {12, 12}, jitter);
    const double expected = dense_step(problem, body);
    for (unsigned seed = 1; seed <= 50; ++seed) {
      const auto limit = body_limit(problem, body, {.bound = BoundKind::probabilistic, .seed = seed});
      CHECK(holds(limit.bracket, expected));
    }
  }
}

TEST_CASE("a probabilistic bound is as narrow as was asked, and no narrower than its probability allows", "[fast]") {
  // 1.648 √n 2k² exp(−√ε (2k − 1)) = p, by hand for n = 10000, p = 1e-12, k = 200: ln(1.648e14 · 80000) = 44.02.
  const double root = std::log(1.648 * 100.0 * 80000.0 * 1e12) / 399.0;
  CHECK(probable_ratio(1e-12, 200, 10000) == Approx(1.0 / (1.0 - root * root)).epsilon(1e-14));
  CHECK(probable_ratio(1e-12, 10, 10000) == std::numeric_limits<double>::infinity());
  for (const double ratio : {1.1, 1.01, 1.001}) {
    const int dimension = dimension_for_ratio(ratio, 1e-12, 10000);
    CHECK(probable_ratio(1e-12, dimension, 10000) <= ratio);
    CHECK(probable_ratio(1e-12, dimension * 9 / 10, 10000) > ratio);
  }
  const auto problem = bodies::problem<2>(KernelFamily::cubic_spline, 1.3, KernelNormalisation::none);
  const auto body = bodies::block<2>(problem, {30, 30}, 0.2);
  const auto limit = body_limit(problem, body, {.bound = BoundKind::probabilistic});
  CHECK(limit.bracket.high / limit.bracket.low - 1.0 < 0.5e-2);
  CHECK(limit.failure_probability == 1e-12);
}

TEST_CASE("the mode of the limit is an eigenvector of the printed operator, zero where it is clamped", "[fast]") {
  const auto problem = bodies::problem<2>(KernelFamily::cubic_spline, 1.3, KernelNormalisation::sum);
  const auto body = bodies::mixed_block<2>(problem, {6, 5}, 0.2);
  const auto limit = body_limit(problem, body, {.tolerance = 1e-6});
  const BodyOperator<2> op(problem, body);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(60);
  for (const int i : op.unknowns()) x[i] = limit.displacement[i] / op.root_inverse_mass()[i];
  const Eigen::VectorXd residual = bodies::printed_operator(problem, body) * x - limit.omega_max * limit.omega_max * x;
  CHECK(residual.norm() < 1e-2 * limit.omega_max * limit.omega_max * x.norm());
  CHECK(residual.norm() == Approx(limit.residual * limit.omega_max * limit.omega_max * x.norm()).epsilon(1e-3));
  CHECK(limit.displacement.head<2>().isZero(0.0));
  CHECK(limit.displacement[3] == 0.0);
}

TEST_CASE("a bracket is mapped by integrator and damping, its low end to the larger frequency", "[fast]") {
  auto problem = bodies::problem<2>(KernelFamily::cubic_spline, 1.3, KernelNormalisation::none);
  const auto body = bodies::block<2>(problem, {8, 8}, 0.2);
  const double omega = body_limit(problem, body).omega_max;
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet})
    for (const double rate : {0.0, 0.3}) {
      problem.integrator = integrator;
      if (rate > 0.0) problem.scheme.damping = Damping{rate};
      // An eigenvalue of leapfrog reaches −1 at ω²x² + 2 c x = 4.
      const auto limit = body_limit(problem, body, {.bound = BoundKind::norm_bound});
      CHECK(limit.bracket.low < limit.critical_time_step);
      CHECK(limit.critical_time_step < limit.bracket.high);  // by the rounding of the operator
      if (integrator == Integrator::leapfrog)
        CHECK(limit.critical_time_step ==
              Approx((std::sqrt(rate * rate + 4.0 * omega * omega) - rate) / (omega * omega)).epsilon(1e-9));
      problem.scheme.damping.reset();
    }
}

TEST_CASE("normalised free edges need a smaller step than the bulk", "[fast]") {
  // theory.md §2: 0.837 x the normalised bulk value at H = Δ, 0.735 x at 1.5 Δ; the plain plate 0.3 to 4 % above the
  // bulk.
  struct Edge {
    double h, ratio;
  };
  constexpr double printed = 1e-3;
  for (const auto& [h, ratio] : {Edge{1.0, 0.837}, Edge{1.5, 0.735}}) {
    auto problem = problem_2d(LatticeKind::square, KernelFamily::gaussian, h, 7.0);
    problem.plane = Plane::stress;
    const auto ratio_to_bulk = [&] {
      return body_limit(problem, free_plate(problem, {20, 20})).critical_time_step /
             std::get<ConditionallyStable<2>>(BulkModes(problem).limit()).critical_time_step;
    };
    const double plain = ratio_to_bulk();
    CHECK(plain > 1.0);
    CHECK(plain < 1.04);
    problem.scheme.kernel_normalisation = KernelNormalisation::sum;
    CHECK(std::abs(ratio_to_bulk() - ratio) < printed);
  }
}

TEST_CASE("renormalised free edges need 0.6 of the step of the bulk, whatever the size of the plate", "[fast]") {
  // theory.md §5, errata.md T8, to the digits that are given there.
  struct Edge {
    KernelFamily kernel;
    double h, ratio, digits;
  };
  for (const auto& [kernel, h, ratio, digits] :
       {Edge{KernelFamily::sinc_5, 1.2, 0.63, 5e-3}, Edge{KernelFamily::cubic_spline, 1.3, 0.585, 5e-4},
        Edge{KernelFamily::wendland_c2, 1.6, 0.586, 5e-4}})
    for (const int side : {12, 20, 40}) {
      INFO(name_of(kernel) << ", " << side);
      auto problem = problem_2d(LatticeKind::square, kernel, h);
      problem.scheme.formulation = Formulation::total_lagrangian_corotated;
      const double bulk = std::get<ConditionallyStable<2>>(bulk_limit(problem)).critical_time_step;
      CHECK(std::abs(body_limit(problem, free_plate(problem, {side, side})).critical_time_step / bulk - ratio) <
            digits);
    }
}

TEST_CASE("a periodic patch has the limit of its wave vectors", "[fast]") {
  for (const LatticeKind lattice : lattices_of(2)) {
    const auto problem = problem_2d(lattice, KernelFamily::quintic_spline, 1.1);
    const auto patch = std::get<ConditionallyStable<2>>(patch_limit(problem, {6, 5}));
    const auto limit = body_limit(problem, periodic_patch(problem, {6, 5}));
    CHECK(holds(limit.bracket, patch.critical_time_step));
    CHECK(limit.critical_time_step == Approx(patch.critical_time_step).epsilon(1e-12));
  }
}

TEST_CASE("a body without forces has no limit, and one too large no factorisation", "[fast]") {
  const auto problem = problem_2d(LatticeKind::square, KernelFamily::cubic_spline, 1.3);
  CHECK_THROWS_AS(body_limit(problem, periodic_patch(problem, {2, 2})), InvalidInput);
  auto apart = bodies::block<2>(problem, {2, 2});
  for (auto& x : apart.position) x *= 10.0;
  apart.pairs = find_pairs(apart.position, problem.kernel.support());
  CHECK_THROWS_AS(body_limit(problem, apart), InvalidInput);
  auto held = free_plate(problem, {3, 3});
  held.clamped.assign(9, Directions<2>::Constant(true));
  CHECK_THROWS_WITH(body_limit(problem, held), "clamp: holds every particle, so that nothing moves");
}
