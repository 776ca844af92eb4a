// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/scene.hpp"
#include "solver/state.hpp"

namespace sphstab::study {

/// All particles at one time. Velocities of `leapfrog` belong to half a step before.
template <int Dim>
struct Snapshot {
  long step;
  double time;
  const solver::State<Dim>& state;
  std::vector<Tensor<Dim>> stress;       ///< σ, positive in tension
  std::vector<double> von_mises_stress;  ///< out-of-plane stress counted (solver/stress.hpp)
};

template <int Dim>
struct SceneRunOptions {
  double time_step;
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

/// The first number of a run that is none, or is beyond 1e100.
struct NonFiniteValue {
  long step;
  double time;
  int particle;
  std::string_view field;  ///< velocity or displacement
};

/// Of the largest values, those at every 50th step and at the last one. Energies and masses are those that the scheme
/// keeps (Simulation::inertia); velocities of `leapfrog` are first brought to the time of the displacements.
struct SceneSummary {
  double time;
  long steps;
  long right_hand_sides;
  double largest_displacement;
  double largest_velocity;
  double largest_von_mises_stress;
  double kinetic_energy;  ///< at the end
  double strain_energy;   ///< at the end
  double work;  ///< of loads and base state up to the end; without damping, kinetic and strain energy together
  /// Largest departure of the momentum from that which the loads have given, over the largest Σ m |v|, in the
  /// directions in which no particle is clamped; absent if there are none.
  std::optional<double> momentum_drift;
};

template <int Dim>
struct SceneRunResult {
  solver::State<Dim> state;  ///< the last; of a failed run the last finite one
  std::vector<double> sample_times;
  std::vector<ProbeHistory<Dim>> probes;
  SceneSummary summary;
  std::optional<NonFiniteValue> failure;  ///< then the run stopped early
};

/// Runs the scene from rest. A run with non-finite values stops at the exact step of the first one, whatever the
/// interval at which it is looked at. With `verlet` every sample, snapshot and 50th step costs a right-hand side.
/// Throws InvalidInput (`time_step`, `duration`) unless both are positive and the steps are at most 1e15. Tested in
/// tests/study/test_scene_run.cpp.
template <int Dim>
SceneRunResult<Dim> run_scene(const Scene<Dim>& scene, const SceneRunOptions<Dim>& options);

extern template SceneRunResult<1> run_scene(const Scene<1>&, const SceneRunOptions<1>&);
extern template SceneRunResult<2> run_scene(const Scene<2>&, const SceneRunOptions<2>&);
extern template SceneRunResult<3> run_scene(const Scene<3>&, const SceneRunOptions<3>&);

}  // namespace sphstab::study
