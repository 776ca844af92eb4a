// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include "model/integrator.hpp"
#include "solver/updated_state.hpp"

/// The steps of the integrators of `ul` (model/integrator.hpp) for any system that offers
///   place(r)             makes r the positions of all that follows,
///   forces(state, F)     F(r, v, q), force per mass, into a field,
///   smoothed(state)      v̂(r, v, ρ), a field that is v itself where there is no XSPH,
///   rates(state, v̂, D)   D(r, v, q), rates of density and deviatoric stress,
///   force_feels_velocity whether F depends on v.
/// Every position is placed once. Checked in tests/solver/test_updated_stepper.cpp.
namespace sphstab::solver {

/// r' = r + Δt v̂.
template <int Dim, class Scalar>
void drift(const Scalar& time_step, const Field<Dim, Scalar>& smoothed, UpdatedState<Dim, Scalar>& state) {
  for (int a = 0; a < state.particles(); ++a) state.position[a] += time_step * smoothed[a];
}

/// v' = v + Δt F.
template <int Dim, class Scalar>
void kick(const Scalar& time_step, const UpdatedRates<Dim, Scalar>& rates, UpdatedState<Dim, Scalar>& state) {
  for (int a = 0; a < state.particles(); ++a) state.velocity[a] += time_step * rates.acceleration[a];
}

/// q' = q + Δt D.
template <int Dim, class Scalar>
void strain(const Scalar& time_step, const UpdatedRates<Dim, Scalar>& rates, UpdatedState<Dim, Scalar>& state) {
  for (int a = 0; a < state.particles(); ++a) {
    state.density[a] += time_step * rates.density[a];
    state.deviatoric_stress[a] += time_step * rates.deviatoric_stress[a];
  }
}

/// r and q together, with v̂ and D at (r, v, q).
template <int Dim, class Scalar, class System>
void drift_and_strain(System& system, const Scalar& time_step, UpdatedRates<Dim, Scalar>& rates,
                      UpdatedState<Dim, Scalar>& state) {
  const auto& smoothed = system.smoothed(state);
  system.rates(state, smoothed, rates);
  drift(time_step, smoothed, state);
  strain(time_step, rates, state);
}

/// F and D where the state is placed.
template <int Dim, class Scalar, class System>
void evaluate(System& system, const UpdatedState<Dim, Scalar>& state, UpdatedRates<Dim, Scalar>& rates) {
  system.forces(state, rates.acceleration);
  system.rates(state, system.smoothed(state), rates);
}

/// One step of either predictor-corrector from F0 and D0 (Gray et al., Eqs. 6.14-6.18); `next` takes F and D.
template <int Dim, class Scalar, class System>
void predict_and_correct(System& system, const Scalar& time_step, const UpdatedRates<Dim, Scalar>& first,
                         UpdatedRates<Dim, Scalar>& next, UpdatedState<Dim, Scalar>& state) {
  const Scalar half = time_step / Scalar(2);
  drift(time_step, system.smoothed(state), state);
  for (int a = 0; a < state.particles(); ++a) state.position[a] += half * time_step * first.acceleration[a];
  kick(time_step, first, state);
  strain(time_step, first, state);
  system.place(state.position);
  evaluate(system, state, next);
  kick(half, next, state);
  kick(Scalar(-half), first, state);
  strain(half, next, state);
  strain(Scalar(-half), first, state);
}

/// `steps` steps, or fewer if go_on(step), called after each with its number from 1, says so. A pure function of the
/// state, stored rates included; where they are not known yet, they are evaluated first. Forces are evaluated once a
/// step by leapfrog and predictor-corrector-pec, twice by predictor-corrector, and by Verlet twice if they feel the
/// velocity, otherwise once a step and once at the start; rates once a step, by predictor-corrector twice.
template <int Dim, class Scalar, class System, class GoOn>
void advance(Integrator integrator, System& system, const Scalar& time_step, long steps,
             UpdatedState<Dim, Scalar>& state, UpdatedRates<Dim, Scalar>& first, UpdatedRates<Dim, Scalar>& next,
             const GoOn& go_on) {
  const Scalar half = time_step / Scalar(2);
  system.place(state.position);
  switch (integrator) {
    case Integrator::leapfrog:
      for (long n = 1; n <= steps; ++n) {
        if (n > 1) system.place(state.position);
        system.forces(state, first.acceleration);
        kick(time_step, first, state);
        drift_and_strain(system, time_step, first, state);
        if (!go_on(n)) return;
      }
      return;
    case Integrator::verlet:
      for (long n = 1; n <= steps; ++n) {
        if (n == 1 || system.force_feels_velocity()) system.forces(state, first.acceleration);
        kick(half, first, state);
        drift_and_strain(system, time_step, first, state);
        system.place(state.position);
        system.forces(state, first.acceleration);
        kick(half, first, state);
        if (!go_on(n)) return;
      }
      return;
    case Integrator::predictor_corrector:
      for (long n = 1; n <= steps; ++n) {
        evaluate(system, state, first);
        predict_and_correct(system, time_step, first, next, state);
        if (!go_on(n)) return;
      }
      return;
    case Integrator::predictor_corrector_pec:
      for (long n = 1; n <= steps; ++n) {
        predict_and_correct(system, time_step, state.stored, next, state);
        std::swap(state.stored, next);
        if (!go_on(n)) return;
      }
      return;
  }
}

}  // namespace sphstab::solver
