// SPDX-License-Identifier: MIT
#include "solver/simulation.hpp"

#include "solver/pair_terms.hpp"
#include "solver/stepper.hpp"
#include "solver/stress.hpp"

namespace sphstab::solver {
namespace {

template <class Matrix>
Matrix symmetric_part(const Matrix& gradient) {
  return (gradient + gradient.transpose()) / 2;
}

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
    : plane_(problem.plane),
      momentum_density_(problem.scheme.momentum_density),
      damping_(problem.scheme.damping),
      integrator_(problem.integrator),
      material_(body.material),
      first_(body.pairs.first),
      neighbour_(body.pairs.neighbour),
      P_(body.size()),
      acceleration_(body.size()) {
  if (problem.scheme.formulation != Formulation::total_lagrangian_linear)
    throw InvalidInput("scheme: this solver runs tl-linear, not " + std::string(name_of(problem.scheme.formulation)));
  for (const auto& material : body.materials) substances_.push_back({material.lame(plane_), 1.0 / material.density()});
  for (const auto& load : body.load) load_.push_back(load.template cast<Real<Scalar>>());
  for (int a = 0; a < static_cast<int>(body.clamped.size()); ++a)
    for (int axis = 0; axis < Dim; ++axis)
      if (body.clamped[a][axis]) held_.push_back({a, axis});

  g_.reserve(neighbour_.size());
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
  for (int a = 0; a < particles(); ++a) {
    const LameConstants& lame = substances_[material_[a]].lame;
    const Tensor<Dim, Scalar> strain = base_strain_[a] + perturbation_strain(displacement, a);
    P_[a] = linear_elastic_stress(strain, lame);
    if constexpr (density == MomentumDensity::equation_of_state) {
      const Scalar ratio = density_ratio(strain, lame);
      P_[a] /= ratio * ratio;
    }
  }
}

template <int Dim, class Scalar>
void Simulation<Dim, Scalar>::undamped_accelerations(const Field<Dim, Scalar>& displacement,
                                                     Field<Dim, Scalar>& acceleration) {
  switch (momentum_density_) {
    case MomentumDensity::frozen:
      store_stresses<MomentumDensity::frozen>(displacement);
      break;
    case MomentumDensity::equation_of_state:
      store_stresses<MomentumDensity::equation_of_state>(displacement);
      break;
  }
  for (int a = 0; a < particles(); ++a) {
    Vector<Dim, Scalar> sum = Vector<Dim, Scalar>::Zero();
    for (int pair = first_[a]; pair < first_[a + 1]; ++pair)
      sum += momentum_term(P_[a], P_[neighbour_[pair]], g_[pair]);
    acceleration[a] = static_cast<Real<Scalar>>(substances_[material_[a]].inverse_density) * sum;
  }
  for (std::size_t a = 0; a < load_.size(); ++a) acceleration[a] += load_[a];
  for (const auto& [a, axis] : held_) acceleration[a][axis] = Scalar(0);
  ++right_hand_sides_;
}

template <int Dim, class Scalar>
void Simulation<Dim, Scalar>::accelerations(const State<Dim, Scalar>& state, Field<Dim, Scalar>& acceleration) {
  undamped_accelerations(state.displacement, acceleration);
  if (damping_)
    for (int a = 0; a < particles(); ++a)
      acceleration[a] -= static_cast<Real<Scalar>>(damping_->rate) * state.velocity[a];
}

template <int Dim, class Scalar>
void Simulation<Dim, Scalar>::advance(State<Dim, Scalar>& state, double time_step, long steps) {
  hold(state);
  const auto undamped = [this](const Field<Dim, Scalar>& displacement, Field<Dim, Scalar>& acceleration) {
    undamped_accelerations(displacement, acceleration);
  };
  solver::advance(integrator_, undamped, damping_, static_cast<Real<Scalar>>(time_step), steps, state, acceleration_);
}

template <int Dim, class Scalar>
void Simulation<Dim, Scalar>::hold(State<Dim, Scalar>& state) const {
  for (const auto& [a, axis] : held_) state.displacement[a][axis] = state.velocity[a][axis] = Scalar(0);
}

template <int Dim, class Scalar>
Tensor<Dim, Scalar> Simulation<Dim, Scalar>::strain(const State<Dim, Scalar>& state, int a) const {
  return base_strain_[a] + perturbation_strain(state.displacement, a);
}

template <int Dim, class Scalar>
Tensor<Dim, Scalar> Simulation<Dim, Scalar>::stress(const State<Dim, Scalar>& state, int a) const {
  return linear_elastic_stress(strain(state, a), substances_[material_[a]].lame);
}

template <int Dim, class Scalar>
Scalar Simulation<Dim, Scalar>::von_mises_stress(const State<Dim, Scalar>& state, int a) const {
  return solver::von_mises_stress(stress_in_space(strain(state, a), substances_[material_[a]].lame, plane_));
}

template <int Dim, class Scalar>
Scalar Simulation<Dim, Scalar>::strain_energy(const State<Dim, Scalar>& state) const {
  Scalar twice_energy(0);
  for (int a = 0; a < particles(); ++a) {
    const Tensor<Dim, Scalar> strain = perturbation_strain(state.displacement, a);
    const Tensor<Dim, Scalar> stress = linear_elastic_stress(strain, substances_[material_[a]].lame);
    twice_energy += static_cast<Real<Scalar>>(weight_[a]) * stress.cwiseProduct(strain).sum();
  }
  return twice_energy / Real<Scalar>(2);
}

template <int Dim, class Scalar>
Scalar Simulation<Dim, Scalar>::kinetic_energy(const State<Dim, Scalar>& state) const {
  Scalar twice_energy(0);
  for (int a = 0; a < particles(); ++a)
    twice_energy += static_cast<Real<Scalar>>(inertia(a)) * state.velocity[a].cwiseProduct(state.velocity[a]).sum();
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
