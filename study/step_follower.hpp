// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "analysis/deformed_limit.hpp"
#include "model/scene.hpp"
#include "study/rigid_motion.hpp"

namespace sphstab::study {

/// What it has taken to follow the limit of a body.
struct FollowingWork {
  long updates = 0;
  long applications = 0;     ///< of the linearised operator
  double cpu_seconds = 0.0;  ///< of the thread
};

/// The critical step of a body of finite strain as it deforms. The first limit, at rest, is converged; each later one
/// is an estimate from a few applications of the operator about the present state, which start from the mode of the one
/// before with noise beside it, so that a mode that overtakes is found. Estimates come from inside the spectrum of
/// `tl-pk1`: they are above the limit, by what the fraction of it that a run takes has to leave room for.
///
/// What waves may take of the limit before the next update is kept free: one with velocities v strains by v/c_p, twice
/// where it is reflected, and that lowers the limit of the laws by three halves of it. A load f per mass that is put on
/// at once sends a wave of f Δp/c_p. What moves a body as a rigid one is no wave (study/rigid_motion.hpp), nor is what
/// loads it as gravity does. c_p is that of the slowest material.
///
/// The next update is due after a number of steps that is doubled where the limit has hardly changed and halved where
/// it has changed much: an update takes about as long as twenty steps, one every thousand of them 2 % of a run. Nothing
/// depends on how fast the machine is. Tested in tests/study/test_step_follower.cpp.
template <int Dim>
class StepFollower {
 public:
  /// Keeps a reference.
  explicit StepFollower(const Scene<Dim>& scene);

  /// Of the body at rest in its base state, or of the last update; nothing where no mode has a restoring force.
  std::optional<double> critical_step() const { return critical_step_; }
  /// Steps until the next update is due.
  long interval() const { return interval_; }

  /// About this displacement. Nothing changes where the state has no limit: a particle is turned inside out.
  void update(const std::vector<Vector<Dim>>& displacement);

  /// What the limit is divided by for the wave that the loads send, and for those of a moving body too.
  double room_for_loads() const { return room_for(wave_of_loads_); }
  double room_for_waves(const std::vector<Vector<Dim>>& displacement, const std::vector<Vector<Dim>>& velocity) const;

  const FollowingWork& work() const { return work_; }

 private:
  std::optional<double> limit_of_state(const analysis::DeformedLimitOptions& options);
  double room_for(double fastest) const { return 1.0 + 3.0 * fastest / wave_speed_; }

  const Body<Dim>& body_;
  FreeMotion<Dim> free_motion_;
  double wave_speed_;
  double wave_of_loads_;  ///< a velocity
  analysis::DeformedBodyOperator<Dim> operator_;
  Eigen::VectorXd mode_;
  std::optional<double> critical_step_;
  long interval_;
  FollowingWork work_;
};

/// The largest ω² of a body of finite strain about a displacement, converged, and the critical step; nothing where a
/// particle is turned inside out.
template <int Dim>
std::optional<analysis::DeformedLimit> limit_about(const Problem<Dim>& problem, const Body<Dim>& body,
                                                   const std::vector<Vector<Dim>>& displacement);

extern template class StepFollower<1>;
extern template class StepFollower<2>;
extern template class StepFollower<3>;
extern template std::optional<analysis::DeformedLimit> limit_about(const Problem<1>&, const Body<1>&,
                                                                   const std::vector<Vector<1>>&);
extern template std::optional<analysis::DeformedLimit> limit_about(const Problem<2>&, const Body<2>&,
                                                                   const std::vector<Vector<2>>&);
extern template std::optional<analysis::DeformedLimit> limit_about(const Problem<3>&, const Body<3>&,
                                                                   const std::vector<Vector<3>>&);

}  // namespace sphstab::study
