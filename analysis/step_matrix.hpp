// SPDX-License-Identifier: MIT
#pragma once

#include "analysis/updated_lagrangian.hpp"
#include "model/integrator.hpp"

namespace sphstab::analysis {

/// The motion dr/dt = κ v, dv/dt = R r + V v + Q q, dq/dt = W v with `Size` components of q.
template <int Dim, int Size, class Scalar>
struct LinearMotion {
  Scalar smoothing;                             ///< κ
  Tensor<Dim, Scalar> of_position;              ///< R
  Tensor<Dim, Scalar> of_velocity;              ///< V
  Eigen::Matrix<Scalar, Dim, Size> of_state;    ///< Q
  Eigen::Matrix<Scalar, Size, Dim> state_rate;  ///< W
  double position_unit = 1.0;                   ///< u, where positions are stored as u r and κ stands for u κ
};

/// E, whose size depends on the integrator.
template <int Dim, int Size, class Scalar>
using StepMatrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, 0, 3 * Dim + 2 * Size, 3 * Dim + 2 * Size>;

/// E of one step of the integrator, in the order (r, v, q) and, for `predictor-corrector-pec`, the stored rates of v
/// and of q. The steps are those of Integrator. Tested in tests/analysis/test_updated_lagrangian.cpp.
template <int Dim, int Size, class Scalar>
StepMatrix<Dim, Size, Scalar> step_matrix(const LinearMotion<Dim, Size, Scalar>& motion, Integrator integrator,
                                          double time_step);

/// The whole state of `ul`: q = (ρ, S).
template <int Dim>
LinearMotion<Dim, UpdatedWave<Dim>::rates, std::complex<double>> full_motion(const UpdatedWave<Dim>& wave);

/// The same with g = i G q, the force of density and stress, in place of q: dg/dt = −(stress part of M) v. Its E is
/// real and has every eigenvalue of the full one but those of q that make no force, all 1 (and, of stored rates, 0).
/// Positions and forces are in units of the frequency of the mode, so that nothing in E is badly scaled.
template <int Dim>
LinearMotion<Dim, Dim, double> reduced_motion(const UpdatedWave<Dim>& wave);

}  // namespace sphstab::analysis
