// SPDX-License-Identifier: MIT
#include "solver/total_lagrangian.hpp"

#include "solver/finite_strain_simulation.hpp"
#include "solver/simulation.hpp"
#include "solver/stepper.hpp"

namespace sphstab::solver {

template <int Dim, class Scalar>
TotalLagrangian<Dim, Scalar>::TotalLagrangian(const Problem<Dim>& problem, const Body<Dim>& body)
    : first_(body.pairs.first),
      neighbour_(body.pairs.neighbour),
      damping_(problem.scheme.damping),
      integrator_(problem.integrator),
      material_(body.material),
      acceleration_(body.size()) {
  for (const auto& material : body.materials)
    substances_.push_back({material.lame(problem.plane), 1.0 / material.density()});
  for (const auto& load : body.load) load_.push_back(load.template cast<Real<Scalar>>());
  for (int a = 0; a < static_cast<int>(body.clamped.size()); ++a)
    for (int axis = 0; axis < Dim; ++axis)
      if (body.clamped[a][axis]) held_.push_back({a, axis});
  g_.reserve(neighbour_.size());
}

template <int Dim, class Scalar>
void TotalLagrangian<Dim, Scalar>::undamped_accelerations(const Field<Dim, Scalar>& displacement,
                                                          Field<Dim, Scalar>& acceleration) {
  internal_accelerations(displacement, acceleration);
  for (std::size_t a = 0; a < load_.size(); ++a) acceleration[a] += load_[a];
  for (const auto& [a, axis] : held_) acceleration[a][axis] = Scalar(0);
  ++right_hand_sides_;
}

template <int Dim, class Scalar>
void TotalLagrangian<Dim, Scalar>::accelerations(const State<Dim, Scalar>& state, Field<Dim, Scalar>& acceleration) {
  undamped_accelerations(state.displacement, acceleration);
  if (damping_)
    for (int a = 0; a < particles(); ++a)
      acceleration[a] -= static_cast<Real<Scalar>>(damping_->rate) * state.velocity[a];
}

template <int Dim, class Scalar>
void TotalLagrangian<Dim, Scalar>::advance(State<Dim, Scalar>& state, double time_step, long steps) {
  hold(state);
  const auto undamped = [this](const Field<Dim, Scalar>& displacement, Field<Dim, Scalar>& acceleration) {
    undamped_accelerations(displacement, acceleration);
  };
  solver::advance(integrator_, undamped, damping_, static_cast<Real<Scalar>>(time_step), steps, state, acceleration_);
}

template <int Dim, class Scalar>
void TotalLagrangian<Dim, Scalar>::hold(State<Dim, Scalar>& state) const {
  for (const auto& [a, axis] : held_) state.displacement[a][axis] = state.velocity[a][axis] = Scalar(0);
}

template <int Dim, class Scalar>
Scalar TotalLagrangian<Dim, Scalar>::kinetic_energy(const State<Dim, Scalar>& state) const {
  Scalar twice_energy(0);
  for (int a = 0; a < particles(); ++a)
    twice_energy += static_cast<Real<Scalar>>(inertia(a)) * state.velocity[a].cwiseProduct(state.velocity[a]).sum();
  return twice_energy / Real<Scalar>(2);
}

template <int Dim, class Scalar>
std::unique_ptr<TotalLagrangian<Dim, Scalar>> make_simulation(const Problem<Dim>& problem, const Body<Dim>& body) {
  if (is_finite_strain(problem.scheme.formulation))
    return std::make_unique<FiniteStrainSimulation<Dim, Scalar>>(problem, body);
  return std::make_unique<Simulation<Dim, Scalar>>(problem, body);
}

template class TotalLagrangian<1, double>;
template std::unique_ptr<TotalLagrangian<1, double>> make_simulation(const Problem<1>&, const Body<1>&);
template class TotalLagrangian<1, float>;
template std::unique_ptr<TotalLagrangian<1, float>> make_simulation(const Problem<1>&, const Body<1>&);
template class TotalLagrangian<1, std::complex<double>>;
template std::unique_ptr<TotalLagrangian<1, std::complex<double>>> make_simulation(const Problem<1>&, const Body<1>&);
template class TotalLagrangian<2, double>;
template std::unique_ptr<TotalLagrangian<2, double>> make_simulation(const Problem<2>&, const Body<2>&);
template class TotalLagrangian<2, float>;
template std::unique_ptr<TotalLagrangian<2, float>> make_simulation(const Problem<2>&, const Body<2>&);
template class TotalLagrangian<2, std::complex<double>>;
template std::unique_ptr<TotalLagrangian<2, std::complex<double>>> make_simulation(const Problem<2>&, const Body<2>&);
template class TotalLagrangian<3, double>;
template std::unique_ptr<TotalLagrangian<3, double>> make_simulation(const Problem<3>&, const Body<3>&);
template class TotalLagrangian<3, float>;
template std::unique_ptr<TotalLagrangian<3, float>> make_simulation(const Problem<3>&, const Body<3>&);
template class TotalLagrangian<3, std::complex<double>>;
template std::unique_ptr<TotalLagrangian<3, std::complex<double>>> make_simulation(const Problem<3>&, const Body<3>&);

}  // namespace sphstab::solver
