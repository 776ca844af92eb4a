// SPDX-License-Identifier: MIT
// The finite strain schemes: rung 0, the tangent moduli against differentiated stresses; rung 1, limits and symmetries;
// and what is made of them, against an independent implementation and closed forms.
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>
#include <catch2/catch.hpp>
#include <numbers>
#include <random>

#include "analysis/amplification.hpp"
#include "analysis/critical_step.hpp"
#include "analysis/dispersion.hpp"
#include "analysis/ellipticity.hpp"
#include "analysis/finite_strain.hpp"
#include "analysis/growth.hpp"
#include "analysis/zone_scan.hpp"
#include "tests/analysis/finite_strain_problems.hpp"
#include "tests/analysis/golden.hpp"
#include "tests/analysis/problems.hpp"

using namespace sphstab;
using namespace sphstab::analysis;
using Catch::Detail::Approx;

namespace {

constexpr double pi = std::numbers::pi;

/// Some tens of operations on numbers of order 1 to 10.
constexpr double rounding = 1e-13;
/// What BulkModes promises of values that are searched.
constexpr double searched = 1e-12;

constexpr std::array formulations{Formulation::total_lagrangian_corotated, Formulation::total_lagrangian_pk1};

/// Numbers of 50 digits: central differences with steps of 1e-16 are right to 32.
using Long = boost::multiprecision::cpp_bin_float_50;

/// P, written from the paper (R S) and its textbook form (F S); R by Newton's iteration R ← (R + R⁻ᵀ)/2.
template <int Dim>
Tensor<Dim, Long> stress(const Scheme& scheme, const LameConstants& lame, const Tensor<Dim, Long>& F) {
  using T = Tensor<Dim, Long>;
  const Long lambda = lame.lambda, G = lame.shear_modulus;
  const T I = T::Identity(), C = F.transpose() * F, E = (C - I) / 2;
  const T inverse = C.inverse();
  const T S = scheme.elastic_law == ElasticLaw::saint_venant_kirchhoff
                  ? T(lambda * E.trace() * I + 2 * G * E)
                  : T(G * (I - inverse) + lambda * log(F.determinant()) * inverse);
  if (scheme.formulation == Formulation::total_lagrangian_pk1) return F * S;
  T R = F;
  for (int i = 0; i < 12; ++i) R = T((R + T(R.inverse().transpose())) / 2);
  return R * S;
}

template <int Dim>
TangentModuli<Dim> differentiated(const Scheme& scheme, const LameConstants& lame, const Tensor<Dim>& F) {
  const Long step = 1e-16;
  TangentModuli<Dim> moduli;
  for (int c = 0; c < Dim * Dim; ++c) {
    Tensor<Dim, Long> before = F.template cast<Long>(), after = before;
    before(c) -= step;
    after(c) += step;
    const Tensor<Dim, Long> slope = (stress<Dim>(scheme, lame, after) - stress<Dim>(scheme, lame, before)) / (2 * step);
    for (int row = 0; row < Dim * Dim; ++row) moduli(row, c) = static_cast<double>(slope(row));
  }
  return moduli;
}

constexpr LameConstants lame{1.4, 0.6, 1.0};

Scheme corotated() { return {.formulation = Formulation::total_lagrangian_corotated}; }
Scheme pk1(ElasticLaw law = ElasticLaw::saint_venant_kirchhoff) {
  return {.formulation = Formulation::total_lagrangian_pk1, .elastic_law = law};
}
std::array<Scheme, 3> every_scheme() { return {corotated(), pk1(), pk1(ElasticLaw::neo_hookean)}; }

template <int Dim>
void check_moduli() {
  for (const auto& scheme : every_scheme())
    for (const Tensor<Dim>& F :
         {Tensor<Dim>(Tensor<Dim>::Identity()), sheared<Dim>(), Tensor<Dim>(0.6 * sheared<Dim>())})
      CHECK((tangent_moduli<Dim>(scheme, lame, F) - differentiated<Dim>(scheme, lame, F)).norm() < rounding);
}

template <int Dim>
Vector<Dim> oblique() {
  return Vector<3>(0.6, -0.35, 0.8).head<Dim>();
}

template <int Dim>
Tensor<Dim> some_rotation() {
  return Eigen::HouseholderQR<Tensor<Dim>>(sheared<Dim>()).householderQ();
}
template <int Dim>
Tensor<Dim> proper_rotation() {
  Tensor<Dim> R = some_rotation<Dim>();
  if (R.determinant() < 0.0) R.col(0) = -R.col(0);
  return R;
}

template <int Dim>
std::vector<Lattice<Dim>> lattices() {
  std::vector<Lattice<Dim>> result;
  for (const auto kind : lattices_of(Dim)) result.emplace_back(kind, 0.7);
  return result;
}

/// Of every scheme, lattice and state.
template <int Dim, class Check>
void for_each_problem(const Check& check) {
  for (const auto& scheme : every_scheme())
    for (const auto& lattice : lattices<Dim>())
      for (const Tensor<Dim>& F : {Tensor<Dim>(Tensor<Dim>::Identity()), sheared<Dim>()}) {
        auto problem = finite_strain_problem<Dim>(scheme.formulation, lattice, KernelFamily::cubic_spline, 1.3, F);
        problem.scheme = scheme;
        INFO("dimension " << Dim << " lattice " << static_cast<int>(lattice.kind()));
        check(problem);
      }
}

ConditionallyStable<2> conditional(const StepLimit<2>& limit) {
  REQUIRE(std::holds_alternative<ConditionallyStable<2>>(limit));
  return std::get<ConditionallyStable<2>>(limit);
}
double critical_step(const Problem<2>& problem) { return conditional(bulk_limit(problem)).critical_time_step; }

Problem<2> reference_problem(const nlohmann::json& reference) {
  auto problem = finite_strain_problem<2>(
      from_name<Formulation>("scheme", reference["scheme"].get<std::string>()),
      Lattice<2>(golden::word(reference, "lattice", LatticeKind::square), reference["spacing"]),
      golden::word(reference, "kernel", KernelFamily::cubic_spline), reference["smoothing_length"]);
  problem.material =
      Material::from_bulk_modulus(reference["density"], reference["bulk_modulus"], reference["shear_modulus"]);
  problem.integrator = golden::word(reference, "integrator", Integrator::leapfrog);
  const auto F = golden::numbers<Vector<4>>(reference["deformation_gradient"]);
  problem.deformation_gradient << F[0], F[1], F[2], F[3];
  return problem;
}

/// The state at which long waves along some direction stop: x = (l X, Y), between two stretches, by bisection.
double loss_of_ellipticity(Formulation formulation, double poisson_ratio) {
  auto problem = finite_strain_problem<2>(formulation, Lattice<2>(LatticeKind::square, 1.0), KernelFamily::sinc_5, 1.2);
  problem.material = Material::from_young_modulus(1.0, 1.0, poisson_ratio);
  double unstable = 0.02, stable = 1.0;
  while (stable - unstable > 1e-10) {
    const double middle = 0.5 * (stable + unstable);
    problem.deformation_gradient = Vector<2>(middle, 1.0).asDiagonal();
    (weakest_direction(problem).squared_speed < 0.0 ? unstable : stable) = middle;
  }
  return stable;
}

}  // namespace

TEST_CASE("the tangent moduli are the derivative of the stress to the last digit", "[fast]") {
  check_moduli<1>();
  check_moduli<2>();
  check_moduli<3>();
}

TEST_CASE("the acoustic tensor of a diagonal state has its closed form", "[fast]") {
  const double la = lame.lambda, G = lame.shear_modulus, l1 = 1.3, l2 = 0.75, t = l1 + l2, angle = 0.7;
  const double c = std::cos(angle), s = std::sin(angle), trace = 0.5 * (l1 * l1 + l2 * l2) - 1.0;
  const double S1 = la * trace + G * (l1 * l1 - 1.0), S2 = la * trace + G * (l2 * l2 - 1.0);
  const Tensor<2> F = Vector<2>(l1, l2).asDiagonal();
  const Vector<2> n(c, s), x(1.0, 0.0);
  Tensor<2> expected;  // theory.md §5
  expected << (la + 2.0 * G) * l1 * c * c + (G * l1 + S2 / t) * s * s, ((la + G) * l2 - S2 / t) * c * s,
      ((la + G) * l1 - S1 / t) * c * s, (la + 2.0 * G) * l2 * s * s + (G * l2 + S1 / t) * c * c;
  CHECK((acoustic_tensor<2>(tangent_moduli<2>(corotated(), lame, F), n) - expected).norm() < rounding);
  const Tensor<2> of_pk1 = acoustic_tensor<2>(tangent_moduli<2>(pk1(), lame, F), x);
  CHECK(of_pk1(0, 0) == Approx(S1 + (la + 2.0 * G) * l1 * l1).epsilon(rounding));
  CHECK(of_pk1(1, 1) == Approx(S1 + G * l2 * l2).epsilon(rounding));
}

TEST_CASE("F S has an energy and so symmetric moduli, R S has not", "[fast]") {
  for (const auto law : {ElasticLaw::saint_venant_kirchhoff, ElasticLaw::neo_hookean}) {
    const auto A = tangent_moduli<3>(pk1(law), lame, sheared<3>());
    CHECK((A - A.transpose()).norm() < rounding);
  }
  const auto A = tangent_moduli<3>(corotated(), lame, sheared<3>());
  CHECK((A - A.transpose()).norm() > 0.1);
  const auto turned = tangent_moduli<3>(corotated(), lame, 0.8 * proper_rotation<3>());
  CHECK((turned - turned.transpose()).norm() < rounding);
}

TEST_CASE("the moduli turn with the body", "[fast]") {
  const Tensor<3> R = proper_rotation<3>(), F = sheared<3>();
  for (const auto& scheme : every_scheme()) {
    const auto A = tangent_moduli<3>(scheme, lame, F), turned = tangent_moduli<3>(scheme, lame, R * F);
    Tensor<3> change = Tensor<3>::Zero();
    for (int c = 0; c < 9; ++c) {
      change(c) = 1.0;
      const Tensor<3> before = (A * change.reshaped()).reshaped(3, 3), moved = R * change;
      CHECK(((turned * moved.reshaped()).reshaped(3, 3) - R * before).norm() < rounding);
    }
  }
}

TEST_CASE("every squared frequency of the corotated force is real", "[fast]") {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> ratio(-0.95, 0.49);
  for (int i = 0; i < 2000; ++i) {
    const double nu = ratio(random);
    Tensor<3> F = Tensor<3>::NullaryExpr([&] { return normal(random); });
    if (F.determinant() < 0.0) F.row(0) = -F.row(0);
    const Vector<3> n = Vector<3>::NullaryExpr([&] { return normal(random); }).normalized();
    const Tensor<3> Q =
        acoustic_tensor<3>(tangent_moduli<3>(corotated(), {2.0 * nu / (1.0 - 2.0 * nu), 1.0, 1.0}, F), n);
    // A double root parts by the root of the rounding.
    CHECK(Q.eigenvalues().imag().cwiseAbs().maxCoeff() < 1e-6 * Q.norm());
  }
}

TEST_CASE("amplification matrices of finite strain agree with the reference", "[fast]") {
  const auto references = golden::cases("matrix", "tl_finite_strain");
  REQUIRE(references.size() == 10);
  for (const auto& reference : references) {
    INFO(reference["id"]);
    const auto problem = reference_problem(reference);
    const auto k = golden::numbers<Vector<2>>(reference["wave_vector"]);
    const double tolerance = reference["tolerance"], step = reference["time_step"];
    const auto E = amplification_matrix(problem, k, step);
    const auto& expected = reference["expect"]["amplification_matrix"];
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        CHECK(golden::difference(E(i, j).real(), expected[i][j][0]) < tolerance);
        CHECK(E(i, j).imag() == 0.0);
      }
    CHECK(golden::difference(mode_spectrum(problem, k, step).spectral_radius, reference["expect"]["spectral_radius"]) <
          tolerance);
    CHECK(state_names(problem) == std::vector<std::string>{"x", "y", "vx", "vy"});
  }
}

TEST_CASE("critical time steps of finite strain agree with the reference", "[fast]") {
  const auto references = golden::cases("dt", "tl_finite_strain");
  REQUIRE(references.size() == 6);
  for (const auto& reference : references) {
    INFO(reference["id"]);
    const auto problem = reference_problem(reference);
    const double expected = reference["expect"]["critical_time_step"];
    const auto limit = conditional(bulk_limit(problem));
    CHECK(std::abs(limit.critical_time_step - expected) < searched * expected);
    CHECK(limit.bracket.low <= expected);
    CHECK(expected <= limit.bracket.high);
    CHECK(limit.bracket.high - limit.bracket.low < 3e-9 * expected);
    CHECK(conditional(mode_limit(problem, limit.mode.wave_vector)).critical_time_step ==
          Approx(limit.critical_time_step).epsilon(searched));
    CHECK_FALSE(published_bound(problem));
  }
}

TEST_CASE("the spectrum of a finite strain mode is that of its amplification matrix, damped or not", "[fast]") {
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet})
    for (const bool damped : {false, true})
      for_each_problem<3>([&](Problem<3> problem) {
        problem.integrator = integrator;
        if (damped) problem.scheme.damping = Damping{0.3};
        const Vector<3> k = 1.5 * oblique<3>();
        const auto spectrum = mode_spectrum(problem, k, 0.2);
        auto expected = numerical_eigenvalues(amplification_matrix(problem, k, 0.2));
        for (const auto value : spectrum.eigenvalues) {
          const auto nearest = std::min_element(expected.begin(), expected.end(), [&](auto a, auto b) {
            return std::abs(a - value) < std::abs(b - value);
          });
          CHECK(std::abs(*nearest - value) < 1e-12);  // of an eigensolver
          expected.erase(nearest);
        }
        CHECK(spectrum.power_bounded == (spectrum.spectral_radius <= 1.0 + 1e-12));
      });
}

namespace {

/// Long waves: ω²/k² is an eigenvalue of Q(n)/ρ0, to the second order in k.
template <int Dim>
void check_long_waves() {
  for_each_problem<Dim>([](const Problem<Dim>& problem) {
    const FiniteStrain<Dim> scheme(problem);
    const Vector<Dim> n = oblique<Dim>().normalized();
    const auto A =
        tangent_moduli<Dim>(problem.scheme, problem.material.lame(Plane::strain), problem.deformation_gradient);
    const Vector<Dim> expected =
        squared_frequencies<Dim>(acoustic_tensor<Dim>(A, n) / problem.material.density(), 1e-12).real();
    const auto error = [&](double k) {
      return (scheme.dynamics(k * n).omega_squared().real() / (k * k) - expected).cwiseAbs().maxCoeff();
    };
    const double order = std::log2(error(0.2) / error(0.1));
    CHECK(order > 1.9);
    CHECK(order < 2.1);
  });
}

template <int Dim>
void check_zeros() {
  for_each_problem<Dim>([](const Problem<Dim>& problem) {
    if (problem.deformation_gradient.isIdentity(0.0)) return;
    CHECK(dynamical_matrix<Dim>(problem, Vector<Dim>::Zero()).isZero(0.0));
    const auto modes = zero_energy_modes(problem);
    REQUIRE(!modes.wave_vectors.empty());
    for (const auto& k : modes.wave_vectors) {
      CHECK(dynamical_matrix<Dim>(problem, k).isZero(1e-20));
      CHECK_FALSE(mode_spectrum<Dim>(problem, k, 0.1).power_bounded);
    }
  });
}

/// The isotropic closed form, and that it is told.
template <int Dim>
void check_unstrained() {
  for (const auto formulation : formulations)
    for (const auto& lattice : lattices<Dim>()) {
      const auto problem =
          finite_strain_problem<Dim>(formulation, lattice, KernelFamily::quintic_spline, 1.1, proper_rotation<Dim>());
      const BulkModes<Dim> modes(problem);
      const auto limit = std::get<ConditionallyStable<Dim>>(modes.limit());
      const double c_p = std::sqrt(problem.material.p_wave_modulus() / problem.material.density());
      CHECK(limit.critical_time_step == Approx(2.0 / (modes.symbol_maximum() * c_p)).epsilon(rounding));
      CHECK(limit.bracket_kind == BracketKind::certified);
      const ZoneScan<Dim> scan(problem);
      const FiniteStrain<Dim> scheme(problem);
      const auto size = [&](const Vector<Dim>& k) { return scheme.renormalised_symbol(k).norm(); };
      CHECK(modes.symbol_maximum() == Approx(scan.maximum(size).value).epsilon(searched));
    }
}

/// Group velocities against differences of ω.
template <int Dim>
void check_group_velocity() {
  for_each_problem<Dim>([](const Problem<Dim>& problem) {
    const DispersionRelation<Dim> relation(problem);
    const Vector<Dim> k = 2.0 * oblique<Dim>();
    const auto omega = [&](const Vector<Dim>& at, int branch) {
      return std::sqrt(relation(at)[branch].omega_squared.real());
    };
    const double h = 1e-4;
    const auto waves = relation(k);
    for (int branch = 0; branch < Dim; ++branch) {
      if (waves[branch].omega_squared.real() <= 0.0) continue;
      REQUIRE(waves[branch].group_velocity);
      for (int j = 0; j < Dim; ++j) {
        const Vector<Dim> e = h * Vector<Dim>::Unit(j);
        // Fourth order in h, whose fifth derivatives are of order 1: 1e-16, below the rounding 1e-16/h.
        const double slope = (8.0 * (omega(k + e, branch) - omega(k - e, branch)) -
                              (omega(k + 2.0 * e, branch) - omega(k - 2.0 * e, branch))) /
                             (12.0 * h);
        CHECK((*waves[branch].group_velocity)[j] == Approx(slope).margin(1e-9));
      }
    }
  });
}

}  // namespace

TEST_CASE("long waves of finite strain run at the speeds of the acoustic tensor", "[fast]") {
  check_long_waves<1>();
  check_long_waves<2>();
  check_long_waves<3>();
}

TEST_CASE("zero-energy modes survive any deformation", "[fast]") {
  check_zeros<1>();
  check_zeros<2>();
  check_zeros<3>();
}

TEST_CASE("an unstrained body has its closed critical step however it is turned", "[fast]") {
  check_unstrained<1>();
  check_unstrained<2>();
  check_unstrained<3>();
}

TEST_CASE("the group velocity of finite strain is the slope of the frequency", "[fast]") {
  check_group_velocity<1>();
  check_group_velocity<2>();
  check_group_velocity<3>();
}

TEST_CASE("a rotation of the body changes no critical step and no name of a branch", "[fast]") {
  for (const auto formulation : formulations)
    for (const auto kind : lattices_of(2)) {
      auto problem =
          finite_strain_problem<2>(formulation, Lattice<2>(kind, 1.0), KernelFamily::wendland_c2, 1.4, sheared<2>());
      const auto plain = conditional(bulk_limit(problem));
      const Vector<2> k(0.9, 0.4);
      const auto branches = DispersionRelation(problem)(k);
      problem.deformation_gradient = rotation(1.4) * problem.deformation_gradient;
      CHECK(critical_step(problem) == Approx(plain.critical_time_step).epsilon(searched));
      const auto turned = DispersionRelation(problem)(k);
      for (int i = 0; i < 2; ++i) {
        CHECK(turned[i].branch == branches[i].branch);
        CHECK(turned[i].omega_squared.real() == Approx(branches[i].omega_squared.real()).epsilon(rounding));
      }
      CHECK(plain.bracket_kind ==
            (formulation == Formulation::total_lagrangian_pk1 ? BracketKind::certified : BracketKind::searched));
    }
}

TEST_CASE("a dilated state is certified and agrees with a search", "[fast]") {
  for (const auto formulation : formulations)
    for (const double stretch : {0.95, 1.4})
      for (const auto kind : lattices_of(2)) {
        auto problem = finite_strain_problem<2>(formulation, Lattice<2>(kind, 1.0), KernelFamily::cubic_spline, 1.3,
                                                stretch * rotation(0.3));
        const auto certified = conditional(bulk_limit(problem));
        CHECK(certified.bracket_kind == BracketKind::certified);
        CHECK(certified.bracket.high - certified.bracket.low < 1e-11);
        const auto found = growth_range(problem, ZoneScan<2>(problem));
        CHECK(2.0 / std::sqrt(found.omega_squared_max) == Approx(certified.critical_time_step).epsilon(searched));
      }
}

TEST_CASE("no point of the zone is stiffer than the critical mode of a strained state", "[fast]") {
  for (const auto formulation : formulations)
    for (const auto kind : lattices_of(2)) {
      const auto problem =
          finite_strain_problem<2>(formulation, Lattice<2>(kind, 1.0), KernelFamily::cubic_spline, 1.3, sheared<2>());
      const FiniteStrain<2> scheme(problem);
      const auto limit = conditional(bulk_limit(problem));
      const double highest = std::pow(2.0 / limit.critical_time_step, 2);
      double sampled = 0.0;
      constexpr int points = 150;
      for (int i = 0; i < points; ++i)
        for (int j = 0; j < points; ++j) {
          const Vector<2> k = problem.lattice.reciprocal_vectors() * Vector<2>(i, j) / points;
          sampled = std::max(sampled, scheme.dynamics(k).omega_squared()[1].real());
        }
      CHECK(sampled <= highest * (1.0 + rounding));
      CHECK(sampled > highest * 0.997);  // (kh)²/2 of a grid with k h = 0.04 and the reach of two neighbours
    }
}

TEST_CASE("the patch that admits the critical mode has its limit, every other a longer one", "[fast]") {
  const auto problem =
      finite_strain_problem<2>(Formulation::total_lagrangian_corotated, Lattice<2>(LatticeKind::square, 1.0),
                               KernelFamily::cubic_spline, 1.3, Vector<2>(1.3, 0.9).asDiagonal());
  const double bulk = critical_step(problem);
  for (const int cells : {4, 7, 60}) {
    const double patch = conditional(patch_limit<2>(problem, {cells, cells})).critical_time_step;
    CHECK(patch >= bulk * (1.0 - searched));
    if (cells == 60) CHECK(patch < bulk * 1.002);
  }
  const BulkModes<2> modes(problem);
  CHECK(modes.spectral_radius(0.999 * bulk) == Approx(1.0).epsilon(rounding));
  CHECK(modes.spectral_radius(1.001 * bulk) > 1.05);
  CHECK(*modes.step_for_growth(0.0) == Approx(bulk).epsilon(rounding));
}

TEST_CASE("ellipticity is lost under uniaxial compression where theory says", "[fast]") {
  const std::array ratios{0.0, 0.3, 0.45, 0.49, 0.4999};
  const std::array thresholds{0.17157288, 0.46909570, 0.81966252, 0.96079938, 0.99960008};
  for (std::size_t i = 0; i < ratios.size(); ++i)
    CHECK(std::abs(loss_of_ellipticity(Formulation::total_lagrangian_corotated, ratios[i]) - thresholds[i]) < 1e-7);
  CHECK(std::abs(loss_of_ellipticity(Formulation::total_lagrangian_corotated, 0.0) - (3.0 - std::sqrt(8.0))) < 1e-9);
  const std::array of_pk1{0.586, 0.706, 0.906, 0.980};
  for (std::size_t i = 0; i < of_pk1.size(); ++i)
    CHECK(std::abs(loss_of_ellipticity(Formulation::total_lagrangian_pk1, ratios[i]) - of_pk1[i]) < 1e-3);
}

TEST_CASE("the weakest direction in space is that of the plane, turned with the lattice's axes or not", "[fast]") {
  // A state that is symmetric about z, compressed along it: the least eigenvalue depends on the polar angle alone.
  auto problem = finite_strain_problem<3>(Formulation::total_lagrangian_corotated, Lattice<3>(LatticeKind::cubic, 1.0),
                                          KernelFamily::cubic_spline, 1.3, Vector<3>(1.0, 1.0, 0.45).asDiagonal());
  const auto weakest = weakest_direction(problem);
  double least = 1.0;
  const auto A = FiniteStrain<3>(problem).moduli();
  for (int i = 0; i <= 200000; ++i) {
    const double angle = 0.5 * pi * i / 200000;
    const Vector<3> n(std::sin(angle), 0.0, std::cos(angle));
    least = std::min(least, squared_frequencies<3>(acoustic_tensor<3>(A, n), 1e-13)[0].real());
  }
  CHECK(weakest.squared_speed == Approx(least).margin(1e-9));
  CHECK(weakest.squared_speed <= least + rounding);
  const Tensor<3> R = proper_rotation<3>();
  problem.deformation_gradient = problem.deformation_gradient * R;  // F0 Rᵀ acts on directions turned by R
  const auto turned = weakest_direction(problem);
  CHECK(turned.squared_speed == Approx(weakest.squared_speed).margin(rounding));
  CHECK((R * turned.direction)[2] == Approx(weakest.direction[2]).margin(1e-6).epsilon(0.0));
}

TEST_CASE("a finite strain state grows if and only if ellipticity is lost", "[fast]") {
  for (const auto formulation : formulations) {
    const double threshold = loss_of_ellipticity(formulation, 0.3);
    for (const double beyond : {1e-3, 1e-6, 1e-9}) {
      auto problem =
          finite_strain_problem<2>(formulation, Lattice<2>(LatticeKind::hexagonal, 1.0), KernelFamily::sinc_5, 1.2);
      problem.material = Material::from_young_modulus(1.0, 1.0, 0.3);
      problem.deformation_gradient = Vector<2>(threshold + beyond, 1.0).asDiagonal();
      CHECK(std::holds_alternative<ConditionallyStable<2>>(bulk_limit(problem)));
      problem.deformation_gradient = Vector<2>(threshold - beyond, 1.0).asDiagonal();
      const auto unstable = bulk_limit(problem);
      REQUIRE(std::holds_alternative<NeverStable<2>>(unstable));
      const auto& never = std::get<NeverStable<2>>(unstable);
      const double slowest = std::sqrt(-weakest_direction(problem).squared_speed);
      const double largest = BulkModes<2>(problem).symbol_maximum();
      CHECK(never.growth_rate <= slowest * largest * (1.0 + rounding));
      CHECK(never.growth_rate > 0.9 * slowest * largest);
      CHECK(growth_range(problem).growth_rate == never.growth_rate);
    }
  }
}

TEST_CASE("growth in a cone of directions narrower than the grid is found whole", "[fast]") {
  auto problem = finite_strain_problem<2>(Formulation::total_lagrangian_corotated,
                                          Lattice<2>(LatticeKind::hexagonal, 1.0), KernelFamily::cubic_spline, 2.0);
  const double threshold = loss_of_ellipticity(problem.scheme.formulation, problem.material.poisson_ratio());
  problem.deformation_gradient = Vector<2>(threshold - 1e-8, 1.0).asDiagonal();
  // Wide kernels have |D~| near its maximum in every direction, the weakest one too.
  const double bound = std::sqrt(-weakest_direction(problem).squared_speed) * BulkModes<2>(problem).symbol_maximum();
  CHECK(growth_range(problem).growth_rate > 0.999 * bound);
}

TEST_CASE("a scan covers what the strain of the base state does not repeat", "[fast]") {
  const auto points = [](const Tensor<2>& F) {
    return static_cast<double>(
        ZoneScan<2>(finite_strain_problem<2>(Formulation::total_lagrangian_pk1, Lattice<2>(LatticeKind::square, 1.0),
                                             KernelFamily::cubic_spline, 2.0, F))
            .points()
            .size());
  };
  // Of the 8 symmetries of the square 4 keep a stretch along x and 2 a shear; boxes on the edges belong to both sides.
  constexpr double edges = 0.2;
  const double unstrained = points(Tensor<2>::Identity());
  CHECK(points(rotation(0.4)) == unstrained);
  CHECK(points(Vector<2>(1.3, 1.0).asDiagonal()) / unstrained == Approx(2.0).epsilon(edges));
  CHECK(points(rotation(0.4) * Vector<2>(1.3, 1.0).asDiagonal()) / unstrained == Approx(2.0).epsilon(edges));
  CHECK(points(sheared<2>()) / unstrained == Approx(4.0).epsilon(edges));
}

TEST_CASE("tension of any size makes no finite strain state grow", "[fast]") {
  for (const auto formulation : formulations)
    for (const double stretch : {1.2, 2.0, 4.0}) {
      const auto problem =
          finite_strain_problem<2>(formulation, Lattice<2>(LatticeKind::square, 1.0), KernelFamily::cubic_spline, 1.3,
                                   Vector<2>(stretch, 1.0).asDiagonal());
      CHECK(weakest_direction(problem).squared_speed > 0.0);
      CHECK(growth_range(problem).growth_rate == 0.0);
    }
}

TEST_CASE("a bar has its closed stiffness, and loses it at a third of the square of its length", "[fast]") {
  const auto bar = [](const Scheme& scheme, double stretch) {
    auto problem = finite_strain_problem<1>(scheme.formulation, Lattice<1>(LatticeKind::chain, 1.0),
                                            KernelFamily::quintic_spline, 1.2, Tensor<1>(stretch));
    problem.scheme = scheme;
    return problem;
  };
  for (const double l : {0.7, 1.0, 1.6}) {
    const auto problem = bar(corotated(), l);
    const auto [lambda, G, kappa] = problem.material.lame(Plane::strain);
    const double p_wave = lambda + 2.0 * G;
    const std::array moduli{p_wave * l, p_wave * 0.5 * (3.0 * l * l - 1.0),
                            G + (G + lambda * (1.0 - std::log(l))) / (l * l)};
    for (std::size_t i = 0; i < moduli.size(); ++i) {
      const BulkModes<1> modes(bar(every_scheme()[i], l));
      const double speed = std::sqrt(moduli[i] / problem.material.density());
      CHECK(std::get<ConditionallyStable<1>>(modes.limit()).critical_time_step ==
            Approx(2.0 / (modes.symbol_maximum() * speed)).epsilon(rounding));
      CHECK(weakest_direction(bar(every_scheme()[i], l)).squared_speed == Approx(speed * speed).epsilon(rounding));
    }
  }
  const double edge = 1.0 / std::sqrt(3.0);
  CHECK(std::holds_alternative<ConditionallyStable<1>>(bulk_limit(bar(pk1(), edge + 1e-9))));
  auto crushed = bar(pk1(), edge - 1e-3);
  const auto free = std::get<NeverStable<1>>(bulk_limit(crushed));
  crushed.scheme.damping = Damping{0.1};
  const auto damped = std::get<NeverStable<1>>(bulk_limit(crushed));
  // r² + c r − g² = 0.
  CHECK(damped.growth_rate == Approx(std::hypot(0.05, free.growth_rate) - 0.05).epsilon(rounding));
}

TEST_CASE("neighbours on a line cannot renormalise a gradient", "[fast]") {
  auto problem = finite_strain_problem<2>(Formulation::total_lagrangian_corotated,
                                          Lattice<2>(LatticeKind::staggered, 1.0), KernelFamily::cubic_spline, 1.3);
  problem.neighbour_rule = NeighbourRule::nearest;
  CHECK_THROWS_WITH(FiniteStrain<2>(problem), Catch::StartsWith("smoothing_length"));
}
