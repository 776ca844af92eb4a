// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "analysis/branch.hpp"
#include "analysis/mode_step.hpp"
#include "model/brillouin_zone.hpp"
#include "model/problem.hpp"

namespace sphstab::analysis {

/// Δt_c lies in [low, high]; rounding errors of the evaluation are included.
struct Bracket {
  double low;
  double high;
};

template <int Dim>
struct CriticalMode {
  Vector<Dim> wave_vector;
  Branch branch;
  double omega;  ///< angular frequency in continuous time, undamped; of an unstable mode its growth rate
};

/// How a bracket was got.
enum class BracketKind {
  certified,  ///< by bounds over the whole set of modes
  searched    ///< the width of the last step of a search that samples the modes
};

/// Stable up to `critical_time_step`, the largest Δt such that no smaller one grows. The formulas are those of ModeStep
/// at the largest ω². Tested in tests/analysis/test_critical_step.cpp.
template <int Dim>
struct ConditionallyStable {
  double critical_time_step;
  Bracket bracket;
  CriticalMode<Dim> mode;
  BracketKind bracket_kind = BracketKind::certified;
};

/// No mode has a restoring force; nothing limits Δt.
struct UnconditionallyStable {};

/// Grows in continuous time, so at every Δt.
template <int Dim>
struct NeverStable {
  double growth_rate;  ///< 1 / time
  CriticalMode<Dim> mode;
};

/// Does not grow in continuous time, yet at every Δt, as Gray's predictor-corrector does (theory.md §4).
template <int Dim>
struct WeaklyUnstable {
  double coefficient;  ///< growth per step, max |λ| − 1 → coefficient · Δt^exponent for small Δt
  int exponent;
  CriticalMode<Dim> mode;  ///< that grows fastest at small Δt
};

template <int Dim>
using StepLimit = std::variant<ConditionallyStable<Dim>, UnconditionallyStable, NeverStable<Dim>, WeaklyUnstable<Dim>>;

/// An extreme ω² over a set of modes, within [lower, upper].
template <int Dim>
struct ExtremeMode {
  Vector<Dim> wave_vector = Vector<Dim>::Zero();
  Branch branch = Branch::longitudinal;
  double omega_squared = 0.0;
  double lower = 0.0;
  double upper = 0.0;
};

/// `lowest` is a mode without restoring force unless one is unstable.
template <int Dim>
struct FrequencyRange {
  ExtremeMode<Dim> lowest;
  ExtremeMode<Dim> highest;
  BracketKind kind = BracketKind::certified;
};

/// The step of a mode of any ω² by the integrator and the damping of a problem.
class ModeSteps {
 public:
  template <int Dim>
  explicit ModeSteps(const Problem<Dim>& problem) : integrator_(problem.integrator), damping_(problem.scheme.damping) {}

  ModeStep operator()(double omega_squared) const { return {integrator_, damping_, omega_squared}; }

 private:
  Integrator integrator_;
  std::optional<Damping> damping_;
};

/// The infinite lattice of a total-Lagrangian scheme: its extreme frequencies over the whole Brillouin zone, found
/// once, and what follows from them for any step. With certified bounds of tl-linear, of finite strain where the state
/// has no preferred direction (FiniteStrain::isotropic_form), and of tl-pk1 everywhere (ZoneScan::upper_bound); of
/// tl-corotated else by a search, whose values are right to 1e-12.
template <int Dim>
class BulkModes {
 public:
  explicit BulkModes(const Problem<Dim>& problem);

  /// The exact critical time step.
  StepLimit<Dim> limit() const;

  const FrequencyRange<Dim>& frequencies() const { return range_; }

  /// max |D(k)| over the zone, 1 / length (`symbol_maximum`), kernel normalisation included; of finite strain that of
  /// the renormalised D~.
  double symbol_maximum() const { return symbol_maximum_; }

  /// Largest spectral radius of E over the zone at this step. At a fixed Δt the trace of a mode is linear in ω² and its
  /// determinant does not depend on it, so that one of the two ends of the range of ω² has it.
  double spectral_radius(double time_step) const;

  /// The largest Δt such that no smaller one has a spectral radius over the zone above 1 + growth_per_step. Nothing
  /// where every Δt qualifies, or none does (`never-stable`, growth_per_step = 0). Throws InvalidInput
  /// (`tolerated_growth_per_step`) if negative.
  std::optional<double> step_for_growth(double growth_per_step) const;

 private:
  void find_linear(const Problem<Dim>& problem);
  void find_finite_strain(const Problem<Dim>& problem);

  ModeSteps steps_;
  FrequencyRange<Dim> range_;
  double symbol_maximum_;
};

/// The exact critical time step of the infinite lattice, of any scheme: that of BulkModes or UpdatedModes.
template <int Dim>
StepLimit<Dim> bulk_limit(const Problem<Dim>& problem);

/// The limit of one mode.
template <int Dim>
StepLimit<Dim> mode_limit(const Problem<Dim>& problem, const Vector<Dim>& wave_vector);

/// The limit over Zhang's modes (Eq. 13): k = (mπ/(MΔp), lπ/(LΔp)), m = 1…M, l = 1…L. Throws InvalidInput (`box`)
/// unless every count is at least 1; so do `patch_limit` and `patch_wave_vectors` (`patch`).
template <int Dim>
StepLimit<Dim> paper_limit(const Problem<Dim>& problem, const LatticeIndex<Dim>& box);

/// The wave vectors that a periodic patch admits, k·(N_i a_i) = 2πn_i, and the limit over them.
template <int Dim>
std::vector<Vector<Dim>> patch_wave_vectors(const Lattice<Dim>& lattice, const LatticeIndex<Dim>& cells);
template <int Dim>
StepLimit<Dim> patch_limit(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells);

/// Zhang's Eq. 15, Δt = ρ/|mW'(Δ)| √(ρ/(2γ+3G)): sufficient for four neighbours, printed for every kernel (errata.md
/// Z4, Z5). Nothing where W'(Δp) = 0, the lattice is not square or the scheme is not tl-linear.
template <int Dim>
std::optional<double> published_bound(const Problem<Dim>& problem);

/// The zero-energy modes: every k of the first Brillouin zone with D(k) = 0 (and so D~ = 0), Γ excluded, each class of
/// equivalent k once (on the boundary of the zone the one with the largest first component, then second), shortest
/// first.
template <int Dim>
struct ZeroEnergyModes {
  std::vector<Vector<Dim>> wave_vectors;
  /// False where D is below rounding on whole regions (very wide, smooth kernels), so that no list can be complete.
  bool complete;
};

template <int Dim>
ZeroEnergyModes<Dim> zero_energy_modes(const Problem<Dim>& problem);

/// k in the first zone, without components that are rounding: where a maximum lies is known to the root of its own.
template <int Dim>
Vector<Dim> tidy(const BrillouinZone<Dim>& zone, const Vector<Dim>& wave_vector);

extern template class BulkModes<1>;
extern template StepLimit<1> bulk_limit(const Problem<1>&);
extern template StepLimit<1> mode_limit(const Problem<1>&, const Vector<1>&);
extern template StepLimit<1> paper_limit(const Problem<1>&, const LatticeIndex<1>&);
extern template std::vector<Vector<1>> patch_wave_vectors(const Lattice<1>&, const LatticeIndex<1>&);
extern template StepLimit<1> patch_limit(const Problem<1>&, const LatticeIndex<1>&);
extern template std::optional<double> published_bound(const Problem<1>&);
extern template ZeroEnergyModes<1> zero_energy_modes(const Problem<1>&);
extern template Vector<1> tidy(const BrillouinZone<1>&, const Vector<1>&);
extern template class BulkModes<2>;
extern template StepLimit<2> bulk_limit(const Problem<2>&);
extern template StepLimit<2> mode_limit(const Problem<2>&, const Vector<2>&);
extern template StepLimit<2> paper_limit(const Problem<2>&, const LatticeIndex<2>&);
extern template std::vector<Vector<2>> patch_wave_vectors(const Lattice<2>&, const LatticeIndex<2>&);
extern template StepLimit<2> patch_limit(const Problem<2>&, const LatticeIndex<2>&);
extern template std::optional<double> published_bound(const Problem<2>&);
extern template ZeroEnergyModes<2> zero_energy_modes(const Problem<2>&);
extern template Vector<2> tidy(const BrillouinZone<2>&, const Vector<2>&);
extern template class BulkModes<3>;
extern template StepLimit<3> bulk_limit(const Problem<3>&);
extern template StepLimit<3> mode_limit(const Problem<3>&, const Vector<3>&);
extern template StepLimit<3> paper_limit(const Problem<3>&, const LatticeIndex<3>&);
extern template std::vector<Vector<3>> patch_wave_vectors(const Lattice<3>&, const LatticeIndex<3>&);
extern template StepLimit<3> patch_limit(const Problem<3>&, const LatticeIndex<3>&);
extern template std::optional<double> published_bound(const Problem<3>&);
extern template ZeroEnergyModes<3> zero_energy_modes(const Problem<3>&);
extern template Vector<3> tidy(const BrillouinZone<3>&, const Vector<3>&);

}  // namespace sphstab::analysis

namespace sphstab {

template <>
struct Names<analysis::BracketKind> {
  static constexpr std::array<Named<analysis::BracketKind>, 2> table{
      {{analysis::BracketKind::certified, "certified"}, {analysis::BracketKind::searched, "searched"}}};
};

}  // namespace sphstab
