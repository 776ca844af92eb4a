// SPDX-License-Identifier: MIT
// Whether a strained law has waves in every direction: without a search, against the search and closed forms.
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "analysis/ellipticity.hpp"
#include "tests/analysis/finite_strain_problems.hpp"

using namespace sphstab;
using namespace sphstab::analysis;

namespace {

constexpr Scheme corotated{.formulation = Formulation::total_lagrangian_corotated};
constexpr Scheme pk1{.formulation = Formulation::total_lagrangian_pk1};
constexpr Scheme neo_hookean{.formulation = Formulation::total_lagrangian_pk1, .elastic_law = ElasticLaw::neo_hookean};

/// Nearer to the loss than this, relative to G/ρ0, the two need not agree: ten times what is_elliptic promises.
constexpr double undecided = 1e-6;

template <int Dim>
constexpr int states = Dim == 3 ? 30 : 300;  // a search in space takes a tenth of a second

LameConstants lame_of(double poisson_ratio) {
  return Material::from_young_modulus(1.0, 1.0, poisson_ratio).lame(Plane::strain);
}

template <int Dim>
class RandomStates {
 public:
  double poisson_ratio() { return std::uniform_real_distribution(-0.4, 0.49)(random_); }

  /// Turned stretches between e^−size and e^size.
  Tensor<Dim> deformation_gradient(double size) {
    Vector<Dim> stretch;
    for (double& u : stretch) u = std::exp(size * number());
    return rotation() * stretch.asDiagonal() * rotation();
  }

 private:
  double number() { return std::uniform_real_distribution(-1.0, 1.0)(random_); }

  Tensor<Dim> rotation() {
    if constexpr (Dim == 1) return Tensor<Dim>::Identity();
    const Tensor<Dim> any = Tensor<Dim>::NullaryExpr([this] { return number(); });
    Tensor<Dim> R = Eigen::HouseholderQR<Tensor<Dim>>(any).householderQ();
    if (R.determinant() < 0.0) R.col(0) = -R.col(0);
    return R;
  }

  std::mt19937 random_{7};
};

template <int Dim>
Lattice<Dim> lattice() {
  return Lattice<Dim>(lattices_of(Dim).front(), 1.0);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("a state is elliptic where the slowest of all waves has a speed, whatever the law", "[fast]",
                       ((int Dim), Dim), 1, 2, 3) {
  RandomStates<Dim> random;
  for (const auto& [scheme, size] : {std::pair(corotated, 0.7), {pk1, 0.5}, {neo_hookean, 3.0}}) {
    int kept = 0, lost = 0;
    for (int i = 0; i < states<Dim>; ++i) {
      auto problem = finite_strain_problem<Dim>(scheme.formulation, lattice<Dim>(), KernelFamily::cubic_spline, 1.3,
                                                random.deformation_gradient(Dim == 1 ? 2.0 * size : size));
      problem.scheme = scheme;
      problem.material = Material::from_young_modulus(1.0, 1.0, random.poisson_ratio());
      const double squared_speed = weakest_direction(problem).squared_speed;
      if (std::abs(squared_speed) < undecided * problem.material.shear_modulus()) continue;
      ++(squared_speed > 0.0 ? kept : lost);
      INFO(name_of(scheme.formulation) << ", nu " << problem.material.poisson_ratio() << ", F\n"
                                       << problem.deformation_gradient << "\nc^2 " << squared_speed);
      CHECK(is_elliptic<Dim>(scheme, problem.material.lame(Plane::strain), problem.deformation_gradient) ==
            (squared_speed > 0.0));
    }
    CHECK(kept > states<Dim> / 20);
    if (Dim == 1 && scheme.formulation == Formulation::total_lagrangian_corotated)
      CHECK(lost == 0);  // dP/dF = (λ + 2G) u
    else
      CHECK(lost > states<Dim> / 20);
  }
}

TEMPLATE_TEST_CASE_SIG("neo-Hookean states lose ellipticity where their closed form says", "[fast]", ((int Dim), Dim),
                       2, 3) {
  // Q(n) = G I + (λ + G − λ ln J) (F⁻ᵀn)(F⁻ᵀn)ᵀ, and F⁻ᵀn is at most as long as 1/u of the least stretch.
  RandomStates<Dim> random;
  for (int i = 0; i < states<Dim>; ++i) {
    const LameConstants lame = lame_of(random.poisson_ratio());
    const Tensor<Dim> F = random.deformation_gradient(3.0);
    const double least = Tensor<Dim>(F.transpose() * F).template selfadjointView<Eigen::Lower>().eigenvalues()[0];
    const double factor = lame.lambda + lame.shear_modulus - lame.lambda * std::log(F.determinant());
    const double slowest = std::min(lame.shear_modulus, lame.shear_modulus + factor / least);
    if (std::abs(slowest) < undecided * lame.shear_modulus) continue;
    CHECK(is_elliptic<Dim>(neo_hookean, lame, F) == (slowest > 0.0));
  }
}

TEST_CASE("the most compressed state is not always the one that loses ellipticity", "[fast]") {
  const auto is_kept = [](const Scheme& scheme, double x, double y) {
    return is_elliptic<2>(scheme, lame_of(0.3), Vector<2>(x, y).asDiagonal());
  };
  CHECK(is_kept(pk1, 0.72, 1.3));
  CHECK_FALSE(is_kept(pk1, 0.80, 0.80));
  // Uniaxially: tl-corotated at 0.46909570 (theory.md §5), neo-Hookean beyond exp(1 + 2G/λ).
  CHECK(is_kept(corotated, 0.46909571, 1.0));
  CHECK_FALSE(is_kept(corotated, 0.46909569, 1.0));
  const double longest = std::exp(1.0 + 0.4 / 0.3);  // 2G/λ = (1 − 2ν)/ν
  CHECK(is_kept(neo_hookean, longest * (1.0 - 1e-6), 1.0));
  CHECK_FALSE(is_kept(neo_hookean, longest * (1.0 + 1e-6), 1.0));
}

TEST_CASE("a state that is turned inside out, or none, is not elliptic", "[fast]") {
  for (const auto& scheme : {corotated, pk1, neo_hookean}) {
    CHECK_FALSE(is_elliptic<2>(scheme, lame_of(0.3), Vector<2>(-1.0, 1.0).asDiagonal()));
    CHECK_FALSE(is_elliptic<2>(scheme, lame_of(0.3), Tensor<2>::Zero()));
    CHECK_FALSE(is_elliptic<2>(scheme, lame_of(0.3), Tensor<2>::Constant(std::nan(""))));
    CHECK(is_elliptic<2>(scheme, lame_of(0.3), Vector<2>(-1.0, -1.0).asDiagonal()));
  }
}
