// SPDX-License-Identifier: MIT
#pragma once

#include "model/kernel.hpp"
#include "solver/state.hpp"

/// What one neighbour b adds to a particle a: Zhang, Hu, Cui & Wang, Eqs. 7 and 9. All of it is checked against sums
/// over all pairs in tests/solver/test_accelerations.cpp.
namespace sphstab::solver {

/// g_ab = V_b ∂W_ab/∂x_a = V_b W'(r) r_ab / r, with r_ab = r_a − r_b; per length. Sums over b of a normalised scheme
/// carry 1 / N_a in it.
template <int Dim>
Vector<Dim> kernel_gradient(const Kernel<Dim>& kernel, const Vector<Dim>& separation, double volume) {
  const double r = separation.norm();
  return volume * kernel.slope(r) / r * separation;
}

/// s_ba ⊗ g_ab with s_ba = s_b − s_a. Eq. 9 is the symmetric part of its sum over b, with m_b/ρ_b = V_b.
template <class Scalar, int Dim>
Tensor<Dim, Scalar> displacement_gradient_term(const Vector<Dim, Scalar>& s_a, const Vector<Dim, Scalar>& s_b,
                                               const Vector<Dim, Real<Scalar>>& g_ab) {
  return (s_b - s_a) * g_ab.transpose();
}

/// (P_a + P_b) · g_ab with P = (ρ0/ρ)² σ and σ = pδ + Gε, positive in tension; the sum over b is the force per volume.
/// In one material it is ρ0 times the summand of Eq. 7, with m_b = ρ0 V_b. Where densities differ, Eq. 7 as printed,
/// m_b (σ_a/ρ_a² + σ_b/ρ_b²), is not the adjoint of Eq. 9 and keeps no energy; this sum is and does.
template <class Scalar, int Dim>
Vector<Dim, Scalar> momentum_term(const Tensor<Dim, Scalar>& P_a, const Tensor<Dim, Scalar>& P_b,
                                  const Vector<Dim, Real<Scalar>>& g_ab) {
  return (P_a + P_b) * g_ab;
}

}  // namespace sphstab::solver
