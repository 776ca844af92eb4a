// SPDX-License-Identifier: MIT
// Rung 1: what the symbol must be without knowing how it is computed: long waves, symmetries, closed forms.
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "analysis/amplification.hpp"
#include "analysis/critical_step.hpp"
#include "analysis/gradient_symbol.hpp"
#include "ladder/cases.hpp"
#include "ladder/point_group.hpp"

using namespace sphstab;

namespace {

constexpr double pi = std::numbers::pi;
/// Sums of up to some hundred terms; phases of a few turns carry their own rounding, times the order of the sum.
constexpr double rounding = 1e-13;

template <int Dim>
Vector<Dim> some_direction() {
  return Vector<3>(0.6, -0.9, 0.4).head<Dim>().normalized();
}

/// A base state that the equation of state makes felt, so that the tensor itself must turn.
template <int Dim>
Problem<Dim> strained_problem(LatticeKind lattice) {
  constexpr std::array<double, 9> gradient{0.06, -0.03, 0.05, -0.09, 0.04, -0.02, 0.03, 0.01, -0.05};
  auto problem = ladder::basic_problem<Dim>(lattice, KernelFamily::quintic_spline, 0.83);
  problem.scheme.momentum_density = MomentumDensity::equation_of_state;
  problem.displacement_gradient = Eigen::Map<const Tensor<Dim>>(gradient.data());
  return problem;
}

template <int Dim>
double largest_frequency_squared(const Problem<Dim>& problem) {
  const auto limit = std::get<analysis::ConditionallyStable<Dim>>(analysis::BulkModes(problem).limit());
  return limit.mode.omega * limit.mode.omega;
}

template <int Dim>
Problem<Dim> nearest_neighbours(LatticeKind lattice) {
  auto problem = ladder::basic_problem<Dim>(lattice, KernelFamily::wendland_c4, 0.77);
  problem.neighbour_rule = NeighbourRule::nearest;
  return problem;
}

/// Checks a symbol D(k) = −2 V W'(Δp) shape(k) of the nearest shell written out by hand, `largest` being max |shape|:
/// at wave vectors all over the zone, and as the critical time step 2 / (c_p max |D|).
template <int Dim, class Shape>
void check_nearest_shell(LatticeKind lattice, const Shape& shape, double largest) {
  INFO(name_of(lattice));
  const auto problem = nearest_neighbours<Dim>(lattice);
  const double spacing = problem.lattice.spacing();
  const double factor = -2.0 * problem.lattice.cell_volume() * problem.kernel.slope(spacing);
  const analysis::GradientSymbol<Dim> symbol(problem);
  for (double step = 0.1; step < 20.0; step += 0.37) {
    const Vector<Dim> k = Vector<3>(step, 1.7 * step, -0.6 * step).head<Dim>() / spacing;
    CHECK((symbol(k) - factor * shape(k)).norm() < rounding * factor);
  }
  const double c_p = std::sqrt(problem.material.lame(problem.plane).p_wave_modulus() / problem.material.density());
  const auto limit = std::get<analysis::ConditionallyStable<Dim>>(analysis::BulkModes(problem).limit());
  CHECK(limit.critical_time_step == Approx(2.0 / (c_p * factor * largest)).epsilon(rounding));
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("rung 1: long waves travel at the p-wave and s-wave speeds, with an error of second order",
                       "[ladder]", ((int Dim), Dim), 1, 2, 3) {
  // D = L k (1 + O(k²)) with the consistency L of the lattice, so that the errors of ω²/|Lk|² are of second order, too;
  // 0.1 leaves room for the fourth.
  constexpr double order = 2.0, order_tolerance = 0.1;
  for (const auto& [kernel, kernel_name] : Names<KernelFamily>::table)
    for (const LatticeKind lattice : lattices_of(Dim)) {
      INFO(kernel_name << " " << name_of(lattice));
      const auto problem = ladder::basic_problem<Dim>(lattice, kernel, Dim == 3 ? 0.93 : 1.27);
      const LameConstants lame = problem.material.lame(problem.plane);
      const Tensor<Dim> L = ladder::consistency(problem);
      // Relative errors of c_p² and c_s² for waves of length 2π Δp / size.
      const auto errors = [&](double size) {
        const Vector<Dim> k = size / problem.lattice.spacing() * some_direction<Dim>(), Lk = L * k;
        const Tensor<Dim> M =
            problem.material.density() / Lk.squaredNorm() * analysis::dynamical_matrix<Dim>(problem, k);
        Eigen::SelfAdjointEigenSolver<Tensor<Dim>> modes(M);
        return std::array<double, 2>{modes.eigenvalues()[Dim - 1] / lame.p_wave_modulus() - 1.0,
                                     modes.eigenvalues()[0] / lame.shear_modulus - 1.0};
      };
      const auto coarse = errors(0.1), fine = errors(0.05);
      for (std::size_t branch = 0; branch < (Dim == 1 ? 1 : 2); ++branch) {
        CHECK(std::abs(fine[branch]) < 1e-2);
        CHECK(std::log2(coarse[branch] / fine[branch]) == Approx(order).margin(order_tolerance));
      }
    }
}

TEMPLATE_TEST_CASE_SIG("rung 1: for a smooth kernel the lattice is no longer felt and the wave speeds are exact",
                       "[ladder]", ((int Dim), Dim), 1, 2, 3) {
  // Gaussian, h = 2 Δp: D = k exp(−k²h²/4), but for its images at k less a reciprocal vector (|k − b| Δp > 5.2, so
  // exp(−27)) and for the cut at 6 h (exp(−36)).
  constexpr double lattice_error = 1e-11;
  for (const LatticeKind lattice : lattices_of(Dim)) {
    INFO(name_of(lattice));
    const double spacing = 0.37, h = 2.0 * spacing;
    Problem<Dim> problem{.lattice = Lattice<Dim>(lattice, spacing),
                         .kernel = Kernel<Dim>(KernelFamily::gaussian, h, 6.0),
                         .material = Material::from_young_modulus(1.7, 2.9, 0.31)};
    const analysis::GradientSymbol<Dim> symbol(problem);
    for (const double size : {0.01, 0.1, 0.5, 1.0}) {
      const Vector<Dim> k = size / spacing * some_direction<Dim>();
      CHECK((symbol(k) - std::exp(-0.25 * k.squaredNorm() * h * h) * k).norm() < lattice_error * k.norm());
    }
  }
}

TEMPLATE_TEST_CASE_SIG("rung 1: without a wave there is no frequency", "[ladder]", ((int Dim), Dim), 1, 2, 3) {
  for (const auto& [name, problem] : ladder::every_variant<Dim>()) {
    INFO(name);
    CHECK(analysis::dynamical_matrix<Dim>(problem, Vector<Dim>::Zero()).norm() == 0.0);
  }
}

TEMPLATE_TEST_CASE_SIG("rung 1: the symbol turns with the lattice, and waves k, -k and k + reciprocal vectors are one",
                       "[ladder]", ((int Dim), Dim), 1, 2, 3) {
  for (const LatticeKind lattice : lattices_of(Dim)) {
    INFO(name_of(lattice));
    const auto problem = strained_problem<Dim>(lattice);
    const double scale = largest_frequency_squared(problem);
    REQUIRE(ladder::point_group(problem.lattice).size() == ladder::order_of_point_group(lattice));
    const auto turn = [](const Tensor<Dim>& R, Problem<Dim>& turned) {
      turned.displacement_gradient = (R * turned.displacement_gradient * R.transpose()).eval();
    };
    for (const double size : {0.4, 1.3, 2.7}) {
      const Vector<Dim> k = size / problem.lattice.spacing() * some_direction<Dim>();
      CHECK(ladder::symmetry_error<Dim>(problem, k, turn) < rounding * scale);
    }
  }
}

TEST_CASE("rung 1: the symbol and the limit of nearest neighbours are those derived by hand", "[ladder]") {
  const double a = ladder::basic_problem<1>(LatticeKind::chain, KernelFamily::gaussian, 1.0).lattice.spacing();
  check_nearest_shell<1>(
      LatticeKind::chain, [a](const Vector<1>& k) { return Vector<1>(std::sin(a * k[0])); }, 1.0);
  check_nearest_shell<2>(
      LatticeKind::square, [a](const Vector<2>& k) -> Vector<2> { return (a * k).array().sin(); }, std::sqrt(2.0));
  // The rows of the staggered lattice are nearest neighbours, its columns are not.
  check_nearest_shell<2>(
      LatticeKind::staggered, [a](const Vector<2>& k) { return Vector<2>(std::sin(a * k[0]), 0.0); }, 1.0);
  check_nearest_shell<3>(
      LatticeKind::cubic, [a](const Vector<3>& k) -> Vector<3> { return (a * k).array().sin(); }, std::sqrt(3.0));
  // bcc, d = (±1, ±1, ±1) a/√3: |D|² is linear in each cos² of the phases, so its maximum is at a corner such as
  // (π/2, 0, 0).
  check_nearest_shell<3>(
      LatticeKind::bcc,
      [a](const Vector<3>& k) -> Vector<3> {
        const Eigen::Array3d s = (a / std::sqrt(3.0) * k).array().sin(), c = (a / std::sqrt(3.0) * k).array().cos();
        return 4.0 / std::sqrt(3.0) * Vector<3>(s[0] * c[1] * c[2], c[0] * s[1] * c[2], c[0] * c[1] * s[2]);
      },
      4.0 / std::sqrt(3.0));
  // fcc, d = (±1, ±1, 0) a/√2 and permutations: largest along an axis, at (π/2, 0, 0), where s (c + c) = 2.
  check_nearest_shell<3>(
      LatticeKind::fcc,
      [a](const Vector<3>& k) -> Vector<3> {
        const Eigen::Array3d s = (a / std::sqrt(2.0) * k).array().sin(), c = (a / std::sqrt(2.0) * k).array().cos();
        return std::sqrt(2.0) * Vector<3>(s[0] * (c[1] + c[2]), s[1] * (c[2] + c[0]), s[2] * (c[0] + c[1]));
      },
      2.0 * std::sqrt(2.0));
  // Six neighbours at 60°: D ∥ k along a row, where 2 s + 2 · ½ sin(θ/2) … is largest at cos(θ/2) = (√33 − 1)/8.
  check_nearest_shell<2>(
      LatticeKind::hexagonal,
      [a](const Vector<2>& k) -> Vector<2> {
        Vector<2> sum = Vector<2>::Zero();
        for (int i = 0; i < 3; ++i) {
          const Vector<2> e(std::cos(i * pi / 3.0), std::sin(i * pi / 3.0));
          sum += std::sin(a * k.dot(e)) * e;
        }
        return sum;
      },
      [] {
        const double c = (std::sqrt(33.0) - 1.0) / 8.0, s = std::sqrt(1.0 - c * c);
        return 2.0 * s * c + s;
      }());
}
