// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "model/names.hpp"

namespace sphstab {

/// Time integrators. The state is (r, v) and, in `ul`, q = (ρ, S); F is the force per mass, D the rate of q, v̂ the
/// XSPH velocity (v itself without XSPH).
enum class Integrator {
  /// Kick, drift: v' = v + Δt F(r, v, q); then r' = r + Δt v̂' and q' = q + Δt D(r, v', q).
  leapfrog,
  /// Kick, drift, kick: v½ = v + ½Δt F(r, v, q); r and q by Δt with v̂½ and D(r, v½, q); v' = v½ + ½Δt F(r', v½, q').
  verlet,
  /// Gray, Monaghan & Swift, Eqs. 6.14-6.18, rates evaluated again from the corrected state: F0, D0 at (r, v, q);
  /// v_p = v + Δt F0, r' = r + Δt v̂ + ½Δt² F0, q_p = q + Δt D0; F, D at (r', v_p, q_p); v' = v_p + ½Δt (F − F0),
  /// q' = q_p + ½Δt (D − D0). For `ul` only.
  predictor_corrector,
  /// The same with F0, D0 kept from the F, D of the step before. For `ul` only.
  predictor_corrector_pec
};

template <>
struct Names<Integrator> {
  static constexpr std::array<Named<Integrator>, 4> table{
      {{Integrator::leapfrog, "leapfrog"},
       {Integrator::verlet, "verlet"},
       {Integrator::predictor_corrector, "predictor-corrector"},
       {Integrator::predictor_corrector_pec, "predictor-corrector-pec"}}};
};

/// Those of total-Lagrangian schemes.
inline constexpr std::array total_lagrangian_integrators{Names<Integrator>::table[0], Names<Integrator>::table[1]};

/// The error for an integrator that a total-Lagrangian scheme is given.
inline InvalidInput for_updated_lagrangian_only(Integrator integrator) {
  return InvalidInput("integrator: " + std::string(name_of(integrator)) + " is for the scheme ul only");
}

}  // namespace sphstab
