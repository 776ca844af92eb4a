// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <complex>

#include "model/material.hpp"
#include "solver/state.hpp"

namespace sphstab::solver {

/// sym A.
template <class Scalar, int Dim>
Tensor<Dim, Scalar> symmetric_part(const Tensor<Dim, Scalar>& A) {
  return (A + A.transpose()) / Real<Scalar>(2);
}

/// σ = λ tr(ε) I + 2 G ε, a pressure, positive in tension: Zhang et al., Eqs. 3 and 8. Their G is 2 × `shear_modulus`
/// and their p has γ = λ of the plane before the trace over the modelled dimensions (errata.md Z10).
template <class Scalar, int Dim>
Tensor<Dim, Scalar> linear_elastic_stress(const Tensor<Dim, Scalar>& strain, const LameConstants& lame) {
  Tensor<Dim, Scalar> stress = static_cast<Real<Scalar>>(2.0 * lame.shear_modulus) * strain;
  stress.diagonal().array() += static_cast<Real<Scalar>>(lame.lambda) * strain.trace();
  return stress;
}

/// The same stress in space. Where there is no strain out of the modelled dimensions (plane strain; uniaxial strain in
/// one dimension) there is the stress λ tr ε, positive in tension; in plane stress there is none.
template <class Scalar, int Dim>
Tensor<3, Scalar> stress_in_space(const Tensor<Dim, Scalar>& strain, const LameConstants& lame, Plane plane) {
  Tensor<3, Scalar> stress = Tensor<3, Scalar>::Zero();
  if (plane == Plane::strain) stress.diagonal().setConstant(static_cast<Real<Scalar>>(lame.lambda) * strain.trace());
  stress.template topLeftCorner<Dim, Dim>() = linear_elastic_stress(strain, lame);
  return stress;
}

/// √(3/2 s : s) with the deviator s = σ − ⅓ tr(σ) I, a pressure: what Zhang et al. draw. Keeps its digits under a large
/// pressure. Checked in tests/solver/test_stress.cpp.
template <class Scalar>
Scalar von_mises_stress(const Tensor<3, Scalar>& stress) {
  using std::sqrt;
  Tensor<3, Scalar> deviator = stress;
  deviator.diagonal().array() -= stress.trace() / Real<Scalar>(3);
  return sqrt(Real<Scalar>(1.5) * deviator.cwiseProduct(deviator).sum());
}

/// ρ/ρ0 = exp(−tr₃ε), Zhang et al., Eq. 6, with the three-dimensional trace κ tr ε also in plane stress (errata.md
/// Z10).
template <class Scalar, int Dim>
Scalar density_ratio(const Tensor<Dim, Scalar>& strain, const LameConstants& lame) {
  using std::exp;
  return exp(static_cast<Real<Scalar>>(-lame.volume_factor) * strain.trace());
}

}  // namespace sphstab::solver
