// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/scene.hpp"
#include "study/growth_watch.hpp"
#include "study/p_wave_speed.hpp"
#include "study/step_follower.hpp"

namespace sphstab::study {

/// All particles at one time, of either formulation. Velocities of `leapfrog` belong to half a step before.
template <int Dim>
struct Snapshot {
  long step;
  double time;
  /// From the positions of the body, never folded back into a periodic box.
  std::vector<Vector<Dim>> displacement;
  std::vector<Vector<Dim>> velocity;     ///< not smoothed
  std::vector<Tensor<Dim>> stress;       ///< σ, positive in tension
  std::vector<double> von_mises_stress;  ///< out-of-plane stress counted (solver/stress.hpp)
  std::vector<double> density;           ///< of `ul`; empty otherwise
};

/// Velocities below this part of c_p are what the rounding of stresses makes.
inline constexpr double velocity_of_rounding = 1e-14;

/// The kinetic energy that the rounding of stresses makes.
template <int Dim>
double energy_of_rounding(const Scene<Dim>& scene) {
  const double velocity = velocity_of_rounding * p_wave_speed(scene.problem);
  double mass = 0.0;
  for (int a = 0; a < scene.body.size(); ++a) mass += scene.body.mass(a);
  return 0.5 * mass * velocity * velocity;
}

template <int Dim>
struct SceneRunOptions {
  double time_step;  ///< of the whole run, or of its beginning if the limit is followed
  /// Of finite strain: the step is this part of the critical step of the body as it deforms (study/step_follower.hpp);
  /// `time_step` does not count.
  std::optional<double> followed_fraction = std::nullopt;
  double duration;     ///< the run ends with the first step at or after it
  long snapshots = 0;  ///< equal intervals (no more than steps), with a snapshot at either end, the last finite state
                       ///< included; 0: none
  std::optional<long> probe_samples =
      std::nullopt;  ///< at most, of every second, third … step, and the last; absent: every step
  std::function<void(long step, long steps)> progress = nullptr;
  std::function<void(const Snapshot<Dim>&)> visit = nullptr;
};

/// What a probe recorded, one value for each of SceneRunResult::sample_times.
template <int Dim>
struct ProbeHistory {
  std::string name;
  int particle;
  std::vector<Vector<Dim>> displacement;
  std::vector<Vector<Dim>> velocity;
  std::vector<Tensor<Dim>> stress;
};

/// The first number of a run that is none, or is beyond 1e40, in `ul` 1e100; of `ul` also a density that is not
/// positive.
struct NonFiniteValue {
  long step;
  double time;
  int particle;
  std::string_view field;                     ///< velocity or displacement; of `ul` a solver::UpdatedQuantity
  std::optional<std::string_view> term = {};  ///< of `ul`, that first made no number: a solver::UpdatedTerm
};

/// A run of finite strain that has more energy than its start and loads have given it, or a particle that has lost
/// ellipticity for long (study/growth_watch.hpp).
struct RunGrowth {
  long step;
  double time;
  std::optional<GrowthCause> cause;
};

/// How the limit of a run was followed.
struct StepFollowing {
  double smallest_step, largest_step;
  FollowingWork work;
  double cost_share;  ///< CPU time of the updates over that of the run
};

/// Of the largest values, those at every 50th step and at the last one. Velocities of `leapfrog` are first brought to
/// the time of the displacements for the kinetic energy.
struct SceneSummary {
  double time;
  long steps;
  long right_hand_sides;  ///< evaluations of the forces
  double largest_displacement;
  double largest_velocity;
  double largest_von_mises_stress;
  double initial_energy;  ///< kinetic and strain energy at the start
  double kinetic_energy;  ///< at the end
  /// At the end. `tl-linear`: ½ Σ V σ(δε) : δε, which the scheme keeps. `ul`: Σ (m/ρ)(P²/(2K) + |S|²/(4μ)), what is
  /// stored for small strains, S out of the plane counted; the scheme keeps it to the order of the strain only.
  double strain_energy;
  double work;  ///< of loads (and the base state of `tl-linear`) up to the end: constant force times displacement
  /// Largest departure of the momentum from that of the start and what the loads have given, over the largest Σ m |v|,
  /// in the directions in which no particle is clamped; absent if there are none.
  std::optional<double> momentum_drift;
  std::optional<StepFollowing> following = {};
  std::optional<long> list_builds = {};  ///< of `ul`: searches for neighbours
  /// Particles that have no neighbour within the support any more, at the end; none in `tl-linear`.
  std::vector<int> lost_particles = {};
  bool is_elliptic = true;  ///< of finite strain, at the end (GrowthWatch::is_elliptic)
};

template <int Dim>
struct SceneRunResult {
  Snapshot<Dim> last;  ///< of a failed run the last finite one
  std::vector<double> sample_times;
  std::vector<ProbeHistory<Dim>> probes;
  SceneSummary summary;
  std::optional<NonFiniteValue> failure;  ///< then the run stopped early
  std::optional<RunGrowth> growth;        ///< of finite strain: then, too
};

/// Runs the scene from its base state with the velocities that it starts with: those of half a step before with
/// `leapfrog`. A run with non-finite values stops at the exact step of the first one, whatever the interval at which it
/// is looked at. With `verlet` every sample, snapshot and 50th step costs an evaluation of the forces.
/// Throws InvalidInput (`time_step`, `duration`) unless both are positive and the steps are at most 1e15, and
/// (`velocity`) for velocities beyond such numbers. Tested in
/// tests/study/test_scene_run.cpp.
template <int Dim>
SceneRunResult<Dim> run_scene(const Scene<Dim>& scene, const SceneRunOptions<Dim>& options);

extern template SceneRunResult<1> run_scene(const Scene<1>&, const SceneRunOptions<1>&);
extern template SceneRunResult<2> run_scene(const Scene<2>&, const SceneRunOptions<2>&);
extern template SceneRunResult<3> run_scene(const Scene<3>&, const SceneRunOptions<3>&);

}  // namespace sphstab::study
