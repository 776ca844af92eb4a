// SPDX-License-Identifier: MIT
// Rung 4 of the updated-Lagrangian scheme: all eigenvalues of the running step map of a small patch.
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include "analysis/amplification.hpp"
#include "analysis/critical_step.hpp"
#include "solver/updated_bloch.hpp"
#include "tests/analysis/updated_problems.hpp"

using namespace sphstab;

namespace {

/// Rung 4: an isolated largest eigenvalue of a matrix of some hundred rows.
constexpr double radius_tolerance = 1e-8;
/// Sums over the patch of products that are exact to rounding.
constexpr double rounding = 1e-12;

/// Stress on every component, and all terms, or none of it.
template <int Dim>
std::vector<Problem<Dim>> variants(LatticeKind lattice) {
  auto plain = updated_problem<Dim>(lattice, KernelFamily::cubic_spline, 1.2, 0.3, 0.0);
  auto tension = updated_problem<Dim>(lattice, KernelFamily::cubic_spline, 1.2, 0.3, -0.05);
  auto all = tension;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) all.deviatoric_stress(i, j) = i == j ? 0.02 - 0.01 * i : 0.013;
  all.scheme.artificial_stress = ArtificialStress{.epsilon = 0.3};
  all.scheme.xsph = Xsph{0.5};
  all.scheme.viscosity = Viscosity{0.2, 0.1};
  return {plain, tension, all};
}

/// e^{ik·x} on every particle for every number of a state.
template <int Dim>
Eigen::MatrixXcd bloch_columns(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells, const Vector<Dim>& k,
                               Eigen::Index size) {
  const auto patch = periodic_patch<Dim>(problem, cells);
  Eigen::MatrixXcd U = Eigen::MatrixXcd::Zero(size * patch.size(), size);
  for (int a = 0; a < patch.size(); ++a)
    U.middleRows(size * a, size).diagonal().setConstant(std::polar(1.0, k.dot(patch.position[a])));
  return U;
}

template <int Dim>
void check(LatticeKind lattice, const LatticeIndex<Dim>& cells) {
  for (auto problem : variants<Dim>(lattice))
    for (const auto& [integrator, name] : Names<Integrator>::table) {
      problem.integrator = integrator;
      INFO(name_of(lattice) << ", " << name);
      const auto limit = analysis::patch_limit<Dim>(problem, cells);
      const auto* stable = std::get_if<analysis::ConditionallyStable<Dim>>(&limit);
      constexpr double some_step = 0.4;
      const double above = stable ? 1.02 * stable->critical_time_step : some_step;
      Eigen::MatrixXd J;
      double radius = 0.0;
      for (const double time_step : {0.5 * above, above}) {
        J = solver::step_jacobian<Dim>(problem, cells, time_step);
        radius = 0.0;
        for (const auto& k : analysis::patch_wave_vectors<Dim>(problem.lattice, cells)) {
          const auto E = analysis::amplification_matrix<Dim>(problem, k, time_step);
          const auto U = bloch_columns<Dim>(problem, cells, k, E.rows());
          CHECK((J * U - U * E).cwiseAbs().maxCoeff() < rounding);
          radius = std::max(radius, analysis::mode_spectrum<Dim>(problem, k, time_step).spectral_radius);
        }
      }
      CHECK(radius > 1.0 + 1e-4);
      const Eigen::EigenSolver<Eigen::MatrixXd> modes(J, false);
      CHECK(modes.eigenvalues().cwiseAbs().maxCoeff() == Approx(radius).epsilon(radius_tolerance));
    }
}

}  // namespace

TEST_CASE("rung 4: the step of a patch of the running scheme of Gray has the eigenvalues of its waves, 1D",
          "[ladder]") {
  check<1>(LatticeKind::chain, LatticeIndex<1>(12));
}

TEST_CASE("rung 4: the step of a patch of the running scheme of Gray has the eigenvalues of its waves, 2D",
          "[ladder]") {
  check<2>(LatticeKind::square, {4, 3});
  check<2>(LatticeKind::staggered, {3, 4});
}

TEST_CASE("rung 4: the step of a patch of the running scheme of Gray has the eigenvalues of its waves, 3D",
          "[ladder]") {
  check<3>(LatticeKind::bcc, {3, 2, 2});
}
