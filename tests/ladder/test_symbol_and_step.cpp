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

/// Every wave vector that a patch admits.
template <int Dim>
std::vector<Vector<Dim>> admitted_wave_vectors(const Lattice<Dim>& lattice, const LatticeIndex<Dim>& cells) {
  std::vector<Vector<Dim>> wave_vectors;
  for (int flat = 0; flat < cells.prod(); ++flat) {
    Vector<Dim> fraction;
    for (int axis = 0, rest = flat; axis < Dim; rest /= cells[axis], ++axis)
      fraction[axis] = static_cast<double>(rest % cells[axis]) / cells[axis];
    wave_vectors.push_back(lattice.reciprocal_vectors() * fraction);
  }
  return wave_vectors;
}

template <int Dim>
double patch_step(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells) {
  return std::get<analysis::ConditionallyStable<Dim>>(analysis::patch_limit(problem, cells)).critical_time_step;
}

template <int Dim>
double bulk_step(const Problem<Dim>& problem) {
  return std::get<analysis::ConditionallyStable<Dim>>(analysis::BulkModes(problem).limit()).critical_time_step;
}

/// ω_max² of the infinite lattice: the scale of the dynamical matrix also on a patch that admits zero-energy modes
/// only.
template <int Dim>
double largest_frequency_squared(const Problem<Dim>& problem) {
  const auto limit = std::get<analysis::ConditionallyStable<Dim>>(analysis::BulkModes(problem).limit());
  return limit.mode.omega * limit.mode.omega;
}

double spectral_radius(const Eigen::MatrixXd& matrix) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("rung 2: the dynamical matrix is the running solver's force on a Bloch wave, for every mode",
                       "[ladder]", ((int Dim), Dim), 1, 2, 3) {
  for (const auto& [name, problem] : ladder::every_variant<Dim>())
    for (const auto& cells : ladder::patches<Dim>()) {
      const auto patch = periodic_patch<Dim>(problem, cells);
      double worst = 0.0;
      for (const auto& k : admitted_wave_vectors<Dim>(problem.lattice, cells)) {
        const Tensor<Dim> M = analysis::dynamical_matrix<Dim>(problem, k);
        worst = std::max(worst, (solver::bloch_acceleration_matrix<Dim>(problem, patch, k) + M).norm());
      }
      INFO(name << ", patch " << cells.transpose());
      CHECK(worst < rounding * largest_frequency_squared<Dim>(problem));
    }
}

TEMPLATE_TEST_CASE_SIG("rung 3: the amplification matrix is one real time step, for every mode and integrator",
                       "[ladder]", ((int Dim), Dim), 1, 2, 3) {
  for (auto& [name, problem] : ladder::every_variant<Dim>())
    for (const auto& [integrator, integrator_name] : total_lagrangian_integrators)
      for (const auto& cells : ladder::patches<Dim>()) {
        problem.integrator = integrator;
        const auto patch = periodic_patch<Dim>(problem, cells);
        const double time_step = 0.5 * bulk_step<Dim>(problem);
        double scale = 0.0, worst = 0.0;
        for (const auto& k : admitted_wave_vectors<Dim>(problem.lattice, cells)) {
          const analysis::ComplexMatrix E = analysis::amplification_matrix<Dim>(problem, k, time_step);
          scale = std::max(scale, E.norm());
          worst = std::max(worst, (solver::bloch_step_matrix<Dim>(problem, patch, k, time_step) - E).norm());
        }
        INFO(name << ", " << integrator_name << ", patch " << cells.transpose());
        CHECK(worst < rounding * scale);
      }
}

TEMPLATE_TEST_CASE_SIG(
    "rung 4: below the limit the Jacobian of a step acts on every Bloch wave as the amplification matrix", "[ladder]",
    ((int Dim), Dim), 1, 2, 3) {
  constexpr int state = 2 * Dim;
  const auto cells = ladder::small_patch<Dim>();
  for (auto& [name, problem] : ladder::every_variant<Dim>())
    for (const auto& [integrator, integrator_name] : total_lagrangian_integrators) {
      problem.integrator = integrator;
      const auto patch = periodic_patch<Dim>(problem, cells);
      const double time_step = 0.9 * patch_step<Dim>(problem, cells);
      const Eigen::MatrixXcd J = solver::step_jacobian(problem, patch, time_step).template cast<std::complex<double>>();
      double worst = 0.0;
      for (const auto& k : admitted_wave_vectors<Dim>(problem.lattice, cells)) {
        Eigen::MatrixXcd U = Eigen::MatrixXcd::Zero(J.rows(), state);
        for (int a = 0; a < patch.size(); ++a)
          U.block<state, state>(state * a, 0).diagonal().setConstant(std::polar(1.0, k.dot(patch.position[a])));
        worst = std::max(worst, (J * U - U * analysis::amplification_matrix<Dim>(problem, k, time_step)).norm());
      }
      INFO(name << ", " << integrator_name);
      CHECK(worst < rounding * J.norm());
    }
}

TEMPLATE_TEST_CASE_SIG("rung 4: above the limit the spectral radius of the solver's step is that of the theory",
                       "[ladder]", ((int Dim), Dim), 1, 2, 3) {
  const auto cells = ladder::small_patch<Dim>();
  for (auto& [name, problem] : ladder::every_variant<Dim>())
    for (const auto& [integrator, integrator_name] : total_lagrangian_integrators) {
      problem.integrator = integrator;
      const auto patch = periodic_patch<Dim>(problem, cells);
      const double time_step = 1.05 * patch_step<Dim>(problem, cells);
      double radius = 0.0;
      for (const auto& k : admitted_wave_vectors<Dim>(problem.lattice, cells))
        radius = std::max(radius, analysis::mode_spectrum<Dim>(problem, k, time_step).spectral_radius);
      INFO(name << ", " << integrator_name);
      CHECK(radius > 1.05);
      CHECK(std::abs(spectral_radius(solver::step_jacobian(problem, patch, time_step)) - radius) <
            eigenvalue_tolerance * radius);
    }
}
