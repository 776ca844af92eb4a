// SPDX-License-Identifier: MIT
#pragma once

#include "model/names.hpp"

namespace sphstab {

/// Time integrators. The state is (r, v); F is the force per mass.
enum class Integrator {
  leapfrog,  ///< kick, drift: v' = v + Δt F(r, v); r' = r + Δt v'
  verlet     ///< kick, drift, kick: v½ = v + ½Δt F(r, v); r' = r + Δt v½; v' = v½ + ½Δt F(r', v½)
};

template <>
struct Names<Integrator> {
  static constexpr std::array<Named<Integrator>, 2> table{
      {{Integrator::leapfrog, "leapfrog"}, {Integrator::verlet, "verlet"}}};
};

}  // namespace sphstab
