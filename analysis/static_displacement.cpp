// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <Eigen/IterativeLinearSolvers>
#include <algorithm>

#include "analysis/body_operator.hpp"
#include "analysis/rigid_motions.hpp"
#include "analysis/spectrum.hpp"

namespace sphstab::analysis {
namespace {

/// Relative residual of the equilibrium, M^−½-weighted.
constexpr double residual_tolerance = 1e-12;

/// A resultant below this, relative to the sum of the forces, is the rounding of a load in balance.
constexpr double in_balance = 1e-10;

constexpr int most_iterations = 100000;

/// ω² of what the load drives, xᵀ H x / xᵀ x, below this part of the norm of H is the rounding of no resistance.
constexpr double no_resistance = 1e-12;

/// Throws InvalidInput if the forces drive a part of the body in a direction in which nothing of it is clamped.
template <int Dim>
void require_balance(const Body<Dim>& body, const BodyOperator<Dim>& op, const Eigen::VectorXd& force) {
  for (const auto& part : connected_parts(body.pairs))
    for (int i = 0; i < Dim; ++i) {
      double resultant = 0.0, sum = 0.0;
      bool free = true;
      for (const int a : part) {
        free = free && op.root_inverse_mass()[a * Dim + i] > 0.0;
        resultant += force[a * Dim + i];
        sum += std::abs(force[a * Dim + i]);
      }
      if (free && std::abs(resultant) > in_balance * sum)
        throw InvalidInput(
            fmt::format("load: it drives particle {} and those connected to it along axis {}, where nothing holds them",
                        part.front(), i));
    }
}

/// Throws InvalidInput if the forces turn a part of the body that nothing holds.
template <int Dim>
void require_balance_of_couples(const Body<Dim>& body, const Eigen::VectorXd& force) {
  const Eigen::MatrixXd motions = rigid_motions(body);
  for (int i = 0; i < motions.cols(); ++i) {
    const Eigen::ArrayXd work = motions.col(i).array() * force.array();
    if (std::abs(work.sum()) > in_balance * work.abs().sum())
      throw InvalidInput("load: its couple turns a part of the body that nothing holds");
  }
}

}  // namespace

template <int Dim>
Eigen::VectorXd static_displacement(const Problem<Dim>& problem, const Body<Dim>& body) {
  if (problem.scheme.momentum_density == MomentumDensity::equation_of_state)
    throw InvalidInput("density_in_momentum: equation-of-state has no linear equilibrium, static ones take frozen");
  const BodyOperator<Dim> op(problem, body);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(op.components());  // M load
  if (!body.load.empty())
    for (const int i : op.unknowns())
      force[i] = body.load[i / Dim][i % Dim] / (op.root_inverse_mass()[i] * op.root_inverse_mass()[i]);
  require_balance(body, op, force);
  if (is_finite_strain(problem.scheme.formulation)) require_balance_of_couples(body, force);
  const Eigen::VectorXd load = op.displacement(force);  // M^½ load

  // From zero and without a preconditioner the iterates stay orthogonal, in M, to all that meets no resistance.
  using Matrix = Eigen::SparseMatrix<double>;
  Eigen::ConjugateGradient<Matrix, Eigen::Lower, Eigen::IdentityPreconditioner> solver;
  const Matrix matrix = op.matrix();
  solver.setTolerance(residual_tolerance);
  solver.setMaxIterations(most_iterations);
  solver.compute(matrix);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(op.components());
  x(op.unknowns()) = solver.solve(load(op.unknowns()).eval());
  if (solver.info() != Eigen::Success || load.dot(x) < no_resistance * op.norm_bound() * x.squaredNorm())
    throw InvalidInput(
        fmt::format("load: it drives a zero-energy mode, which nothing resists; {} iterations left a relative residual "
                    "of {:.1e}",
                    solver.iterations(), solver.error()));
  return op.displacement(x);
}

template Eigen::VectorXd static_displacement(const Problem<1>&, const Body<1>&);
template Eigen::VectorXd static_displacement(const Problem<2>&, const Body<2>&);
template Eigen::VectorXd static_displacement(const Problem<3>&, const Body<3>&);

}  // namespace sphstab::analysis
