// SPDX-License-Identifier: MIT
#pragma once

#include "solver/bloch.hpp"
#include "solver/updated_simulation.hpp"

/// Derivatives of the running solver `ul` by dual numbers, exact to rounding, and what it does to the Bloch waves of
/// its base state. States are flat vectors (solver/updated_state.hpp). Checked in tests/solver/test_updated_bloch.cpp.
namespace sphstab::solver {

/// The derivative of one step at `state` along `direction`. The simulation is one of duals; of the state only the
/// values count. Stored rates of predictor-corrector-pec belong to the state. Throws InvalidInput (`time_step`) where
/// the step leaves the finite numbers.
template <int Dim>
Eigen::VectorXd step_derivative(UpdatedSimulation<Dim, Dual>& simulation, const UpdatedState<Dim, Dual>& state,
                                const Eigen::VectorXd& direction, double time_step);

/// The Jacobian of one step about the base state in a box of these cells, of the whole flat state. Dense, one step a
/// column: for small boxes.
template <int Dim>
Eigen::MatrixXd step_jacobian(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells, double time_step);

/// E(k): what one step of length `time_step` does to the amplitudes of a small wave e^{ik·x} on the base state in a box
/// of these cells, in the order of a flat state: [x, y, vx, vy, ρ, Sxx, Syy, Sxy], with predictor-corrector-pec [Fx,
/// Fy, dρ, dSxx, dSyy, dSxy] after them. Throws InvalidInput (`wave_vector`) unless the box admits k.
template <int Dim>
Eigen::MatrixXcd bloch_step_matrix(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells,
                                   const Vector<Dim>& wave_vector, double time_step);

/// L(k): the rates [v̂, F, dρ, dS] that the amplitudes [r, v, ρ, S] of such a wave bring about.
template <int Dim>
Eigen::MatrixXcd bloch_rate_matrix(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells,
                                   const Vector<Dim>& wave_vector);

extern template Eigen::VectorXd step_derivative(UpdatedSimulation<1, Dual>&, const UpdatedState<1, Dual>&,
                                                const Eigen::VectorXd&, double);
extern template Eigen::MatrixXd step_jacobian(const Problem<1>&, const LatticeIndex<1>&, double);
extern template Eigen::MatrixXcd bloch_step_matrix(const Problem<1>&, const LatticeIndex<1>&, const Vector<1>&, double);
extern template Eigen::MatrixXcd bloch_rate_matrix(const Problem<1>&, const LatticeIndex<1>&, const Vector<1>&);
extern template Eigen::VectorXd step_derivative(UpdatedSimulation<2, Dual>&, const UpdatedState<2, Dual>&,
                                                const Eigen::VectorXd&, double);
extern template Eigen::MatrixXd step_jacobian(const Problem<2>&, const LatticeIndex<2>&, double);
extern template Eigen::MatrixXcd bloch_step_matrix(const Problem<2>&, const LatticeIndex<2>&, const Vector<2>&, double);
extern template Eigen::MatrixXcd bloch_rate_matrix(const Problem<2>&, const LatticeIndex<2>&, const Vector<2>&);
extern template Eigen::VectorXd step_derivative(UpdatedSimulation<3, Dual>&, const UpdatedState<3, Dual>&,
                                                const Eigen::VectorXd&, double);
extern template Eigen::MatrixXd step_jacobian(const Problem<3>&, const LatticeIndex<3>&, double);
extern template Eigen::MatrixXcd bloch_step_matrix(const Problem<3>&, const LatticeIndex<3>&, const Vector<3>&, double);
extern template Eigen::MatrixXcd bloch_rate_matrix(const Problem<3>&, const LatticeIndex<3>&, const Vector<3>&);

}  // namespace sphstab::solver
