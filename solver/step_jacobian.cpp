// SPDX-License-Identifier: MIT
#include "solver/step_jacobian.hpp"

#include <algorithm>

namespace sphstab::solver {
namespace {

/// A power of two, so that scaling by it is exact, with a square far below rounding.
constexpr double complex_step = 0x1p-100;

template <int Dim>
Field<Dim, std::complex<double>> imaginary_step(const Field<Dim>& direction) {
  Field<Dim, std::complex<double>> field(direction.size());
  std::transform(direction.begin(), direction.end(), field.begin(), [](const Vector<Dim>& d) {
    return Vector<Dim, std::complex<double>>(d * std::complex<double>(0.0, complex_step));
  });
  return field;
}

template <int Dim>
Field<Dim> derivative_of(const Field<Dim, std::complex<double>>& image) {
  Field<Dim> field(image.size());
  std::transform(image.begin(), image.end(), field.begin(),
                 [](const Vector<Dim, std::complex<double>>& y) { return Vector<Dim>(y.imag() / complex_step); });
  return field;
}

/// Component `index` of particle a in the order [v, s] of the Jacobian.
template <int Dim, class AnyState>
auto& component(AnyState& state, int a, int index) {
  return index < Dim ? state.velocity[a][index] : state.displacement[a][index - Dim];
}

}  // namespace

template <int Dim>
State<Dim> step_derivative(DerivativeSimulation<Dim>& simulation, const State<Dim>& direction, double time_step) {
  State<Dim, std::complex<double>> state(direction.particles());
  state.velocity = imaginary_step<Dim>(direction.velocity);
  state.displacement = imaginary_step<Dim>(direction.displacement);
  simulation.advance(state, time_step);
  State<Dim> derivative(direction.particles());
  derivative.velocity = derivative_of<Dim>(state.velocity);
  derivative.displacement = derivative_of<Dim>(state.displacement);
  return derivative;
}

template <int Dim>
Field<Dim> acceleration_derivative(DerivativeSimulation<Dim>& simulation, const Field<Dim>& direction) {
  State<Dim, std::complex<double>> state(simulation.particles());
  state.displacement = imaginary_step<Dim>(direction);
  Field<Dim, std::complex<double>> acceleration(direction.size());
  simulation.accelerations(state, acceleration);
  return derivative_of<Dim>(acceleration);
}

template <int Dim>
Eigen::MatrixXd step_jacobian(const Problem<Dim>& problem, const Body<Dim>& body, double time_step) {
  const auto simulation = make_simulation<Dim, std::complex<double>>(problem, body);
  const int size = 2 * Dim * body.size();
  Eigen::MatrixXd jacobian(size, size);
  for (int column = 0; column < size; ++column) {
    State<Dim> direction(body.size());
    component<Dim>(direction, column / (2 * Dim), column % (2 * Dim)) = 1.0;
    const State<Dim> image = step_derivative(*simulation, direction, time_step);
    for (int row = 0; row < size; ++row)
      jacobian(row, column) = component<Dim>(image, row / (2 * Dim), row % (2 * Dim));
  }
  return jacobian;
}

template State<1> step_derivative(DerivativeSimulation<1>&, const State<1>&, double);
template Field<1> acceleration_derivative(DerivativeSimulation<1>&, const Field<1>&);
template Eigen::MatrixXd step_jacobian(const Problem<1>&, const Body<1>&, double);
template State<2> step_derivative(DerivativeSimulation<2>&, const State<2>&, double);
template Field<2> acceleration_derivative(DerivativeSimulation<2>&, const Field<2>&);
template Eigen::MatrixXd step_jacobian(const Problem<2>&, const Body<2>&, double);
template State<3> step_derivative(DerivativeSimulation<3>&, const State<3>&, double);
template Field<3> acceleration_derivative(DerivativeSimulation<3>&, const Field<3>&);
template Eigen::MatrixXd step_jacobian(const Problem<3>&, const Body<3>&, double);

}  // namespace sphstab::solver
