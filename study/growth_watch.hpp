// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "model/scene.hpp"
#include "solver/finite_strain_simulation.hpp"

namespace sphstab::study {

/// Why a run grows.
enum class GrowthCause {
  time_step,           ///< it is above the critical step of the state
  tension,             ///< of `ul`: the particles are pulled apart
  loss_of_ellipticity  ///< the law has no waves in some direction of some particle's strain
};

/// A run has grown where its kinetic and strain energy are this many times what the start and the largest work of the
/// loads have given and what steps near the limit make of that: far more than, in `tl-corotated`, the strain that is no
/// potential.
inline constexpr double energy_of_growth = 3.0;

/// Particles that have lost ellipticity at so many looks in a row do not come back with the wave that took them there.
inline constexpr int looks_of_loss = 10;

/// What a run of finite strain is watched for beside its energy: loss of ellipticity, where the law has no waves in
/// some direction of a particle's strain (analysis/ellipticity.hpp), so that waves grow at any step. Whatever moves
/// strains all that is within its support: a particle counts where all its neighbours have lost ellipticity, too, and
/// have for `looks_of_loss` looks. Large vibrations take particles beyond the loss and back, and a corner may be
/// crushed for good while what is about it holds it. Tested in tests/study/test_finite_strain_run.cpp.
template <int Dim>
class GrowthWatch {
 public:
  using Displacement = std::vector<Vector<Dim>>;

  /// Keeps references to scene and simulation.
  GrowthWatch(const Scene<Dim>& scene, const solver::FiniteStrainSimulation<Dim>& simulation, Displacement start);

  /// Judges every particle: whether one, with its neighbours, has been without waves now and at the `looks_of_loss` − 1
  /// looks before.
  bool sees_lasting_loss(const Displacement& displacement);
  /// Whether there was any such particle at the last look.
  bool sees_loss() const { return longest_loss() > 0; }

  /// Whether there is no such particle.
  bool is_elliptic(const Displacement& displacement) const;

  /// Whether the energy is more than `energy_of_growth` times what was given. Below the limit a mode holds now and
  /// then, without growing, up to 1/(1 − (ωΔt/2)²) times what it was given.
  bool has_grown(double energy, double given, double time_step) const;

  /// The run has not grown here yet.
  void keep(Displacement displacement) { calm_ = std::move(displacement); }

  /// Why the run has grown since it was calm. The state that has grown is not asked: in a body that is torn some
  /// particle is always turned inside out. A fixed step is compared with the critical one of the start, too, because
  /// what grows may have strained the calm state already. Where ellipticity is lost there is no critical step.
  std::optional<GrowthCause> cause(double time_step, bool is_fixed) const;

 private:
  std::vector<bool> without_waves(const Displacement& displacement) const;
  int longest_loss() const { return *std::max_element(looks_lost_.begin(), looks_lost_.end()); }
  std::optional<double> critical_step(const Displacement& displacement) const;
  bool is_above_limit(double time_step, const Displacement& displacement) const;

  const Scene<Dim>& scene_;
  const solver::FiniteStrainSimulation<Dim>& simulation_;
  Displacement start_, calm_;
  std::vector<int> looks_lost_;  ///< in a row, of each particle with its neighbours
};

extern template class GrowthWatch<1>;
extern template class GrowthWatch<2>;
extern template class GrowthWatch<3>;

}  // namespace sphstab::study

namespace sphstab {

template <>
struct Names<study::GrowthCause> {
  static constexpr std::array<Named<study::GrowthCause>, 3> table{
      {{study::GrowthCause::time_step, "time step"},
       {study::GrowthCause::tension, "tension"},
       {study::GrowthCause::loss_of_ellipticity, "loss of ellipticity"}}};
};

}  // namespace sphstab
