// SPDX-License-Identifier: MIT
#include "study/updated_growth_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/updated_stress.hpp"
#include "study/noise.hpp"
#include "study/p_wave_speed.hpp"

namespace sphstab::study {
namespace {

constexpr double largest_velocity = 1e-6;  ///< in c_p
/// What grows under a stress σ = s ρ c0² does so at a rate of about 2√s c0/Δp. Its displacements must stay below
/// 0.01 √s Δp for the stress that they make, of second order, to be far below σ: velocities below this times s.
constexpr double largest_velocity_over_stress = 0.02;
constexpr double seed_over_largest = 1e-3;

}  // namespace

template <int Dim>
PerturbedPatch<Dim>::PerturbedPatch(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells)
    : simulation_(problem, cells), state_(simulation_.base_state()) {
  if (problem.integrator == Integrator::predictor_corrector_pec) state_.stored = solver::UpdatedRates<Dim>(particles());
  base_ = solver::flat_state(state_);
  const Material& material = problem.material;
  const double density = state_.density[0], mu = material.shear_modulus();
  speed_of_p_waves_ = p_wave_speed(problem);
  crossing_time_ = problem.lattice.spacing() / speed_of_p_waves_;
  of_density_ = std::sqrt(material.bulk_modulus() / material.density()) / density;
  of_deviatoric_ = mu > 0.0 ? 1.0 / (2.0 * mu * density) : 0.0;
  const Tensor<Dim> stress = problem.deviatoric_stress - problem.pressure * Tensor<Dim>::Identity();
  const double size = stress.norm() / material.bulk_modulus();
  largest_amplitude_ = size > 0.0 ? std::min(largest_velocity, largest_velocity_over_stress * size) : largest_velocity;
}

template <int Dim>
Eigen::VectorXd PerturbedPatch<Dim>::noise_departure(unsigned noise_seed) {
  if (particles() == 1) throw InvalidInput("patch: one cell moves as a whole; take a larger one");
  const auto velocity = noise<Dim>(particles(), noise_seed);
  Vector<Dim> mean = Vector<Dim>::Zero();
  for (const auto& v : velocity) mean += v / particles();
  const int size = numbers_per_particle();
  Eigen::VectorXd departure = Eigen::VectorXd::Zero(size * particles());
  for (int a = 0; a < particles(); ++a) departure.template segment<Dim>(size * a + Dim) = velocity[a] - mean;
  return departure;
}

template <int Dim>
void PerturbedPatch<Dim>::advance(Eigen::VectorXd& departure, double time_step, int steps) {
  solver::set_flat_state<Dim, double>(base_ + departure, state_);
  if (simulation_.advance(state_, time_step, steps))
    departure.setConstant(std::numeric_limits<double>::infinity());
  else
    departure = solver::flat_state(state_) - base_;
}

template <int Dim>
double PerturbedPatch<Dim>::amplitude(const Eigen::VectorXd& departure) {
  const int size = numbers_per_particle();
  double square = 0.0;
  for (int a = 0; a < particles(); ++a) {
    const auto numbers = departure.segment(size * a, size);
    const Vector<symmetric_size<Dim>> components = numbers.template segment<symmetric_size<Dim>>(2 * Dim + 1);
    const auto S = solver::deviatoric_stress_in_space<double, Dim>(symmetric_tensor<Dim, double>(components));
    square += numbers.template segment<Dim>(Dim).squaredNorm() + std::pow(of_density_ * numbers[2 * Dim], 2) +
              of_deviatoric_ * S.squaredNorm();
  }
  return std::sqrt(square / particles()) / speed_of_p_waves_;
}

template <int Dim>
double PerturbedPatch<Dim>::seed_amplitude(double time_step) const {
  return seed_over_largest * largest_amplitude_ * std::min(1.0, crossing_time_ / time_step);
}

template <int Dim>
UpdatedGrowthRun<Dim>::UpdatedGrowthRun(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells,
                                        unsigned noise_seed)
    : PerturbationRun(std::make_shared<PerturbedPatch<Dim>>(problem, cells), noise_seed) {}

template <int Dim>
UpdatedGrowthRun<Dim>::UpdatedGrowthRun(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells,
                                        const Eigen::VectorXd& departure)
    : PerturbationRun(std::make_shared<PerturbedPatch<Dim>>(problem, cells), departure) {}

template class PerturbedPatch<1>;
template class UpdatedGrowthRun<1>;
template class PerturbedPatch<2>;
template class UpdatedGrowthRun<2>;
template class PerturbedPatch<3>;
template class UpdatedGrowthRun<3>;

}  // namespace sphstab::study
