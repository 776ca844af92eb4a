// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "analysis/critical_step.hpp"
#include "analysis/gradient_symbol.hpp"
#include "tests/analysis/problems.hpp"

using namespace sphstab;
using namespace sphstab::analysis;

namespace {

/// Rounding of a basis a hundred times longer than the spacing.
constexpr double rounding = 1e-12;

/// The problem with another basis of its lattice: columns Σ_i a_i n_ij.
Problem<2> in_basis(Problem<2> problem, const Tensor<2>& n) {
  const double spacing = problem.lattice.spacing();
  problem.lattice = Lattice<2>(problem.lattice.primitive_vectors() / spacing * n, spacing);
  return problem;
}

const Tensor<2> bases[] = {Tensor<2>{{1.0, 100.0}, {0.0, 1.0}}, Tensor<2>{{0.0, 1.0}, {1.0, 0.0}},
                           Tensor<2>{{2.0, 7.0}, {1.0, 3.0}}};

}  // namespace

TEST_CASE("the symbol and its frequencies do not depend on the basis of the lattice", "[fast]") {
  for (const LatticeKind kind : lattices_of(2)) {
    const auto problem = problem_2d(kind, KernelFamily::quintic_spline, 1.3);
    const GradientSymbol<2> symbol(problem);
    for (const auto& basis : bases) {
      INFO(name_of(kind) << " " << basis);
      const GradientSymbol<2> skewed(in_basis(problem, basis));
      CHECK(skewed.series().terms().size() == symbol.series().terms().size());
      CHECK(skewed.series().euclidean_type() < 2.0 * symbol.series().euclidean_type());
      CHECK((skewed.consistency() - symbol.consistency()).norm() < rounding);
      for (const Vector<2>& k : {Vector<2>(0.3, 1.1), Vector<2>(-2.0, 2.5)}) {
        CHECK((skewed(k) - symbol(k)).norm() < rounding);
        CHECK((skewed.wave_vector(skewed.phases(k)) - k).norm() < rounding);
      }
    }
  }
}

TEST_CASE("limit, critical mode and zero-energy modes do not depend on the basis of the lattice", "[fast]") {
  constexpr double of_modes = 1e-6;  // position of a maximum known to 1e-13 in height
  for (const LatticeKind kind : lattices_of(2)) {
    const auto problem = problem_2d(kind, KernelFamily::cubic_spline, 1.3);
    const auto limit = std::get<ConditionallyStable<2>>(BulkModes<2>(problem).limit());
    const auto zeros = zero_energy_modes(problem).wave_vectors;
    for (const auto& basis : bases) {
      INFO(name_of(kind) << " " << basis);
      const auto skewed = in_basis(problem, basis);
      const auto found = std::get<ConditionallyStable<2>>(BulkModes<2>(skewed).limit());
      CHECK(found.critical_time_step == Approx(limit.critical_time_step).epsilon(rounding));
      CHECK(found.mode.omega == Approx(limit.mode.omega).epsilon(rounding));
      CHECK(found.mode.wave_vector.norm() == Approx(limit.mode.wave_vector.norm()).epsilon(of_modes));
      const auto modes = zero_energy_modes(skewed).wave_vectors;
      REQUIRE(modes.size() == zeros.size());
      for (std::size_t i = 0; i < modes.size(); ++i) CHECK((modes[i] - zeros[i]).norm() < of_modes);
    }
  }
}
