// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <complex>

#include "model/problem.hpp"
#include "study/perturbation_run.hpp"

namespace sphstab::study {

/// The running solver of a periodic patch about its base state: that of `ul`, or a total-Lagrangian one.
template <int Dim>
std::shared_ptr<PerturbedSolver> perturbed_solver(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells);

/// A wave that a periodic patch admits, by theory: an eigenvector of E(k) at one step.
template <int Dim>
struct PatchWave {
  Vector<Dim> wave_vector;
  Eigen::VectorXcd shape;  ///< displacements, v and what else a particle of the solver has, in its order; of norm 1
  std::complex<double> eigenvalue;

  /// ln |λ|.
  double growth_per_step() const { return std::log(std::abs(eigenvalue)); }
};

/// The largest spectral radius of E(k) over the wave vectors that a patch admits, and where it is.
template <int Dim>
struct PatchRadius {
  Vector<Dim> wave_vector;
  double spectral_radius;
};
template <int Dim>
PatchRadius<Dim> largest_radius(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells, double time_step);

/// The one whose |λ| is largest, at one wave vector or of all that the patch admits.
template <int Dim>
PatchWave<Dim> fastest_wave(const Problem<Dim>& problem, const Vector<Dim>& wave_vector, double time_step);
template <int Dim>
PatchWave<Dim> fastest_wave(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells, double time_step);

/// Re(shape e^{ik·x + iπ/4}) on every particle: off the origin, because at a zone boundary a sine would vanish on all.
template <int Dim>
Eigen::VectorXd departure_of(const PatchWave<Dim>& wave, const Problem<Dim>& problem, const LatticeIndex<Dim>& cells);

/// The growth per step of the running solver that starts from this wave: ln of the ratio of its Bloch amplitudes
/// (projected on the shape) over two e-foldings, but 10 to 20 000 steps, per step. At displacements of `amplitude` Δp;
/// or at 1e-6 Δp and half that, extrapolated to none: their error is of first order where neighbours sit on a kink of
/// W'' and where three cells repeat the wave, which by the square of its strains drives itself; of second elsewhere.
/// Tested in tests/ladder/test_updated_growth.cpp and test_finite_strain_growth.cpp.
template <int Dim>
double seeded_growth(const PatchWave<Dim>& wave, const Problem<Dim>& problem, const LatticeIndex<Dim>& cells,
                     double time_step, double amplitude);
template <int Dim>
double seeded_growth(const PatchWave<Dim>& wave, const Problem<Dim>& problem, const LatticeIndex<Dim>& cells,
                     double time_step);

/// The growth per step of the fastest wave that noise holds, of a scheme that is not linear. The run is scaled back to
/// a small amplitude again and again for so many steps, until slower waves are left far behind; then the growth of its
/// amplitude is measured over two e-foldings from a tenth of the largest one and from half of that, extrapolated to
/// none. What is left is the rounding of positions, or of 1 + strain.
/// Tested in tests/ladder/test_updated_growth.cpp and test_finite_strain_growth.cpp.
template <int Dim>
double noise_growth(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells, unsigned noise_seed, double time_step,
                    long steps);

}  // namespace sphstab::study
