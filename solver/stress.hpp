// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <complex>

#include "model/material.hpp"
#include "solver/state.hpp"

namespace sphstab::solver {

/// σ = λ tr(ε) I + 2 G ε, a pressure, positive in tension: Zhang et al., Eqs. 3 and 8. Their G is 2 × `shear_modulus`
/// and their p has γ = λ of the plane before the trace over the modelled dimensions (errata.md Z10).
template <class Scalar, int Dim>
Tensor<Dim, Scalar> linear_elastic_stress(const Tensor<Dim, Scalar>& strain, const LameConstants& lame) {
  Tensor<Dim, Scalar> stress = static_cast<Real<Scalar>>(2.0 * lame.shear_modulus) * strain;
  stress.diagonal().array() += static_cast<Real<Scalar>>(lame.lambda) * strain.trace();
  return stress;
}

/// ρ/ρ0 = exp(−tr₃ε), Zhang et al., Eq. 6, with the three-dimensional trace κ tr ε also in plane stress (errata.md
/// Z10).
template <class Scalar, int Dim>
Scalar density_ratio(const Tensor<Dim, Scalar>& strain, const LameConstants& lame) {
  using std::exp;
  return exp(static_cast<Real<Scalar>>(-lame.volume_factor) * strain.trace());
}

}  // namespace sphstab::solver
