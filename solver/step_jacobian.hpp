// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <complex>

#include "solver/total_lagrangian.hpp"

/// Derivatives of the running solver at its base state (s = 0, v = 0) by complex step: Im F(iε d)/ε has no cancellation
/// and an error of order ε², so they are exact to rounding. The imaginary unit carries the derivative and nothing else.
/// Checked against differences of real steps in tests/solver/test_step_jacobian.cpp.
namespace sphstab::solver {

/// A simulation of any total-Lagrangian scheme (make_simulation) whose scalars carry a derivative in their imaginary
/// part.
template <int Dim>
using DerivativeSimulation = TotalLagrangian<Dim, std::complex<double>>;

/// Derivative of one step of length `time_step` along a real direction (δv, δs).
template <int Dim>
State<Dim> step_derivative(DerivativeSimulation<Dim>& simulation, const State<Dim>& direction, double time_step);

/// Derivative of the accelerations along a real displacement δs, at velocity 0; 1 / time².
template <int Dim>
Field<Dim> acceleration_derivative(DerivativeSimulation<Dim>& simulation, const Field<Dim>& direction);

/// The Jacobian of one step, 2 Dim N × 2 Dim N. Row and column 2 Dim a + i hold v_i of particle a, 2 Dim a + Dim + i
/// its s_i, for every scheme; theory orders finite strain [s, v], and whoever compares reorders. Dense,
/// one step a column: for small patches.
template <int Dim>
Eigen::MatrixXd step_jacobian(const Problem<Dim>& problem, const Body<Dim>& body, double time_step);

extern template State<1> step_derivative(DerivativeSimulation<1>&, const State<1>&, double);
extern template Field<1> acceleration_derivative(DerivativeSimulation<1>&, const Field<1>&);
extern template Eigen::MatrixXd step_jacobian(const Problem<1>&, const Body<1>&, double);
extern template State<2> step_derivative(DerivativeSimulation<2>&, const State<2>&, double);
extern template Field<2> acceleration_derivative(DerivativeSimulation<2>&, const Field<2>&);
extern template Eigen::MatrixXd step_jacobian(const Problem<2>&, const Body<2>&, double);
extern template State<3> step_derivative(DerivativeSimulation<3>&, const State<3>&, double);
extern template Field<3> acceleration_derivative(DerivativeSimulation<3>&, const Field<3>&);
extern template Eigen::MatrixXd step_jacobian(const Problem<3>&, const Body<3>&, double);

}  // namespace sphstab::solver
