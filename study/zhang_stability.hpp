// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "model/body.hpp"
#include "solver/state.hpp"
#include "study/bisection.hpp"
#include "study/zhang_statics.hpp"

/// The stability tests of Zhang, Hu, Cui & Wang on the plate of their Case 1 (Figs. 15-18). Steps are times. Tested in
/// tests/study/test_zhang_cases.cpp.
namespace sphstab::study::zhang {

/// A plate: its H/Δ, whether its sums are normalised, and its plane.
struct PlateKind {
  double h_over_spacing;
  KernelNormalisation normalisation = KernelNormalisation::none;
  Plane plane = Plane::stress;
};

Problem<2> plate_problem(const PlateKind& kind);
Body<2> plate_body(const PlateKind& kind, double load = 1.0);

/// Largest angular frequency of a body (1/time) and the mode that has it, by the spectrum.
struct FastestMode {
  double omega;
  solver::Field<2> displacement;
};
FastestMode fastest_mode(const Problem<2>& problem, const Body<2>& body);

/// 2/ω of the plate: it does not depend on the load.
double critical_step(const PlateKind& kind);

/// The H/Δ with the smallest critical step, and that step (Fig. 16).
std::pair<double, double> smallest_critical_step(KernelNormalisation normalisation, Plane plane);

/// The H/Δ below which normalisation raises the critical step and above which it lowers it.
double crossing_of_normalisation(Plane plane);

/// The H/Δ between which a step is above the critical one.
std::pair<double, double> unstable_range(double time_step, KernelNormalisation normalisation);

/// By bisection on runs about the loaded plate at rest, of at most `horizon` steps if it is given.
Bisection bisect_loaded(const Problem<2>& problem, const Body<2>& body, const solver::Field<2>& rest, double tolerance,
                        std::optional<long> horizon = std::nullopt);

/// Growth (1/time) of what departs from the loaded plate at rest at a small step, in a run of so many steps, or four
/// times as many while it is undecided; absent: none shows.
std::optional<double> growth_rate(const Problem<2>& problem, const Body<2>& body, const solver::Field<2>& rest,
                                  double time_step, long horizon);

/// Where a nonlinear plate (`density_in_momentum` equation-of-state) comes to rest by running, with steps that are
/// halved until it does; absent: it never did.
std::optional<solver::Field<2>> nonlinear_rest(const Problem<2>& problem, const Body<2>& body);

/// ln|λ| a step of a leapfrog mode above its limit: λ = 1 − z/2 ± √(z²/4 − z), z = (ω Δt)², so that
/// ln|λ| = 2 arcosh(ω Δt/2).
double growth_per_step(double omega, double time_step);

/// The same by running the loaded plate so many steps from its rest with one particle pushed aside. What departs from
/// rest is scaled back again and again, which a linear scheme allows. After n steps a second mode that grows slower by
/// g takes g exp(−2gn) off, at most 1/(2en) whatever g is.
double measured_growth_per_step(const Problem<2>& problem, const Body<2>& body, const solver::Field<2>& rest,
                                double time_step, long steps);

}  // namespace sphstab::study::zhang
