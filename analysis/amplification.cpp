// SPDX-License-Identifier: MIT
#include "analysis/amplification.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <limits>
#include <string_view>

#include "analysis/acoustic_form.hpp"
#include "analysis/finite_strain.hpp"
#include "analysis/gradient_symbol.hpp"
#include "analysis/mode_step.hpp"
#include "analysis/step_matrix.hpp"

namespace sphstab::analysis {
namespace {

/// What a spectral radius of exactly 1 may exceed it by.
constexpr double few_roundings = 8.0 * std::numeric_limits<double>::epsilon();
/// The same of an eigensolver on a matrix of up to 23 rows.
constexpr double solver_error = 1e-12;
/// Eigenvalues this close are one, and a matrix with a smaller singular value has a null vector: a defective eigenvalue
/// of order two is off by the root of the rounding, one of order three by its cube root.
constexpr double same_eigenvalue = 1e-5;
constexpr double least_coupling = 1e-9;

/// M is a multiple of I plus (coupling D) Dᵀ: it lacks an eigenvector where that rank-one part is nilpotent.
template <int Dim>
bool lacks_eigenvector(const AcousticForm<Dim>& form, const Vector<Dim>& D) {
  const Vector<Dim> image = form.coupling * D;
  const double size = image.norm() * D.norm();
  return size > 0.0 && std::abs(image.dot(D)) <= few_roundings * size;
}

bool is_updated(const Scheme& scheme) { return scheme.formulation == Formulation::updated_lagrangian; }

/// The quantity's name with each axis after it.
template <int Dim>
void add_vector(const std::string& quantity, std::vector<std::string>& names) {
  for (int axis = 0; axis < Dim; ++axis) names.push_back(quantity + "xyz"[axis]);
}

template <int Dim>
void add_density_and_stress(const std::string& density, const std::string& stress, std::vector<std::string>& names) {
  names.push_back(density);
  for (const auto& [i, j] : symmetric_places<Dim>) names.push_back(stress + "xyz"[i] + "xyz"[j]);
}

/// Whether every eigenvalue of E in `eigenvalues` that lies on the unit circle has as many eigenvectors as it is often
/// there.
bool semisimple_on_circle(const ComplexMatrix& E, const std::vector<std::complex<double>>& eigenvalues) {
  const auto identity = ComplexMatrix::Identity(E.rows(), E.cols());
  return std::all_of(eigenvalues.begin(), eigenvalues.end(), [&](std::complex<double> eigenvalue) {
    if (std::abs(eigenvalue) < 1.0 - same_eigenvalue) return true;
    const auto equal = std::count_if(eigenvalues.begin(), eigenvalues.end(), [&](std::complex<double> other) {
      return std::abs(other - eigenvalue) <= same_eigenvalue;
    });
    const Eigen::VectorXd values = (E - eigenvalue * identity).jacobiSvd().singularValues();
    return (values.array() <= least_coupling * std::max(1.0, values[0])).count() >= equal;
  });
}

/// The spectrum of `ul`: that of the motion reduced to the forces of ρ and S, and what is left out of it, eigenvalues 1
/// of states without force and 0 of their stored rates.
template <int Dim>
ModeSpectrum updated_spectrum(const Problem<Dim>& problem, const Vector<Dim>& wave_vector, double time_step) {
  const UpdatedWave<Dim> wave = UpdatedLagrangian<Dim>(problem)(wave_vector);
  const Eigen::VectorXcd reduced = step_matrix(reduced_motion(wave), problem.integrator, time_step).eigenvalues();
  const ComplexMatrix E = step_matrix(full_motion(wave), problem.integrator, time_step);
  ModeSpectrum spectrum{{reduced.begin(), reduced.end()}, std::max(1.0, reduced.cwiseAbs().maxCoeff()), true};
  constexpr int without_force = UpdatedWave<Dim>::rates - Dim;
  spectrum.eigenvalues.resize(spectrum.eigenvalues.size() + without_force, 1.0);
  spectrum.eigenvalues.resize(E.rows(), 0.0);
  spectrum.power_bounded =
      spectrum.spectral_radius <= 1.0 + solver_error && semisimple_on_circle(E, spectrum.eigenvalues);
  return spectrum;
}

/// The spectrum of a total-Lagrangian mode: the pair of each ω², all real.
template <int Dim>
ModeSpectrum spectrum_of(const Problem<Dim>& problem, const Vector<Dim>& omega_squared, double time_step,
                         bool lacks_eigenvector) {
  ModeSpectrum spectrum{{}, 0.0, true};
  for (const double value : omega_squared) {
    const ModeStep step(problem.integrator, problem.scheme.damping, value);
    for (const auto& eigenvalue : step.eigenvalues(time_step)) spectrum.eigenvalues.push_back(eigenvalue);
    const double radius = step.spectral_radius(time_step);
    const bool on_circle = radius >= 1.0 - few_roundings;
    spectrum.spectral_radius = std::max(spectrum.spectral_radius, radius);
    spectrum.power_bounded = spectrum.power_bounded && radius <= 1.0 + few_roundings && !step.defective(time_step) &&
                             !(on_circle && lacks_eigenvector);
  }
  return spectrum;
}

}  // namespace

template <int Dim>
std::vector<std::string> state_names(const Problem<Dim>& problem) {
  std::vector<std::string> names;
  if (problem.scheme.formulation == Formulation::total_lagrangian_linear) {
    add_vector<Dim>("v", names);
    add_vector<Dim>("s", names);
    return names;
  }
  add_vector<Dim>("", names);
  add_vector<Dim>("v", names);
  if (is_finite_strain(problem.scheme.formulation)) return names;
  add_density_and_stress<Dim>("rho", "S", names);
  if (problem.integrator != Integrator::predictor_corrector_pec) return names;
  add_vector<Dim>("F", names);
  add_density_and_stress<Dim>("drho", "dS", names);
  return names;
}

template <int Dim>
Tensor<Dim> dynamical_matrix(const Problem<Dim>& problem, const Vector<Dim>& wave_vector) {
  switch (problem.scheme.formulation) {
    case Formulation::total_lagrangian_linear:
      break;
    case Formulation::total_lagrangian_corotated:
    case Formulation::total_lagrangian_pk1:
      return FiniteStrain<Dim>(problem).dynamics(wave_vector).M;
    case Formulation::updated_lagrangian:
      return UpdatedLagrangian<Dim>(problem)(wave_vector).dynamical_matrix();
  }
  const GradientSymbol<Dim> symbol(problem);
  return AcousticForm<Dim>(problem, symbol.consistency()).dynamical_matrix(symbol(wave_vector));
}

template <int Dim>
ComplexMatrix amplification_matrix(const Problem<Dim>& problem, const Vector<Dim>& wave_vector, double time_step) {
  if (is_updated(problem.scheme))
    return step_matrix(full_motion(UpdatedLagrangian<Dim>(problem)(wave_vector)), problem.integrator, time_step);
  const Tensor<Dim> M = dynamical_matrix(problem, wave_vector), I = Tensor<Dim>::Identity();
  const double dt = time_step;
  const double a = problem.scheme.damping ? problem.scheme.damping->rate * dt : 0.0, b = 1.0 - 0.5 * a;
  const int s = is_finite_strain(problem.scheme.formulation) ? 0 : Dim, v = Dim - s;  // where each begins
  Eigen::Matrix<double, 2 * Dim, 2 * Dim> E;
  const auto fill = [&](const Tensor<Dim>& vv, const Tensor<Dim>& vs, const Tensor<Dim>& sv, const Tensor<Dim>& ss) {
    E.template block<Dim, Dim>(v, v) = vv;
    E.template block<Dim, Dim>(v, s) = vs;
    E.template block<Dim, Dim>(s, v) = sv;
    E.template block<Dim, Dim>(s, s) = ss;
  };
  switch (problem.integrator) {
    case Integrator::leapfrog:
      fill((1.0 - a) * I, -dt * M, dt * (1.0 - a) * I, I - dt * dt * M);
      break;
    case Integrator::verlet:
      fill(b * b * I - 0.5 * b * dt * dt * M, -0.5 * (1.0 + b) * dt * M + 0.25 * dt * dt * dt * M * M, b * dt * I,
           I - 0.5 * dt * dt * M);
      break;
    case Integrator::predictor_corrector:
    case Integrator::predictor_corrector_pec:
      throw for_updated_lagrangian_only(problem.integrator);
  }
  return E.template cast<std::complex<double>>();
}

template <int Dim>
ModeSpectrum mode_spectrum(const Problem<Dim>& problem, const Vector<Dim>& wave_vector, double time_step) {
  if (is_updated(problem.scheme)) return updated_spectrum(problem, wave_vector, time_step);
  if (is_finite_strain(problem.scheme.formulation)) {
    Vector<Dim> omega_squared = FiniteStrain<Dim>(problem).dynamics(wave_vector).omega_squared().real();
    return spectrum_of<Dim>(problem, omega_squared.reverse(), time_step, false);
  }
  const GradientSymbol<Dim> symbol(problem);
  const AcousticForm<Dim> form(problem, symbol.consistency());
  const Vector<Dim> D = symbol.cleaned(wave_vector);
  Vector<Dim> omega_squared = Vector<Dim>::Constant(form.transverse(D));
  omega_squared[0] = form.longitudinal(D);
  return spectrum_of<Dim>(problem, omega_squared, time_step, lacks_eigenvector(form, D));
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
