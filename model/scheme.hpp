// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "model/names.hpp"

namespace sphstab {

/// The SPH discretisation of the solid.
enum class Formulation {
  total_lagrangian_linear,  ///< Zhang, Hu, Cui & Wang, Eqs. 6-9: small strain, kernel gradients of the reference state
  /// Tran-Duc, Meylan & Thamwattana, Sec. 2.3: renormalised gradients of the reference state, force R·S
  total_lagrangian_corotated,
  total_lagrangian_pk1,  ///< the same with the force F·S of the first Piola-Kirchhoff stress
  updated_lagrangian     ///< Gray, Monaghan & Swift, Eqs. 3.1-3.14: kernel gradients of the present state
};

template <>
struct Names<Formulation> {
  static constexpr std::array<Named<Formulation>, 4> table{{{Formulation::total_lagrangian_linear, "tl-linear"},
                                                            {Formulation::total_lagrangian_corotated, "tl-corotated"},
                                                            {Formulation::total_lagrangian_pk1, "tl-pk1"},
                                                            {Formulation::updated_lagrangian, "ul"}}};
};

constexpr bool is_total_lagrangian(Formulation formulation) { return formulation != Formulation::updated_lagrangian; }

/// Whether strains and rotations may be large and the gradients are renormalised.
constexpr bool is_finite_strain(Formulation formulation) {
  return formulation == Formulation::total_lagrangian_corotated || formulation == Formulation::total_lagrangian_pk1;
}

/// The second Piola-Kirchhoff stress S of finite strain, E = (FᵀF − I)/2 Green's strain, C = FᵀF, J = det F; in two
/// dimensions of plane strain, in one of uniaxial strain.
enum class ElasticLaw {
  saint_venant_kirchhoff,  ///< S = λ tr(E) I + 2 G E
  neo_hookean              ///< S = G (I − C⁻¹) + λ ln(J) C⁻¹, of tl-pk1 only
};

template <>
struct Names<ElasticLaw> {
  static constexpr std::array<Named<ElasticLaw>, 2> table{
      {{ElasticLaw::saint_venant_kirchhoff, "saint-venant-kirchhoff"}, {ElasticLaw::neo_hookean, "neo-hookean"}}};
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

/// The weight φ of the artificial stress of a pair.
enum class ArtificialStressWeight {
  kernel_ratio,   ///< (W(r)/W(Δp))ⁿ, Gray et al. Eq. 3.13
  distance_ratio  ///< (r/Δp)ⁿ, as printed by Tran-Duc et al. (errata.md T3)
};

template <>
struct Names<ArtificialStressWeight> {
  static constexpr std::array<Named<ArtificialStressWeight>, 2> table{
      {{ArtificialStressWeight::kernel_ratio, "kernel-ratio"},
       {ArtificialStressWeight::distance_ratio, "distance-ratio"}}};
};

/// What the theory takes the artificial stress R for when the state is perturbed.
enum class ArtificialStressLinearisation {
  exact,  ///< R follows the perturbed stress, its principal axes included
  frozen  ///< R is constant, as in the published analysis
};

template <>
struct Names<ArtificialStressLinearisation> {
  static constexpr std::array<Named<ArtificialStressLinearisation>, 2> table{
      {{ArtificialStressLinearisation::exact, "exact"}, {ArtificialStressLinearisation::frozen, "frozen"}}};
};

/// The side from which a principal stress of exactly zero is linearised: R has a kink there.
enum class ZeroStressSide {
  compression,  ///< R and δR are zero
  tension       ///< R is zero, δR that of a stress just above zero
};

template <>
struct Names<ZeroStressSide> {
  static constexpr std::array<Named<ZeroStressSide>, 2> table{
      {{ZeroStressSide::compression, "compression"}, {ZeroStressSide::tension, "tension"}}};
};

/// Artificial stress, Gray et al. Eqs. 3.12-3.14, 5.31: (R_a + R_b) φ beside the stresses of a pair, where R has the
/// principal axes of σ and −ε σ_i/ρ² for each positive principal stress σ_i, zero for the others.
struct ArtificialStress {
  double epsilon;         ///< > 0
  double exponent = 4.0;  ///< n of φ
  ArtificialStressWeight weight = ArtificialStressWeight::kernel_ratio;
  ArtificialStressLinearisation linearisation = ArtificialStressLinearisation::exact;
  ZeroStressSide zero_side = ZeroStressSide::compression;
};

/// XSPH, Gray et al. Eq. 3.6: particles, densities and stresses move with v̂_a = v_a + ε̃ Σ (m_b/ρ̄_ab)(v_b − v_a) W_ab.
struct Xsph {
  double epsilon;  ///< ε̃ ≠ 0
};

/// Which pairs the viscosity acts on.
enum class ViscousPairs {
  all,         ///< on approach and separation alike: linear
  approaching  ///< v_ab · r_ab < 0 alone: no derivative at rest
};

template <>
struct Names<ViscousPairs> {
  static constexpr std::array<Named<ViscousPairs>, 2> table{
      {{ViscousPairs::all, "all"}, {ViscousPairs::approaching, "approaching"}}};
};

/// Π_ab = α h c0 (v_ab·r_ab) / (ρ̄_ab (r_ab² + (ηh)²)) beside the stresses of a pair.
struct Viscosity {
  double alpha;  ///< > 0
  double eta;    ///< ≥ 0
  ViscousPairs pairs = ViscousPairs::all;
};

/// Which sum is dρ/dt of `ul`; about a uniform base state of one material both have the same derivative.
enum class DensityRate {
  masses,  ///< Σ_b m_b v̂_ab · ∇_a W_ab, Gray et al. Eq. 3.8
  volumes  ///< ρ_a Σ_b (m_b/ρ_b) v̂_ab · ∇_a W_ab, Eq. 3.9
};

template <>
struct Names<DensityRate> {
  static constexpr std::array<Named<DensityRate>, 2> table{
      {{DensityRate::masses, "masses"}, {DensityRate::volumes, "volumes"}}};
};

/// A scheme: its formulation and the terms that are switched on. An absent optional is a term that costs nothing.
struct Scheme {
  Formulation formulation = Formulation::total_lagrangian_linear;
  ElasticLaw elastic_law = ElasticLaw::saint_venant_kirchhoff;
  MomentumDensity momentum_density = MomentumDensity::frozen;
  KernelNormalisation kernel_normalisation = KernelNormalisation::none;
  std::optional<Damping> damping = {};
  std::optional<ArtificialStress> artificial_stress = {};
  std::optional<Xsph> xsph = {};
  std::optional<Viscosity> viscosity = {};
  DensityRate density_rate = DensityRate::masses;
};

/// Throws InvalidInput naming `what` there is for total-Lagrangian schemes alone, unless this is one.
inline void require_total_lagrangian(const Scheme& scheme, const std::string& what) {
  if (!is_total_lagrangian(scheme.formulation))
    throw InvalidInput("scheme: " + what + " is for total-Lagrangian schemes, not " +
                       std::string(name_of(scheme.formulation)));
}

}  // namespace sphstab
