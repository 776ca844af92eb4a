// SPDX-License-Identifier: MIT
#pragma once

#include "model/material.hpp"
#include "model/scheme.hpp"
#include "model/tensor.hpp"

namespace sphstab::analysis {

/// A of δP = A : δF, a pressure: component (i,J) of a tensor is at place i + Dim·J, as Eigen stores it, so that
/// A(i + Dim·J, k + Dim·L) = ∂P_iJ/∂F_kL.
template <int Dim>
using TangentModuli = Eigen::Matrix<double, Dim * Dim, Dim * Dim>;

/// A of the force of a finite strain scheme about F, det F > 0: P = R S of `tl-corotated`, R the polar factor of
/// F = R U, and P = F S of `tl-pk1` (theory.md §5, errata.md T5), with S of ElasticLaw:
///   δ(F S) = δF S + F δS,   δ(R S) = R (Ω S + δS),   Ω U + U Ω = Rᵀ δF − δFᵀ R,   δE = sym(Fᵀ δF),
///   δS = λ tr(δE) I + 2G δE   or   λ (C⁻¹ : δE) C⁻¹ + 2 (G − λ ln J) C⁻¹ δE C⁻¹.
/// Symmetric for `tl-pk1`, which has an energy; for `tl-corotated` only at a rotation times a multiple of I. Tested in
/// tests/analysis/test_finite_strain.cpp.
template <int Dim>
TangentModuli<Dim> tangent_moduli(const Scheme& scheme, const LameConstants& lame, const Tensor<Dim>& F);

/// A_iJkL m_J n_L.
template <int Dim>
Tensor<Dim> contraction(const TangentModuli<Dim>& moduli, const Vector<Dim>& m, const Vector<Dim>& n);

/// Q_ik = A_iJkL n_J n_L. Its eigenvalues are real: A of `tl-pk1` is symmetric, and with R S
///   Rᵀ Q R = G (n·Un) I + (I + λ/G n nᵀ)(G U + T),   T = Tᵀ, T n = 0,
/// a positive definite matrix times a symmetric one beside a multiple of I.
template <int Dim>
Tensor<Dim> acoustic_tensor(const TangentModuli<Dim>& moduli, const Vector<Dim>& n) {
  return contraction<Dim>(moduli, n, n);
}

extern template TangentModuli<1> tangent_moduli(const Scheme&, const LameConstants&, const Tensor<1>&);
extern template Tensor<1> contraction<1>(const TangentModuli<1>&, const Vector<1>&, const Vector<1>&);
extern template TangentModuli<2> tangent_moduli(const Scheme&, const LameConstants&, const Tensor<2>&);
extern template Tensor<2> contraction<2>(const TangentModuli<2>&, const Vector<2>&, const Vector<2>&);
extern template TangentModuli<3> tangent_moduli(const Scheme&, const LameConstants&, const Tensor<3>&);
extern template Tensor<3> contraction<3>(const TangentModuli<3>&, const Vector<3>&, const Vector<3>&);

}  // namespace sphstab::analysis
