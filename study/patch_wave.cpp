// SPDX-License-Identifier: MIT
#include "study/patch_wave.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "analysis/amplification.hpp"
#include "analysis/critical_step.hpp"
#include "model/body.hpp"
#include "study/growth_run.hpp"
#include "study/updated_growth_run.hpp"

namespace sphstab::study {
namespace {

constexpr double displacement = 1e-6;  ///< in Δp
constexpr double e_foldings = 2.0;
constexpr double fewest_steps = 10.0, most_steps = 20000.0;

/// From two amplitudes, the error being of first order, to none.
template <class GrowthAt>
double extrapolated(const GrowthAt& growth_at, double amplitude) {
  return 2.0 * growth_at(0.5 * amplitude) - growth_at(amplitude);
}

/// Steps in which a departure grows by `e_foldings`.
int steps_of_growth(double growth_per_step) {
  const double per_step = std::max(std::abs(growth_per_step), 1.0 / most_steps);
  return static_cast<int>(std::clamp(std::ceil(e_foldings / per_step), fewest_steps, most_steps));
}

/// Of the largest amplitude of a patch, where growth from noise is measured.
constexpr double measured_share = 0.1;
/// How often a run from noise is scaled back, and for how many times two e-foldings it is kept at either amplitude.
constexpr long scalings = 400, settling = 10;

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
std::shared_ptr<PerturbedSolver> perturbed_solver(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells) {
  if (problem.scheme.formulation == Formulation::updated_lagrangian)
    return std::make_shared<PerturbedPatch<Dim>>(problem, cells);
  return perturbed_body(problem, periodic_patch(problem, cells));
}

template <int Dim>
PatchWave<Dim> fastest_wave(const Problem<Dim>& problem, const Vector<Dim>& wave_vector, double time_step) {
  const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> modes(
      analysis::amplification_matrix(problem, wave_vector, time_step));
  Eigen::Index fastest = 0;
  modes.eigenvalues().cwiseAbs().maxCoeff(&fastest);
  Eigen::VectorXcd shape = modes.eigenvectors().col(fastest);
  // Of tl-linear theory names v first.
  if (problem.scheme.formulation == Formulation::total_lagrangian_linear)
    std::rotate(shape.begin(), shape.begin() + Dim, shape.end());
  return {wave_vector, shape, modes.eigenvalues()[fastest]};
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
                     double time_step, double amplitude) {
  const auto factors = phases(wave, periodic_patch(problem, cells));
  const int steps = steps_of_growth(wave.growth_per_step());
  Eigen::VectorXd departure = amplitude * (departure_of(wave, problem, cells) * problem.lattice.spacing() /
                                           wave.shape.template head<Dim>().norm());
  const auto before = amplitude_of(wave, factors, departure);
  perturbed_solver(problem, cells)->advance(departure, time_step, steps);
  return std::log(std::abs(amplitude_of(wave, factors, departure) / before)) / steps;
}

template <int Dim>
double seeded_growth(const PatchWave<Dim>& wave, const Problem<Dim>& problem, const LatticeIndex<Dim>& cells,
                     double time_step) {
  return extrapolated([&](double amplitude) { return seeded_growth<Dim>(wave, problem, cells, time_step, amplitude); },
                      displacement);
}

template <int Dim>
double noise_growth(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells, unsigned noise_seed, double time_step,
                    long steps) {
  const auto solver = perturbed_solver(problem, cells);
  double growth_per_step = 0.0;
  const auto run = [&](Eigen::VectorXd& departure, double amplitude, long end) {
    const int stride = static_cast<int>(std::max(1L, end / scalings));
    departure *= amplitude / solver->amplitude(departure);
    for (long step = 0; step < end; step += stride) {
      solver->advance(departure, time_step, stride);
      const double factor = solver->amplitude(departure) / amplitude;
      growth_per_step = std::log(factor) / stride;
      departure /= factor;
    }
  };
  const double largest = measured_share * solver->largest_amplitude();
  assert(std::isfinite(largest));
  Eigen::VectorXd fastest = solver->noise_departure(noise_seed);
  run(fastest, largest, steps);
  const int measured = steps_of_growth(growth_per_step);
  return extrapolated(
      [&](double amplitude) {
        Eigen::VectorXd departure = fastest;
        run(departure, amplitude, settling * measured);  // what its size adds to its shape belongs to the size
        solver->advance(departure, time_step, measured);
        return std::log(solver->amplitude(departure) / amplitude) / measured;
      },
      largest);
}

template std::shared_ptr<PerturbedSolver> perturbed_solver(const Problem<1>&, const LatticeIndex<1>&);
template PatchRadius<1> largest_radius(const Problem<1>&, const LatticeIndex<1>&, double);
template PatchWave<1> fastest_wave(const Problem<1>&, const Vector<1>&, double);
template PatchWave<1> fastest_wave(const Problem<1>&, const LatticeIndex<1>&, double);
template Eigen::VectorXd departure_of(const PatchWave<1>&, const Problem<1>&, const LatticeIndex<1>&);
template double seeded_growth(const PatchWave<1>&, const Problem<1>&, const LatticeIndex<1>&, double, double);
template double seeded_growth(const PatchWave<1>&, const Problem<1>&, const LatticeIndex<1>&, double);
template double noise_growth(const Problem<1>&, const LatticeIndex<1>&, unsigned, double, long);
template std::shared_ptr<PerturbedSolver> perturbed_solver(const Problem<2>&, const LatticeIndex<2>&);
template PatchRadius<2> largest_radius(const Problem<2>&, const LatticeIndex<2>&, double);
template PatchWave<2> fastest_wave(const Problem<2>&, const Vector<2>&, double);
template PatchWave<2> fastest_wave(const Problem<2>&, const LatticeIndex<2>&, double);
template Eigen::VectorXd departure_of(const PatchWave<2>&, const Problem<2>&, const LatticeIndex<2>&);
template double seeded_growth(const PatchWave<2>&, const Problem<2>&, const LatticeIndex<2>&, double, double);
template double seeded_growth(const PatchWave<2>&, const Problem<2>&, const LatticeIndex<2>&, double);
template double noise_growth(const Problem<2>&, const LatticeIndex<2>&, unsigned, double, long);
template std::shared_ptr<PerturbedSolver> perturbed_solver(const Problem<3>&, const LatticeIndex<3>&);
template PatchRadius<3> largest_radius(const Problem<3>&, const LatticeIndex<3>&, double);
template PatchWave<3> fastest_wave(const Problem<3>&, const Vector<3>&, double);
template PatchWave<3> fastest_wave(const Problem<3>&, const LatticeIndex<3>&, double);
template Eigen::VectorXd departure_of(const PatchWave<3>&, const Problem<3>&, const LatticeIndex<3>&);
template double seeded_growth(const PatchWave<3>&, const Problem<3>&, const LatticeIndex<3>&, double, double);
template double seeded_growth(const PatchWave<3>&, const Problem<3>&, const LatticeIndex<3>&, double);
template double noise_growth(const Problem<3>&, const LatticeIndex<3>&, unsigned, double, long);

}  // namespace sphstab::study
