// SPDX-License-Identifier: MIT
// Rung 1 of `ul`: what the linearised scheme of Gray, Monaghan & Swift must be without knowing how it is computed.
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "analysis/amplification.hpp"
#include "analysis/updated_lagrangian.hpp"
#include "ladder/cases.hpp"
#include "ladder/point_group.hpp"

using namespace sphstab;

namespace {

constexpr double pi = std::numbers::pi;
/// Sums of up to some hundred terms, relative to the largest entry of M over the zone.
constexpr double rounding = 1e-13;
/// Errors of long waves are of second order in k; 0.1 leaves room for the fourth.
constexpr double order = 2.0, order_tolerance = 0.1;

template <int Dim>
Vector<Dim> some_direction() {
  return Vector<3>(0.6, -0.9, 0.4).head<Dim>().normalized();
}

template <int Dim>
Problem<Dim> updated_problem(LatticeKind lattice, KernelFamily kernel, double h_over_spacing) {
  auto problem = ladder::basic_problem<Dim>(lattice, kernel, h_over_spacing);
  problem.scheme.formulation = Formulation::updated_lagrangian;
  return problem;
}

/// In tension and shear, with every term that moves no energy out of the waves.
template <int Dim>
Problem<Dim> stressed_problem(LatticeKind lattice) {
  auto problem = updated_problem<Dim>(lattice, KernelFamily::quintic_spline, 0.83);
  Tensor<3> S;
  S << 0.3, 0.5, -0.1, 0.5, -0.2, 0.2, -0.1, 0.2, -0.4;
  problem.pressure = -0.2;
  problem.deviatoric_stress = S.topLeftCorner<Dim, Dim>();
  problem.scheme.artificial_stress = ArtificialStress{.epsilon = 0.4};
  problem.scheme.xsph = Xsph{0.5};
  return problem;
}

double c0_squared(const Material& material) { return material.bulk_modulus() / material.density(); }

/// One cubic spline of h = Δp = 1 on a chain of density 1 under the stress σ = −P: its one neighbour a side has W =
/// 1/6, W' = −1/2 and W'' = 1, so that A = −sin k, B = 2 (1 − cos k), β = ε̃ (1 − cos k)/3, Aφ = A and, with (φ W')' = n
/// W'²/W + W'' = 3n/2 + 1, f = (3n/2 + 1) B.
struct Chain {
  double stress = 0.0, shear_modulus = 0.4, sound_speed = 1.3;
  std::optional<ArtificialStress> artificial_stress = {};
  double xsph = 0.0;

  /// The reference density makes that of the stressed state 1.
  Problem<1> problem(Integrator integrator = Integrator::leapfrog) const {
    const double reference = 1.0 + stress / (sound_speed * sound_speed);
    Problem<1> problem{.lattice = Lattice<1>(LatticeKind::chain, 1.0),
                       .kernel = Kernel<1>(KernelFamily::cubic_spline, 1.0),
                       .material = Material::from_sound_speed(reference, sound_speed, shear_modulus),
                       .integrator = integrator,
                       .pressure = -stress};
    problem.scheme.formulation = Formulation::updated_lagrangian;
    problem.scheme.artificial_stress = artificial_stress;
    if (xsph != 0.0) problem.scheme.xsph = Xsph{xsph};
    return problem;
  }

  double epsilon() const { return artificial_stress && stress > 0.0 ? artificial_stress->epsilon : 0.0; }
  double smoothing(double k) const { return 1.0 - xsph * (1.0 - std::cos(k)) / 3.0; }
  /// Stress part of ω²: exactly linearised, R follows every stress and takes its share ε of the force.
  double stress_part(double k) const {
    const bool follows = artificial_stress && artificial_stress->linearisation == ArtificialStressLinearisation::exact;
    const double stiffness = sound_speed * sound_speed + 4.0 / 3.0 * shear_modulus + 2.0 * stress;
    return smoothing(k) * (1.0 - (follows ? epsilon() : 0.0)) * stiffness * std::pow(std::sin(k), 2);
  }
  double omega_squared(double k) const {
    const double n = artificial_stress ? artificial_stress->exponent : 0.0;
    const double repulsion = 1.0 - epsilon() * (1.5 * n + 1.0);
    return stress_part(k) - smoothing(k) * 2.0 * stress * repulsion * 2.0 * (1.0 - std::cos(k));
  }
};

/// … at rest, in compression, in tension, and with every term.
std::vector<Chain> chains() {
  const ArtificialStress exact{.epsilon = 0.3};
  ArtificialStress frozen{.epsilon = 0.2, .exponent = 2.5};
  frozen.linearisation = ArtificialStressLinearisation::frozen;
  return {{},
          {.stress = -0.1},
          {.stress = 0.1},
          {.stress = -0.1, .artificial_stress = exact, .xsph = 0.5},
          {.stress = 0.1, .artificial_stress = exact, .xsph = 0.5},
          {.stress = 0.1, .artificial_stress = frozen, .xsph = 0.5}};
}

}  // namespace

TEMPLATE_TEST_CASE_SIG(
    "rung 1: without stress long waves of ul travel at the p-wave and s-wave speeds, with an error "
    "of second order",
    "[ladder]", ((int Dim), Dim), 1, 2, 3) {
  // A = −L k (1 + O(k²)) with the consistency L of the lattice; XSPH smooths by O(k²).
  for (const auto& [kernel, kernel_name] : Names<KernelFamily>::table)
    for (const LatticeKind lattice : lattices_of(Dim))
      for (const double xsph : {0.0, 0.5}) {
        INFO(kernel_name << " " << name_of(lattice) << ", XSPH " << xsph);
        auto problem = updated_problem<Dim>(lattice, kernel, Dim == 3 ? 0.93 : 1.27);
        if (xsph > 0.0) problem.scheme.xsph = Xsph{xsph};
        const Tensor<Dim> L = ladder::consistency(problem);
        const auto errors = [&](double size) {
          const Vector<Dim> k = size / problem.lattice.spacing() * some_direction<Dim>(), Lk = L * k;
          const Tensor<Dim> M =
              problem.material.density() / Lk.squaredNorm() * analysis::dynamical_matrix<Dim>(problem, k);
          const Vector<Dim> moduli = Eigen::SelfAdjointEigenSolver<Tensor<Dim>>(M).eigenvalues();
          return std::array<double, 2>{moduli[Dim - 1] / problem.material.p_wave_modulus() - 1.0,
                                       moduli[0] / problem.material.shear_modulus() - 1.0};
        };
        const auto coarse = errors(0.1), fine = errors(0.05);
        for (std::size_t branch = 0; branch < (Dim == 1 ? 1 : 2); ++branch) {
          CHECK(std::abs(fine[branch]) < 1e-2);
          CHECK(std::log2(coarse[branch] / fine[branch]) == Approx(order).margin(order_tolerance));
        }
      }
}

TEMPLATE_TEST_CASE_SIG("rung 1: long waves of a stressed body obey the exact relation of the continuum", "[ladder]",
                       ((int Dim), Dim), 2, 3) {
  // Gray's Eqs. 4.9 to 4.12, (4.12) with the ½ that the print lacks (errata.md G2); k and S in the plane of x and y. A
  // Gaussian of h = 2 Δp knows nothing of the lattice to 1e-11 (test_limits.cpp).
  for (const LatticeKind lattice : lattices_of(Dim)) {
    INFO(name_of(lattice));
    auto problem = updated_problem<Dim>(lattice, KernelFamily::gaussian, 2.0);
    problem.kernel = Kernel<Dim>(KernelFamily::gaussian, 2.0 * problem.lattice.spacing(), 6.0);
    problem.pressure = -0.6;
    problem.deviatoric_stress(0, 0) = 0.5;
    problem.deviatoric_stress(1, 1) = -0.2;
    problem.scheme.xsph = Xsph{0.5};
    const double zeta = 0.35, mu = problem.material.shear_modulus(), c0 = c0_squared(problem.material);
    const double rho = problem.material.density() + problem.pressure / c0, K = rho * c0;
    struct Errors {
      double matrix, longitudinal, transverse;
    };
    const auto errors = [&](double size) {
      const double kx = 0.6 * size / problem.lattice.spacing(), ky = -0.8 * size / problem.lattice.spacing();
      const double k_squared = kx * kx + ky * ky;
      Tensor<2> continuum;
      continuum << kx * kx * (K + 4.0 / 3.0 * mu) + ky * ky * (mu - zeta), kx * ky * (K + mu / 3.0 + zeta),
          kx * ky * (K + mu / 3.0 - zeta), ky * ky * (K + 4.0 / 3.0 * mu) + kx * kx * (mu + zeta);
      Vector<Dim> k = Vector<Dim>::Zero();
      k[0] = kx, k[1] = ky;
      const Tensor<2> M = rho * analysis::dynamical_matrix<Dim>(problem, k).template topLeftCorner<2, 2>();
      const Vector<2> omega_squared = Eigen::EigenSolver<Tensor<2>>(M).eigenvalues().real();
      const double longitudinal = k_squared * (K + 4.0 / 3.0 * mu);
      const double transverse = mu * k_squared + (kx * kx - ky * ky) * zeta;
      return Errors{(M - continuum).norm() / k_squared, omega_squared.maxCoeff() / longitudinal - 1.0,
                    omega_squared.minCoeff() / transverse - 1.0};
    };
    const auto coarse = errors(0.1), fine = errors(0.05);
    for (const auto error : {&Errors::matrix, &Errors::longitudinal, &Errors::transverse}) {
      CHECK(std::abs(fine.*error) < 3e-2);
      CHECK(std::log2(coarse.*error / fine.*error) == Approx(order).margin(order_tolerance));
    }
  }
}

TEST_CASE("rung 1: in tension artificial stress takes 1 - eps a_n of the modulus of long waves, in compression nothing",
          "[ladder]") {
  // a_n as theory.md §3 has it, found there from the nonlinear step: to half a unit of its last digit.
  constexpr double last_digit = 5e-4;
  struct Known {
    KernelFamily kernel;
    double h_over_spacing, exponent, a_n;
  };
  for (const auto& known :
       {Known{KernelFamily::cubic_spline, 1.0, 4.0, 0.674}, Known{KernelFamily::cubic_spline, 1.3, 4.0, 0.411},
        Known{KernelFamily::cubic_spline, 1.5, 4.0, 0.293}, Known{KernelFamily::sinc_5, 1.2, 6.0, 0.706}}) {
    INFO(name_of(known.kernel) << ", h/Δp " << known.h_over_spacing);
    auto problem = updated_problem<2>(LatticeKind::square, known.kernel, known.h_over_spacing);
    const auto plain = problem;
    problem.scheme.artificial_stress =
        ArtificialStress{.epsilon = 0.3, .exponent = known.exponent, .zero_side = ZeroStressSide::tension};
    // What is left of the moduli of waves of length 2π Δp / size along x.
    const auto left = [&](double size) -> Vector<2> {
      const Vector<2> k(size / problem.lattice.spacing(), 0.0);
      return analysis::dynamical_matrix<2>(problem, k).diagonal().array() /
             analysis::dynamical_matrix<2>(plain, k).diagonal().array();
    };
    const double factor = analysis::UpdatedLagrangian<2>(problem).tension_modulus_factor();
    CHECK((1.0 - factor) / 0.3 == Approx(known.a_n).margin(last_digit));
    for (const int polarisation : {0, 1}) {
      const double coarse = left(0.1)[polarisation] - factor, fine = left(0.05)[polarisation] - factor;
      CHECK(std::abs(fine) < 1e-3);
      // With h = Δp every neighbour is one spacing away along x or none, and the factor is that of every k.
      if (known.h_over_spacing == 1.0)
        CHECK(std::abs(coarse) < rounding);
      else
        CHECK(std::log2(coarse / fine) == Approx(order).margin(order_tolerance));
    }
    problem.scheme.artificial_stress->zero_side = ZeroStressSide::compression;
    CHECK(left(0.05) == Vector<2>::Ones());
    CHECK(left(2.0) == Vector<2>::Ones());
  }
}

TEMPLATE_TEST_CASE_SIG("rung 1: without a wave a stressed body neither vibrates nor grows", "[ladder]",
                       ((int Dim), Dim), 1, 2, 3) {
  for (const LatticeKind lattice : lattices_of(Dim)) {
    INFO(name_of(lattice));
    auto problem = stressed_problem<Dim>(lattice);
    problem.scheme.viscosity = Viscosity{1.0, 0.1};
    CHECK(analysis::dynamical_matrix<Dim>(problem, Vector<Dim>::Zero()).norm() == 0.0);
    for (const auto& [integrator, name] : Names<Integrator>::table) {
      problem.integrator = integrator;
      CHECK(analysis::mode_spectrum<Dim>(problem, Vector<Dim>::Zero(), 0.1).spectral_radius == 1.0);
    }
  }
}

TEMPLATE_TEST_CASE_SIG(
    "rung 1: the waves of ul turn with lattice and stress, and k, -k and k + reciprocal vectors are "
    "one",
    "[ladder]", ((int Dim), Dim), 1, 2, 3) {
  for (const LatticeKind lattice : lattices_of(Dim)) {
    INFO(name_of(lattice));
    const auto problem = stressed_problem<Dim>(lattice);
    REQUIRE(ladder::point_group(problem.lattice).size() == ladder::order_of_point_group(lattice));
    const auto turn = [](const Tensor<Dim>& R, Problem<Dim>& turned) {
      turned.deviatoric_stress = (R * turned.deviatoric_stress * R.transpose()).eval();
    };
    // At π/Δp M is nearly as large as anywhere.
    const double scale =
        analysis::dynamical_matrix<Dim>(problem, pi / problem.lattice.spacing() * some_direction<Dim>()).norm();
    for (const double size : {0.4, 1.3, 2.7}) {
      const Vector<Dim> k = size / problem.lattice.spacing() * some_direction<Dim>();
      CHECK(ladder::symmetry_error<Dim>(problem, k, turn) < rounding * scale);
    }
  }
}

TEST_CASE("rung 1: waves of a chain of nearest neighbours are those derived by hand", "[ladder]") {
  for (const auto& chain : chains())
    for (double k = 0.1; k < 6.0; k += 0.37) {
      INFO("stress " << chain.stress << ", eps " << chain.epsilon() << ", k " << k);
      const double omega_squared = analysis::dynamical_matrix<1>(chain.problem(), Vector<1>(k))(0, 0);
      CHECK(std::abs(omega_squared - chain.omega_squared(k)) < rounding);
    }
}

TEST_CASE("rung 1: 2/(3n+2) is the artificial stress that stops the clumping of a chain of nearest neighbours",
          "[ladder]") {
  constexpr double nearly = 1e-9;
  for (const double n : {1.0, 2.5, 4.0, 6.0})
    for (const double side : {-nearly, nearly}) {
      INFO("n " << n << ", side " << side);
      const Chain chain{.stress = 0.1,
                        .artificial_stress = ArtificialStress{.epsilon = 2.0 / (3.0 * n + 2.0) + side, .exponent = n}};
      const double omega_squared = analysis::dynamical_matrix<1>(chain.problem(), Vector<1>(pi))(0, 0);
      CHECK((omega_squared > 0.0) == (side > 0.0));
    }
}

TEST_CASE("rung 1: a step of Gray's predictor-corrector has the trace 2 - z and the determinant 1 + z z_s / 4",
          "[ladder]") {
  // theory.md §4: z = ω² Δt², z_s its stress part; the other two of the four eigenvalues are those of static
  // offsets, 1.
  for (auto chain : chains()) {
    chain.xsph = 0.0;  // F0 is not smoothed in r', so that XSPH under stress has no such form
    for (const double dt : {0.05, 0.4, 1.1})
      for (double k = 0.1; k < 6.0; k += 0.83) {
        INFO("stress " << chain.stress << ", eps " << chain.epsilon() << ", k " << k << ", Δt " << dt);
        const auto E =
            analysis::amplification_matrix<1>(chain.problem(Integrator::predictor_corrector), Vector<1>(k), dt);
        const double z = chain.omega_squared(k) * dt * dt, z_s = chain.stress_part(k) * dt * dt;
        CHECK(std::abs(E.trace() - (4.0 - z)) < rounding);
        CHECK(std::abs(E.determinant() - (1.0 + 0.25 * z * z_s)) < 10.0 * rounding);
      }
  }
}

TEST_CASE("rung 1: without stress the predictor-corrector grows by z²/8 a step, with stored rates by z²/4",
          "[ladder]") {
  // The relative error of these is of order z = (ωΔt)²: below 1e-4 here.
  const Chain chain;
  const double k = 1.2, dt = 0.01 / std::sqrt(chain.omega_squared(k)), z = 1e-4;
  const auto growth = [&](Integrator integrator) {
    return analysis::mode_spectrum<1>(chain.problem(integrator), Vector<1>(k), dt).spectral_radius - 1.0;
  };
  CHECK(growth(Integrator::predictor_corrector) == Approx(z * z / 8.0).epsilon(1e-3));
  CHECK(growth(Integrator::predictor_corrector_pec) == Approx(z * z / 4.0).epsilon(1e-3));
}
