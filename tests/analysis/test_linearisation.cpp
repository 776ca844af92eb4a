// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <catch2/catch.hpp>
#include <vector>

#include "analysis/amplification.hpp"
#include "model/lattice_index.hpp"
#include "tests/analysis/golden.hpp"
#include "tests/analysis/problems.hpp"

// Rung 0 of the ladder: Zhang's Eqs. 6 to 9 are written out here for a displacement field on the infinite lattice and
// differenced with 50 digits; the time steps are written out too. Nothing is shared with analysis/ but the nouns.

using namespace sphstab;
using namespace sphstab::analysis;

namespace {

using Precise = boost::multiprecision::cpp_bin_float_50;
template <int Size>
using PreciseVector = std::array<Precise, Size>;
template <int Size>
using PreciseMatrix = std::array<PreciseVector<Size>, Size>;

/// Differences of step 1e-15 in 50 digits are exact to 1e-30. What is left are the roundings of the double result:
/// kernel slopes (1e-15 of W(0)/h, 1e-13 for Wendland C6) and sums of some 30 terms.
constexpr double formula_tolerance = 1e-13;
/// Closed-form against Eigen's eigenvalues; those that coincide (the transverse ones of 3-D) keep their eigenvectors.
constexpr double eigenvalue_tolerance = 1e-11;

/// The equations of the paper about the base state u = H x.
template <int Dim>
class PaperEquations {
 public:
  explicit PaperEquations(const Problem<Dim>& problem) : problem_(problem) {
    // |n_i| ≤ |b_i| r / 2π, and |b_i| < 4π of every lattice of spacing 1.
    const LatticeIndex<Dim> reach =
        LatticeIndex<Dim>::Constant(static_cast<int>(std::ceil(2.0 * problem.kernel.support())));
    std::vector<Vector<Dim>> offsets;
    for_each_index<Dim>(-reach, reach, [&](const LatticeIndex<Dim>& n) {
      const Vector<Dim> x = problem.lattice.site(n);
      if (x.norm() > 0.0 && x.norm() < problem.kernel.support() * (1.0 - tie_margin)) offsets.push_back(x);
    });
    if (problem.neighbour_rule == NeighbourRule::nearest) {
      const double nearest = std::min_element(offsets.begin(), offsets.end(), [](const auto& a, const auto& b) {
                               return a.norm() < b.norm();
                             })->norm();
      std::erase_if(offsets, [&](const auto& x) { return x.norm() > 1.0001 * nearest; });
    }
    Precise normalisation = V() * problem.kernel.value(Precise(0));
    for (const auto& x : offsets) normalisation += V() * problem.kernel.value(length(x));
    if (problem.scheme.kernel_normalisation == KernelNormalisation::none) normalisation = 1;
    for (const auto& d : offsets) {
      // V ∂W_ij/∂x_i / N for the neighbour j at x_i + d.
      const Precise r = length(d), factor = -V() * problem.kernel.slope(r) / (r * normalisation);
      neighbours_.push_back({precise(d), {}});
      for (int i = 0; i < Dim; ++i) neighbours_.back().gradient[i] = factor * d[i];
    }
  }

  /// Acceleration at the origin for the displacement H x + amplitude e_j cos(k·x).
  PreciseVector<Dim> acceleration(const Vector<Dim>& k, int j, const Precise& amplitude) const {
    PreciseVector<Dim> a{};
    const auto here = stress_over_density_squared(PreciseVector<Dim>{}, k, j, amplitude);
    for (const auto& [d, gradient] : neighbours_) {
      const auto there = stress_over_density_squared(d, k, j, amplitude);
      for (int alpha = 0; alpha < Dim; ++alpha)
        for (int beta = 0; beta < Dim; ++beta)
          a[alpha] += Precise(problem_.material.density()) * (here[alpha][beta] + there[alpha][beta]) * gradient[beta];
    }
    return a;
  }

  /// −∂(acceleration)/∂(amplitude), column by column.
  PreciseMatrix<Dim> dynamical_matrix(const Vector<Dim>& k) const {
    const Precise step = 1e-15;
    PreciseMatrix<Dim> M;
    for (int j = 0; j < Dim; ++j) {
      const auto above = acceleration(k, j, step), below = acceleration(k, j, -step);
      for (int i = 0; i < Dim; ++i) M[i][j] = -(above[i] - below[i]) / (2 * step);
    }
    return M;
  }

 private:
  struct Neighbour {
    PreciseVector<Dim> d;
    PreciseVector<Dim> gradient;
  };

  Precise V() const { return problem_.lattice.cell_volume(); }
  static PreciseVector<Dim> precise(const Vector<Dim>& x) {
    PreciseVector<Dim> result;
    std::copy(x.begin(), x.end(), result.begin());
    return result;
  }
  static Precise length(const Vector<Dim>& x) {
    Precise square = 0;
    for (const double component : x) square += Precise(component) * component;
    return sqrt(square);
  }

  PreciseVector<Dim> displacement(const PreciseVector<Dim>& x, const Vector<Dim>& k, int j,
                                  const Precise& amplitude) const {
    PreciseVector<Dim> s{};
    Precise phase = 0;
    for (int i = 0; i < Dim; ++i) {
      phase += k[i] * x[i];
      for (int l = 0; l < Dim; ++l) s[i] += problem_.displacement_gradient(i, l) * x[l];
    }
    s[j] += amplitude * cos(phase);
    return s;
  }

  PreciseMatrix<Dim> stress_over_density_squared(const PreciseVector<Dim>& x, const Vector<Dim>& k, int j,
                                                 const Precise& amplitude) const {
    PreciseMatrix<Dim> strain{};
    const auto s_i = displacement(x, k, j, amplitude);
    for (const auto& [d, gradient] : neighbours_) {
      PreciseVector<Dim> x_j = x;
      for (int i = 0; i < Dim; ++i) x_j[i] += d[i];
      const auto s_j = displacement(x_j, k, j, amplitude);
      for (int a = 0; a < Dim; ++a)
        for (int b = 0; b < Dim; ++b)
          strain[a][b] += ((s_j[b] - s_i[b]) * gradient[a] + (s_j[a] - s_i[a]) * gradient[b]) / 2;
    }
    // Zhang's constants from E and μ: G = E/(1+μ); p = μG/(1−2μ) tr ε, in plane stress μG/(1−μ) tr ε.
    const Precise mu = problem_.material.poisson_ratio(), G = 2 * Precise(problem_.material.shear_modulus());
    const bool plane_stress = problem_.plane == Plane::stress;
    Precise trace = 0;
    for (int a = 0; a < Dim; ++a) trace += strain[a][a];
    const Precise p = mu * G / (plane_stress ? Precise(1 - mu) : Precise(1 - 2 * mu)) * trace;
    Precise rho = problem_.material.density();
    // Eq. 6, the exponent −(1−2μ)/(μG) p being minus the trace of the three-dimensional strain.
    if (problem_.scheme.momentum_density == MomentumDensity::equation_of_state)
      rho *= exp(Precise(-trace * (plane_stress ? Precise((1 - 2 * mu) / (1 - mu)) : Precise(1))));
    PreciseMatrix<Dim> result;
    for (int a = 0; a < Dim; ++a)
      for (int b = 0; b < Dim; ++b) result[a][b] = (G * strain[a][b] + (a == b ? p : Precise(0))) / (rho * rho);
    return result;
  }

  Problem<Dim> problem_;
  std::vector<Neighbour> neighbours_;
};

/// One time step of the state (v, s) of a mode with force −M s − c v per mass, as `Integrator` documents it.
template <int Dim>
PreciseVector<2 * Dim> stepped(const Problem<Dim>& problem, const PreciseMatrix<Dim>& M, PreciseVector<2 * Dim> state,
                               double dt) {
  const Precise c = problem.scheme.damping ? problem.scheme.damping->rate : 0.0;
  const auto kick = [&](const Precise& x) {
    PreciseVector<Dim> force;
    for (int i = 0; i < Dim; ++i) {
      force[i] = -c * state[i];
      for (int j = 0; j < Dim; ++j) force[i] -= M[i][j] * state[Dim + j];
    }
    for (int i = 0; i < Dim; ++i) state[i] += x * force[i];
  };
  const auto drift = [&](const Precise& x) {
    for (int i = 0; i < Dim; ++i) state[Dim + i] += x * state[i];
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

template <int Dim>
Problem<Dim> unit_problem(LatticeKind lattice, KernelFamily kernel, double smoothing_length) {
  return {.lattice = Lattice<Dim>(lattice, 1.0),
          .kernel = Kernel<Dim>(kernel, smoothing_length),
          .material = Material::from_young_modulus(1.7, 2.1, 0.35)};
}

/// Schemes that exercise every term on every lattice, about a base state without any symmetry.
template <int Dim>
std::vector<Problem<Dim>> every_term() {
  constexpr std::array<double, 9> gradient{0.05, -0.07, 0.04, 0.02, -0.03, 0.01, -0.02, 0.06, 0.035};
  std::vector<Problem<Dim>> problems;
  for (const auto plane : {Plane::strain, Plane::stress})
    for (const auto density : {MomentumDensity::frozen, MomentumDensity::equation_of_state})
      for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum})
        for (const auto integrator : {Integrator::leapfrog, Integrator::verlet})
          for (const auto lattice : lattices_of(Dim)) {
            if (plane == Plane::stress && Dim != 2) continue;
            auto problem = unit_problem<Dim>(lattice, KernelFamily::quartic_spline, 0.74);
            problem.plane = plane;
            problem.integrator = integrator;
            problem.scheme.momentum_density = density;
            problem.scheme.kernel_normalisation = normalisation;
            if (normalisation == KernelNormalisation::sum) problem.scheme.damping = Damping{0.3};
            problem.displacement_gradient = Eigen::Map<const Tensor<Dim>>(gradient.data());
            problems.push_back(problem);
          }
  return problems;
}

/// Off all symmetry lines.
template <int Dim>
Vector<Dim> wave_vector() {
  return Vector<3>(0.9, -1.4, 0.6).head<Dim>();
}

template <int Dim>
void check_dynamical_matrix(const Problem<Dim>& problem) {
  const auto expected = PaperEquations<Dim>(problem).dynamical_matrix(wave_vector<Dim>());
  const auto M = dynamical_matrix<Dim>(problem, wave_vector<Dim>());
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) CHECK(std::abs(M(i, j) - static_cast<double>(expected[i][j])) < formula_tolerance);
}

double nearest_distance(const std::complex<double>& value, const std::vector<std::complex<double>>& list) {
  double nearest = std::abs(value - list.front());
  for (const auto& other : list) nearest = std::min(nearest, std::abs(value - other));
  return nearest;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the dynamical matrix is the derivative of Zhang's equations 6 to 9", "[fast]", ((int Dim), Dim),
                       1, 2, 3) {
  for (const auto& problem : every_term<Dim>()) {
    if (problem.integrator != Integrator::leapfrog) continue;
    INFO(name_of(problem.plane) << " " << name_of(problem.scheme.momentum_density) << " "
                                << name_of(problem.scheme.kernel_normalisation) << " "
                                << name_of(problem.lattice.kind()));
    check_dynamical_matrix<Dim>(problem);
  }
}

TEMPLATE_TEST_CASE_SIG("the dynamical matrix is right for every kernel, and for nearest neighbours", "[fast]",
                       ((int Dim), Dim), 1, 2, 3) {
  for (const auto& [family, name] : Names<KernelFamily>::table)
    for (const auto rule : {NeighbourRule::support, NeighbourRule::nearest})
      for (const auto lattice : lattices_of(Dim)) {
        INFO(name << " " << name_of(lattice) << " " << name_of(rule));
        auto problem = unit_problem<Dim>(lattice, family, Dim == 3 ? 0.8 : 1.1);
        problem.neighbour_rule = rule;
        check_dynamical_matrix<Dim>(problem);
      }
}

TEMPLATE_TEST_CASE_SIG("the amplification matrix is one time step of the linearised equations", "[fast]",
                       ((int Dim), Dim), 1, 2, 3) {
  constexpr double dt = 0.7;
  for (const auto& problem : every_term<Dim>()) {
    INFO(name_of(problem.integrator) << " damped " << problem.scheme.damping.has_value());
    const auto M = PaperEquations<Dim>(problem).dynamical_matrix(wave_vector<Dim>());
    const auto E = amplification_matrix<Dim>(problem, wave_vector<Dim>(), dt);
    for (int column = 0; column < 2 * Dim; ++column) {
      PreciseVector<2 * Dim> unit{};
      unit[column] = 1;
      const auto image = stepped<Dim>(problem, M, unit, dt);
      for (int row = 0; row < 2 * Dim; ++row)
        CHECK(std::abs(E(row, column) - static_cast<double>(image[row])) < formula_tolerance);
    }
  }
}

TEMPLATE_TEST_CASE_SIG("closed-form eigenvalues are those of the amplification matrix", "[fast]", ((int Dim), Dim), 1,
                       2, 3) {
  for (const auto& problem : every_term<Dim>())
    for (const double dt : {0.2, 1.1, 2.6, 4.0}) {
      const auto numerical = numerical_eigenvalues(amplification_matrix<Dim>(problem, wave_vector<Dim>(), dt));
      const auto spectrum = mode_spectrum<Dim>(problem, wave_vector<Dim>(), dt);
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

TEST_CASE("where the two branches meet without a common eigenvector, powers of the step grow and it is said",
          "[fast]") {
  // The coupling's eigenvalues γ + G + 2κσ_i add up to 2 (γ + G)(1 + 2 tr e0): for e0 = (−¼ + d, −¼ − d) they are ±4Gd,
  // so that (coupling D)·D vanishes for D ∥ (1, 1), but not coupling D: M is a multiple of I plus a nilpotent matrix.
  auto problem = problem_2d(LatticeKind::square, KernelFamily::gaussian, 0.7, 7.0);
  problem.neighbour_rule = NeighbourRule::nearest;
  problem.scheme.momentum_density = MomentumDensity::equation_of_state;
  constexpr double d = 0.2;  // below ¼, where the lower branch loses its restoring force
  const double L = -2.0 * problem.kernel.slope(1.0);
  problem.displacement_gradient = Vector<2>(-0.25 + d, -0.25 - d).asDiagonal();
  problem.displacement_gradient /= L;
  const double dt = 0.3;
  const auto norm_of_power = [&](const Vector<2>& k, int doublings) {
    ComplexMatrix power = amplification_matrix(problem, k, dt);
    for (int i = 0; i < doublings; ++i) power = power * power;
    return power.norm();
  };
  const Vector<2> diagonal(1.1, 1.1), beside(1.1, 1.0);
  // E^n of a Jordan block of order two is linear in n; the constant part is below 1e-2 of it after 2^14 steps.
  CHECK(norm_of_power(diagonal, 15) / norm_of_power(diagonal, 14) == Approx(2.0).epsilon(1e-2));
  CHECK(mode_spectrum(problem, diagonal, dt).spectral_radius == Approx(1.0).epsilon(1e-14));
  CHECK_FALSE(mode_spectrum(problem, diagonal, dt).power_bounded);
  CHECK(norm_of_power(beside, 15) < 100.0);
  CHECK(mode_spectrum(problem, beside, dt).power_bounded);
}

TEST_CASE("the state is named after Zhang's u, v, R, S", "[fast]") {
  CHECK(state_names(problem_2d(LatticeKind::square, KernelFamily::gaussian, 1.0)) ==
        std::vector<std::string>{"vx", "vy", "sx", "sy"});
}
