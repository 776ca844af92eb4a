// SPDX-License-Identifier: MIT
#pragma once

#include <complex>

#include "model/body.hpp"
#include "model/problem.hpp"
#include "solver/state.hpp"

/// Bloch waves y_a = ŷ e^{ik·x_a} on a periodic patch, and what the running solver does to them. On a lattice a step
/// maps the Bloch waves of one wave vector to themselves, so a small complex matrix says it all.
namespace sphstab::solver {

/// The wave ŷ e^{ik·x}; k in radians per length. Its real and imaginary parts are the fields that a real run may carry.
/// Throws InvalidInput (`wave_vector`) unless the patch admits k: k · (n_i a_i) = 2π × an integer for its periods.
template <int Dim>
Field<Dim, std::complex<double>> bloch_wave(const Body<Dim>& body, const Vector<Dim>& wave_vector,
                                            const Vector<Dim, std::complex<double>>& amplitude);

/// ŷ = (1/N) Σ_a y_a e^{−ik·x_a}. A real field Re(ŷ e^{ik·x}) gives ŷ/2, unless 2k is a reciprocal lattice vector.
template <int Dim, class Scalar>
Vector<Dim, std::complex<double>> bloch_amplitude(const Body<Dim>& body, const Vector<Dim>& wave_vector,
                                                  const Field<Dim, Scalar>& field);

/// A matrix that maps [v̂, ŝ] (Zhang's u, v, R, S) to [v̂, ŝ]. Theory orders finite strain [ŝ, v̂].
template <int Dim>
using BlochStepMatrix = Eigen::Matrix<std::complex<double>, 2 * Dim, 2 * Dim>;

/// −M(k): the amplitude of the accelerations for a displacement ŝ e^{ik·x} of the base state at rest; 1 / time².
/// Measured on the real solver, exact to rounding also for a nonlinear scheme (solver/step_jacobian.hpp).
template <int Dim>
Tensor<Dim, std::complex<double>> bloch_acceleration_matrix(const Problem<Dim>& problem, const Body<Dim>& patch,
                                                            const Vector<Dim>& wave_vector);

/// E(k): what one step of length `time_step` does to the amplitudes [v̂, ŝ] of a small wave on the base state.
template <int Dim>
BlochStepMatrix<Dim> bloch_step_matrix(const Problem<Dim>& problem, const Body<Dim>& patch,
                                       const Vector<Dim>& wave_vector, double time_step);

extern template Field<1, std::complex<double>> bloch_wave(const Body<1>&, const Vector<1>&,
                                                          const Vector<1, std::complex<double>>&);
extern template Vector<1, std::complex<double>> bloch_amplitude(const Body<1>&, const Vector<1>&, const Field<1>&);
extern template Vector<1, std::complex<double>> bloch_amplitude(const Body<1>&, const Vector<1>&,
                                                                const Field<1, std::complex<double>>&);
extern template Tensor<1, std::complex<double>> bloch_acceleration_matrix(const Problem<1>&, const Body<1>&,
                                                                          const Vector<1>&);
extern template BlochStepMatrix<1> bloch_step_matrix(const Problem<1>&, const Body<1>&, const Vector<1>&, double);
extern template Field<2, std::complex<double>> bloch_wave(const Body<2>&, const Vector<2>&,
                                                          const Vector<2, std::complex<double>>&);
extern template Vector<2, std::complex<double>> bloch_amplitude(const Body<2>&, const Vector<2>&, const Field<2>&);
extern template Vector<2, std::complex<double>> bloch_amplitude(const Body<2>&, const Vector<2>&,
                                                                const Field<2, std::complex<double>>&);
extern template Tensor<2, std::complex<double>> bloch_acceleration_matrix(const Problem<2>&, const Body<2>&,
                                                                          const Vector<2>&);
extern template BlochStepMatrix<2> bloch_step_matrix(const Problem<2>&, const Body<2>&, const Vector<2>&, double);
extern template Field<3, std::complex<double>> bloch_wave(const Body<3>&, const Vector<3>&,
                                                          const Vector<3, std::complex<double>>&);
extern template Vector<3, std::complex<double>> bloch_amplitude(const Body<3>&, const Vector<3>&, const Field<3>&);
extern template Vector<3, std::complex<double>> bloch_amplitude(const Body<3>&, const Vector<3>&,
                                                                const Field<3, std::complex<double>>&);
extern template Tensor<3, std::complex<double>> bloch_acceleration_matrix(const Problem<3>&, const Body<3>&,
                                                                          const Vector<3>&);
extern template BlochStepMatrix<3> bloch_step_matrix(const Problem<3>&, const Body<3>&, const Vector<3>&, double);

}  // namespace sphstab::solver
