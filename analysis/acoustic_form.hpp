// SPDX-License-Identifier: MIT
#pragma once

#include "model/problem.hpp"

namespace sphstab::analysis {

/// M of d²s/dt² = −M s as a function of the gradient symbol D alone, in the two blocks of theory.md §2 (G the textbook
/// shear modulus, Zhang's is 2G):
///   M = shear |D|² I + (coupling D) Dᵀ
///   shear = f G,  coupling = f [(γ + G) I + 2κ σ0],  f = ρ0/ρ̄², ρ̄ = ρ0 exp(−κ tr e0), σ0 = 2G e0 + γ tr(e0) I,
/// e0 = sym(H L) the strain that SPH sees in the base state; with `frozen` density f = 1/ρ0 and σ0 does not enter. Its
/// eigenvalues, both real: ω_T² = shear |D|² on the directions normal to D, and ω_L² = D · (shear I + coupling) D.
/// Units: length² / time². Tested in tests/analysis/test_linearisation.cpp.
template <int Dim>
struct AcousticForm {
  double shear;
  Tensor<Dim> coupling;

  /// `consistency` is L of the gradient symbol.
  AcousticForm(const Problem<Dim>& problem, const Tensor<Dim>& consistency);

  Tensor<Dim> dynamical_matrix(const Vector<Dim>& D) const {
    return shear * D.squaredNorm() * Tensor<Dim>::Identity() + (coupling * D) * D.transpose();
  }
  /// Q of ω_L² = D · Q D.
  Tensor<Dim> longitudinal() const { return shear * Tensor<Dim>::Identity() + coupling; }
  double longitudinal(const Vector<Dim>& D) const { return D.dot(longitudinal() * D); }
  double transverse(const Vector<Dim>& D) const { return shear * D.squaredNorm(); }
};

extern template struct AcousticForm<1>;
extern template struct AcousticForm<2>;
extern template struct AcousticForm<3>;

}  // namespace sphstab::analysis
