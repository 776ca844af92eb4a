// SPDX-License-Identifier: MIT
#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <catch2/catch.hpp>
#include <vector>

#include "analysis/amplification.hpp"
#include "tests/analysis/golden.hpp"
#include "tests/analysis/problems.hpp"

// Rung 0 of the ladder: Zhang's Eqs. 6 to 9 are written out here for a displacement field on the infinite lattice and
// differenced with 50 digits; the time steps are written out too. Nothing is shared with analysis/ but the nouns.

using namespace sphstab;
using namespace sphstab::analysis;

namespace {

using Precise = boost::multiprecision::cpp_bin_float_50;
using PreciseVector = std::array<Precise, 2>;
using PreciseTensor = std::array<PreciseVector, 2>;

/// Differences of step 1e-15 in 50 digits are exact to 1e-30. What is left are the roundings of the double result:
/// kernel slopes (1e-15 of W(0)/h, 1e-13 for Wendland C6) and sums of some 30 terms.
constexpr double formula_tolerance = 1e-13;
/// Closed-form against Eigen's eigenvalues, away from double ones.
constexpr double eigenvalue_tolerance = 1e-11;

/// The equations of the paper about the base state u = H x.
class PaperEquations {
 public:
  explicit PaperEquations(const Problem<2>& problem) : problem_(problem) {
    const double reach = std::ceil(4.0 * problem.kernel.support());
    std::vector<double> distances;
    for (int i = -static_cast<int>(reach); i <= reach; ++i)
      for (int j = -static_cast<int>(reach); j <= reach; ++j) {
        const Vector<2> x = problem.lattice.site({i, j});
        if (x.norm() > 0.0 && x.norm() < problem.kernel.support() * (1.0 - tie_margin)) offsets_.push_back(x);
      }
    if (problem.neighbour_rule == NeighbourRule::nearest) {
      const double nearest = std::min_element(offsets_.begin(), offsets_.end(), [](const auto& a, const auto& b) {
                               return a.norm() < b.norm();
                             })->norm();
      std::erase_if(offsets_, [&](const auto& x) { return x.norm() > 1.0001 * nearest; });
    }
    normalisation_ = 1;
    if (problem.scheme.kernel_normalisation == KernelNormalisation::sum) {
      normalisation_ = V() * problem.kernel.value(Precise(0));
      for (const auto& x : offsets_) normalisation_ += V() * problem.kernel.value(length(x));
    }
  }

  /// Acceleration at the origin for the displacement H x + amplitude e_j cos(k·x).
  PreciseVector acceleration(const Vector<2>& k, int j, const Precise& amplitude) const {
    PreciseVector a{0, 0};
    const PreciseTensor here = stress_over_density_squared({0, 0}, k, j, amplitude);
    for (const auto& d : offsets_) {
      const PreciseTensor there = stress_over_density_squared({d[0], d[1]}, k, j, amplitude);
      const PreciseVector gradient = kernel_gradient(d);
      for (int alpha = 0; alpha < 2; ++alpha)
        for (int beta = 0; beta < 2; ++beta)
          a[alpha] += Precise(problem_.material.density()) * V() * (here[alpha][beta] + there[alpha][beta]) *
                      gradient[beta] / normalisation_;
    }
    return a;
  }

  /// −∂(acceleration)/∂(amplitude), column by column.
  PreciseTensor dynamical_matrix(const Vector<2>& k) const {
    const Precise step = 1e-15;
    PreciseTensor M;
    for (int j = 0; j < 2; ++j) {
      const auto above = acceleration(k, j, step), below = acceleration(k, j, -step);
      for (int i = 0; i < 2; ++i) M[i][j] = -(above[i] - below[i]) / (2 * step);
    }
    return M;
  }

 private:
  Precise V() const { return problem_.lattice.cell_volume(); }
  static Precise length(const Vector<2>& x) { return sqrt(Precise(x[0]) * x[0] + Precise(x[1]) * x[1]); }

  /// ∂W_ij/∂x_i for the neighbour j at x_i + d.
  PreciseVector kernel_gradient(const Vector<2>& d) const {
    const Precise r = length(d), slope = problem_.kernel.slope(r);
    return {-slope * d[0] / r, -slope * d[1] / r};
  }

  PreciseVector displacement(const PreciseVector& x, const Vector<2>& k, int j, const Precise& amplitude) const {
    const auto& H = problem_.displacement_gradient;
    PreciseVector s{H(0, 0) * x[0] + H(0, 1) * x[1], H(1, 0) * x[0] + H(1, 1) * x[1]};
    s[j] += amplitude * cos(Precise(k[0] * x[0] + k[1] * x[1]));
    return s;
  }

  PreciseTensor stress_over_density_squared(const PreciseVector& x, const Vector<2>& k, int j,
                                            const Precise& amplitude) const {
    PreciseTensor strain{PreciseVector{0, 0}, PreciseVector{0, 0}};
    const PreciseVector s_i = displacement(x, k, j, amplitude);
    for (const auto& d : offsets_) {
      const PreciseVector gradient = kernel_gradient(d);
      const PreciseVector s_j = displacement({x[0] + d[0], x[1] + d[1]}, k, j, amplitude);
      for (int a = 0; a < 2; ++a)
        for (int b = 0; b < 2; ++b)
          strain[a][b] +=
              V() * ((s_j[b] - s_i[b]) * gradient[a] + (s_j[a] - s_i[a]) * gradient[b]) / (2 * normalisation_);
    }
    // Zhang's constants from E and μ: G = E/(1+μ); p = μG/(1−2μ) tr ε, in plane stress μG/(1−μ) tr ε.
    const Precise mu = problem_.material.poisson_ratio(), G = 2 * Precise(problem_.material.shear_modulus());
    const bool plane_stress = problem_.plane == Plane::stress;
    const Precise trace = strain[0][0] + strain[1][1];
    const Precise p = mu * G / (plane_stress ? Precise(1 - mu) : Precise(1 - 2 * mu)) * trace;
    Precise rho = problem_.material.density();
    // Eq. 6, the exponent −(1−2μ)/(μG) p being minus the trace of the three-dimensional strain.
    if (problem_.scheme.momentum_density == MomentumDensity::equation_of_state)
      rho *= exp(Precise(-trace * (plane_stress ? Precise((1 - 2 * mu) / (1 - mu)) : Precise(1))));
    PreciseTensor result;
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) result[a][b] = (G * strain[a][b] + (a == b ? p : Precise(0))) / (rho * rho);
    return result;
  }

  Problem<2> problem_;
  std::vector<Vector<2>> offsets_;
  Precise normalisation_;
};

/// One time step of the state (v, s) of a mode with force −M s − c v per mass, as `Integrator` documents it.
std::array<Precise, 4> stepped(const Problem<2>& problem, const PreciseTensor& M, std::array<Precise, 4> state,
                               double dt) {
  const Precise c = problem.scheme.damping ? problem.scheme.damping->rate : 0.0;
  const auto force = [&](const std::array<Precise, 4>& y, int i) -> Precise {
    return -M[i][0] * y[2] - M[i][1] * y[3] - c * y[i];
  };
  const auto kick = [&](const Precise& x) {
    const Precise first = force(state, 0), second = force(state, 1);
    state[0] += x * first;
    state[1] += x * second;
  };
  const auto drift = [&](const Precise& x) {
    state[2] += x * state[0];
    state[3] += x * state[1];
  };
  if (problem.integrator == Integrator::leapfrog) {
    kick(dt);
    drift(dt);
  } else {
    kick(Precise(dt) / 2);
    drift(dt);
    kick(Precise(dt) / 2);
  }
  return state;
}

/// Schemes that exercise every term, each with a wave vector off all symmetry lines.
std::vector<Problem<2>> every_term() {
  std::vector<Problem<2>> problems;
  for (const auto plane : {Plane::strain, Plane::stress})
    for (const auto density : {MomentumDensity::frozen, MomentumDensity::equation_of_state})
      for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum})
        for (const auto integrator : {Integrator::leapfrog, Integrator::verlet})
          for (const auto lattice : {LatticeKind::square, LatticeKind::staggered}) {
            auto problem = problem_2d(lattice, KernelFamily::quartic_spline, 0.9);
            problem.plane = plane;
            problem.material = Material::from_young_modulus(1.7, 2.1, 0.35);
            problem.integrator = integrator;
            problem.scheme.momentum_density = density;
            problem.scheme.kernel_normalisation = normalisation;
            if (lattice == LatticeKind::staggered) problem.scheme.damping = Damping{0.3};
            problem.displacement_gradient << 0.05, 0.02, -0.07, -0.03;
            problems.push_back(problem);
          }
  return problems;
}

const Vector<2> wave_vector(0.9, -1.4);

double nearest_distance(const std::complex<double>& value, const std::vector<std::complex<double>>& list) {
  double nearest = std::abs(value - list.front());
  for (const auto& other : list) nearest = std::min(nearest, std::abs(value - other));
  return nearest;
}

}  // namespace

TEST_CASE("the dynamical matrix is the derivative of Zhang's equations 6 to 9", "[fast]") {
  for (const auto& problem : every_term()) {
    INFO(name_of(problem.plane) << " " << name_of(problem.scheme.momentum_density) << " "
                                << name_of(problem.scheme.kernel_normalisation) << " "
                                << name_of(problem.lattice.kind()));
    const auto expected = PaperEquations(problem).dynamical_matrix(wave_vector);
    const auto M = dynamical_matrix(problem, wave_vector);
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) CHECK(std::abs(M(i, j) - static_cast<double>(expected[i][j])) < formula_tolerance);
  }
}

TEST_CASE("the dynamical matrix is right for every kernel, and for four neighbours", "[fast]") {
  for (const auto& [family, name] : Names<KernelFamily>::table)
    for (const auto rule : {NeighbourRule::support, NeighbourRule::nearest}) {
      INFO(name);
      auto problem = problem_2d(LatticeKind::square, family, 1.1);
      problem.neighbour_rule = rule;
      const auto expected = PaperEquations(problem).dynamical_matrix(wave_vector);
      const auto M = dynamical_matrix(problem, wave_vector);
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) CHECK(std::abs(M(i, j) - static_cast<double>(expected[i][j])) < formula_tolerance);
    }
}

TEST_CASE("the amplification matrix is one time step of the linearised equations", "[fast]") {
  constexpr double dt = 0.7;
  for (const auto& problem : every_term()) {
    INFO(name_of(problem.integrator) << " damped " << problem.scheme.damping.has_value());
    const auto M = PaperEquations(problem).dynamical_matrix(wave_vector);
    const auto E = amplification_matrix(problem, wave_vector, dt);
    for (int column = 0; column < 4; ++column) {
      std::array<Precise, 4> unit{0, 0, 0, 0};
      unit[column] = 1;
      const auto image = stepped(problem, M, unit, dt);
      for (int row = 0; row < 4; ++row)
        CHECK(std::abs(E(row, column) - static_cast<double>(image[row])) < formula_tolerance);
    }
  }
}

TEST_CASE("closed-form eigenvalues are those of the amplification matrix", "[fast]") {
  for (const auto& problem : every_term())
    for (const double dt : {0.2, 1.1, 2.6, 4.0}) {
      const auto numerical = numerical_eigenvalues(amplification_matrix(problem, wave_vector, dt));
      const auto spectrum = mode_spectrum(problem, wave_vector, dt);
      REQUIRE(spectrum.eigenvalues.size() == numerical.size());
      double radius = 0.0;
      for (const auto& value : numerical) {
        CHECK(nearest_distance(value, spectrum.eigenvalues) < eigenvalue_tolerance * std::max(1.0, std::abs(value)));
        radius = std::max(radius, std::abs(value));
      }
      for (const auto& value : spectrum.eigenvalues)
        CHECK(nearest_distance(value, numerical) < eigenvalue_tolerance * std::max(1.0, std::abs(value)));
      CHECK(spectrum.spectral_radius == Approx(radius).epsilon(eigenvalue_tolerance));
    }
}

TEST_CASE("long waves travel at the p-wave and s-wave speeds", "[fast]") {
  // ω² − c²k² of relative order k² (kernel error): a fourth of it when k is halved. L is I to 1e-6 here.
  const auto problem = problem_2d(LatticeKind::hexagonal, KernelFamily::gaussian, 1.3, 7.0);
  const LameConstants lame = problem.material.lame(problem.plane);
  const auto squares = [&](double size) {
    const Vector<2> n(0.6, 0.8), t(-0.8, 0.6);
    const auto M = dynamical_matrix(problem, Vector<2>(size * n));
    return std::array<double, 2>{n.dot(M * n) / (size * size), t.dot(M * t) / (size * size)};
  };
  constexpr double quadrature_error = 1e-5;
  CHECK(squares(1e-4)[0] == Approx(lame.p_wave_modulus()).epsilon(quadrature_error));
  CHECK(squares(1e-4)[1] == Approx(lame.shear_modulus).epsilon(quadrature_error));
  constexpr double next_order = 1e-2;
  for (const std::size_t branch : {std::size_t{0}, std::size_t{1}}) {
    const double limit = squares(1e-4)[branch];
    CHECK((squares(0.1)[branch] - limit) / (squares(0.05)[branch] - limit) == Approx(4.0).epsilon(next_order));
  }
}

TEST_CASE("amplification matrices and their spectra agree with the reference", "[fast]") {
  const auto references = golden::cases("matrix");
  REQUIRE(references.size() == 17);
  for (const auto& reference : references) {
    INFO(reference["id"]);
    const auto problem = golden::problem(reference);
    const auto k = golden::numbers<Vector<2>>(reference["wave_vector"]);
    const double dt = reference["time_step"], tolerance = reference["tolerance"];
    const auto E = amplification_matrix(problem, k, dt);
    const auto spectrum = mode_spectrum(problem, k, dt);
    const auto& expect = reference["expect"];
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        CHECK(golden::difference(E(i, j).real(), expect["amplification_matrix"][i][j][0]) < tolerance);
        CHECK(E(i, j).imag() == 0.0);
      }
    std::vector<std::complex<double>> polynomial{1.0};
    for (const auto& root : spectrum.eigenvalues) {
      polynomial.push_back(0.0);
      for (std::size_t i = polynomial.size() - 1; i > 0; --i) polynomial[i] -= root * polynomial[i - 1];
    }
    for (std::size_t i = 0; i < polynomial.size(); ++i)
      CHECK(golden::difference(polynomial[i].real(), expect["characteristic_polynomial"][i][0]) < tolerance);
    if (expect.contains("spectral_radius"))
      CHECK(golden::difference(spectrum.spectral_radius, expect["spectral_radius"]) < tolerance);
  }
}

TEST_CASE("a mode is power-bounded unless it grows, drifts or sits exactly at the limit", "[fast]") {
  auto problem = problem_2d(LatticeKind::square, KernelFamily::gaussian, 0.7, 7.0);
  problem.neighbour_rule = NeighbourRule::nearest;
  const Vector<2> k(std::numbers::pi / 2, std::numbers::pi / 2);
  const LameConstants lame = problem.material.lame(problem.plane);
  // Four neighbours: ω_L² = (γ + 2G) |D|²/ρ with |D|² = 2 (2 V W')².
  const double limit = 2.0 / std::sqrt(lame.p_wave_modulus() * 8.0 * std::pow(problem.kernel.slope(1.0), 2));
  CHECK(mode_spectrum(problem, k, 0.999 * limit).power_bounded);
  CHECK(mode_spectrum(problem, k, 0.999 * limit).spectral_radius == 1.0);
  CHECK_FALSE(mode_spectrum(problem, k, limit).power_bounded);
  CHECK_FALSE(mode_spectrum(problem, k, 1.001 * limit).power_bounded);
  CHECK(mode_spectrum(problem, k, 1.001 * limit).spectral_radius > 1.01);
  for (const Vector<2>& zero_energy :
       {Vector<2>(0, 0), Vector<2>(std::numbers::pi, 0), Vector<2>(std::numbers::pi, -std::numbers::pi)}) {
    CHECK_FALSE(mode_spectrum(problem, zero_energy, 0.1).power_bounded);
    CHECK(mode_spectrum(problem, zero_energy, 0.1).spectral_radius == 1.0);
  }
  CHECK(mode_spectrum(problem, Vector<2>(1e-7, 0), 0.1).power_bounded);
  problem.scheme.damping = Damping{0.2};
  CHECK(mode_spectrum(problem, Vector<2>(std::numbers::pi, 0), 0.1).power_bounded);
}

TEST_CASE("the state is named after Zhang's u, v, R, S", "[fast]") {
  CHECK(state_names(problem_2d(LatticeKind::square, KernelFamily::gaussian, 1.0)) ==
        std::vector<std::string>{"vx", "vy", "sx", "sy"});
}
