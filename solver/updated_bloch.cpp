// SPDX-License-Identifier: MIT
#include "solver/updated_bloch.hpp"

#include <fmt/format.h>

namespace sphstab::solver {
namespace {

using Complex = std::complex<double>;

Eigen::VectorXd derivatives(const FlatVector<Dual>& numbers) {
  return numbers.unaryExpr([](const Dual& x) { return x.derivative; });
}

/// The state moved infinitesimally along a direction.
template <int Dim>
UpdatedState<Dim, Dual> moved(UpdatedState<Dim, Dual> state, const Eigen::VectorXd& direction) {
  FlatVector<Dual> numbers = flat_state(state);
  for (int i = 0; i < numbers.size(); ++i) numbers[i].derivative = direction[i];
  set_flat_state(numbers, state);
  return state;
}

/// The matrix of a map of real fields, `size` numbers a particle, that commutes with translations, for waves e^{ik·x}:
/// column by column from the real and the imaginary part of the wave.
template <int Dim, class Map>
Eigen::MatrixXcd bloch_matrix(const Body<Dim>& patch, const Vector<Dim>& wave_vector, int size, const Map& map) {
  const auto wave = bloch_wave<Dim>(patch, wave_vector, Vector<Dim, Complex>::Unit(0));
  Eigen::MatrixXcd matrix = Eigen::MatrixXcd::Zero(size, size);
  for (int column = 0; column < size; ++column)
    for (const Complex unit : {Complex(1.0, 0.0), Complex(0.0, 1.0)}) {
      Eigen::VectorXd direction = Eigen::VectorXd::Zero(size * patch.size());
      for (int a = 0; a < patch.size(); ++a) direction[size * a + column] = (std::conj(unit) * wave[a][0]).real();
      const Eigen::VectorXd image = map(direction);
      for (int a = 0; a < patch.size(); ++a)
        matrix.col(column) += unit * std::conj(wave[a][0]) * image.segment(size * a, size);
    }
  return matrix / patch.size();
}

/// Everything that a step maps, stored rates included.
template <int Dim>
UpdatedState<Dim, Dual> base_of(const Problem<Dim>& problem, const UpdatedSimulation<Dim, Dual>& simulation) {
  UpdatedState<Dim, Dual> base = simulation.base_state();
  if (problem.integrator == Integrator::predictor_corrector_pec)
    base.stored = UpdatedRates<Dim, Dual>(base.particles());
  return base;
}

}  // namespace

template <int Dim>
Eigen::VectorXd step_derivative(UpdatedSimulation<Dim, Dual>& simulation, const UpdatedState<Dim, Dual>& state,
                                const Eigen::VectorXd& direction, double time_step) {
  auto image = moved(state, direction);
  if (simulation.advance(image, time_step))
    throw InvalidInput(fmt::format("time_step: a step of {} leaves the finite numbers", time_step));
  return derivatives(flat_state(image));
}

template <int Dim>
Eigen::MatrixXd step_jacobian(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells, double time_step) {
  UpdatedSimulation<Dim, Dual> simulation(problem, cells);
  const auto base = base_of(problem, simulation);
  const int size = numbers_per_particle(base) * base.particles();
  Eigen::MatrixXd jacobian(size, size);
  for (int column = 0; column < size; ++column)
    jacobian.col(column) = step_derivative(simulation, base, Eigen::VectorXd::Unit(size, column), time_step);
  return jacobian;
}

template <int Dim>
Eigen::MatrixXcd bloch_step_matrix(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells,
                                   const Vector<Dim>& wave_vector, double time_step) {
  UpdatedSimulation<Dim, Dual> simulation(problem, cells);
  const auto base = base_of(problem, simulation);
  return bloch_matrix<Dim>(
      periodic_patch(problem, cells), wave_vector, numbers_per_particle(base),
      [&](const Eigen::VectorXd& direction) { return step_derivative(simulation, base, direction, time_step); });
}

template <int Dim>
Eigen::MatrixXcd bloch_rate_matrix(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells,
                                   const Vector<Dim>& wave_vector) {
  UpdatedSimulation<Dim, Dual> simulation(problem, cells);
  const UpdatedState<Dim, Dual>& base = simulation.base_state();
  return bloch_matrix<Dim>(
      periodic_patch(problem, cells), wave_vector, numbers_per_particle(base), [&](const Eigen::VectorXd& direction) {
        const auto state = moved(base, direction);
        UpdatedRates<Dim, Dual> rates(state.particles());
        simulation.place(state.position);
        simulation.forces(state, rates.acceleration);
        const auto& smoothed = simulation.smoothed(state);
        simulation.rates(state, smoothed, rates);
        return derivatives(
            flat_state(UpdatedState<Dim, Dual>{smoothed, rates.acceleration, rates.density, rates.deviatoric_stress}));
      });
}

template Eigen::VectorXd step_derivative(UpdatedSimulation<1, Dual>&, const UpdatedState<1, Dual>&,
                                         const Eigen::VectorXd&, double);
template Eigen::MatrixXd step_jacobian(const Problem<1>&, const LatticeIndex<1>&, double);
template Eigen::MatrixXcd bloch_step_matrix(const Problem<1>&, const LatticeIndex<1>&, const Vector<1>&, double);
template Eigen::MatrixXcd bloch_rate_matrix(const Problem<1>&, const LatticeIndex<1>&, const Vector<1>&);
template Eigen::VectorXd step_derivative(UpdatedSimulation<2, Dual>&, const UpdatedState<2, Dual>&,
                                         const Eigen::VectorXd&, double);
template Eigen::MatrixXd step_jacobian(const Problem<2>&, const LatticeIndex<2>&, double);
template Eigen::MatrixXcd bloch_step_matrix(const Problem<2>&, const LatticeIndex<2>&, const Vector<2>&, double);
template Eigen::MatrixXcd bloch_rate_matrix(const Problem<2>&, const LatticeIndex<2>&, const Vector<2>&);
template Eigen::VectorXd step_derivative(UpdatedSimulation<3, Dual>&, const UpdatedState<3, Dual>&,
                                         const Eigen::VectorXd&, double);
template Eigen::MatrixXd step_jacobian(const Problem<3>&, const LatticeIndex<3>&, double);
template Eigen::MatrixXcd bloch_step_matrix(const Problem<3>&, const LatticeIndex<3>&, const Vector<3>&, double);
template Eigen::MatrixXcd bloch_rate_matrix(const Problem<3>&, const LatticeIndex<3>&, const Vector<3>&);

}  // namespace sphstab::solver
