// SPDX-License-Identifier: MIT
#include "solver/bloch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "solver/step_jacobian.hpp"

namespace sphstab::solver {
namespace {

using Complex = std::complex<double>;
constexpr Complex i_unit{0.0, 1.0};

/// k · (a period) is known to the rounding of positions of thousands of spacings, many digits below this.
constexpr double phase_tolerance = 1e-9;

/// A period of the patch is x_b − x_a + r_ab for a neighbour b that is an image; e^{ik·period} has to be 1.
template <int Dim>
void require_admitted(const Body<Dim>& body, const Vector<Dim>& k) {
  for (int a = 0; a < body.size(); ++a)
    for (int pair = body.pairs.first[a]; pair < body.pairs.first[a + 1]; ++pair) {
      const Vector<Dim> period =
          body.position[body.pairs.neighbour[pair]] - body.position[a] + body.pairs.separation[pair];
      if (std::abs(std::polar(1.0, k.dot(period)) - 1.0) > phase_tolerance)
        throw InvalidInput(fmt::format("wave_vector: {} is not 2π times an integer over the period {} of the patch",
                                       fmt::join(k.data(), k.data() + Dim, ","),
                                       fmt::join(period.data(), period.data() + Dim, ",")));
    }
}

enum class Part { real, imaginary };

template <int Dim>
Field<Dim> part_of(const Field<Dim, Complex>& wave, Part part) {
  Field<Dim> field(wave.size());
  std::transform(wave.begin(), wave.end(), field.begin(), [part](const Vector<Dim, Complex>& y) {
    return part == Part::real ? Vector<Dim>(y.real()) : Vector<Dim>(y.imag());
  });
  return field;
}

/// The unit wave e^{ik·x} along axis `axis`.
template <int Dim>
Field<Dim, Complex> unit_wave(const Body<Dim>& body, const Vector<Dim>& k, int axis) {
  return bloch_wave<Dim>(body, k, Vector<Dim, Complex>::Unit(axis));
}

}  // namespace

template <int Dim>
Field<Dim, Complex> bloch_wave(const Body<Dim>& body, const Vector<Dim>& wave_vector,
                               const Vector<Dim, Complex>& amplitude) {
  require_admitted(body, wave_vector);
  Field<Dim, Complex> wave;
  wave.reserve(body.position.size());
  for (const auto& x : body.position) wave.push_back(amplitude * std::polar(1.0, wave_vector.dot(x)));
  return wave;
}

template <int Dim, class Scalar>
Vector<Dim, Complex> bloch_amplitude(const Body<Dim>& body, const Vector<Dim>& wave_vector,
                                     const Field<Dim, Scalar>& field) {
  Vector<Dim, Complex> sum = Vector<Dim, Complex>::Zero();
  for (int a = 0; a < body.size(); ++a) sum += field[a] * std::polar(1.0, -wave_vector.dot(body.position[a]));
  return sum / static_cast<double>(body.size());
}

template <int Dim>
Tensor<Dim, Complex> bloch_acceleration_matrix(const Problem<Dim>& problem, const Body<Dim>& patch,
                                               const Vector<Dim>& wave_vector) {
  const auto simulation = make_simulation<Dim, Complex>(problem, patch);
  Tensor<Dim, Complex> matrix = Tensor<Dim, Complex>::Zero();
  for (int column = 0; column < Dim; ++column) {
    const auto wave = unit_wave(patch, wave_vector, column);
    for (const auto& [part, unit] : {std::pair(Part::real, Complex(1.0)), std::pair(Part::imaginary, i_unit)})
      matrix.col(column) +=
          unit * bloch_amplitude(patch, wave_vector, acceleration_derivative(*simulation, part_of<Dim>(wave, part)));
  }
  return matrix;
}

template <int Dim>
BlochStepMatrix<Dim> bloch_step_matrix(const Problem<Dim>& problem, const Body<Dim>& patch,
                                       const Vector<Dim>& wave_vector, double time_step) {
  const auto simulation = make_simulation<Dim, Complex>(problem, patch);
  BlochStepMatrix<Dim> matrix = BlochStepMatrix<Dim>::Zero();
  for (int column = 0; column < 2 * Dim; ++column) {
    const auto wave = unit_wave(patch, wave_vector, column % Dim);
    for (const auto& [part, unit] : {std::pair(Part::real, Complex(1.0)), std::pair(Part::imaginary, i_unit)}) {
      State<Dim> direction(patch.size());
      (column < Dim ? direction.velocity : direction.displacement) = part_of<Dim>(wave, part);
      const State<Dim> image = step_derivative(*simulation, direction, time_step);
      matrix.col(column).template head<Dim>() += unit * bloch_amplitude(patch, wave_vector, image.velocity);
      matrix.col(column).template tail<Dim>() += unit * bloch_amplitude(patch, wave_vector, image.displacement);
    }
  }
  return matrix;
}

template Field<1, Complex> bloch_wave(const Body<1>&, const Vector<1>&, const Vector<1, Complex>&);
template Vector<1, Complex> bloch_amplitude(const Body<1>&, const Vector<1>&, const Field<1>&);
template Vector<1, Complex> bloch_amplitude(const Body<1>&, const Vector<1>&, const Field<1, Complex>&);
template Tensor<1, Complex> bloch_acceleration_matrix(const Problem<1>&, const Body<1>&, const Vector<1>&);
template BlochStepMatrix<1> bloch_step_matrix(const Problem<1>&, const Body<1>&, const Vector<1>&, double);
template Field<2, Complex> bloch_wave(const Body<2>&, const Vector<2>&, const Vector<2, Complex>&);
template Vector<2, Complex> bloch_amplitude(const Body<2>&, const Vector<2>&, const Field<2>&);
template Vector<2, Complex> bloch_amplitude(const Body<2>&, const Vector<2>&, const Field<2, Complex>&);
template Tensor<2, Complex> bloch_acceleration_matrix(const Problem<2>&, const Body<2>&, const Vector<2>&);
template BlochStepMatrix<2> bloch_step_matrix(const Problem<2>&, const Body<2>&, const Vector<2>&, double);
template Field<3, Complex> bloch_wave(const Body<3>&, const Vector<3>&, const Vector<3, Complex>&);
template Vector<3, Complex> bloch_amplitude(const Body<3>&, const Vector<3>&, const Field<3>&);
template Vector<3, Complex> bloch_amplitude(const Body<3>&, const Vector<3>&, const Field<3, Complex>&);
template Tensor<3, Complex> bloch_acceleration_matrix(const Problem<3>&, const Body<3>&, const Vector<3>&);
template BlochStepMatrix<3> bloch_step_matrix(const Problem<3>&, const Body<3>&, const Vector<3>&, double);

}  // namespace sphstab::solver
