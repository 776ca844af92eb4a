// SPDX-License-Identifier: MIT
#include "study/patch_wave.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "analysis/amplification.hpp"
#include "analysis/critical_step.hpp"
#include "model/body.hpp"
#include "study/updated_growth_run.hpp"

namespace sphstab::study {
namespace {

constexpr double displacement = 1e-6;  ///< in Δp
constexpr double e_foldings = 2.0;
constexpr double fewest_steps = 10.0, most_steps = 20000.0;

/// e^{ik·x} of every particle.
template <int Dim>
Eigen::VectorXcd phases(const PatchWave<Dim>& wave, const Body<Dim>& patch) {
  Eigen::VectorXcd factors(patch.size());
  for (int a = 0; a < patch.size(); ++a) factors[a] = std::polar(1.0, wave.wave_vector.dot(patch.position[a]));
  return factors;
}

/// The share of the wave in a departure, up to a factor.
template <int Dim>
std::complex<double> amplitude_of(const PatchWave<Dim>& wave, const Eigen::VectorXcd& phases,
                                  const Eigen::VectorXd& departure) {
  const Eigen::Index size = wave.shape.size();
  return wave.shape.dot(departure.reshaped(size, phases.size()) * phases.conjugate());
}

}  // namespace

template <int Dim>
PatchWave<Dim> fastest_wave(const Problem<Dim>& problem, const Vector<Dim>& wave_vector, double time_step) {
  const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> modes(
      analysis::amplification_matrix(problem, wave_vector, time_step));
  Eigen::Index fastest = 0;
  modes.eigenvalues().cwiseAbs().maxCoeff(&fastest);
  return {wave_vector, modes.eigenvectors().col(fastest), modes.eigenvalues()[fastest]};
}

template <int Dim>
PatchRadius<Dim> largest_radius(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells, double time_step) {
  PatchRadius<Dim> largest{Vector<Dim>::Zero(), 0.0};
  for (const auto& k : analysis::patch_wave_vectors<Dim>(problem.lattice, cells)) {
    const double radius = analysis::mode_spectrum<Dim>(problem, k, time_step).spectral_radius;
    if (radius > largest.spectral_radius) largest = {k, radius};
  }
  return largest;
}

template <int Dim>
PatchWave<Dim> fastest_wave(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells, double time_step) {
  return fastest_wave<Dim>(problem, largest_radius(problem, cells, time_step).wave_vector, time_step);
}

template <int Dim>
Eigen::VectorXd departure_of(const PatchWave<Dim>& wave, const Problem<Dim>& problem, const LatticeIndex<Dim>& cells) {
  constexpr double eighth = 0.7853981633974483;
  const auto factors = phases(wave, periodic_patch(problem, cells));
  return (wave.shape * factors.transpose() * std::polar(1.0, eighth)).real().reshaped();
}

template <int Dim>
double seeded_growth(const PatchWave<Dim>& wave, const Problem<Dim>& problem, const LatticeIndex<Dim>& cells,
                     double time_step) {
  const auto factors = phases(wave, periodic_patch(problem, cells));
  const double per_step = std::max(std::abs(wave.growth_per_step()), 1.0 / most_steps);
  const int steps = static_cast<int>(std::clamp(std::ceil(e_foldings / per_step), fewest_steps, most_steps));
  PerturbedPatch<Dim> patch(problem, cells);
  const Eigen::VectorXd start =
      departure_of(wave, problem, cells) * problem.lattice.spacing() / wave.shape.template head<Dim>().norm();
  const auto growth_at = [&](double amplitude) {
    Eigen::VectorXd departure = amplitude * start;
    const auto before = amplitude_of(wave, factors, departure);
    patch.advance(departure, time_step, steps);
    return std::log(std::abs(amplitude_of(wave, factors, departure) / before)) / steps;
  };
  return 2.0 * growth_at(0.5 * displacement) - growth_at(displacement);
}

template PatchRadius<1> largest_radius(const Problem<1>&, const LatticeIndex<1>&, double);
template PatchWave<1> fastest_wave(const Problem<1>&, const Vector<1>&, double);
template PatchWave<1> fastest_wave(const Problem<1>&, const LatticeIndex<1>&, double);
template Eigen::VectorXd departure_of(const PatchWave<1>&, const Problem<1>&, const LatticeIndex<1>&);
template double seeded_growth(const PatchWave<1>&, const Problem<1>&, const LatticeIndex<1>&, double);
template PatchRadius<2> largest_radius(const Problem<2>&, const LatticeIndex<2>&, double);
template PatchWave<2> fastest_wave(const Problem<2>&, const Vector<2>&, double);
template PatchWave<2> fastest_wave(const Problem<2>&, const LatticeIndex<2>&, double);
template Eigen::VectorXd departure_of(const PatchWave<2>&, const Problem<2>&, const LatticeIndex<2>&);
template double seeded_growth(const PatchWave<2>&, const Problem<2>&, const LatticeIndex<2>&, double);
template PatchRadius<3> largest_radius(const Problem<3>&, const LatticeIndex<3>&, double);
template PatchWave<3> fastest_wave(const Problem<3>&, const Vector<3>&, double);
template PatchWave<3> fastest_wave(const Problem<3>&, const LatticeIndex<3>&, double);
template Eigen::VectorXd departure_of(const PatchWave<3>&, const Problem<3>&, const LatticeIndex<3>&);
template double seeded_growth(const PatchWave<3>&, const Problem<3>&, const LatticeIndex<3>&, double);

}  // namespace sphstab::study
