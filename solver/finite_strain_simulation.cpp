// SPDX-License-Identifier: MIT
#include "solver/finite_strain_simulation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>

#include "solver/pair_terms.hpp"

namespace sphstab::solver {
namespace {

/// N is not made where it would lose this many digits: neighbours as far out of a line or a plane as 1e-5 of their
/// distance are a line or a plane.
constexpr double smallest_condition = 1e-10;

StressMeasure stress_measure(const Scheme& scheme) {
  const bool neo_hookean = scheme.elastic_law == ElasticLaw::neo_hookean;
  switch (scheme.formulation) {
    case Formulation::total_lagrangian_corotated:
      if (neo_hookean) throw InvalidInput("elastic_law: tl-corotated runs saint-venant-kirchhoff, not neo-hookean");
      return StressMeasure::corotated;
    case Formulation::total_lagrangian_pk1:
      return neo_hookean ? StressMeasure::neo_hookean : StressMeasure::saint_venant_kirchhoff;
    case Formulation::total_lagrangian_linear:
    case Formulation::updated_lagrangian:
      break;
  }
  throw InvalidInput(
      fmt::format("scheme: this solver runs tl-corotated and tl-pk1, not {}", name_of(scheme.formulation)));
}

/// N_a, the inverse of Σ_b V_b (X_b − X_a) ⊗ ∇_a W_ab, which is symmetric and not negative, since W' ≤ 0.
template <int Dim>
Tensor<Dim> corrected_gradients(const Tensor<Dim>& sum, int a, const Vector<Dim>& position) {
  const Vector<Dim> eigenvalues = Eigen::SelfAdjointEigenSolver<Tensor<Dim>>(sum, Eigen::EigenvaluesOnly).eigenvalues();
  const double largest = eigenvalues[Dim - 1];
  if (!(eigenvalues[0] > smallest_condition * largest))
    throw InvalidInput(fmt::format("body: particle {} at [{}] has {}: its gradients cannot be corrected", a,
                                   fmt::join(position.data(), position.data() + Dim, ", "),
                                   !(largest > 0.0) ? "no neighbours"
                                   : Dim == 2       ? "its neighbours in a line"
                                                    : "its neighbours in a plane"));
  return sum.inverse();
}

}  // namespace

template <int Dim, class Scalar>
FiniteStrainSimulation<Dim, Scalar>::FiniteStrainSimulation(const Problem<Dim>& problem, const Body<Dim>& body)
    : Base(problem, body),
      measure_(stress_measure(problem.scheme)),
      base_gradient_(problem.deformation_gradient.template cast<Real<Scalar>>()),
      volume_(body.volume),
      corrected_stress_(body.size()) {
  if (problem.plane != Plane::strain) throw InvalidInput("plane: finite strain is plane strain, not stress");
  correction_.reserve(body.size());
  for (int a = 0; a < body.size(); ++a) {
    Tensor<Dim> sum = Tensor<Dim>::Zero();
    for (int pair = first_[a]; pair < first_[a + 1]; ++pair) {
      const Vector<Dim>& r_ab = body.pairs.separation[pair];
      const Vector<Dim> g_ab = kernel_gradient(problem.kernel, r_ab, body.volume[neighbour_[pair]]);
      sum -= r_ab * g_ab.transpose();
      g_.push_back(g_ab.template cast<Real<Scalar>>());
    }
    correction_.push_back(corrected_gradients<Dim>(sum, a, body.position[a]).template cast<Real<Scalar>>());
  }
}

template <int Dim, class Scalar>
double FiniteStrainSimulation<Dim, Scalar>::inertia(int a) const {
  return volume_[a] / substance(a).inverse_density;
}

template <int Dim, class Scalar>
Tensor<Dim, Scalar> FiniteStrainSimulation<Dim, Scalar>::perturbation_gradient(const Field<Dim, Scalar>& displacement,
                                                                               int a) const {
  Tensor<Dim, Scalar> gradient = Tensor<Dim, Scalar>::Zero();
  for (int pair = first_[a]; pair < first_[a + 1]; ++pair)
    gradient += displacement_gradient_term(displacement[a], displacement[neighbour_[pair]], g_[pair]);
  return gradient * correction_[a];
}

template <int Dim, class Scalar>
template <StressMeasure measure>
void FiniteStrainSimulation<Dim, Scalar>::store_stresses(const Field<Dim, Scalar>& displacement) {
  for (int a = 0; a < this->particles(); ++a) {
    const Tensor<Dim, Scalar> F = base_gradient_ + perturbation_gradient(displacement, a);
    corrected_stress_[a] = first_piola_stress<measure>(F, substance(a).lame) * correction_[a];
  }
}

template <int Dim, class Scalar>
void FiniteStrainSimulation<Dim, Scalar>::internal_accelerations(const Field<Dim, Scalar>& displacement,
                                                                 Field<Dim, Scalar>& acceleration) {
  with_measure(measure_, [&](auto measure) { store_stresses<measure>(displacement); });
  for (int a = 0; a < this->particles(); ++a) {
    Vector<Dim, Scalar> sum = Vector<Dim, Scalar>::Zero();
    for (int pair = first_[a]; pair < first_[a + 1]; ++pair)
      sum += momentum_term(corrected_stress_[a], corrected_stress_[neighbour_[pair]], g_[pair]);
    acceleration[a] = static_cast<Real<Scalar>>(substance(a).inverse_density) * sum;
  }
}

template <int Dim, class Scalar>
Tensor<Dim, Scalar> FiniteStrainSimulation<Dim, Scalar>::deformation_gradient(const State<Dim, Scalar>& state,
                                                                              int a) const {
  return base_gradient_ + perturbation_gradient(state.displacement, a);
}

template <int Dim, class Scalar>
Tensor<3, Scalar> FiniteStrainSimulation<Dim, Scalar>::stress_in_space(const State<Dim, Scalar>& state, int a) const {
  const Tensor<Dim, Scalar> F = deformation_gradient(state, a);
  return with_measure(measure_, [&](auto measure) { return cauchy_stress<measure>(F, substance(a).lame); });
}

template <int Dim, class Scalar>
Tensor<Dim, Scalar> FiniteStrainSimulation<Dim, Scalar>::stress(const State<Dim, Scalar>& state, int a) const {
  return stress_in_space(state, a).template topLeftCorner<Dim, Dim>();
}

template <int Dim, class Scalar>
Scalar FiniteStrainSimulation<Dim, Scalar>::von_mises_stress(const State<Dim, Scalar>& state, int a) const {
  return solver::von_mises_stress(stress_in_space(state, a));
}

template <int Dim, class Scalar>
Scalar FiniteStrainSimulation<Dim, Scalar>::strain_energy(const State<Dim, Scalar>& state) const {
  Scalar energy(0);
  for (int a = 0; a < this->particles(); ++a) {
    const Tensor<Dim, Scalar> F = deformation_gradient(state, a);
    energy += static_cast<Real<Scalar>>(volume_[a]) *
              with_measure(measure_, [&](auto measure) { return energy_density<measure>(F, substance(a).lame); });
  }
  return energy;
}

template <int Dim, class Scalar>
Scalar FiniteStrainSimulation<Dim, Scalar>::perturbation_energy(const State<Dim, Scalar>& state) const {
  Scalar twice_energy(0);
  for (int a = 0; a < this->particles(); ++a) {
    const Tensor<Dim, Scalar> e =
        symmetric_part<Scalar, Dim>(base_gradient_.transpose() * perturbation_gradient(state.displacement, a));
    twice_energy +=
        static_cast<Real<Scalar>>(volume_[a]) * linear_elastic_stress(e, substance(a).lame).cwiseProduct(e).sum();
  }
  return twice_energy / Real<Scalar>(2);
}

template class FiniteStrainSimulation<1, double>;
template class FiniteStrainSimulation<1, float>;
template class FiniteStrainSimulation<1, std::complex<double>>;
template class FiniteStrainSimulation<2, double>;
template class FiniteStrainSimulation<2, float>;
template class FiniteStrainSimulation<2, std::complex<double>>;
template class FiniteStrainSimulation<3, double>;
template class FiniteStrainSimulation<3, float>;
template class FiniteStrainSimulation<3, std::complex<double>>;

}  // namespace sphstab::solver
