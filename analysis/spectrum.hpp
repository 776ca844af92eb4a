// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "analysis/critical_step.hpp"
#include "model/body.hpp"

namespace sphstab::analysis {

/// What proves that no frequency of a body lies above the bracket.
enum class BoundKind {
  factorisation,  ///< σ M − S has a Cholesky factorisation: no eigenvalue above σ
  norm_bound,     ///< particle by particle, as explicit finite-element codes bound it element by element: proven, loose
  probabilistic   ///< Lanczos from a random start; the probability that it fails is stated
};

}  // namespace sphstab::analysis

namespace sphstab {

template <>
struct Names<analysis::BoundKind> {
  static constexpr std::array<Named<analysis::BoundKind>, 3> table{
      {{analysis::BoundKind::factorisation, "factorisation"},
       {analysis::BoundKind::norm_bound, "norm-bound"},
       {analysis::BoundKind::probabilistic, "probabilistic"}}};
};

}  // namespace sphstab

namespace sphstab::analysis {

struct BodyLimitOptions {
  std::optional<BoundKind> bound = std::nullopt;  ///< absent: the tightest that the size of the body allows
  double tolerance = 1e-10;                       ///< relative, of the largest eigenvalue
  unsigned seed = 1;                              ///< of the random start
  std::function<void(double fraction)> progress = nullptr;
};

/// The largest angular frequency of a body and the critical step that follows from it.
struct BodyLimit {
  double critical_time_step;
  Bracket bracket;  ///< of the step: its low end belongs to the upper bound of the frequency
  BoundKind bracket_kind;
  double failure_probability;  ///< of a probabilistic bracket; 0 otherwise
  double omega_max;
  double residual;               ///< ‖K x − ω² x‖ / (ω² ‖x‖) in the inner product in which K is symmetric
  long applications;             ///< of the operator
  Eigen::VectorXd displacement;  ///< of the mode, components of a particle adjacent, clamped ones 0; up to a factor
};

/// Throws InvalidInput if no particle feels a force, and for what the scheme does not define on a body.
template <int Dim>
BodyLimit body_limit(const Problem<Dim>& problem, const Body<Dim>& body, const BodyLimitOptions& options = {});

/// What a low mode is.
enum class BodyModeKind { vibration, rigid, zero_energy };

struct BodyMode {
  double omega;
  BodyModeKind kind;
  Eigen::VectorXd displacement;  ///< as in BodyLimit
};

/// The `count` lowest modes, ascending.
template <int Dim>
std::vector<BodyMode> lowest_modes(const Problem<Dim>& problem, const Body<Dim>& body, int count);

/// The displacement in equilibrium under body.load, by conjugate gradients, orthogonal to the motions that meet no
/// resistance. Throws InvalidInput where the load drives such a motion: there is no equilibrium.
template <int Dim>
Eigen::VectorXd static_displacement(const Problem<Dim>& problem, const Body<Dim>& body);

}  // namespace sphstab::analysis
