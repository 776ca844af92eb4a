// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "model/names.hpp"

namespace sphstab {

/// The SPH discretisation of the solid.
enum class Formulation {
  total_lagrangian_linear  ///< Zhang, Hu, Cui & Wang, Eqs. 6-9: small strain, kernel gradients of the reference state
};

template <>
struct Names<Formulation> {
  static constexpr std::array<Named<Formulation>, 1> table{{{Formulation::total_lagrangian_linear, "tl-linear"}}};
};

/// The density in σ/ρ² of Zhang's Eq. 7; Eq. 9 takes m/ρ0 in both cases (errata.md Z9).
enum class MomentumDensity {
  frozen,            ///< ρ0
  equation_of_state  ///< ρ_i = ρ0 exp(−tr₃ ε_i), Eq. 6
};

template <>
struct Names<MomentumDensity> {
  static constexpr std::array<Named<MomentumDensity>, 2> table{
      {{MomentumDensity::frozen, "frozen"}, {MomentumDensity::equation_of_state, "equation-of-state"}}};
};

/// Division of the strain sum and the momentum sum of each particle by N_i = Σ_j V_j W_ij, W(0) included (Zhang, after
/// Eq. 11).
enum class KernelNormalisation { none, sum };

template <>
struct Names<KernelNormalisation> {
  static constexpr std::array<Named<KernelNormalisation>, 2> table{
      {{KernelNormalisation::none, "none"}, {KernelNormalisation::sum, "sum"}}};
};

/// Mass-proportional damping: force −rate · v per mass.
struct Damping {
  double rate;  ///< 1 / time, > 0
};

/// A scheme: its formulation and the terms that are switched on. An absent optional is a term that costs nothing.
struct Scheme {
  Formulation formulation = Formulation::total_lagrangian_linear;
  MomentumDensity momentum_density = MomentumDensity::frozen;
  KernelNormalisation kernel_normalisation = KernelNormalisation::none;
  std::optional<Damping> damping;
};

}  // namespace sphstab
