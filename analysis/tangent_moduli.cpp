// SPDX-License-Identifier: MIT
#include "analysis/tangent_moduli.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <optional>

namespace sphstab::analysis {
namespace {

template <int Dim>
Tensor<Dim> symmetric_part(const Tensor<Dim>& X) {
  return 0.5 * (X + X.transpose());
}

/// S about F and its derivative along Green's strain.
template <int Dim>
class ElasticResponse {
 public:
  ElasticResponse(ElasticLaw law, const LameConstants& lame, const Tensor<Dim>& F) : law_(law), lame_(lame) {
    const Tensor<Dim> identity = Tensor<Dim>::Identity(), C = F.transpose() * F, E = 0.5 * (C - identity);
    const double lambda = lame.lambda, G = lame.shear_modulus;
    switch (law) {
      case ElasticLaw::saint_venant_kirchhoff:
        stress_ = lambda * E.trace() * identity + 2.0 * G * E;
        break;
      case ElasticLaw::neo_hookean:
        inverse_ = symmetric_part<Dim>(C.inverse());
        log_volume_ = std::log(F.determinant());
        // I − C⁻¹ = 2 C⁻¹ E, without its cancellation.
        stress_ = symmetric_part<Dim>(2.0 * G * inverse_ * E) + lambda * log_volume_ * inverse_;
        break;
    }
  }

  const Tensor<Dim>& stress() const { return stress_; }

  Tensor<Dim> stress_change(const Tensor<Dim>& of_strain) const {
    const double lambda = lame_.lambda, G = lame_.shear_modulus;
    if (law_ == ElasticLaw::saint_venant_kirchhoff)
      return lambda * of_strain.trace() * Tensor<Dim>::Identity() + 2.0 * G * of_strain;
    return lambda * inverse_.cwiseProduct(of_strain).sum() * inverse_ +
           2.0 * (G - lambda * log_volume_) * inverse_ * of_strain * inverse_;
  }

 private:
  ElasticLaw law_;
  LameConstants lame_;
  Tensor<Dim> stress_ = Tensor<Dim>::Zero();
  Tensor<Dim> inverse_ = Tensor<Dim>::Zero();  ///< C⁻¹, of neo-Hookean
  double log_volume_ = 0.0;
};

/// F = R U, U = V diag(u) Vᵀ.
template <int Dim>
class PolarDecomposition {
 public:
  explicit PolarDecomposition(const Tensor<Dim>& F) {
    const Eigen::JacobiSVD<Small> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
    axes_ = svd.matrixV();
    stretches_ = svd.singularValues();
    rotation_ = svd.matrixU() * axes_.transpose();
  }

  const Tensor<Dim>& rotation() const { return rotation_; }

  /// Ω of δR = R Ω: in the principal axes of U component ij is that of Rᵀ δF − δFᵀ R over u_i + u_j.
  Tensor<Dim> spin(const Tensor<Dim>& of_gradient) const {
    const Tensor<Dim> turned = axes_.transpose() * rotation_.transpose() * of_gradient * axes_;
    Tensor<Dim> in_axes = turned - turned.transpose();
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) in_axes(i, j) /= stretches_[i] + stretches_[j];
    return axes_ * in_axes * axes_.transpose();
  }

 private:
  /// Of that size, without an allocation; of a fixed size compilers take the decomposition for uninitialised.
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, Dim, Dim>;

  Tensor<Dim> axes_;
  Vector<Dim> stretches_;
  Tensor<Dim> rotation_;
};

}  // namespace

template <int Dim>
TangentModuli<Dim> tangent_moduli(const Scheme& scheme, const LameConstants& lame, const Tensor<Dim>& F) {
  const ElasticResponse<Dim> response(scheme.elastic_law, lame, F);
  std::optional<PolarDecomposition<Dim>> polar;
  if (scheme.formulation == Formulation::total_lagrangian_corotated) polar.emplace(F);
  TangentModuli<Dim> moduli;
  for (int column = 0; column < Dim * Dim; ++column) {
    Tensor<Dim> of_gradient = Tensor<Dim>::Zero();
    of_gradient(column) = 1.0;
    const Tensor<Dim> of_stress = response.stress_change(symmetric_part<Dim>(F.transpose() * of_gradient));
    Tensor<Dim> change;
    if (polar)
      change = polar->rotation() * (polar->spin(of_gradient) * response.stress() + of_stress);
    else
      change = of_gradient * response.stress() + F * of_stress;
    moduli.col(column) = change.reshaped();
  }
  return moduli;
}

template <int Dim>
Tensor<Dim> contraction(const TangentModuli<Dim>& moduli, const Vector<Dim>& m, const Vector<Dim>& n) {
  Tensor<Dim> sum = Tensor<Dim>::Zero();
  for (int J = 0; J < Dim; ++J)
    for (int L = 0; L < Dim; ++L) sum += m[J] * n[L] * moduli.template block<Dim, Dim>(Dim * J, Dim * L);
  return sum;
}

template TangentModuli<1> tangent_moduli(const Scheme&, const LameConstants&, const Tensor<1>&);
template Tensor<1> contraction<1>(const TangentModuli<1>&, const Vector<1>&, const Vector<1>&);
template TangentModuli<2> tangent_moduli(const Scheme&, const LameConstants&, const Tensor<2>&);
template Tensor<2> contraction<2>(const TangentModuli<2>&, const Vector<2>&, const Vector<2>&);
template TangentModuli<3> tangent_moduli(const Scheme&, const LameConstants&, const Tensor<3>&);
template Tensor<3> contraction<3>(const TangentModuli<3>&, const Vector<3>&, const Vector<3>&);

}  // namespace sphstab::analysis
