// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>

#include "analysis/updated_lagrangian.hpp"

using namespace sphstab;

namespace {

constexpr double c0 = 1.3, mu = 0.37, rho0 = 1.7, pressure = -0.21;

template <int Dim>
constexpr LatticeKind lattice_of = Dim == 1   ? LatticeKind::chain
                                   : Dim == 2 ? LatticeKind::hexagonal
                                              : LatticeKind::fcc;

/// An untruncated Gaussian of this h sees a perfect continuum but for its own width: the sums of long waves are
/// integrals to 1e-16.
constexpr double wide = 1.6;

template <int Dim>
Problem<Dim> stressed_problem() {
  Problem<Dim> problem{.lattice = Lattice<Dim>(lattice_of<Dim>, 0.8),
                       .kernel = Kernel<Dim>(KernelFamily::gaussian, 0.8 * wide, 7.0),
                       .material = Material::from_sound_speed(rho0, c0, mu)};
  problem.scheme.formulation = Formulation::updated_lagrangian;
  problem.pressure = pressure;
  Vector<symmetric_size<Dim>> S = Vector<symmetric_size<Dim>>::Zero();
  for (int c = 0; c < S.size(); ++c) S[c] = 0.11 * std::cos(1.0 + 2.0 * c);
  problem.deviatoric_stress = symmetric_tensor<Dim, double>(S);
  return problem;
}

/// A few roundings of numbers of order 1.
constexpr double rounding = 1e-14;

}  // namespace

TEST_CASE("in principal axes the waves of the continuum are those of Gray's Eqs. 4.9 and 4.10", "[fast]") {
  auto problem = stressed_problem<2>();
  const double Sxx = 0.13, Syy = -0.07, zeta = 0.5 * (Sxx - Syy), rho = rho0 + pressure / (c0 * c0);
  problem.deviatoric_stress << Sxx, 0.0, 0.0, Syy;
  const double kx = 0.31, ky = -0.83;
  const double stiffness = rho * c0 * c0;
  Tensor<2> expected;
  expected << kx * kx * (stiffness + 4.0 * mu / 3.0) + ky * ky * (mu - zeta), kx * ky * (stiffness + mu / 3.0 + zeta),
      kx * ky * (stiffness + mu / 3.0 - zeta), ky * ky * (stiffness + 4.0 * mu / 3.0) + kx * kx * (mu + zeta);
  const Tensor<2> found = analysis::continuum_matrix(problem, Vector<2>(kx, ky));
  CHECK((rho * found - expected).cwiseAbs().maxCoeff() < rounding);
  // Eq. 4.11, and Eq. 4.12 with the factor 1/2 that it lacks (errata.md G2).
  const double k2 = kx * kx + ky * ky;
  const auto waves = analysis::squared_frequencies<2>(found, 0.0);
  CHECK(waves[0].real() == Approx((mu * k2 + (kx * kx - ky * ky) * (Sxx - Syy) / 2.0) / rho).epsilon(rounding));
  CHECK(waves[1].real() == Approx(k2 * (c0 * c0 + 4.0 * mu / (3.0 * rho))).epsilon(rounding));
}

TEMPLATE_TEST_CASE_SIG("long waves of the lattice are those of the continuum, to second order in k", "[fast]",
                       ((int Dim), Dim), 1, 2, 3) {
  const auto problem = stressed_problem<Dim>();
  const analysis::UpdatedLagrangian<Dim> scheme(problem);
  const Vector<Dim> direction = Vector<Dim>(Eigen::Vector3d(0.36, -0.48, 0.8).head<Dim>());
  const auto error = [&](double k) {
    const Vector<Dim> wave_vector = k * direction;
    const Tensor<Dim> continuum = analysis::continuum_matrix(problem, wave_vector);
    return (scheme(wave_vector).dynamical_matrix() - continuum).norm() / continuum.norm();
  };
  // W~ = exp(−(kh)²/4): the error is (kh)² times a constant, and of fourth order beyond: 0.01 of it at these k.
  const double coarse = error(0.08), fine = error(0.04);
  CHECK(fine > 0.0);
  CHECK(coarse / fine == Approx(4.0).epsilon(0.02));
}
