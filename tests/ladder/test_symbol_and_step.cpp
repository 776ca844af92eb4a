// SPDX-License-Identifier: MIT
// Rungs 2, 3 and 4: what the theory says of one mode, against what the running solver does to it.
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>

#include "analysis/amplification.hpp"
#include "analysis/critical_step.hpp"
#include "ladder/cases.hpp"
#include "solver/bloch.hpp"
#include "solver/step_jacobian.hpp"

using namespace sphstab;

namespace {

/// Sums of up to 50 products in two passes, on a base state of strain 0.1: a few hundred roundings of relative size
/// 1e-16. Derivatives are exact (complex step), so nothing else is in the difference.
constexpr double rounding = 1e-13;
/// Eigenvalues of a dense matrix of a hundred rows; the largest is simple and its condition of order ten.
constexpr double eigenvalue_tolerance = 1e-11;

/// Patches that admit zone centre, boundary and corners, and modes that are none of these.
const LatticeIndex<2> patches[] = {{4, 4}, {5, 3}, {6, 7}};

/// Every wave vector that a patch admits.
std::vector<Vector<2>> admitted_wave_vectors(const Lattice<2>& lattice, const LatticeIndex<2>& cells) {
  std::vector<Vector<2>> wave_vectors;
  for (int i = 0; i < cells[0]; ++i)
    for (int j = 0; j < cells[1]; ++j)
      wave_vectors.push_back(lattice.reciprocal_vectors() *
                             Vector<2>(static_cast<double>(i) / cells[0], static_cast<double>(j) / cells[1]));
  return wave_vectors;
}

double patch_step(const Problem<2>& problem, const LatticeIndex<2>& cells) {
  return std::get<analysis::ConditionallyStable<2>>(analysis::patch_limit(problem, cells)).critical_time_step;
}

double spectral_radius(const Eigen::MatrixXd& matrix) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("rung 2: the dynamical matrix is the running solver's force on a Bloch wave, for every mode", "[ladder]") {
  for (const auto& [name, problem] : ladder::every_variant())
    for (const auto& cells : patches) {
      const auto patch = periodic_patch<2>(problem, cells);
      double scale = 0.0, worst = 0.0;
      for (const auto& k : admitted_wave_vectors(problem.lattice, cells)) {
        const Tensor<2> M = analysis::dynamical_matrix(problem, k);
        scale = std::max(scale, M.norm());
        worst = std::max(worst, (solver::bloch_acceleration_matrix(problem, patch, k) + M).norm());
      }
      INFO(name << ", patch " << cells.transpose());
      CHECK(worst < rounding * scale);
    }
}

TEST_CASE("rung 3: the amplification matrix is one real time step, for every mode and integrator", "[ladder]") {
  for (auto& [name, problem] : ladder::every_variant())
    for (const auto& [integrator, integrator_name] : Names<Integrator>::table)
      for (const auto& cells : patches) {
        problem.integrator = integrator;
        const auto patch = periodic_patch<2>(problem, cells);
        const double time_step = 0.5 * patch_step(problem, cells);
        double scale = 0.0, worst = 0.0;
        for (const auto& k : admitted_wave_vectors(problem.lattice, cells)) {
          const analysis::ComplexMatrix E = analysis::amplification_matrix(problem, k, time_step);
          scale = std::max(scale, E.norm());
          worst = std::max(worst, (solver::bloch_step_matrix(problem, patch, k, time_step) - E).norm());
        }
        INFO(name << ", " << integrator_name << ", patch " << cells.transpose());
        CHECK(worst < rounding * scale);
      }
}

TEST_CASE("rung 4: below the limit the Jacobian of a step acts on every Bloch wave as the amplification matrix",
          "[ladder]") {
  constexpr int state = 4;
  const LatticeIndex<2> cells(5, 4);
  for (auto& [name, problem] : ladder::every_variant())
    for (const auto& [integrator, integrator_name] : Names<Integrator>::table) {
      problem.integrator = integrator;
      const auto patch = periodic_patch<2>(problem, cells);
      const double time_step = 0.9 * patch_step(problem, cells);
      const Eigen::MatrixXcd J = solver::step_jacobian(problem, patch, time_step).template cast<std::complex<double>>();
      double worst = 0.0;
      for (const auto& k : admitted_wave_vectors(problem.lattice, cells)) {
        Eigen::MatrixXcd U = Eigen::MatrixXcd::Zero(J.rows(), state);
        for (int a = 0; a < patch.size(); ++a)
          U.block<state, state>(state * a, 0).diagonal().setConstant(std::polar(1.0, k.dot(patch.position[a])));
        worst = std::max(worst, (J * U - U * analysis::amplification_matrix(problem, k, time_step)).norm());
      }
      INFO(name << ", " << integrator_name);
      CHECK(worst < rounding * J.norm());
    }
}

TEST_CASE("rung 4: above the limit the spectral radius of the solver's step is that of the theory", "[ladder]") {
  const LatticeIndex<2> cells(5, 4);
  for (auto& [name, problem] : ladder::every_variant())
    for (const auto& [integrator, integrator_name] : Names<Integrator>::table) {
      problem.integrator = integrator;
      const auto patch = periodic_patch<2>(problem, cells);
      const double time_step = 1.05 * patch_step(problem, cells);
      double radius = 0.0;
      for (const auto& k : admitted_wave_vectors(problem.lattice, cells))
        radius = std::max(radius, analysis::mode_spectrum(problem, k, time_step).spectral_radius);
      INFO(name << ", " << integrator_name);
      CHECK(radius > 1.05);
      CHECK(std::abs(spectral_radius(solver::step_jacobian(problem, patch, time_step)) - radius) <
            eigenvalue_tolerance * radius);
    }
}
