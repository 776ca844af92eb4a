// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/LU>
#include <cmath>
#include <type_traits>

#include "solver/polar.hpp"
#include "solver/stress.hpp"

/// Stresses and energies of a deformation gradient F, with E = (FᵀF − I)/2, C = FᵀF and J = det F. Two dimensions are
/// plane strain, one is uniaxial strain: the stretch out of the modelled directions is 1. Checked in
/// tests/solver/test_finite_strain_stress.cpp.
namespace sphstab::solver {

/// The stress P whose divergence is the force, and its law.
enum class StressMeasure {
  corotated,               ///< P = R S, S = λ tr(E) I + 2 G E
  saint_venant_kirchhoff,  ///< P = F S, S = λ tr(E) I + 2 G E
  neo_hookean              ///< P = F S, S = G (I − C⁻¹) + λ ln(J) C⁻¹
};

/// visit(constant) with a constant that holds the measure: what is chosen once need not be asked a particle.
template <class Visit>
auto with_measure(StressMeasure measure, const Visit& visit) {
  switch (measure) {
    case StressMeasure::corotated:
      return visit(std::integral_constant<StressMeasure, StressMeasure::corotated>());
    case StressMeasure::saint_venant_kirchhoff:
      return visit(std::integral_constant<StressMeasure, StressMeasure::saint_venant_kirchhoff>());
    case StressMeasure::neo_hookean:
      break;
  }
  return visit(std::integral_constant<StressMeasure, StressMeasure::neo_hookean>());
}

/// E, no unit.
template <class Scalar, int Dim>
Tensor<Dim, Scalar> green_strain(const Tensor<Dim, Scalar>& F) {
  return (F.transpose() * F - Tensor<Dim, Scalar>::Identity()) / Real<Scalar>(2);
}

/// P, a pressure: Tran-Duc et al., Sec. 2.3, where the trace over the modelled directions takes λ = K − 2G/3.
template <StressMeasure measure, class Scalar, int Dim>
Tensor<Dim, Scalar> first_piola_stress(const Tensor<Dim, Scalar>& F, const LameConstants& lame) {
  using std::log;
  if constexpr (measure == StressMeasure::neo_hookean) {
    const auto G = static_cast<Real<Scalar>>(lame.shear_modulus), lambda = static_cast<Real<Scalar>>(lame.lambda);
    return G * F + (lambda * log(F.determinant()) - G) * F.inverse().transpose();
  }
  const Tensor<Dim, Scalar> S = linear_elastic_stress(green_strain(F), lame);
  if constexpr (measure == StressMeasure::corotated) return rotation(F) * S;
  return F * S;
}

/// Cauchy's stress in space, P Fᵀ/J, and out of the modelled directions S_33/J = λ tr(E)/J or λ ln(J)/J; a pressure,
/// positive in tension.
template <StressMeasure measure, class Scalar, int Dim>
Tensor<3, Scalar> cauchy_stress(const Tensor<Dim, Scalar>& F, const LameConstants& lame) {
  using std::log;
  const Scalar J = F.determinant();
  const Scalar volume_strain = measure == StressMeasure::neo_hookean ? Scalar(log(J)) : green_strain(F).trace();
  Tensor<3, Scalar> stress = Tensor<3, Scalar>::Zero();
  stress.diagonal().setConstant(static_cast<Real<Scalar>>(lame.lambda) * volume_strain / J);
  stress.template topLeftCorner<Dim, Dim>() = first_piola_stress<measure>(F, lame) * F.transpose() / J;
  return stress;
}

/// W, an energy per reference volume, zero at rest: ½ λ tr²E + G E : E, and ½ G (tr C − d) − G ln J + ½ λ ln²J in d
/// dimensions. The derivative ∂W/∂F is P, but for `corotated`, which has no potential.
template <StressMeasure measure, class Scalar, int Dim>
Scalar energy_density(const Tensor<Dim, Scalar>& F, const LameConstants& lame) {
  using std::log;
  const Tensor<Dim, Scalar> E = green_strain(F);
  if constexpr (measure == StressMeasure::neo_hookean) {
    const auto G = static_cast<Real<Scalar>>(lame.shear_modulus), lambda = static_cast<Real<Scalar>>(lame.lambda);
    const Scalar log_J = log(F.determinant());
    return G * (E.trace() - log_J) + lambda / 2 * log_J * log_J;
  }
  return linear_elastic_stress(E, lame).cwiseProduct(E).sum() / Real<Scalar>(2);
}

}  // namespace sphstab::solver
