// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

#include "analysis/dynamics.hpp"
#include "analysis/gradient_symbol.hpp"
#include "analysis/tangent_moduli.hpp"
#include "model/problem.hpp"

namespace sphstab::analysis {

/// ω² of a state without preferred direction: longitudinal |D~|² and Dim − 1 times transverse |D~|²; length² / time².
struct IsotropicForm {
  double longitudinal;
  double transverse;
};

/// The finite strain schemes (`tl-corotated`, `tl-pk1`) linearised about x = F0 X for one wave e^{ik·X} on the
/// reference lattice (theory.md §5): N = L⁻¹ renormalises the gradient, so that δF = i x D~ᵀ with D~ = N D, and
///   M(k) = Q(D~)/ρ0,  Q_ik(n) = A_iJkL n_J n_L with the tangent moduli A of F0.
/// M is homogeneous in D~: whether ω² < 0 depends on F0 and the direction of D~ alone, and every growth is a loss of
/// ellipticity. ω² is real. A rotation before F0 rotates M alike. Tested in tests/analysis/test_finite_strain.cpp.
template <int Dim>
class FiniteStrain {
 public:
  /// Throws InvalidInput: `smoothing_length` where the neighbours do not span the space, so that L has no inverse;
  /// `deformation_gradient` unless det F0 > 0.
  explicit FiniteStrain(const Problem<Dim>& problem);

  /// D, before renormalisation, and N.
  const GradientSymbol<Dim>& symbol() const { return symbol_; }
  const Tensor<Dim>& renormalisation() const { return renormalisation_; }
  /// D~(k), or exactly zero where D vanishes to rounding; 1 / length.
  Vector<Dim> renormalised_symbol(const Vector<Dim>& wave_vector) const {
    return renormalisation_ * symbol_.cleaned(wave_vector);
  }

  /// A/ρ0, length² / time².
  const TangentModuli<Dim>& moduli() const { return moduli_; }
  Dynamics<Dim> dynamics(const Vector<Dim>& wave_vector) const;
  /// ∂M/∂k_j.
  std::array<Tensor<Dim>, Dim> derivatives(const Vector<Dim>& wave_vector) const;

  /// F0⁻ᵀ k: the normal of the fronts in the present frame, in which polarisations are.
  Vector<Dim> present_wave_vector(const Vector<Dim>& wave_vector) const { return pulled_back_ * wave_vector; }

  /// Of an F0 that is a rotation times a multiple of I.
  const std::optional<IsotropicForm>& isotropic_form() const { return isotropic_form_; }

 private:
  GradientSymbol<Dim> symbol_;
  Tensor<Dim> renormalisation_;
  Tensor<Dim> pulled_back_;  ///< F0⁻ᵀ
  TangentModuli<Dim> moduli_;
  std::optional<IsotropicForm> isotropic_form_;
};

extern template class FiniteStrain<1>;
extern template class FiniteStrain<2>;
extern template class FiniteStrain<3>;

}  // namespace sphstab::analysis
