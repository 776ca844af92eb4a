// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "model/material.hpp"

namespace sphstab::study {

/// A step rule Δt = factor · unit of another code, and what this case makes of it.
struct RuleOfThumb {
  std::string_view rule;                 ///< the code and the name of the rule there
  std::string_view formula;              ///< of the unit, with K and G the three-dimensional moduli
  double unit;                           ///< h / wave speed of this case, a time
  std::optional<double> default_factor;  ///< nothing where the code leaves it to the user
};

/// The documented rules of public codes for elastic solids, read from their sources or manuals in November 2026:
///   SPHinXsys        solid_dynamics::AcousticTimeStep, 0.6 h / √(K/ρ) (elastic_dynamics, elastic_solid)
///   TrixiParticles   TotalLagrangianSPHSystem with StepsizeCallback(cfl), h / √(K/ρ), K = E/(d(1−2ν)) in d dimensions
///   DualSPHysics     FlexStruc, h / √((K+4G/3)/ρ); CFL number 0.2 in a published solid example
///   Radioss          SPH cell step, 0.3 h / √((K+4G/3)/ρ) (theory manual, SPH time step control)
/// All take h of a kernel with support 2h. Velocities are zero here.
std::vector<RuleOfThumb> rules_of_thumb(const Material& material, double smoothing_length, int dimension);

}  // namespace sphstab::study
