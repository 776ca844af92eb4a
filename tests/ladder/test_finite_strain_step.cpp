// SPDX-License-Identifier: MIT
// Rungs 2, 3 and 4 of finite strain: what the theory says of one wave, against what the running solver does to it.
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>

#include "analysis/amplification.hpp"
#include "analysis/critical_step.hpp"
#include "ladder/finite_strain_cases.hpp"
#include "solver/bloch.hpp"
#include "solver/step_jacobian.hpp"

using namespace sphstab;

namespace {

/// Two sums of up to 250 products, the inverse of another between them, and stretches of up to 1.4: some hundred
/// roundings of 1e-16. Derivatives are exact (complex step), so nothing else is in the difference.
constexpr double rounding = 1e-13;
/// Eigenvalues of a dense matrix of a hundred rows; the largest is simple and its condition of order ten.
constexpr double eigenvalue_tolerance = 1e-11;

/// Theory orders the state of finite strain [s, v], the solver [v, s].
template <int Dim>
Eigen::MatrixXcd in_order_of_solver(const analysis::ComplexMatrix& E) {
  Eigen::MatrixXcd result(2 * Dim, 2 * Dim);
  result << E.bottomRightCorner<Dim, Dim>(), E.bottomLeftCorner<Dim, Dim>(), E.topRightCorner<Dim, Dim>(),
      E.topLeftCorner<Dim, Dim>();
  return result;
}

/// 1/√|M| of the stiffest wave that a patch admits: half of what the integrators bear.
template <int Dim>
double half_step(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells) {
  double largest = 0.0;
  for (const auto& k : analysis::patch_wave_vectors<Dim>(problem.lattice, cells))
    largest = std::max(largest, analysis::dynamical_matrix<Dim>(problem, k).norm());
  return 1.0 / std::sqrt(largest);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG(
    "rung 2: the dynamical matrix of finite strain is the running solver's force on a Bloch wave, for every mode",
    "[ladder]", ((int Dim), Dim), 1, 2, 3) {
  const auto cells = ladder::patches<Dim>().back();
  for (const auto& [name, problem] : ladder::every_finite_strain<Dim>()) {
    const auto patch = periodic_patch<Dim>(problem, cells);
    double scale = 0.0, worst = 0.0;
    for (const auto& k : analysis::patch_wave_vectors<Dim>(problem.lattice, cells)) {
      const Tensor<Dim> M = analysis::dynamical_matrix<Dim>(problem, k);
      scale = std::max(scale, M.norm());
      worst = std::max(worst, (solver::bloch_acceleration_matrix<Dim>(problem, patch, k) + M).norm());
    }
    INFO(name);
    CHECK(worst / scale < rounding);
  }
}

TEMPLATE_TEST_CASE_SIG(
    "rung 3: the amplification matrix of finite strain is one real time step, for every mode and integrator",
    "[ladder]", ((int Dim), Dim), 1, 2, 3) {
  const auto cells = ladder::small_patch<Dim>();
  for (const auto& variant : ladder::every_finite_strain<Dim>()) {
    const double time_step = half_step<Dim>(variant.problem, cells);
    for (const auto& [name, problem] : ladder::every_step(variant)) {
      const auto patch = periodic_patch<Dim>(problem, cells);
      double scale = 0.0, worst = 0.0;
      for (const auto& k : analysis::patch_wave_vectors<Dim>(problem.lattice, cells)) {
        const auto E = in_order_of_solver<Dim>(analysis::amplification_matrix<Dim>(problem, k, time_step));
        scale = std::max(scale, E.norm());
        worst = std::max(worst, (solver::bloch_step_matrix<Dim>(problem, patch, k, time_step) - E).norm());
      }
      INFO(name);
      CHECK(worst / scale < rounding);
    }
  }
}

TEMPLATE_TEST_CASE_SIG(
    "rung 4: the Jacobian of a step of finite strain acts on every Bloch wave as the amplification "
    "matrix, and above the limit has its spectral radius",
    "[ladder]", ((int Dim), Dim), 1, 2, 3) {
  constexpr int state = 2 * Dim;
  const auto cells = ladder::small_patch<Dim>();
  for (const auto& variant : ladder::every_finite_strain<Dim>())
    for (const auto& [name, problem] : ladder::every_step(variant)) {
      INFO(name);
      const auto patch = periodic_patch<Dim>(problem, cells);
      const auto limit = std::get<analysis::ConditionallyStable<Dim>>(analysis::patch_limit(problem, cells));
      for (const double fraction : {0.9, 1.05}) {
        const double time_step = fraction * limit.critical_time_step;
        const Eigen::MatrixXd J = solver::step_jacobian(problem, patch, time_step);
        double worst = 0.0, radius = 0.0;
        for (const auto& k : analysis::patch_wave_vectors<Dim>(problem.lattice, cells)) {
          Eigen::MatrixXcd U = Eigen::MatrixXcd::Zero(J.rows(), state);
          for (int a = 0; a < patch.size(); ++a)
            U.block<state, state>(state * a, 0).diagonal().setConstant(std::polar(1.0, k.dot(patch.position[a])));
          const auto E = in_order_of_solver<Dim>(analysis::amplification_matrix<Dim>(problem, k, time_step));
          worst = std::max(worst, (J * U - U * E).norm());
          radius = std::max(radius, analysis::mode_spectrum<Dim>(problem, k, time_step).spectral_radius);
        }
        CHECK(worst / J.norm() < rounding);
        if (fraction < 1.0) continue;
        CHECK(radius > 1.05);
        const Eigen::EigenSolver<Eigen::MatrixXd> modes(J, false);
        CHECK(modes.eigenvalues().cwiseAbs().maxCoeff() == Approx(radius).epsilon(eigenvalue_tolerance));
      }
    }
}
