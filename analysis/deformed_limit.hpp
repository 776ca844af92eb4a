// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <complex>
#include <functional>
#include <optional>

#include "analysis/deformed_body.hpp"

namespace sphstab::analysis {

struct DeformedLimitOptions {
  int dimension = 30;          ///< of the Krylov spaces
  double tolerance = 1e-8;     ///< of the residuals, relative to the largest ω²
  long most = 4000;            ///< applications for each end of the spectrum; few of them make an estimate
  bool leftmost = false;       ///< whether the other end is asked for
  Eigen::VectorXd start = {};  ///< DeformedLimit::vector of a state nearby; absent: random
  double noise = 1e-2;         ///< of the norm of `start`, added to it: a mode that overtakes is not missed
  unsigned seed = 1;           ///< of what is random
  std::function<void(double fraction)> progress = nullptr;
};

/// A mode about a deformed state. ω² of a complex pair, the one with a positive imaginary part, grows in continuous
/// time (flutter), and so does a negative one; an imaginary part below the residual is none.
struct DeformedMode {
  std::complex<double> omega_squared;
  double residual;         ///< ‖K x − ω² x‖ / ‖x‖ over the largest |ω²|
  Eigen::VectorXd vector;  ///< M^½ displacement, of norm 1; of a complex pair the real part
};

struct DeformedLimit {
  DeformedMode largest;  ///< of the largest real part
  /// That of `largest` (step_of_mode): modes that grow at any step do not count.
  std::optional<double> critical_time_step;
  std::optional<DeformedMode> leftmost;  ///< of the smallest real part: an upper estimate of it where K is symmetric
  long applications;
};

/// The largest step of the integrator and the damping for a mode that oscillates; nothing for one of a complex pair or
/// with ω² not above 0.
template <int Dim>
std::optional<double> step_of_mode(const Problem<Dim>& problem, std::complex<double> omega_squared);

/// The extreme ω² of the state that the operator is about, by `arnoldi`: with few applications estimates, from inside
/// the spectrum where K is symmetric, whose quality the residuals tell. Tested in
/// tests/analysis/test_deformed_limit.cpp.
template <int Dim>
DeformedLimit deformed_limit(DeformedBodyOperator<Dim>& body_operator, const DeformedLimitOptions& options = {});

extern template std::optional<double> step_of_mode(const Problem<1>&, std::complex<double>);
extern template std::optional<double> step_of_mode(const Problem<2>&, std::complex<double>);
extern template std::optional<double> step_of_mode(const Problem<3>&, std::complex<double>);
extern template DeformedLimit deformed_limit(DeformedBodyOperator<1>&, const DeformedLimitOptions&);
extern template DeformedLimit deformed_limit(DeformedBodyOperator<2>&, const DeformedLimitOptions&);
extern template DeformedLimit deformed_limit(DeformedBodyOperator<3>&, const DeformedLimitOptions&);

}  // namespace sphstab::analysis
