// SPDX-License-Identifier: MIT
#include "study/growth_run.hpp"

#include <cmath>
#include <limits>

#include "solver/total_lagrangian.hpp"
#include "study/noise.hpp"

namespace sphstab::study {
namespace {

using solver::Field;
using solver::State;

/// Size of the perturbation, √(strain energy / that of a strain of 1): a strain. Six digits above rounding even on
/// a base state of strain 1, so that noise of the arithmetic stays small beside it.
constexpr double seed_strain = 1e-10;
/// A linear scheme may grow for ever; a nonlinear one must stay below it, where the error of the growth is of that
/// order.
constexpr double largest_nonlinear_strain = 2e-5;
/// A displacement s of which SPH sees less strain than this times s/h consists of zero-energy modes.
constexpr double smallest_strain = 1e-12;

/// Growth is that of a perturbation, which loads do not drive.
template <int Dim>
Body<Dim> without_loads(Body<Dim> body) {
  body.load.clear();
  return body;
}

/// Σ_a (λ + 2G)_a V_a, an energy: that of a strain of 1.
template <int Dim>
double energy_of_unit_strain(const Problem<Dim>& problem, const Body<Dim>& body) {
  double energy = 0.0;
  for (int a = 0; a < body.size(); ++a)
    energy += body.material_of(a).lame(problem.plane).p_wave_modulus() * body.volume[a];
  return energy;
}

bool is_linear(const Scheme& scheme) {
  return !is_finite_strain(scheme.formulation) && scheme.momentum_density == MomentumDensity::frozen;
}

/// A total-Lagrangian solver with the loads of its body.
template <int Dim>
class PerturbedBody : public PerturbedSolver {
 public:
  PerturbedBody(const Problem<Dim>& problem, const Body<Dim>& body, const Field<Dim>& equilibrium)
      : simulation_(solver::make_simulation(problem, body)),
        energy_scale_(energy_of_unit_strain(problem, body)),
        largest_amplitude_(is_linear(problem.scheme) ? std::numeric_limits<double>::infinity()
                                                     : largest_nonlinear_strain),
        smoothing_length_(problem.kernel.smoothing_length()),
        equilibrium_(equilibrium),
        state_(body.size()) {}

  Eigen::VectorXd noise_departure(unsigned noise_seed) override {
    return departure(noise<Dim>(state_.particles(), noise_seed));
  }

  /// At rest. Throws InvalidInput (`patch`) without strain energy.
  Eigen::VectorXd departure(const Field<Dim>& displacement) {
    state_ = State<Dim>(state_.particles());
    state_.displacement = displacement;
    simulation_->hold(state_);
    double square = 0.0;
    for (const auto& s : state_.displacement) square += s.squaredNorm() / static_cast<double>(state_.particles());
    const Eigen::VectorXd departure = flat();
    if (!(amplitude(departure) > smallest_strain * std::sqrt(square) / smoothing_length_))
      throw InvalidInput(
          "patch: no perturbation of it has a strain energy (zero-energy modes only); take a larger one");
    return departure;
  }

  void advance(Eigen::VectorXd& departure, double time_step, int steps) override {
    set(departure);
    for (int a = 0; a < state_.particles(); ++a) state_.displacement[a] += equilibrium_[a];
    simulation_->advance(state_, time_step, steps);
    for (int a = 0; a < state_.particles(); ++a) state_.displacement[a] -= equilibrium_[a];
    departure = flat();
  }

  double amplitude(const Eigen::VectorXd& departure) override {
    set(departure);
    return std::sqrt(simulation_->perturbation_energy(state_) / energy_scale_);
  }

  double seed_amplitude(double) const override { return seed_strain; }
  double largest_amplitude() const override { return largest_amplitude_; }

 private:
  Eigen::VectorXd flat() const {
    Eigen::VectorXd numbers(2 * Dim * state_.particles());
    for (int a = 0; a < state_.particles(); ++a)
      numbers.template segment<2 * Dim>(2 * Dim * a) << state_.displacement[a], state_.velocity[a];
    return numbers;
  }

  void set(const Eigen::VectorXd& numbers) {
    for (int a = 0; a < state_.particles(); ++a) {
      state_.displacement[a] = numbers.template segment<Dim>(2 * Dim * a);
      state_.velocity[a] = numbers.template segment<Dim>(2 * Dim * a + Dim);
    }
  }

  std::unique_ptr<solver::TotalLagrangian<Dim>> simulation_;
  double energy_scale_;  ///< of a strain of 1
  double largest_amplitude_;
  double smoothing_length_;
  Field<Dim> equilibrium_;
  State<Dim> state_;
};

template <int Dim>
std::shared_ptr<PerturbedBody<Dim>> unloaded(const Problem<Dim>& problem, const Body<Dim>& body) {
  return std::make_shared<PerturbedBody<Dim>>(problem, without_loads(body), State<Dim>(body.size()).displacement);
}

template <int Dim>
PerturbationRun run_from(const Field<Dim>& displacement, const std::shared_ptr<PerturbedBody<Dim>>& body) {
  return {body, body->departure(displacement)};
}

}  // namespace

template <int Dim>
std::shared_ptr<PerturbedSolver> perturbed_body(const Problem<Dim>& problem, const Body<Dim>& body) {
  return unloaded(problem, body);
}

template <int Dim>
GrowthRun<Dim>::GrowthRun(const Problem<Dim>& problem, const Body<Dim>& body, unsigned noise_seed)
    : PerturbationRun(unloaded(problem, body), noise_seed) {}

template <int Dim>
GrowthRun<Dim>::GrowthRun(const Problem<Dim>& problem, const Body<Dim>& body, const Field<Dim>& displacement)
    : PerturbationRun(run_from(displacement, unloaded(problem, body))) {}

template <int Dim>
GrowthRun<Dim>::GrowthRun(const Problem<Dim>& problem, const Body<Dim>& body, const Field<Dim>& equilibrium,
                          unsigned noise_seed)
    : PerturbationRun(std::make_shared<PerturbedBody<Dim>>(problem, body, equilibrium), noise_seed) {}

template std::shared_ptr<PerturbedSolver> perturbed_body(const Problem<1>&, const Body<1>&);
template class GrowthRun<1>;
template std::shared_ptr<PerturbedSolver> perturbed_body(const Problem<2>&, const Body<2>&);
template class GrowthRun<2>;
template std::shared_ptr<PerturbedSolver> perturbed_body(const Problem<3>&, const Body<3>&);
template class GrowthRun<3>;

}  // namespace sphstab::study
