// SPDX-License-Identifier: MIT
#include "solver/simulation.hpp"

#include "solver/pair_terms.hpp"
#include "solver/stress.hpp"

namespace sphstab::solver {
namespace {

/// N_a = Σ_b V_b W_ab over a itself and its neighbours, or 1 where the scheme does not normalise.
template <int Dim>
double normalisation(const Problem<Dim>& problem, const Body<Dim>& body, int a) {
  switch (problem.scheme.kernel_normalisation) {
    case KernelNormalisation::none:
      return 1.0;
    case KernelNormalisation::sum:
      double N_a = body.volume[a] * problem.kernel.value(0.0);
      for (int pair = body.pairs.first[a]; pair < body.pairs.first[a + 1]; ++pair)
        N_a += body.volume[body.pairs.neighbour[pair]] * problem.kernel.value(body.pairs.separation[pair].norm());
      return N_a;
  }
  return 1.0;
}

}  // namespace

template <int Dim, class Scalar>
Simulation<Dim, Scalar>::Simulation(const Problem<Dim>& problem, const Body<Dim>& body)
    : Base(problem, body), plane_(problem.plane), momentum_density_(problem.scheme.momentum_density), P_(body.size()) {
  if (problem.scheme.formulation != Formulation::total_lagrangian_linear)
    throw InvalidInput("scheme: this solver runs tl-linear, not " + std::string(name_of(problem.scheme.formulation)));
  base_strain_.reserve(body.size());
  weight_.reserve(body.size());
  for (int a = 0; a < body.size(); ++a) {
    const double N_a = normalisation(problem, body, a);
    Tensor<Dim> gradient = Tensor<Dim>::Zero();
    for (int pair = first_[a]; pair < first_[a + 1]; ++pair) {
      const Vector<Dim>& r_ab = body.pairs.separation[pair];
      const Vector<Dim> g_ab = kernel_gradient(problem.kernel, r_ab, body.volume[neighbour_[pair]] / N_a);
      gradient -= problem.displacement_gradient * r_ab * g_ab.transpose();
      g_.push_back(g_ab.template cast<Real<Scalar>>());
    }
    base_strain_.push_back(symmetric_part(gradient).template cast<Real<Scalar>>());
    weight_.push_back(body.volume[a] * N_a);
  }
}

template <int Dim, class Scalar>
Tensor<Dim, Scalar> Simulation<Dim, Scalar>::perturbation_strain(const Field<Dim, Scalar>& displacement, int a) const {
  Tensor<Dim, Scalar> gradient = Tensor<Dim, Scalar>::Zero();
  for (int pair = first_[a]; pair < first_[a + 1]; ++pair)
    gradient += displacement_gradient_term(displacement[a], displacement[neighbour_[pair]], g_[pair]);
  return symmetric_part(gradient);
}

template <int Dim, class Scalar>
template <MomentumDensity density>
void Simulation<Dim, Scalar>::store_stresses(const Field<Dim, Scalar>& displacement) {
  for (int a = 0; a < this->particles(); ++a) {
    const LameConstants& lame = substance(a).lame;
    const Tensor<Dim, Scalar> strain = base_strain_[a] + perturbation_strain(displacement, a);
    P_[a] = linear_elastic_stress(strain, lame);
    if constexpr (density == MomentumDensity::equation_of_state) {
      const Scalar ratio = density_ratio(strain, lame);
      P_[a] /= ratio * ratio;
    }
  }
}

template <int Dim, class Scalar>
void Simulation<Dim, Scalar>::internal_accelerations(const Field<Dim, Scalar>& displacement,
                                                     Field<Dim, Scalar>& acceleration) {
  switch (momentum_density_) {
    case MomentumDensity::frozen:
      store_stresses<MomentumDensity::frozen>(displacement);
      break;
    case MomentumDensity::equation_of_state:
      store_stresses<MomentumDensity::equation_of_state>(displacement);
      break;
  }
  for (int a = 0; a < this->particles(); ++a) {
    Vector<Dim, Scalar> sum = Vector<Dim, Scalar>::Zero();
    for (int pair = first_[a]; pair < first_[a + 1]; ++pair)
      sum += momentum_term(P_[a], P_[neighbour_[pair]], g_[pair]);
    acceleration[a] = static_cast<Real<Scalar>>(substance(a).inverse_density) * sum;
  }
}

template <int Dim, class Scalar>
Tensor<Dim, Scalar> Simulation<Dim, Scalar>::strain(const State<Dim, Scalar>& state, int a) const {
  return base_strain_[a] + perturbation_strain(state.displacement, a);
}

template <int Dim, class Scalar>
Tensor<Dim, Scalar> Simulation<Dim, Scalar>::stress(const State<Dim, Scalar>& state, int a) const {
  return linear_elastic_stress(strain(state, a), substance(a).lame);
}

template <int Dim, class Scalar>
Scalar Simulation<Dim, Scalar>::von_mises_stress(const State<Dim, Scalar>& state, int a) const {
  return solver::von_mises_stress(stress_in_space(strain(state, a), substance(a).lame, plane_));
}

template <int Dim, class Scalar>
Scalar Simulation<Dim, Scalar>::strain_energy(const State<Dim, Scalar>& state) const {
  Scalar twice_energy(0);
  for (int a = 0; a < this->particles(); ++a) {
    const Tensor<Dim, Scalar> strain = perturbation_strain(state.displacement, a);
    const Tensor<Dim, Scalar> stress = linear_elastic_stress(strain, substance(a).lame);
    twice_energy += static_cast<Real<Scalar>>(weight_[a]) * stress.cwiseProduct(strain).sum();
  }
  return twice_energy / Real<Scalar>(2);
}

template class Simulation<1, double>;
template class Simulation<1, float>;
template class Simulation<1, std::complex<double>>;
template class Simulation<2, double>;
template class Simulation<2, float>;
template class Simulation<2, std::complex<double>>;
template class Simulation<3, double>;
template class Simulation<3, float>;
template class Simulation<3, std::complex<double>>;

}  // namespace sphstab::solver
