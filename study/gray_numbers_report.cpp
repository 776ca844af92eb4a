// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <numbers>

#include "analysis/amplification.hpp"
#include "analysis/lattice_sums.hpp"
#include "analysis/updated_lagrangian.hpp"
#include "io/document.hpp"
#include "io/figure.hpp"
#include "study/report.hpp"

namespace sphstab::study {
namespace {

using std::numbers::pi, std::numbers::sqrt2;

/// ε and n of the paper's calculations, ε̃ of its XSPH.
constexpr double epsilon = 0.3, exponent = 4.0, xsph = 0.5;
/// Where a formula is compared, in units that make no factor 1: density and stress of the base state, μ, c0², Δp = 1.
constexpr double density = 1.25, square_of_c0 = 1.6, shear_modulus = 0.7, pressure = -0.1, Sxx = 0.2, Syy = -0.07;
constexpr double zeta = 0.5 * (Sxx - Syy), bulk_modulus = density * square_of_c0;
/// A formula that is right agrees to this much of its value …
constexpr double rounding = 1e-11;
/// … and in the limit of long waves, taken at k Δp = 1e-3, to the (kh)² that is left.
constexpr double long_wave = 1e-3, long_wave_error = 1e-5;
/// A value that is wrong by no more than this part of it, though not in its last digit, was rounded or simplified.
constexpr double rounded_off = 0.25;

enum class Verdict { right, rounded, misprint, wrong };

std::string_view name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::right:
      return "right";
    case Verdict::rounded:
      return "rounded";
    case Verdict::misprint:
      return "misprint";
    case Verdict::wrong:
      return "wrong";
  }
  return "";
}

/// A printed number, or what a printed formula gives, beside ours.
struct Number {
  std::string where;
  std::string what;
  double printed;
  double ours;
  double resolution;  ///< half a unit of the last printed digit
  Verdict verdict;
  std::string why;
};

/// A statement, what we find, and whether it holds.
struct Statement {
  std::string where;
  std::string printed;
  std::string ours;
  bool holds;
  Verdict verdict;
  std::string why;
};

/// What the values allow to be said: `misprint` and `wrong` are one to them.
bool borne_out(const Number& number) {
  const double difference = std::abs(number.printed - number.ours);
  switch (number.verdict) {
    case Verdict::right:
      return difference <= number.resolution;
    case Verdict::rounded:
      return difference > number.resolution && difference <= rounded_off * std::abs(number.ours);
    case Verdict::misprint:
    case Verdict::wrong:
      return difference > number.resolution;
  }
  return false;
}

bool borne_out(const Statement& statement) { return statement.holds == (statement.verdict == Verdict::right); }

const Vector<2> clumping_wave(pi, 0.0);

/// The sums of the cubic spline at k = (π/Δp, 0), or another k, Δp = 1.
analysis::LatticeSums<2> sums(LatticeKind lattice, double h, double n = exponent, const Vector<2>& k = clumping_wave) {
  return analysis::LatticeSummation<2>(Lattice<2>(lattice, 1.0), Kernel<2>(KernelFamily::cubic_spline, h),
                                       NeighbourRule::support, ArtificialStress{.epsilon = 1.0, .exponent = n},
                                       std::nullopt)(k);
}

/// The principal stress in ρ²R that stops clumping, as a part of σ (Eq. 5.22).
double clumping_coefficient(LatticeKind lattice, double h, double n = exponent) {
  const auto s = sums(lattice, h, n);
  return s.B(0, 0) / s.f(0, 0);
}

double B_y(LatticeKind lattice, double h) { return sums(lattice, h).B(1, 1); }

template <class Function>
double root(const Function& f, double low, double high) {
  std::uintmax_t iterations = 100;
  const auto [a, b] =
      boost::math::tools::toms748_solve(f, low, high, boost::math::tools::eps_tolerance<double>(50), iterations);
  return 0.5 * (a + b);
}

/// The scheme about the base state above.
Problem<2> stressed(LatticeKind lattice, double h) {
  Problem<2> problem{
      .lattice = Lattice<2>(lattice, 1.0),
      .kernel = Kernel<2>(KernelFamily::cubic_spline, h),
      .material = Material::from_sound_speed(density - pressure / square_of_c0, std::sqrt(square_of_c0), shear_modulus),
      .pressure = pressure};
  problem.scheme.formulation = Formulation::updated_lagrangian;
  problem.deviatoric_stress.diagonal() << Sxx, Syy;
  return problem;
}

/// A Gaussian of h = 2 Δp: sums over a lattice of spacing 1 are the integrals to 1e-11.
Kernel<2> lattice_blind_kernel() { return {KernelFamily::gaussian, 2.0, 7.0}; }

ArtificialStress frozen(double strength, double n = exponent) {
  return {.epsilon = strength, .exponent = n, .linearisation = ArtificialStressLinearisation::frozen};
}

/// ρ̄ω² V/(1 − β) as a matrix on V.
Tensor<2> scaled_matrix(const Problem<2>& problem, const Vector<2>& k) {
  const auto wave = analysis::UpdatedLagrangian<2>(problem)(k);
  return density / wave.smoothing * wave.dynamical_matrix();
}

/// A value to five digits.
std::string five(double value) { return fmt::format("{:.5g}", value); }

/// A row for a formula, whose value agrees to a relative error if it is right.
Number formula(std::string where, std::string what, double printed, double ours, Verdict verdict = Verdict::right,
               std::string why = "", double error = rounding) {
  return {std::move(where), std::move(what), printed, ours, error * std::abs(ours), verdict, std::move(why)};
}

/// Eqs. 4.9 to 4.13 and 5.11 against the scheme in the limit of long waves.
std::vector<Number> continuum_numbers() {
  auto problem = stressed(LatticeKind::square, 2.0);
  problem.kernel = lattice_blind_kernel();
  const double kx = 0.8, ky = 0.6;
  const Tensor<2> M = scaled_matrix(problem, long_wave * Vector<2>(kx, ky)) / (long_wave * long_wave);
  const Eigen::EigenSolver<Tensor<2>> modes(M);
  const int fast = modes.eigenvalues()[0].real() > modes.eigenvalues()[1].real() ? 0 : 1, slow = 1 - fast;
  const Vector<2> V = modes.eigenvectors().col(slow).real();
  const double K = bulk_modulus, mu = shear_modulus, turning = (kx * kx - ky * ky) * (Sxx - Syy);
  const double x_row = kx * kx * (K + 4.0 / 3.0 * mu) + ky * ky * (mu - zeta) + kx * ky * (K + mu / 3.0 + zeta);
  const double y_row = ky * ky * (K + 4.0 / 3.0 * mu) + kx * kx * (mu + zeta) + kx * ky * (K + mu / 3.0 - zeta);
  const auto limit = [](std::string where, std::string what, double printed, double ours,
                        Verdict verdict = Verdict::right, std::string why = "") {
    return formula(std::move(where), std::move(what), printed, ours, verdict, std::move(why), long_wave_error);
  };
  return {limit("(4.9)", "ρω²V_x, V = (1, 1)", x_row, M.row(0).sum()),
          limit("(4.10)", "ρω²V_y, V = (1, 1)", y_row, M.row(1).sum()),
          limit("(4.11)", "ρω² of the longitudinal wave", K + 4.0 / 3.0 * mu, modes.eigenvalues()[fast].real()),
          limit("(4.12)", "ρω² of the transverse wave", mu + turning, modes.eigenvalues()[slow].real(),
                Verdict::misprint, "the last term lacks a factor ½"),
          limit("(4.13)", "V_x/V_y of the transverse wave", -ky * (K + mu / 3.0 + zeta) / (kx * (K + mu / 3.0 - zeta)),
                V[0] / V[1]),
          limit("(5.11)", "ρω²V_x, V = (1, 1)", x_row - kx * ky * (K - square_of_c0), M.row(0).sum(), Verdict::misprint,
                "the second c0² lacks its ρ̄")};
}

/// Eq. 2.8, and Eqs. 6.2 and 6.3 with the angle of Eq. 6.1.
std::vector<Number> material_numbers() {
  const double ratio = 3.0 * bulk_modulus / shear_modulus, Sxy = 0.11;
  const double theta = 0.5 * std::atan(2.0 * Sxy / (Sxx - Syy)), c = std::cos(theta), s = std::sin(theta);
  const Vector<2> principal =
      Eigen::SelfAdjointEigenSolver<Tensor<2>>((Tensor<2>() << Sxx, Sxy, Sxy, Syy).finished()).eigenvalues();
  return {
      formula("(2.8)", "Poisson's ratio", (ratio - 2.0) / (2.0 * (ratio + 2.0)),
              Material::from_bulk_modulus(density, bulk_modulus, shear_modulus).poisson_ratio(), Verdict::misprint,
              "the denominator is 2 (3K/μ + 1)"),
      formula("(6.2)", "the greater principal value of S with Sxy = 0.11",
              c * c * Sxx + 2.0 * s * c * Sxy + s * s * Syy, principal[1]),
      formula("(6.3)", "the lesser principal value of S with Sxy = 0.11", s * s * Sxx + 2.0 * s * c * Sxy + c * c * Syy,
              principal[0], Verdict::misprint, "the term 2sc σxy lacks its minus sign")};
}

/// Eqs. 5.4 and 5.10, where the kernel knows nothing of the lattice.
std::vector<Number> smooth_numbers() {
  const Kernel<2> kernel = lattice_blind_kernel();
  const Vector<2> k(0.3, 0.2);
  const double transform = std::exp(-0.25 * k.squaredNorm() * std::pow(kernel.smoothing_length(), 2));
  const auto s = analysis::LatticeSummation<2>(Lattice<2>(LatticeKind::square, 1.0), kernel, NeighbourRule::support,
                                               std::nullopt, std::nullopt)(k);
  return {formula("(5.4)", "V̂/V", 0.5 * (1.0 + transform), 1.0 - xsph * s.beta_sum),
          formula("(5.10)", "A_x", -k[0] * transform, s.A[0]),
          formula("(5.10)", "B_x", k[0] * k[0] * transform, s.B(0, 0)),
          formula("(5.10)", "C", k[0] * k[1] * transform, s.B(0, 1))};
}

/// f_xx of Eqs. 5.14 and 5.15 as they are printed, by the derivatives of W to the power n + 1.
double f_xx_of_powers(double h, const Vector<2>& k) {
  const Kernel<2> kernel(KernelFamily::cubic_spline, h);
  const Lattice<2> lattice(LatticeKind::staggered, 1.0);
  double sum = 0.0;
  for (const auto& b : lattice_neighbours(lattice, kernel.support(), NeighbourRule::support)) {
    const double r = b.distance, x = b.position[0] / r, W = kernel.value(r), W_x = kernel.slope(r) * x;
    const double W_xx = kernel.curvature(r) * x * x + kernel.slope(r) / r * (1.0 - x * x);
    sum += (1.0 - std::cos(k.dot(b.position))) * (exponent + 1.0) *
           (exponent * std::pow(W, exponent - 1.0) * W_x * W_x + std::pow(W, exponent) * W_xx);
  }
  return lattice.cell_volume() / ((exponent + 1.0) * std::pow(kernel.value(1.0), exponent)) * sum;
}

/// Eqs. 5.6 to 5.9 and 5.14 at no special wave vector.
std::vector<Number> general_numbers() {
  const Vector<2> k(0.9, 1.7), V(1.0, 0.6);
  const double h = 1.2, mu = shear_modulus;
  auto problem = stressed(LatticeKind::staggered, h);
  problem.scheme.xsph = Xsph{xsph};
  const auto s = sums(LatticeKind::staggered, h, exponent, k);
  const Vector<2> ours = scaled_matrix(problem, k) * V, BV = s.B * V;
  const double A_x = s.A[0], A_y = s.A[1], A_V = s.A.dot(V);
  const double T_xx = 2.0 / 3.0 * mu * (2.0 * V[0] * A_x - V[1] * A_y);
  const double T_yy = 2.0 / 3.0 * mu * (2.0 * V[1] * A_y - V[0] * A_x);
  const double T_xy = mu * (V[0] * A_y + V[1] * A_x) - zeta * (V[0] * A_y - V[1] * A_x);
  const double px = pressure - Sxx, py = pressure - Syy;
  return {formula("(5.6)", "ρω²V_x/(1−β)",
                  -2.0 * (px - bulk_modulus) * A_V * A_x + 2.0 * px * BV[0] - T_xx * A_x - T_xy * A_y, ours[0],
                  Verdict::misprint, "factor 2 on ρ̄c0², sign and (Δp)² of the T terms"),
          formula("(5.7), (5.8)", "ρω²V_x/(1−β)",
                  -(2.0 * px - bulk_modulus) * A_V * A_x + 2.0 * px * BV[0] + T_xx * A_x + T_xy * A_y, ours[0]),
          formula("(5.7), (5.9)", "ρω²V_y/(1−β)",
                  -(2.0 * py - bulk_modulus) * A_V * A_y + 2.0 * py * BV[1] + T_yy * A_y + T_xy * A_x, ours[1]),
          formula("(5.14), (5.15)", "f_xx", f_xx_of_powers(h, k), s.f(0, 0))};
}

/// Eqs. 5.18 to 5.28, the modes at k = (π/Δp, 0), h = Δp.
std::vector<Number> mode_numbers() {
  const auto modes = [](LatticeKind lattice, double strength) {
    auto problem = stressed(lattice, 1.0);
    if (strength > 0.0) problem.scheme.artificial_stress = frozen(strength);
    return scaled_matrix(problem, clumping_wave);
  };
  const Tensor<2> without = modes(LatticeKind::square, 0.0), with = modes(LatticeKind::square, 1.0);
  const Tensor<2> resisting = modes(LatticeKind::staggered, epsilon);
  const auto square = sums(LatticeKind::square, 1.0), centred = sums(LatticeKind::staggered, 1.0);
  const double px = pressure - Sxx, py = pressure - Syy, A_squared = centred.A[0] * centred.A[0];
  const double p_wave = bulk_modulus + 4.0 / 3.0 * shear_modulus;
  const std::string value = "ρω²/(1−β), ";
  return {
      formula("(5.18)", value + "longitudinal, square, R = 0", 2.0 * square.B(0, 0) * px, without(0, 0)),
      formula("(5.19)", value + "transverse, square, R = 0", 2.0 * square.B(1, 1) * py, without(1, 1)),
      formula("(5.20)", value + "longitudinal, square, ε = 1", 2.0 * px * (square.B(0, 0) - square.f(0, 0)),
              with(0, 0)),
      formula("(5.24)", value + "transverse, square, ε = 1", 2.0 * py * (square.B(1, 1) - square.f(1, 1)), with(1, 1)),
      formula("(5.22)", "−ρ²R/|P−S| where clumping stops, square", square.B(0, 0) / square.f(0, 0),
              without(0, 0) / (without(0, 0) - with(0, 0))),
      formula("(5.25)", value + "longitudinal, face-centred, ε = 0.3",
              2.0 * px * (centred.B(0, 0) - epsilon * centred.f(0, 0)) + A_squared * (p_wave - px), resisting(0, 0),
              Verdict::misprint, "A_x² multiplies −2P + 2Sxx"),
      formula("(5.26)", "−ρ²R/|P−S| where clumping stops without A_x, face-centred",
              2.0 * centred.B(0, 0) / centred.f(0, 0), centred.B(0, 0) / centred.f(0, 0), Verdict::misprint,
              "a factor 2 too many; (5.27) is without it"),
      formula("(5.28)", value + "transverse, face-centred, ε = 0.3",
              2.0 * py * (centred.B(1, 1) - epsilon * centred.f(1, 1)) + A_squared * (shear_modulus + zeta),
              resisting(1, 1))};
}

/// All of these, a heading each.
std::vector<std::pair<std::string, std::vector<Number>>> formulas() {
  return {{"Formulas of the material", material_numbers()},
          {"Long waves along (0.8, 0.6), k = 1; ours the limit of the scheme", continuum_numbers()},
          {"Where the kernel knows nothing of the lattice: Gaussian, h = 2Δp, k = (0.3, 0.2)", smooth_numbers()},
          {"No special wave: face-centred, h = 1.2Δp, k = (0.9, 1.7), V = (1, 0.6)", general_numbers()},
          {"The modes at k = (π/Δp, 0), h = Δp", mode_numbers()}};
}

/// ω of a long wave along x over that without artificial stress, less 1, per strain |δρ|/ρ0 of a tension; R constant.
double long_wave_error_of(LatticeKind lattice, double h, double strength, double n) {
  const double strain = 1e-5;
  const auto stiffness = [&](std::optional<ArtificialStress> artificial_stress) {
    Problem<2> problem{.lattice = Lattice<2>(lattice, 1.0),
                       .kernel = Kernel<2>(KernelFamily::cubic_spline, h),
                       .material = Material::from_sound_speed(1.0, 1.0, 0.0),
                       .pressure = -strain};
    problem.scheme.formulation = Formulation::updated_lagrangian;
    problem.scheme.artificial_stress = artificial_stress;
    return analysis::dynamical_matrix<2>(problem, Vector<2>(long_wave, 0.0))(0, 0);
  };
  return (std::sqrt(stiffness(frozen(strength, n)) / stiffness(std::nullopt)) - 1.0) / strain;
}

/// How much more than the least over n = 1 … 8 the error of long waves is at n = 4, each with the R that just stops
/// clumping; the worst over both lattices and h/Δp from 1 to 1.5.
double excess_of_exponent() {
  double worst = 0.0;
  for (const auto lattice : {LatticeKind::square, LatticeKind::staggered})
    for (const double h : {1.0, 1.1, 1.2, 1.3, 1.4, 1.5}) {
      const auto error = [&](double n) {
        return long_wave_error_of(lattice, h, clumping_coefficient(lattice, h, n), n);
      };
      double least = error(1.0);
      for (const double n : {2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0}) least = std::min(least, error(n));
      worst = std::max(worst, error(exponent) / least - 1.0);
    }
  return worst;
}

/// What of the modulus of long waves the R that just stops clumping takes once it follows the stress; square, h = Δp.
double price(double n) {
  auto problem = stressed(LatticeKind::square, 1.0);
  problem.scheme.artificial_stress =
      ArtificialStress{.epsilon = clumping_coefficient(LatticeKind::square, 1.0, n), .exponent = n};
  return 1.0 - analysis::UpdatedLagrangian<2>(problem).tension_modulus_factor();
}

double tension_modulus_factor(double h) {
  auto problem = stressed(LatticeKind::square, h);
  problem.scheme.artificial_stress = ArtificialStress{.epsilon = epsilon, .exponent = exponent};
  return analysis::UpdatedLagrangian<2>(problem).tension_modulus_factor();
}

std::vector<Number> printed_numbers() {
  constexpr auto square = LatticeKind::square, staggered = LatticeKind::staggered;
  const auto s = sums(square, 1.0), c = sums(staggered, 1.0), wide = sums(staggered, 1.5);
  const double nearest = 30.0 * (3.0 * exponent + 2.0) / (7.0 * pi), w = 2.0 - sqrt2;
  const auto sign_change = [](LatticeKind lattice, double low, double high) {
    return root([=](double h) { return B_y(lattice, h); }, low, high);
  };
  const double reduction = clumping_coefficient(square, 1.0) / clumping_coefficient(square, 1.4);
  const double halved = root(
      [=](double h) { return clumping_coefficient(square, h) - 0.5 * clumping_coefficient(square, 1.0); }, 1.2, 1.6);
  return {
      {"(5.21)", "B_x (Δp)², square, h = Δp", 30.0 / (7.0 * pi) * (2.0 + w * (3.0 - sqrt2)), s.B(0, 0), rounding,
       Verdict::right, ""},
      {"(5.21)", "f_xx (Δp)², square, h = Δp, n = 4", nearest, s.f(0, 0), rounding, Verdict::rounded,
       fmt::format("nearest neighbours alone; for n = 1 {} instead of {}", five(150.0 / (7.0 * pi)),
                   five(sums(square, 1.0, 1.0).f(0, 0)))},
      {"(5.21)", "β, square, h = Δp", 10.0 / (7.0 * pi) * (1.0 + w * w * w), xsph * s.beta_sum, 0.005, Verdict::wrong,
       "it is 5/(7π) (1 + 2(2−√2)³)"},
      {"(5.23)", "3/(3n+2), square, n = 4", 3.0 / (3.0 * exponent + 2.0), clumping_coefficient(square, 1.0), rounding,
       Verdict::rounded, "2.92893/(3n+2) with f_xx of (5.21)"},
      {"after (5.23)", "reduction of that coefficient at h = 1.4Δp, \"~2\"", 2.0, reduction, 0.05, Verdict::rounded,
       fmt::format("it is 2 at h = {:.3f}Δp", halved)},
      {"after (5.24)", "B_y (Δp)², square, h = Δp", -0.096, s.B(1, 1), 0.0005, Verdict::rounded, "truncated"},
      {"after (5.24)", "h/Δp from which B_y > 0, square", 1.2, sign_change(square, 1.1, 1.3), 0.05, Verdict::right, ""},
      {"after (5.24)", "h/Δp up to which B_y > 0, square", 1.7, sign_change(square, 1.3, 1.7), 0.05, Verdict::wrong,
       ""},
      {"after (5.25)", "B_x (Δp)², face-centred, h = Δp", 2.81, c.B(0, 0), 0.005, Verdict::right, ""},
      {"after (5.25)", "f_xx (Δp)², face-centred, h = Δp", 19.7, c.f(0, 0), 0.05, Verdict::right, ""},
      {"after (5.25)", "A_x Δp, face-centred, h = Δp", -0.43, c.A[0], 0.005, Verdict::right, ""},
      {"(5.27)", "coefficient of R, face-centred, h = Δp", 0.14, clumping_coefficient(staggered, 1.0), 0.005,
       Verdict::right, ""},
      {"after (5.27)", "4n + 3.7 of f_xx at n = 6", 27.7, sums(staggered, 1.0, 6.0).f(0, 0), 0.05, Verdict::right, ""},
      {"after (5.27)", "4n + 3.7 of f_xx at n = 2", 11.7, sums(staggered, 1.0, 2.0).f(0, 0), 0.05, Verdict::rounded,
       "a straight line from n = 4 on"},
      {"after (5.28)", "B_y (Δp)², face-centred, h = Δp", 0.52, c.B(1, 1), 0.005, Verdict::right, ""},
      {"after (5.28)", "f_yy (Δp)², face-centred, h = Δp", 1.6, c.f(1, 1), 0.05, Verdict::right, ""},
      {"(5.29)", "coefficient of R, face-centred, h = Δp", 0.32, c.B(1, 1) / c.f(1, 1), 0.005, Verdict::rounded,
       "truncated; more than the ε = 0.3 of the paper"},
      {"after (5.29)", "h/Δp from which B_y < 0, face-centred", 1.4, sign_change(staggered, 1.1, 1.6), 0.05,
       Verdict::wrong, ""},
      {"(5.30)", "coefficient of P − Syy, h = 1.5Δp", -0.07, 2.0 * wide.B(1, 1), 0.005, Verdict::wrong,
       fmt::format("that is B_y = {}, not 2B_y", five(wide.B(1, 1)))},
      {"(5.30)", "coefficient of μ, h = 1.5Δp", 0.18, wide.A[0] * wide.A[0], 0.005, Verdict::wrong,
       fmt::format("A_x² at h = Δp is {}", five(c.A[0] * c.A[0]))},
      {"(5.32)", "error of ω per |δρ|/ρ0, ε = 0.3, n = 4, h = Δp, R constant", 0.02,
       long_wave_error_of(square, 1.0, epsilon, exponent), 0.005, Verdict::wrong,
       "and none of order δρ once R follows the stress, see below"},
      {"(5.32)", "the same, h = 1.5Δp", 0.02, long_wave_error_of(square, 1.5, epsilon, exponent), 0.005, Verdict::wrong,
       ""}};
}

template <class Function>
bool decreases(const Function& f, double low, double high) {
  constexpr int parts = 50;
  for (int i = 0; i < parts; ++i)
    if (f(low + (high - low) * (i + 1) / parts) >= f(low + (high - low) * i / parts)) return false;
  return true;
}

template <class Function>
double least(const Function& f, double low, double high) {
  constexpr int parts = 200;
  double smallest = f(low);
  for (int i = 1; i <= parts; ++i) smallest = std::min(smallest, f(low + (high - low) * i / parts));
  return smallest;
}

std::vector<Statement> statements() {
  constexpr auto square = LatticeKind::square, staggered = LatticeKind::staggered;
  const auto s = sums(square, 1.0), c = sums(staggered, 1.0), wide = sums(staggered, 1.5);
  const auto B_x_of = [](double h) { return sums(square, h).B(0, 0); };
  const auto f_xx_of = [](double h) { return sums(square, h).f(0, 0); };
  const auto f_yy_of = [](double h) { return sums(staggered, h).f(1, 1); };
  const double least_f_yy = least(f_yy_of, 0.8, 4.0), zero_f_yy = root(f_yy_of, 0.7, 0.8);
  const double needed = -2.0 * wide.B(1, 1) / (wide.A[0] * wide.A[0]);
  const double factor = tension_modulus_factor(1.0), wide_factor = tension_modulus_factor(1.5);
  const double excess = excess_of_exponent();
  const double vanishing = std::max({std::abs(s.A[0]), std::abs(s.A[1]), std::abs(s.B(0, 1))});
  const double face_centred = std::max(std::abs(c.A[1]), std::abs(c.B(0, 1)));
  return {
      {"5.3.1", "A and C vanish, square", fmt::format("all below {:g}", rounding), vanishing < rounding, Verdict::right,
       ""},
      {"5.3.1", "longitudinal stable for σxx < 0, h = Δp: B_x > 0, β < 1",
       fmt::format("B_x = {}, β = {}", five(s.B(0, 0)), five(xsph * s.beta_sum)),
       s.B(0, 0) > 0.0 && xsph * s.beta_sum < 1.0, Verdict::right, ""},
      {"after (5.23)", "B_x and f_xx decrease from h = Δp to 1.5Δp, square",
       fmt::format("to {} and {}", five(B_x_of(1.5)), five(f_xx_of(1.5))),
       decreases(B_x_of, 1.0, 1.5) && decreases(f_xx_of, 1.0, 1.5), Verdict::right, ""},
      {"after (5.23)", "so does the coefficient of (5.23)",
       fmt::format("from {} to {}", five(clumping_coefficient(square, 1.0)), five(clumping_coefficient(square, 1.5))),
       decreases([](double h) { return clumping_coefficient(square, h); }, 1.0, 1.5), Verdict::right, ""},
      {"after (5.23)", "n = 4 is a good choice for Δp < h < 1.5Δp, as long waves go",
       fmt::format("with R constant within {:.1f} % of the best n from 1 to 8", 100.0 * excess), excess < 0.02,
       Verdict::right,
       fmt::format("once R follows the stress the price falls on: {:.3f} of the modulus for n = 4, {:.3f} for n = 8",
                   price(4.0), price(8.0))},
      {"after (5.24)", "transverse unstable for σyy < 0, square, h = Δp: B_y < 0",
       fmt::format("B_y = {}", five(s.B(1, 1))), s.B(1, 1) < 0.0, Verdict::right, ""},
      {"5.3.2", "artificial stress will not stabilise the transverse mode, square: f_yy ≤ 0",
       fmt::format("f_yy = {}", five(s.f(1, 1))), s.f(1, 1) <= 0.0, Verdict::right,
       "in tension it even drives that mode, which was stable"},
      {"5.3.2", "C and A_y vanish, face-centred", fmt::format("all below {:g}", rounding), face_centred < rounding,
       Verdict::right, ""},
      {"after (5.27)", "the coefficient of (5.27) decreases from h = Δp to 1.5Δp",
       fmt::format("from {} to {}", five(clumping_coefficient(staggered, 1.0)),
                   five(clumping_coefficient(staggered, 1.5))),
       decreases([](double h) { return clumping_coefficient(staggered, h); }, 1.0, 1.5), Verdict::right, ""},
      {"after (5.28)", "f_yy > 0 for all h/Δp, face-centred",
       fmt::format("from 0.8 to 4, at least {}", five(least_f_yy)), least_f_yy > 0.0, Verdict::right,
       fmt::format("negative below {:.3f}", zero_f_yy)},
      {"after (5.28)", "transverse stable for σyy < 0, face-centred, h = Δp: B_y > 0",
       fmt::format("B_y = {}", five(c.B(1, 1))), c.B(1, 1) > 0.0, Verdict::right, ""},
      {"after (5.30)", "at h = 1.5Δp transverse waves are stable because μ > |P|",
       fmt::format("needs μ + ζ > {:.0f} |P − Syy|", needed), needed <= 1.0, Verdict::wrong,
       "A_x² was taken at h = Δp"},
      {"end of 5.3.2", "transverse stable for Δp < h < 1.4Δp, face-centred: B_y > 0",
       fmt::format("B_y = {} at 1.35", five(B_y(staggered, 1.35))),
       least([](double h) { return B_y(staggered, h); }, 1.0, 1.399) > 0.0, Verdict::wrong, ""},
      {"after (5.31)", "the effect on long waves is negligible, ε = 0.3, n = 4",
       fmt::format("in tension {:.3f} of the modulus is left at h = Δp, {:.3f} at 1.5Δp", factor, wide_factor),
       factor > 0.98 && wide_factor > 0.98, Verdict::wrong, "whatever the stress: R follows it"}};
}

io::Table table_of(const std::vector<Number>& numbers) {
  io::Table table{{"where", "what", "printed", "ours", "verdict", "why"}, {}};
  for (const auto& n : numbers)
    table.rows.push_back({n.where, n.what, five(n.printed), five(n.ours), std::string(name_of(n.verdict)), n.why});
  return table;
}

io::Table table_of(const std::vector<Statement>& all) {
  io::Table table{{"where", "statement", "ours", "verdict", "why"}, {}};
  for (const auto& s : all) table.rows.push_back({s.where, s.printed, s.ours, std::string(name_of(s.verdict)), s.why});
  return table;
}

/// f against h/Δp from 0.9 to 1.8.
template <class Function>
io::Curve curve_of(std::string label, const Function& f, io::CurveStyle style = io::CurveStyle::line) {
  io::Curve curve{std::move(label), {}, style};
  for (int i = 0; i <= 90; ++i) curve.points.emplace_back(0.9 + 0.01 * i, f(0.9 + 0.01 * i));
  return curve;
}

io::LineFigure figure_of_B_y() {
  io::LineFigure figure;
  figure.title = "Transverse stiffness of a compressed lattice at k = (π/Δp, 0), cubic spline";
  figure.x_label = "h / Δp";
  figure.y_label = "(Δp)² B_y";
  figure.curves = {curve_of("square", [](double h) { return B_y(LatticeKind::square, h); }),
                   curve_of("face-centred", [](double h) { return B_y(LatticeKind::staggered, h); })};
  figure.shades = {{1.2, 1.7, "printed: square above 0"}};
  figure.vertical_lines = {{1.4, "printed: face-centred below 0 from here"}};
  return figure;
}

io::LineFigure figure_of_coefficients() {
  io::LineFigure figure;
  figure.title = "Artificial stress that a mode at k = (π/Δp, 0) needs in tension, n = 4";
  figure.x_label = "h / Δp";
  figure.y_label = "ε";
  figure.curves = {
      curve_of("longitudinal, square", [](double h) { return clumping_coefficient(LatticeKind::square, h); }),
      curve_of("longitudinal, face-centred", [](double h) { return clumping_coefficient(LatticeKind::staggered, h); }),
      curve_of("transverse, face-centred",
               [](double h) {
                 const auto s = sums(LatticeKind::staggered, h);
                 return s.B(1, 1) / s.f(1, 1);
               }),
      curve_of(
          "ε of the paper", [](double) { return epsilon; }, io::CurveStyle::dashed)};
  return figure;
}

template <class Row>
void check(const std::vector<Row>& rows, Report& report) {
  for (const auto& row : rows)
    if (!borne_out(row)) report.failures.push_back(fmt::format("{}: not {}", row.where, name_of(row.verdict)));
}

}  // namespace

Report gray_numbers_report(const Progress& progress) {
  const auto numbers = printed_numbers();
  const auto all = statements();
  if (progress) progress(0.5);
  Report report;
  check(numbers, report);
  check(all, report);
  report.summary = fmt::format(
      "Every number, threshold, window and formula that Gray, Monaghan & Swift print in Secs. 4 and 5 (and some of 2 "
      "and "
      "6)\nbeside ours: cubic spline, Δp = 1, k = (π/Δp, 0) and R constant unless said otherwise.\n\n"
      "**Verdicts.** `right`: to the last printed digit, and a formula to 1e-11. `rounded`: off by less than {:.0f} "
      "%.\n"
      "`misprint`: the formula as printed is wrong, what the paper does with it is not. `wrong`: neither.\n"
      "\n## Numbers, thresholds and windows\n\n{}\n"
      "![B_y against h/Δp with the printed windows](transverse.svg)\n\n"
      "![the artificial stress that each mode needs](needed.svg)\n"
      "\n## Statements\n\n{}\n"
      "\n## Formulas\n\n"
      "What a formula gives as it is printed, beside ours, for one state: ρ̄ = {}, c0² = {}, μ = {}, P = {}, Sxx = {}, "
      "Syy = {}.\n",
      100.0 * rounded_off, io::to_markdown(table_of(numbers)), io::to_markdown(table_of(all)), density, square_of_c0,
      shear_modulus, pressure, Sxx, Syy);
  std::vector<Number> every_formula;
  for (const auto& [heading, rows] : formulas()) {
    check(rows, report);
    report.summary += fmt::format("\n### {}\n\n{}", heading, io::to_markdown(table_of(rows)));
    every_formula.insert(every_formula.end(), rows.begin(), rows.end());
  }
  report.files = {{"README.md", "# The printed numbers of Gray, Monaghan & Swift\n\n" + report.summary +
                                    "\nRegenerate with `sphstab report gray-printed-numbers --overwrite`.\n"},
                  {"numbers.csv", io::to_csv(table_of(numbers))},
                  {"statements.csv", io::to_csv(table_of(all))},
                  {"formulas.csv", io::to_csv(table_of(every_formula))},
                  {"transverse.svg", io::render_svg(figure_of_B_y())},
                  {"needed.svg", io::render_svg(figure_of_coefficients())}};
  return report;
}

}  // namespace sphstab::study
