// SPDX-License-Identifier: MIT
#pragma once

#include "solver/state.hpp"

/// What a pair of particles adds in `ul`: Gray, Monaghan & Swift, Eqs. 3.1-3.14, with r_ab = r_a − r_b, v_ab = v_a −
/// v_b and g_ab = ∇_a W_ab = r_ab F_ab, F_ab = W'(r)/r. All of it is checked against values worked out by hand in
/// tests/solver/test_updated_pair_terms.cpp.
namespace sphstab::solver {

/// Π_ab = α h c0 v_ab · r_ab / (ρ̄_ab (r² + (ηh)²)) with ρ̄_ab = (ρ_a + ρ_b)/2. It stands beside σ/ρ², which is positive
/// in tension, and so is negative on approach (errata.md G13).
template <class Scalar, int Dim>
Scalar viscous_pair_term(const Vector<Dim, Scalar>& v_ab, const Vector<Dim, Scalar>& r_ab, const Scalar& density_a,
                         const Scalar& density_b, const Scalar& alpha_h_c0, const Scalar& eta_h_squared) {
  return Scalar(2) * alpha_h_c0 * v_ab.dot(r_ab) / ((density_a + density_b) * (r_ab.squaredNorm() + eta_h_squared));
}

/// (σ_a/ρ_a² + σ_b/ρ_b²) · g_ab: m_b times it is added to dv_a/dt, m_a times it taken from dv_b/dt (3.1).
template <class Scalar, int Dim>
Vector<Dim, Scalar> stress_pair_term(const Tensor<Dim, Scalar>& sigma_over_rho2_a,
                                     const Tensor<Dim, Scalar>& sigma_over_rho2_b, const Vector<Dim, Scalar>& g_ab) {
  return (sigma_over_rho2_a + sigma_over_rho2_b) * g_ab;
}

/// (R_a + R_b) φ · g_ab, beside the term above (3.12, 3.14), φ = fⁿ.
template <class Scalar, int Dim>
Vector<Dim, Scalar> artificial_pair_term(const Tensor<Dim, Scalar>& R_a, const Tensor<Dim, Scalar>& R_b,
                                         const Scalar& phi, const Vector<Dim, Scalar>& g_ab) {
  return phi * ((R_a + R_b) * g_ab);
}

/// (v_b − v_a) W_ab/ρ̄_ab: ε̃ m_b times it is added to v̂_a, ε̃ m_a times it taken from v̂_b (3.6).
template <class Scalar, int Dim>
Vector<Dim, Scalar> smoothing_pair_term(const Vector<Dim, Scalar>& v_ab, const Scalar& density_a,
                                        const Scalar& density_b, const Scalar& W_ab) {
  return -(Scalar(2) * W_ab / (density_a + density_b)) * v_ab;
}

/// v̂_ba ⊗ g_ab: m_b/ρ_b times it is added to ∂v̂_i/∂x_j of a, m_a/ρ_a times it to that of b (3.10); −m_b and −m_a
/// times its trace to dρ/dt of a and of b (3.8).
template <class Scalar, int Dim>
Tensor<Dim, Scalar> velocity_gradient_pair_term(const Vector<Dim, Scalar>& smoothed_v_ab,
                                                const Vector<Dim, Scalar>& g_ab) {
  return -smoothed_v_ab * g_ab.transpose();
}

}  // namespace sphstab::solver
