// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "solver/growth.hpp"

namespace sphstab::study {

/// One of our solvers about a base state that its step leaves as it is. What departs from that state is a flat vector
/// of all numbers that the step maps.
class PerturbedSolver {
 public:
  virtual ~PerturbedSolver() = default;

  /// What noise perturbs; the same `noise_seed` gives the same on every machine. Of no particular amplitude, but not 0:
  /// throws InvalidInput (`patch`) where nothing that noise perturbs has one.
  virtual Eigen::VectorXd noise_departure(unsigned noise_seed) = 0;

  /// Goes so many steps. Numbers that are not finite may remain.
  virtual void advance(Eigen::VectorXd& departure, double time_step, int steps) = 0;

  /// The size of a departure in a norm that rigid motion and the drift of zero-energy modes do not raise.
  virtual double amplitude(const Eigen::VectorXd& departure) = 0;

  /// The amplitude of the departures that runs start with.
  virtual double seed_amplitude(double time_step) const = 0;

  /// The amplitude up to which the growth of a departure is that of a small one; infinite where the solver is linear.
  virtual double largest_amplitude() const = 0;
};

/// Runs one solver at one time step after another and measures how the amplitude of a small departure grows.
///
/// A run starts from the seed. After a growing run the fastest mode is known to the solver: the next run starts from it
/// with a tenth of the seed, which shows growth early without taking anything from the theory. What grows beyond the
/// largest amplitude is scaled back to that of the seed, the whole departure with it, so that a run may see as many
/// e-foldings as it needs.
/// Tested in tests/study/test_growth_run.cpp and test_updated_growth_run.cpp.
class PerturbationRun {
 public:
  /// The seed may have any amplitude but 0.
  PerturbationRun(std::shared_ptr<PerturbedSolver> solver, const Eigen::VectorXd& seed);
  /// From noise.
  PerturbationRun(const std::shared_ptr<PerturbedSolver>& solver, unsigned noise_seed);

  /// Runs `horizon` steps, up to four times as many while the trend is undecided, fewer once the growth is plain. Its
  /// signature is a GrowthProbe (study/bisection.hpp).
  solver::GrowthFit operator()(double time_step, long horizon);

 private:
  struct Course {
    Eigen::VectorXd departure;
    double scaled_back;                 ///< logarithm of all factors so far
    std::vector<double> log_amplitude;  ///< as if it had not been scaled back
  };

  Course start(double time_step) const;
  /// Appends amplitudes until `end` steps; false if there is nothing more to see before.
  bool run(long end, double time_step, int stride, Course& course) const;

  std::shared_ptr<PerturbedSolver> solver_;
  Eigen::VectorXd seed_;                         ///< of amplitude 1
  std::optional<Eigen::VectorXd> fastest_mode_;  ///< of amplitude 1
};

}  // namespace sphstab::study
