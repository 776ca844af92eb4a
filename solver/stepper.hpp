// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "model/integrator.hpp"
#include "model/scheme.hpp"
#include "solver/state.hpp"

namespace sphstab::solver {

/// v' = v + Δt (A − c v). The damping is a pass of its own: v is first scaled by 1 − c Δt.
template <int Dim, class Scalar>
void kick(const Field<Dim, Scalar>& A, const std::optional<Damping>& damping, Real<Scalar> time_step,
          Field<Dim, Scalar>& velocity) {
  if (damping)
    for (auto& v : velocity) v *= 1 - static_cast<Real<Scalar>>(damping->rate) * time_step;
  for (std::size_t a = 0; a < velocity.size(); ++a) velocity[a] += time_step * A[a];
}

/// r' = r + Δt v.
template <int Dim, class Scalar>
void drift(Real<Scalar> time_step, State<Dim, Scalar>& state) {
  for (std::size_t a = 0; a < state.displacement.size(); ++a) state.displacement[a] += time_step * state.velocity[a];
}

/// `steps` steps of the integrator for F(r, v) = A(r) − c v, where undamped(displacement, A) writes A into the buffer.
/// Zhang's Eqs. 10 and 11 are `leapfrog` with v of the half step before. A pure function of (r, v): a call with n steps
/// is n calls with one. It evaluates A n times with leapfrog and n + 1 times with Verlet, whose steps share the A
/// between them, damped or not. Checked in tests/solver/test_stepper.cpp.
template <int Dim, class Scalar, class Undamped>
void advance(Integrator integrator, const Undamped& undamped, const std::optional<Damping>& damping,
             Real<Scalar> time_step, long steps, State<Dim, Scalar>& state, Field<Dim, Scalar>& A) {
  switch (integrator) {
    case Integrator::predictor_corrector:
    case Integrator::predictor_corrector_pec:
      throw for_updated_lagrangian_only(integrator);
    case Integrator::leapfrog:
      for (long n = 0; n < steps; ++n) {
        undamped(state.displacement, A);
        kick<Dim, Scalar>(A, damping, time_step, state.velocity);
        drift(time_step, state);
      }
      return;
    case Integrator::verlet:
      undamped(state.displacement, A);
      for (long n = 0; n < steps; ++n) {
        kick<Dim, Scalar>(A, damping, time_step / 2, state.velocity);
        drift(time_step, state);
        undamped(state.displacement, A);
        kick<Dim, Scalar>(A, damping, time_step / 2, state.velocity);
      }
      return;
  }
}

}  // namespace sphstab::solver
