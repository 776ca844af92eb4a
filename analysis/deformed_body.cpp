// SPDX-License-Identifier: MIT
#include "analysis/deformed_body.hpp"

#include <fmt/format.h>

#include <Eigen/LU>

namespace sphstab::analysis {
namespace {

/// X ↦ X N of tensors, components in the order of TangentModuli.
template <int Dim>
TangentModuli<Dim> product_from_the_right(const Tensor<Dim>& N) {
  TangentModuli<Dim> product;
  for (int J = 0; J < Dim; ++J)
    for (int L = 0; L < Dim; ++L)
      product.template block<Dim, Dim>(Dim * J, Dim * L) = N(L, J) * Tensor<Dim>::Identity();
  return product;
}

}  // namespace

template <int Dim>
DeformedBodyOperator<Dim>::DeformedBodyOperator(const Problem<Dim>& problem, const Body<Dim>& body)
    : Base(problem, body), problem_(problem), of_gradient_(body.size()) {
  if (!is_finite_strain(problem.scheme.formulation))
    throw InvalidInput(fmt::format("scheme: the spectrum of a deformed body is for tl-corotated and tl-pk1, not {}",
                                   name_of(problem.scheme.formulation)));
  for (const Material& material : body.materials) lame_.push_back(material.lame(problem.plane));
  set_state(Eigen::VectorXd::Zero(Base::components()));
}

template <int Dim>
void DeformedBodyOperator<Dim>::set_state(const Eigen::VectorXd& displacement) {
  const Body<Dim>& body = Base::body_;
  for (int a = 0; a < body.size(); ++a) Base::displacement_[a] = Base::of_particle(displacement, a);
  for (int a = 0; a < body.size(); ++a) {
    const Tensor<Dim>& N = Base::renormalisation_[a];
    const Tensor<Dim> F = problem_.deformation_gradient + Base::displacement_gradient(a) * N;
    if (const double J = F.determinant(); !(J > 0.0))
      throw InvalidInput(fmt::format("displacement: particle {} is turned inside out, its det F is {:.3g}", a, J));
    const TangentModuli<Dim> times_N = product_from_the_right<Dim>(N);
    of_gradient_[a] = times_N * tangent_moduli<Dim>(problem_.scheme, lame_[body.material[a]], F) * times_N;
  }
}

template <int Dim>
void DeformedBodyOperator<Dim>::apply(const Eigen::VectorXd& x, Eigen::VectorXd& y) {
  Base::apply_with(
      [this](int a, const Tensor<Dim>& gradient) -> Tensor<Dim> {
        return (of_gradient_[a] * gradient.reshaped()).reshaped(Dim, Dim);
      },
      x, y);
}

template class DeformedBodyOperator<1>;
template class DeformedBodyOperator<2>;
template class DeformedBodyOperator<3>;

}  // namespace sphstab::analysis
