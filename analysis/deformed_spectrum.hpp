// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "analysis/deformed_limit.hpp"

namespace sphstab::analysis {

/// Bodies of so many unknowns at most are looked at whole: a dense eigenproblem of some seconds.
inline constexpr int most_unknowns_of_whole_spectrum = 1000;

/// What the spectrum about a deformed state says of steps and growth.
struct DeformedSpectrum {
  std::vector<DeformedMode> all;        ///< by real, then imaginary part, both of a pair; empty: the body is too large
  DeformedMode largest;                 ///< of the largest real part
  DeformedMode smallest;                ///< of the smallest real part
  std::optional<DeformedMode> growing;  ///< of the modes looked at the one that grows fastest in continuous time
  double growth_rate;                   ///< of it; 0 where none grows
  /// Slower growth cannot be told from rounding, or of large bodies need not have shown.
  double smallest_seen_growth_rate;
  std::optional<double> step_of_largest;  ///< step_of_mode
  bool has_damped_pairs;                  ///< whether damping holds a complex pair back, whose steps are not known
  long applications;
};

/// max Re s of s² + c s + ω² = 0, c the damping rate: the growth rate of a mode in continuous time, negative where it
/// decays. 1 / time.
double growth_rate_of(std::complex<double> omega_squared, double damping_rate);

/// The whole spectrum of M^−½ K M^−½ about the state that the operator is about, or, of more than
/// `most_unknowns_of_whole_spectrum`, both ends by `deformed_limit` and what a motion that starts from noise is led to
/// by some hundred to thousand linear steps, as many as the size of the body allows: complex pairs inside the spectrum,
/// which R·S has where a body is bent, show there if they grow fast enough. A mode counts as growing if it does when ω²
/// is moved towards those that do not by what is not known of it, 1e-11 of the largest one or ten residuals. Throws
/// InvalidInput if nothing moves. Tested in tests/analysis/test_deformed_spectrum.cpp.
template <int Dim>
DeformedSpectrum deformed_spectrum(DeformedBodyOperator<Dim>& body_operator,
                                   const std::function<void(double fraction)>& progress = nullptr);

extern template DeformedSpectrum deformed_spectrum(DeformedBodyOperator<1>&, const std::function<void(double)>&);
extern template DeformedSpectrum deformed_spectrum(DeformedBodyOperator<2>&, const std::function<void(double)>&);
extern template DeformedSpectrum deformed_spectrum(DeformedBodyOperator<3>&, const std::function<void(double)>&);

}  // namespace sphstab::analysis
