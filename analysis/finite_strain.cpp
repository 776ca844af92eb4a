// SPDX-License-Identifier: MIT
#include "analysis/finite_strain.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace sphstab::analysis {
namespace {

/// Roundings that the moduli and the products behind an entry of M carry.
constexpr double roundings = 32.0 * std::numeric_limits<double>::epsilon();
/// A smaller |det L|, of an L near I or of the size of its largest entry, is that of neighbours on a line or in a
/// plane.
constexpr double least_volume = 1e-9;

template <int Dim>
Tensor<Dim> inverse_of_consistency(const Tensor<Dim>& L) {
  if (!(std::abs(L.determinant()) > least_volume * std::pow(L.cwiseAbs().maxCoeff(), Dim)))
    throw InvalidInput(
        "smoothing_length: the neighbours of a particle lie on a line or in a plane, so that its gradient cannot be "
        "renormalised");
  return L.inverse();
}

template <int Dim>
Tensor<Dim> orientation_kept(const Tensor<Dim>& F) {
  if (!(F.determinant() > 0.0))
    throw InvalidInput(fmt::format("deformation_gradient: its determinant {} is not above 0", F.determinant()));
  return F;
}

template <int Dim>
TangentModuli<Dim> moduli_over_density(const Problem<Dim>& problem, const Tensor<Dim>& F) {
  return tangent_moduli<Dim>(problem.scheme, problem.material.lame(Plane::strain), F) / problem.material.density();
}

template <int Dim>
std::optional<IsotropicForm> isotropic_form_of(const Problem<Dim>& problem) {
  const Tensor<Dim> C = problem.deformation_gradient.transpose() * problem.deformation_gradient;
  const double stretch_squared = C.trace() / Dim;
  const Tensor<Dim> identity = Tensor<Dim>::Identity();
  if ((C - stretch_squared * identity).cwiseAbs().maxCoeff() > roundings * stretch_squared) return std::nullopt;
  const auto moduli = moduli_over_density<Dim>(problem, std::sqrt(stretch_squared) * identity);
  const Tensor<Dim> Q = acoustic_tensor<Dim>(moduli, Vector<Dim>::Unit(0));
  return IsotropicForm{Q(0, 0), Q(Dim - 1, Dim - 1)};
}

}  // namespace

template <int Dim>
FiniteStrain<Dim>::FiniteStrain(const Problem<Dim>& problem)
    : symbol_(problem),
      renormalisation_(inverse_of_consistency<Dim>(symbol_.consistency())),
      pulled_back_(orientation_kept<Dim>(problem.deformation_gradient).inverse().transpose()),
      moduli_(moduli_over_density<Dim>(problem, problem.deformation_gradient)),
      isotropic_form_(isotropic_form_of<Dim>(problem)) {}

template <int Dim>
Dynamics<Dim> FiniteStrain<Dim>::dynamics(const Vector<Dim>& wave_vector) const {
  const Vector<Dim> D = renormalised_symbol(wave_vector);
  const double size = D.norm(), of_D = renormalisation_.norm() * symbol_.series().rounding();
  return {acoustic_tensor<Dim>(moduli_, D), moduli_.norm() * size * (roundings * size + 2.0 * of_D)};
}

template <int Dim>
std::array<Tensor<Dim>, Dim> FiniteStrain<Dim>::derivatives(const Vector<Dim>& wave_vector) const {
  const Vector<Dim> D = renormalised_symbol(wave_vector);
  const Tensor<Dim> jacobian = renormalisation_ * symbol_.jacobian(wave_vector);
  std::array<Tensor<Dim>, Dim> result;
  for (int j = 0; j < Dim; ++j) {
    const Vector<Dim> change = jacobian.col(j);
    result[j] = contraction<Dim>(moduli_, change, D) + contraction<Dim>(moduli_, D, change);
  }
  return result;
}

template class FiniteStrain<1>;
template class FiniteStrain<2>;
template class FiniteStrain<3>;

}  // namespace sphstab::analysis
