// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "solver/dual.hpp"
#include "solver/state.hpp"

/// What one particle knows of its stress in `ul`: Gray, Monaghan & Swift, Eqs. 2.2-2.7, 5.31 and 6.1-6.7. All of it is
/// checked in tests/solver/test_updated_stress.cpp.
namespace sphstab::solver {

/// P = c0² (ρ − ρ0), positive in compression (2.7).
template <class Scalar>
Scalar pressure(const Scalar& density, const Scalar& reference_density, const Scalar& sound_speed_squared) {
  return sound_speed_squared * (density - reference_density);
}

/// σ = −P I + S, positive in tension (2.2).
template <class Scalar, int Dim>
Tensor<Dim, Scalar> total_stress(const Scalar& pressure, const Tensor<Dim, Scalar>& deviatoric_stress) {
  Tensor<Dim, Scalar> stress = deviatoric_stress;
  stress.diagonal().array() -= pressure;
  return stress;
}

/// S in space: traceless, and alike in the directions that are not modelled (plane strain, uniaxial strain).
template <class Scalar, int Dim>
Tensor<3, Scalar> deviatoric_stress_in_space(const Tensor<Dim, Scalar>& S) {
  Tensor<3, Scalar> in_space = Tensor<3, Scalar>::Zero();
  if constexpr (Dim < 3) in_space.diagonal().setConstant(-S.trace() / Scalar(3 - Dim));
  in_space.template topLeftCorner<Dim, Dim>() = S;
  return in_space;
}

/// dS/dt = 2μ (ε̇ − ⅓ tr(ε̇) I) + S Ωᵀ + Ω S with the rate of strain ε̇ and the spin Ω, the symmetric and the
/// antisymmetric part of L_ij = ∂v_i/∂x_j (2.3-2.5); ⅓ in all dimensions, whose missing strains are zero.
template <class Scalar, int Dim>
Tensor<Dim, Scalar> jaumann_rate(const Tensor<Dim, Scalar>& velocity_gradient, const Tensor<Dim, Scalar>& S,
                                 const Scalar& shear_modulus) {
  const Tensor<Dim, Scalar> twice_strain_rate = velocity_gradient + velocity_gradient.transpose();
  const Tensor<Dim, Scalar> spin = (velocity_gradient - velocity_gradient.transpose()) / Scalar(2);
  const Tensor<Dim, Scalar> turned = spin * S;
  Tensor<Dim, Scalar> rate = shear_modulus * twice_strain_rate + (turned + turned.transpose());
  rate.diagonal().array() -= shear_modulus * twice_strain_rate.trace() / Scalar(3);
  return rate;
}

/// The tensor with the principal axes of σ and its positive principal values, zero in the place of the others.
template <class Scalar>
Tensor<1, Scalar> positive_part(const Tensor<1, Scalar>& sigma) {
  return sigma[0] > Scalar(0) ? sigma : Tensor<1, Scalar>::Zero();
}

/// In two dimensions with c², s² and sc of (6.1) from cos 2θ = (σxx − σyy)/D and sin 2θ = 2σxy/D, where D is the
/// difference of the principal stresses. Axes are needed only where one of them is positive and the other is not, so
/// equal ones never divide by zero.
template <class Scalar>
Tensor<2, Scalar> positive_part(const Tensor<2, Scalar>& sigma) {
  using std::sqrt;
  const Scalar half_trace = (sigma(0, 0) + sigma(1, 1)) / Scalar(2);
  const Scalar half_difference = (sigma(0, 0) - sigma(1, 1)) / Scalar(2);
  const Scalar radius_squared = half_difference * half_difference + sigma(0, 1) * sigma(0, 1);
  if (!(half_trace * half_trace < radius_squared))  // both of one sign
    return half_trace > Scalar(0) ? sigma : Tensor<2, Scalar>::Zero();
  const Scalar radius = sqrt(radius_squared);
  const Scalar half_largest = (half_trace + radius) / Scalar(2);
  const Scalar cos_2theta = half_difference / radius, sin_2theta = sigma(0, 1) / radius;
  Tensor<2, Scalar> part;
  part << half_largest * (Scalar(1) + cos_2theta), half_largest * sin_2theta, half_largest * sin_2theta,
      half_largest * (Scalar(1) - cos_2theta);
  return part;
}

template <class Scalar>
Tensor<3, Scalar> positive_part(const Tensor<3, Scalar>& sigma) {
  const Eigen::SelfAdjointEigenSolver<Tensor<3, Scalar>> axes(sigma);
  const auto& V = axes.eigenvectors();
  return V * axes.eigenvalues().cwiseMax(Scalar(0)).asDiagonal() * V.transpose();
}

/// With derivatives: V (Q ∘ Vᵀ dσ V) Vᵀ, Q_ij = (λ_i⁺ − λ_j⁺)/(λ_i − λ_j), 1 or 0 where both have one sign.
inline Tensor<3, Dual> positive_part(const Tensor<3, Dual>& sigma) {
  const Tensor<3> value = sigma.unaryExpr([](const Dual& x) { return x.value; });
  const Tensor<3> change = sigma.unaryExpr([](const Dual& x) { return x.derivative; });
  const Eigen::SelfAdjointEigenSolver<Tensor<3>> axes(value);
  const Tensor<3>& V = axes.eigenvectors();
  const Vector<3>& lambda = axes.eigenvalues();
  Tensor<3> turned = V.transpose() * change * V;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      if (lambda[i] > 0.0 && lambda[j] > 0.0) continue;
      const double positive = std::max(lambda[i], 0.0) - std::max(lambda[j], 0.0);
      turned(i, j) *= positive == 0.0 ? 0.0 : positive / (lambda[i] - lambda[j]);
    }
  const Tensor<3> part = V * lambda.cwiseMax(0.0).asDiagonal() * V.transpose();
  const Tensor<3> part_change = V * turned * V.transpose();
  return part.binaryExpr(part_change, [](double x, double dx) { return Dual(x, dx); });
}

/// R: −ε σ_i/ρ² along each principal axis with a positive principal stress σ_i, zero along the others (5.31, 6.4-6.7;
/// (6.3) needs a minus sign before 2sc, errata.md G10). At a principal stress of exactly 0, R and its derivative are 0.
template <class Scalar, int Dim>
Tensor<Dim, Scalar> artificial_stress(const Tensor<Dim, Scalar>& sigma, const Scalar& density, const Scalar& epsilon) {
  return -epsilon / (density * density) * positive_part(sigma);
}

}  // namespace sphstab::solver
