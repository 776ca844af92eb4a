// SPDX-License-Identifier: MIT
#include "analysis/amplification.hpp"

#include <algorithm>
#include <limits>
#include <string_view>

#include "analysis/acoustic_form.hpp"
#include "analysis/gradient_symbol.hpp"
#include "analysis/mode_step.hpp"

namespace sphstab::analysis {
namespace {

/// What a spectral radius of exactly 1 may exceed it by.
constexpr double few_roundings = 8.0 * std::numeric_limits<double>::epsilon();

/// M is a multiple of I plus (coupling D) Dᵀ: it lacks an eigenvector where that rank-one part is nilpotent.
template <int Dim>
bool lacks_eigenvector(const AcousticForm<Dim>& form, const Vector<Dim>& D) {
  const Vector<Dim> image = form.coupling * D;
  const double size = image.norm() * D.norm();
  return size > 0.0 && std::abs(image.dot(D)) <= few_roundings * size;
}

}  // namespace

template <int Dim>
std::vector<std::string> state_names(const Problem<Dim>&) {
  std::vector<std::string> names;
  for (const char quantity : std::string_view("vs"))
    for (int axis = 0; axis < Dim; ++axis) names.push_back({quantity, "xyz"[axis]});
  return names;
}

template <int Dim>
Tensor<Dim> dynamical_matrix(const Problem<Dim>& problem, const Vector<Dim>& wave_vector) {
  const GradientSymbol<Dim> symbol(problem);
  return AcousticForm<Dim>(problem, symbol.consistency()).dynamical_matrix(symbol(wave_vector));
}

template <int Dim>
ComplexMatrix amplification_matrix(const Problem<Dim>& problem, const Vector<Dim>& wave_vector, double time_step) {
  const Tensor<Dim> M = dynamical_matrix(problem, wave_vector), I = Tensor<Dim>::Identity();
  const double dt = time_step;
  const double a = problem.scheme.damping ? problem.scheme.damping->rate * dt : 0.0, b = 1.0 - 0.5 * a;
  Eigen::Matrix<double, 2 * Dim, 2 * Dim> E;
  const auto fill = [&E](const Tensor<Dim>& vv, const Tensor<Dim>& vs, const Tensor<Dim>& sv, const Tensor<Dim>& ss) {
    E.template topLeftCorner<Dim, Dim>() = vv;
    E.template topRightCorner<Dim, Dim>() = vs;
    E.template bottomLeftCorner<Dim, Dim>() = sv;
    E.template bottomRightCorner<Dim, Dim>() = ss;
  };
  switch (problem.integrator) {
    case Integrator::leapfrog:
      fill((1.0 - a) * I, -dt * M, dt * (1.0 - a) * I, I - dt * dt * M);
      break;
    case Integrator::verlet:
      fill(b * b * I - 0.5 * b * dt * dt * M, -0.5 * (1.0 + b) * dt * M + 0.25 * dt * dt * dt * M * M, b * dt * I,
           I - 0.5 * dt * dt * M);
      break;
  }
  return E.template cast<std::complex<double>>();
}

template <int Dim>
ModeSpectrum mode_spectrum(const Problem<Dim>& problem, const Vector<Dim>& wave_vector, double time_step) {
  const GradientSymbol<Dim> symbol(problem);
  const AcousticForm<Dim> form(problem, symbol.consistency());
  const Vector<Dim> D = symbol.cleaned(wave_vector);

  ModeSpectrum spectrum{{}, 0.0, true};
  const auto add_branch = [&](double omega_squared) {
    const ModeStep step(problem.integrator, problem.scheme.damping, omega_squared);
    for (const auto& eigenvalue : step.eigenvalues(time_step)) spectrum.eigenvalues.push_back(eigenvalue);
    const double radius = step.spectral_radius(time_step);
    const bool on_circle = radius >= 1.0 - few_roundings;
    spectrum.spectral_radius = std::max(spectrum.spectral_radius, radius);
    spectrum.power_bounded = spectrum.power_bounded && radius <= 1.0 + few_roundings && !step.defective(time_step) &&
                             !(on_circle && lacks_eigenvector(form, D));
  };
  add_branch(form.longitudinal(D));
  for (int branch = 1; branch < Dim; ++branch) add_branch(form.transverse(D));
  return spectrum;
}

template std::vector<std::string> state_names(const Problem<1>&);
template Tensor<1> dynamical_matrix(const Problem<1>&, const Vector<1>&);
template ComplexMatrix amplification_matrix(const Problem<1>&, const Vector<1>&, double);
template ModeSpectrum mode_spectrum(const Problem<1>&, const Vector<1>&, double);
template std::vector<std::string> state_names(const Problem<2>&);
template Tensor<2> dynamical_matrix(const Problem<2>&, const Vector<2>&);
template ComplexMatrix amplification_matrix(const Problem<2>&, const Vector<2>&, double);
template ModeSpectrum mode_spectrum(const Problem<2>&, const Vector<2>&, double);
template std::vector<std::string> state_names(const Problem<3>&);
template Tensor<3> dynamical_matrix(const Problem<3>&, const Vector<3>&);
template ComplexMatrix amplification_matrix(const Problem<3>&, const Vector<3>&, double);
template ModeSpectrum mode_spectrum(const Problem<3>&, const Vector<3>&, double);

}  // namespace sphstab::analysis
