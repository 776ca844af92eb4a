// SPDX-License-Identifier: MIT
#include "analysis/dispersion.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "analysis/amplification.hpp"
#include "tests/analysis/problems.hpp"

using namespace sphstab;
using namespace sphstab::analysis;

namespace {

constexpr double pi = std::numbers::pi;
/// A dozen roundings.
constexpr double rounding_tolerance = 1e-14;
/// Roundings of lattice sums whose terms nearly cancel, relative to the largest value over the zone.
constexpr double sum_tolerance = 1e-13;
/// The group velocity is a quotient with ω, which may be a hundredth of its largest.
constexpr double quotient_tolerance = 100.0 * sum_tolerance;
/// Eigen's eigenvalues of a non-symmetric matrix, relative to its norm: 1e-15 times the condition of the eigenvalues,
/// |coupling D| |D| / |D · coupling D|, here below 100.
constexpr double eigenvalue_tolerance = 1e-12;

template <int Dim>
Problem<Dim> problem_of(LatticeKind lattice, KernelFamily kernel = KernelFamily::cubic_spline,
                        double smoothing_length = 1.3, double gaussian_cutoff = default_gaussian_cutoff) {
  return {Lattice<Dim>(lattice, 1.0),
          Kernel<Dim>(kernel, smoothing_length, gaussian_cutoff),
          NeighbourRule::support,
          zhang_material(),
          Plane::strain,
          Scheme{}};
}

/// Strained by H with the density of the equation of state.
template <int Dim>
Problem<Dim> strained(Problem<Dim> problem, const Tensor<Dim>& gradient) {
  problem.scheme.momentum_density = MomentumDensity::equation_of_state;
  problem.displacement_gradient = gradient;
  return problem;
}

class Random {
 public:
  template <int Dim>
  Vector<Dim> vector(double largest) {
    return Vector<Dim>::NullaryExpr([&] { return largest * uniform_(engine_); });
  }
  template <int Dim>
  Tensor<Dim> tensor(double largest) {
    return Tensor<Dim>::NullaryExpr([&] { return largest * uniform_(engine_); });
  }

 private:
  std::mt19937 engine_{11};
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
};

/// Calls check(problem, random) on every lattice of a dimension, at rest and in three base states, the last one
/// compressed beyond stability.
template <int Dim, class Check>
void for_each_problem(const Check& check) {
  Random random;
  for (const LatticeKind lattice : lattices_of(Dim)) {
    const auto at_rest = problem_of<Dim>(lattice);
    const Tensor<Dim> squeeze = -0.5 * Tensor<Dim>::Identity();
    INFO(name_of(lattice));
    check(at_rest, random);
    check(strained<Dim>(at_rest, random.tensor<Dim>(0.15)), random);
    check(strained<Dim>(at_rest, random.tensor<Dim>(0.15)), random);
    check(strained<Dim>(at_rest, squeeze), random);
  }
}

template <class Check>
void for_each_dimension(const Check& check) {
  check(std::integral_constant<int, 1>());
  check(std::integral_constant<int, 2>());
  check(std::integral_constant<int, 3>());
}

/// The branch of that name; one of the two transverse ones in 3-D.
template <int Dim>
WaveBranch<Dim> wave_of(const DispersionRelation<Dim>& relation, Branch branch, const Vector<Dim>& k) {
  const auto waves = relation(k);
  return *std::find_if(waves.begin(), waves.end(), [branch](const auto& wave) { return wave.branch == branch; });
}

template <int Dim>
double omega_of(const DispersionRelation<Dim>& relation, Branch branch, const Vector<Dim>& k) {
  return std::sqrt(wave_of(relation, branch, k).omega_squared.real());
}

/// c_p and c_s of zhang_material() in plane strain from E and ν.
const double p_wave_speed = std::sqrt(1.3 * 0.7 / (1.3 * 0.4)), s_wave_speed = std::sqrt(0.5);

}  // namespace

TEST_CASE("the branches are the eigenvalues of the dynamical matrix, least first", "[fast]") {
  for_each_dimension([](auto dimension) {
    constexpr int Dim = dimension();
    for_each_problem<Dim>([](const Problem<Dim>& problem, Random& random) {
      const DispersionRelation<Dim> relation(problem);
      for (int sample = 0; sample < 20; ++sample) {
        const Vector<Dim> k = random.vector<Dim>(4.0);
        const Tensor<Dim> M = dynamical_matrix(problem, k);
        auto expected = numerical_eigenvalues(M.template cast<std::complex<double>>());
        std::sort(expected.begin(), expected.end(), [](auto a, auto b) { return a.real() < b.real(); });
        const auto waves = relation(k);
        for (int i = 0; i < Dim; ++i)
          CHECK(std::abs(waves[i].omega_squared - expected[i]) < eigenvalue_tolerance * M.norm());
      }
    });
  });
}

TEST_CASE("one branch is longitudinal and the others are transverse", "[fast]") {
  for_each_dimension([](auto dimension) {
    constexpr int Dim = dimension();
    for_each_problem<Dim>([](const Problem<Dim>& problem, Random& random) {
      const Vector<Dim> k = random.vector<Dim>(3.0), D = GradientSymbol<Dim>(problem)(k);
      const Tensor<Dim> M = dynamical_matrix(problem, k);
      const auto waves = DispersionRelation<Dim>(problem)(k);
      const auto longitudinal = [](const auto& wave) { return wave.branch == Branch::longitudinal; };
      REQUIRE(std::count_if(waves.begin(), waves.end(), longitudinal) == 1);
      const double of_longitudinal = std::find_if(waves.begin(), waves.end(), longitudinal)->omega_squared.real();
      // D is the left eigenvector of the longitudinal branch: Dᵀ M = ω_L² Dᵀ.
      CHECK((M.transpose() * D - of_longitudinal * D).norm() < eigenvalue_tolerance * M.norm() * D.norm());
    });
  });
}

TEST_CASE("the group velocity is the gradient of the frequency", "[fast]") {
  // Beside a point without frequency ω behaves like √(a² + x²), whose fifth derivative is some 40/a⁴ = 3e4 at most
  // where ω > 0.2. Central differences of step h and h/2, extrapolated: h⁴/480 |ω⁽⁵⁾| = 4e-12, and roundings 8 ε ω/h =
  // 7e-12.
  constexpr double least_omega = 0.2, h = 5e-4, difference_tolerance = 2e-11;
  int checked = 0;
  for_each_dimension([&](auto dimension) {
    constexpr int Dim = dimension();
    for_each_problem<Dim>([&](const Problem<Dim>& problem, Random& random) {
      const DispersionRelation<Dim> relation(problem);
      for (int sample = 0; sample < 20; ++sample) {
        const Vector<Dim> k = random.vector<Dim>(3.0);
        for (const auto& wave : relation(k)) {
          if (wave.omega_squared.real() < least_omega * least_omega) continue;
          for (int axis = 0; axis < Dim; ++axis) {
            const auto difference = [&](double step) {
              const Vector<Dim> e = step * Vector<Dim>::Unit(axis);
              return (omega_of<Dim>(relation, wave.branch, k + e) - omega_of<Dim>(relation, wave.branch, k - e)) /
                     (2.0 * step);
            };
            const double expected = (4.0 * difference(0.5 * h) - difference(h)) / 3.0;
            CHECK(std::abs((*wave.group_velocity)[axis] - expected) < difference_tolerance);
            ++checked;
          }
        }
      }
    });
  });
  CHECK(checked > 1000);
}

TEST_CASE("equivalent wave vectors have the same frequency, growth and group velocity", "[fast]") {
  for_each_dimension([](auto dimension) {
    constexpr int Dim = dimension();
    for_each_problem<Dim>([](const Problem<Dim>& problem, Random& random) {
      const DispersionRelation<Dim> relation(problem);
      const Vector<Dim> k = random.vector<Dim>(3.0);
      const Vector<Dim> whole = Vector<Dim>::LinSpaced(2.0, 3.0 - Dim);  // 2, 1, 0
      const Vector<Dim> equivalent = k + problem.lattice.reciprocal_vectors() * whole;
      const auto here = relation(k), there = relation(equivalent);
      for (int i = 0; i < Dim; ++i) {
        CHECK(there[i].branch == here[i].branch);
        CHECK(there[i].omega_squared.real() == Approx(here[i].omega_squared.real()).margin(sum_tolerance));
        CHECK(there[i].growth_rate == Approx(here[i].growth_rate).margin(quotient_tolerance));
        REQUIRE(there[i].group_velocity.has_value() == here[i].group_velocity.has_value());
        if (here[i].group_velocity)
          CHECK((*there[i].group_velocity - *here[i].group_velocity).norm() < quotient_tolerance);
      }
    });
  });
}

TEST_CASE("the nearest-neighbour chain has the textbook dispersion of central differences", "[fast]") {
  // D = 2Δ|W'(Δ)| sin(kΔ), V = Δ: ω = c_p |D|, and its slope is a cosine that changes sign at kΔ = π/2.
  auto problem = problem_of<1>(LatticeKind::chain);
  problem.neighbour_rule = NeighbourRule::nearest;
  const DispersionRelation<1> relation(problem);
  const double factor = -2.0 * problem.kernel.slope(1.0) * p_wave_speed;
  for (const double k : {0.1, 0.7, 1.3, 1.8, 2.9, -0.4}) {
    const auto wave = relation(Vector<1>(k))[0];
    CHECK(wave.omega_squared.real() == Approx(std::pow(factor * std::sin(k), 2)).epsilon(rounding_tolerance));
    CHECK(*wave.phase_speed == Approx(factor * std::sin(k) / k).epsilon(rounding_tolerance));
    CHECK((*wave.group_velocity)[0] ==
          Approx(factor * std::copysign(std::cos(k), k * std::cos(k))).epsilon(rounding_tolerance));
  }
}

TEST_CASE("four neighbours have the closed dispersion of Zhang's appendix", "[fast]") {
  // D = 2Δ²|W'(Δ)| (sin kx, sin ky).
  auto problem = problem_of<2>(LatticeKind::square);
  problem.neighbour_rule = NeighbourRule::nearest;
  const DispersionRelation<2> relation(problem);
  const double factor = -2.0 * problem.kernel.slope(1.0);
  for (const auto& k : {Vector<2>(0.3, 0.2), Vector<2>(-1.2, 2.5), Vector<2>(2.0, 0.0)}) {
    const double size = std::hypot(std::sin(k[0]), std::sin(k[1]));
    const Vector<2> slope = k.array().sin() * k.array().cos() / size;
    for (const auto& [branch, speed] :
         {std::pair{Branch::longitudinal, p_wave_speed}, std::pair{Branch::transverse, s_wave_speed}}) {
      const auto wave = wave_of(relation, branch, k);
      CHECK(*wave.phase_speed == Approx(factor * speed * size / k.norm()).epsilon(rounding_tolerance));
      CHECK((*wave.group_velocity - factor * speed * slope).norm() < rounding_tolerance);
    }
  }
}

TEST_CASE("a wide Gaussian has the dispersion of its Fourier transform", "[fast]") {
  // The lattice sum is the transform exp(−k²h²/4) up to the images 2π away, exp(−(2π − k)²h²/4) < 1e-20 here, and the
  // cut at 7h, e^{-49}; so D = k exp(−k²h²/4), ω = c|D|, ∂ω/∂|k| = c (1 − k²h²/2) exp(−k²h²/4).
  constexpr double h = 2.5;
  for_each_dimension([](auto dimension) {
    constexpr int Dim = dimension();
    const LatticeKind lattice = lattices_of(Dim).front();
    const DispersionRelation<Dim> relation(problem_of<Dim>(lattice, KernelFamily::gaussian, h, 7.0));
    for (const double length : {0.01, 0.2, 0.5, 0.7}) {
      const Vector<Dim> direction = Vector<Dim>::LinSpaced(1.0, -0.5).normalized(), k = length * direction;
      const double decay = std::exp(-0.25 * length * length * h * h);
      for (const auto& wave : relation(k)) {
        const double speed = wave.branch == Branch::longitudinal ? p_wave_speed : s_wave_speed;
        CHECK(*wave.phase_speed == Approx(speed * decay).epsilon(sum_tolerance));
        CHECK((*wave.group_velocity - speed * (1.0 - 0.5 * length * length * h * h) * decay * direction).norm() <
              sum_tolerance);
      }
    }
  });
}

TEST_CASE("long waves travel at c_p and c_s with an error of second order", "[fast]") {
  // The next term is (kh)² times the first, 1e-4 of it at k = 0.01.
  constexpr double order_tolerance = 1e-3;
  const DispersionRelation<2> relation(problem_of<2>(LatticeKind::hexagonal, KernelFamily::gaussian, 2.0, 7.0));
  const Vector<2> direction = Vector<2>(0.8, 0.6);
  for (const auto& [branch, speed] :
       {std::pair{Branch::longitudinal, p_wave_speed}, std::pair{Branch::transverse, s_wave_speed}}) {
    const auto errors = [&, branch = branch, speed = speed](double length) {
      const auto wave = wave_of<2>(relation, branch, length * direction);
      return std::array<double, 3>{*wave.phase_speed - speed, wave.group_velocity->norm() - speed,
                                   *wave.phase_speed - wave.group_velocity->norm()};
    };
    const auto coarse = errors(0.02), fine = errors(0.01);
    for (std::size_t i = 0; i < coarse.size(); ++i)
      CHECK(std::log2(coarse[i] / fine[i]) == Approx(2.0).margin(order_tolerance));
  }
}

TEST_CASE("waves without frequency have no speed", "[fast]") {
  const auto all_still = [](const auto& waves) {
    for (const auto& wave : waves) {
      CHECK(wave.omega_squared == 0.0);
      CHECK(!std::signbit(wave.omega_squared.real()));
      CHECK(wave.growth_rate == 0.0);
      CHECK_FALSE(wave.phase_speed);
      CHECK_FALSE(wave.group_velocity);
    }
  };
  for_each_dimension([&](auto dimension) {
    constexpr int Dim = dimension();
    for_each_problem<Dim>([&](const Problem<Dim>& problem, Random&) {
      // Γ, a point that is equivalent to it, and a half of a reciprocal vector (theory.md §1).
      const DispersionRelation<Dim> relation(problem);
      all_still(relation(Vector<Dim>::Zero()));
      all_still(relation(problem.lattice.reciprocal_vectors() * Vector<Dim>::Ones()));
      all_still(relation(0.5 * problem.lattice.reciprocal_vectors() * Vector<Dim>::Ones()));
    });
  });
  all_still(DispersionRelation<2>(problem_of<2>(LatticeKind::hexagonal))(Vector<2>(4.0 * pi / 3.0, 0.0)));
}

TEST_CASE("a compressed state grows as its closed form says, with and without damping", "[fast]") {
  // theory.md §2, equibiaxial strain e as SPH sees it: ω_L² = (ρ0/ρ̄²)|D|² (λ + 2G + 4(λ + G) e), ρ̄ = ρ0 exp(−2e), with
  // λ = 0.75 and G = 0.5.
  const auto at_rest = problem_of<2>(LatticeKind::square);
  const double e = -0.5 * GradientSymbol<2>(at_rest).consistency()(0, 0);
  for (const double rate : {0.0, 0.4}) {
    auto problem = strained<2>(at_rest, -0.5 * Tensor<2>::Identity());
    if (rate > 0.0) problem.scheme.damping = Damping{rate};
    const Vector<2> k(1.1, 0.4);
    const double D_squared = GradientSymbol<2>(problem)(k).squaredNorm();
    const double omega_squared = std::exp(4.0 * e) * D_squared * (1.75 + 5.0 * e);
    REQUIRE(omega_squared < 0.0);
    const auto waves = DispersionRelation<2>(problem)(k);
    CHECK(waves[0].branch == Branch::longitudinal);
    CHECK(waves[0].omega_squared.real() == Approx(omega_squared).epsilon(rounding_tolerance));
    CHECK(waves[0].growth_rate ==
          Approx(0.5 * (std::sqrt(rate * rate - 4.0 * omega_squared) - rate)).epsilon(rounding_tolerance));
    CHECK_FALSE(waves[0].phase_speed);
    CHECK_FALSE(waves[0].group_velocity);
    CHECK(waves[1].omega_squared.real() == Approx(std::exp(4.0 * e) * D_squared * 0.5).epsilon(rounding_tolerance));
    CHECK(waves[1].growth_rate == 0.0);
  }
}

TEST_CASE("frequencies beyond the range of a double are refused", "[fast]") {
  // c_p² = 1e±280 by the material, |D|² = 1e±40 by the spacing.
  for (const double size : {1e-20, 1e20}) {
    auto problem = problem_of<2>(LatticeKind::square);
    const double modulus = std::pow(size, -7.0);
    problem.lattice = Lattice<2>(LatticeKind::square, size);
    problem.kernel = Kernel<2>(KernelFamily::cubic_spline, 1.3 * size);
    problem.material = Material::from_young_modulus(1.0 / modulus, modulus, 0.3);
    CHECK_THROWS_WITH(DispersionRelation<2>(problem)(Vector<2>(1.0, 0.5) / size),
                      Catch::Contains("leave the range of a double"));
  }
}
