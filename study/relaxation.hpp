// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "model/body.hpp"
#include "solver/state.hpp"

namespace sphstab::study {

struct RelaxationOptions {
  double time_step;  ///< at most 0.85 of the critical step without damping
  double tolerance = 1e-10;
  long largest_steps = 10'000'000;
  std::function<void(long steps, double residual)> progress = nullptr;
};

/// Where a body comes to rest under its loads.
template <int Dim>
struct Relaxation {
  bool converged;
  solver::Field<Dim> displacement;
  long steps;
  double residual;            ///< norm of the remaining forces over that of the forces at rest
  double displacement_error;  ///< estimated, over the norm of the displacement
  double damping_rate;        ///< of the last steps
};

/// Static equilibrium by running the problem with mass-proportional damping from rest, until both residual and
/// estimated error of the displacement are below the tolerance; not converged after `largest_steps`, or if the run
/// explodes.
///
/// Norms are √(Σ m y²) with m = ρ0 V N. A damping rate of the scheme is kept. Otherwise it is adapted to twice the
/// frequency of the slowest motion there is, which is then damped critically: ω² is the smaller of the Rayleigh
/// quotients (strain over kinetic energy of a field y) of displacement and velocity. The first tells the slowest loaded
/// motion, the second what creeps on when all else has come to rest, such as nearly zero-energy modes. The error of the
/// displacement is estimated as that of the residual in the mode with the smallest quotient found.
///
/// In finite strain and `ul` the velocity tells nothing, and `slowest` is that of the displacement alone; `ul`, which
/// has no damping of its own, has its velocities reduced every few steps. A run ends, not converged, when `gives_up`
/// says so of the displacements.
///
/// In directions in which no particle is clamped, a mean load only makes the body fall; it is left out, and the mass
/// centre stays where it is. Throws InvalidInput (`time_step`, `tolerance`) unless both are positive. Tested in
/// tests/study/test_relaxation.cpp.
template <int Dim>
Relaxation<Dim> relax(const Problem<Dim>& problem, const Body<Dim>& body, const RelaxationOptions& options,
                      const std::function<bool(const solver::Field<Dim>&)>& gives_up = nullptr);

extern template Relaxation<1> relax(const Problem<1>&, const Body<1>&, const RelaxationOptions&,
                                    const std::function<bool(const solver::Field<1>&)>&);
extern template Relaxation<2> relax(const Problem<2>&, const Body<2>&, const RelaxationOptions&,
                                    const std::function<bool(const solver::Field<2>&)>&);
extern template Relaxation<3> relax(const Problem<3>&, const Body<3>&, const RelaxationOptions&,
                                    const std::function<bool(const solver::Field<3>&)>&);

}  // namespace sphstab::study
