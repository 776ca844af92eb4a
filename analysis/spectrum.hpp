// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "analysis/critical_step.hpp"
#include "model/body.hpp"

namespace sphstab::analysis {

/// What proves that no frequency of a body lies above the bracket.
enum class BoundKind {
  factorisation,  ///< σ M − S has a Cholesky factorisation: no eigenvalue above σ
  norm_bound,     ///< the largest row sum of M^−½ S M^−½ (Gershgorin): proven, loose
  probabilistic   ///< Lanczos from a random start; the probability that it fails is stated
};

/// What a low mode is: see docs/spectrum.md for what separates them.
enum class BodyModeKind {
  vibration,
  rigid,       ///< a translation or rotation of a body, or of parts of it that do not touch
  zero_energy  ///< particles move against each other and hardly any strain is felt
};

}  // namespace sphstab::analysis

namespace sphstab {

template <>
struct Names<analysis::BodyModeKind> {
  static constexpr std::array<Named<analysis::BodyModeKind>, 3> table{
      {{analysis::BodyModeKind::vibration, "vibration"},
       {analysis::BodyModeKind::rigid, "rigid"},
       {analysis::BodyModeKind::zero_energy, "zero-energy"}}};
};

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
  double failure_probability = 1e-12;             ///< of a probabilistic bound
  double probabilistic_width = 1e-2;              ///< relative, of a probabilistic bound on the eigenvalue
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

/// The largest ω² of M d²s/dt² = −S s (analysis/body_operator.hpp), of finite strain about rest, by Lanczos, never
/// above the true one but for rounding, and an upper bound on it (docs/spectrum.md): with `factorisation` within the
/// tolerance or what the factorisation rounds. Absent `options.bound`: a factorisation up to 100 000 particles if it
/// takes minutes and 4 GB at most, otherwise the lesser of the two other bounds. Throws InvalidInput if no particle
/// feels a force, for what the scheme does not define on a body, and for a factorisation that is asked for and too
/// large (`upper_bound`). Tested in tests/analysis/test_spectrum.cpp.
template <int Dim>
BodyLimit body_limit(const Problem<Dim>& problem, const Body<Dim>& body, const BodyLimitOptions& options = {});

struct BodyMode {
  double omega;
  BodyModeKind kind;
  double residual;  ///< ‖K x − ω² x‖ / ‖x‖ as in BodyLimit; ω² is right to its square over the gap
  Eigen::VectorXd displacement;  ///< as in BodyLimit
};

/// The `count` lowest modes, ascending, or all that there are. Throws InvalidInput (`lowest_modes`) if `count` is not
/// positive or the body is too large to be factorised. Tested in tests/analysis/test_body_modes.cpp.
template <int Dim>
std::vector<BodyMode> lowest_modes(const Problem<Dim>& problem, const Body<Dim>& body, int count);

/// The displacement in equilibrium under body.load, S s = M load, by conjugate gradients, orthogonal to the motions
/// that meet no resistance; linear, so that of finite strain under small loads. Throws InvalidInput where the load
/// drives such a motion: there is no equilibrium; and for `density_in_momentum` equation-of-state, which is not linear
/// in the load. Tested in tests/analysis/test_body_modes.cpp.
template <int Dim>
Eigen::VectorXd static_displacement(const Problem<Dim>& problem, const Body<Dim>& body);

extern template BodyLimit body_limit(const Problem<1>&, const Body<1>&, const BodyLimitOptions&);
extern template BodyLimit body_limit(const Problem<2>&, const Body<2>&, const BodyLimitOptions&);
extern template BodyLimit body_limit(const Problem<3>&, const Body<3>&, const BodyLimitOptions&);
extern template std::vector<BodyMode> lowest_modes(const Problem<1>&, const Body<1>&, int);
extern template std::vector<BodyMode> lowest_modes(const Problem<2>&, const Body<2>&, int);
extern template std::vector<BodyMode> lowest_modes(const Problem<3>&, const Body<3>&, int);
extern template Eigen::VectorXd static_displacement(const Problem<1>&, const Body<1>&);
extern template Eigen::VectorXd static_displacement(const Problem<2>&, const Body<2>&);
extern template Eigen::VectorXd static_displacement(const Problem<3>&, const Body<3>&);

}  // namespace sphstab::analysis
