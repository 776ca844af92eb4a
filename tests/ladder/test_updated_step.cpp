// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "analysis/amplification.hpp"
#include "analysis/updated_lagrangian.hpp"
#include "solver/updated_bloch.hpp"
#include "tests/analysis/updated_problems.hpp"

using namespace sphstab;

namespace {

/// Both sides sum some 30 neighbours and pass through three matrix products; the solver's derivatives are exact.
constexpr double rounding = 1e-12;
constexpr double time_step = 0.23;

/// A stressed base state with every term of the scheme, and those that switch one of them.
template <int Dim>
std::vector<Problem<Dim>> variants(LatticeKind lattice, KernelFamily kernel) {
  Problem<Dim> all = updated_problem<Dim>(lattice, kernel, 1.3, 0.3, -0.04);
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j)
      all.deviatoric_stress(i, j) = i == j ? 0.07 - 0.11 * i + 0.02 * i * i : 0.03 - 0.01 * (i + j);
  all.scheme.artificial_stress = ArtificialStress{.epsilon = 0.4};
  all.scheme.xsph = Xsph{0.5};
  all.scheme.viscosity = Viscosity{0.3, 0.1};
  std::vector<Problem<Dim>> problems{all};
  problems.emplace_back(all).scheme.artificial_stress.reset();
  problems.emplace_back(all).scheme.artificial_stress->weight = ArtificialStressWeight::distance_ratio;
  problems.emplace_back(all).scheme.xsph.reset();
  problems.emplace_back(all).scheme.viscosity.reset();
  problems.emplace_back(updated_problem<Dim>(lattice, kernel, 1.3, 0.3, 0.0));
  problems.emplace_back(all).lattice = all.lattice.deformed(Tensor<Dim>::Identity() * 1.04);
  return problems;
}

/// Largest difference of E(k) between the theory and one step of the running solver, over waves of a small box.
template <int Dim>
void check_steps(LatticeKind lattice, KernelFamily kernel) {
  const LatticeIndex<Dim> cells = LatticeIndex<Dim>::Constant(Dim == 3 ? 3 : 5);
  for (const auto& variant : variants<Dim>(lattice, kernel))
    for (const auto& [integrator, name] : Names<Integrator>::table) {
      Problem<Dim> problem = variant;
      problem.integrator = integrator;
      Vector<Dim> fractions = Vector<Dim>::Constant(1.0);
      fractions[0] = 2.0;
      const Vector<Dim> k = problem.lattice.reciprocal_vectors() * (fractions / cells[0]);
      INFO(name_of(lattice) << ", " << name);
      const Eigen::MatrixXcd run = solver::bloch_step_matrix<Dim>(problem, cells, k, time_step);
      const Eigen::MatrixXcd theory = analysis::amplification_matrix<Dim>(problem, k, time_step);
      REQUIRE(run.rows() == theory.rows());
      CHECK((run - theory).cwiseAbs().maxCoeff() < rounding);
    }
}

}  // namespace

TEST_CASE("rung 3: a step of the running scheme of Gray does to a wave what the theory says", "[ladder]") {
  check_steps<1>(LatticeKind::chain, KernelFamily::quintic_spline);
  for (const LatticeKind lattice : lattices_of(2)) check_steps<2>(lattice, KernelFamily::wendland_c2);
  check_steps<3>(LatticeKind::fcc, KernelFamily::cubic_spline);
}

TEST_CASE("rung 2: the rates of the running scheme of Gray are those of the theory, block by block", "[ladder]") {
  const LatticeIndex<2> cells(5, 4);
  for (const auto& problem : variants<2>(LatticeKind::hexagonal, KernelFamily::cubic_spline)) {
    const Vector<2> k = problem.lattice.reciprocal_vectors() * Vector<2>(0.4, 0.25);
    const Eigen::MatrixXcd L = solver::bloch_rate_matrix<2>(problem, cells, k);
    const auto wave = analysis::UpdatedLagrangian<2>(problem)(k);
    constexpr std::complex<double> i(0.0, 1.0);
    const auto difference = [](const auto& run, const auto& theory) { return (run - theory).cwiseAbs().maxCoeff(); };
    CHECK(difference(L.block(0, 2, 2, 2), wave.smoothing * Eigen::Matrix2cd::Identity()) < rounding);
    CHECK(difference(L.block(2, 0, 2, 2), wave.of_position.cast<std::complex<double>>()) < rounding);
    CHECK(difference(L.block(2, 2, 2, 2), wave.of_velocity.cast<std::complex<double>>()) < rounding);
    CHECK(difference(L.block(2, 4, 2, 4), i * wave.of_state.cast<std::complex<double>>()) < rounding);
    CHECK(difference(L.block(4, 2, 4, 2), i * wave.state_rate.cast<std::complex<double>>()) < rounding);
  }
}
