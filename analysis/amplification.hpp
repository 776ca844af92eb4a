// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <string>
#include <vector>

#include "model/problem.hpp"

namespace sphstab::analysis {

using ComplexMatrix = Eigen::MatrixXcd;

/// The names of the state's components in order: tl-linear in 2-D "vx", "vy", "sx", "sy" (Zhang's u, v, R, S);
/// tl-corotated and tl-pk1 "x", "y", "vx", "vy"; ul the same and "rho", "Sxx", "Syy", "Sxy", and the stored rates "Fx"
/// … "dSxy" of predictor-corrector-pec.
template <int Dim>
std::vector<std::string> state_names(const Problem<Dim>& problem);

/// M(k) of d²s/dt² = −M s, 1 / time², without viscosity (theory.md §2, §3 and §5; includes the base state).
template <int Dim>
Tensor<Dim> dynamical_matrix(const Problem<Dim>& problem, const Vector<Dim>& wave_vector);

/// E of e^{n+1} = E e^n (Zhang Eq. 14, A.5 corrected: errata.md Z1). With b = 1 − cΔt/2, c the damping rate:
///   leapfrog  [[(1 − cΔt) I, −Δt M], [Δt (1 − cΔt) I, I − Δt² M]]
///   verlet    [[b² I − ½bΔt² M, −½(1 + b)Δt M + ¼Δt³ M²], [bΔt I, I − ½Δt² M]]
/// of (v, s), in tl-corotated and tl-pk1 of (s, v); and of `ul` that of step_matrix. Tested in
/// tests/analysis/test_linearisation.cpp and test_finite_strain.cpp.
template <int Dim>
ComplexMatrix amplification_matrix(const Problem<Dim>& problem, const Vector<Dim>& wave_vector, double time_step);

/// The spectrum of E at one mode: of total-Lagrangian schemes in closed form from the eigenvalues of M, real and each
/// with its eigenvector but for special states of tl-linear; of ul by an eigensolver.
struct ModeSpectrum {
  std::vector<std::complex<double>> eigenvalues;  ///< of tl-linear the longitudinal pair, then the transverse ones; of
                                                  ///< tl-corotated and tl-pk1 the pair of the largest ω² first
  double spectral_radius;
  /// |λ| ≤ 1, and every λ on the unit circle is semisimple. False at zero-energy modes (drift) and at ωΔt = 2 exactly.
  bool power_bounded;
};

template <int Dim>
ModeSpectrum mode_spectrum(const Problem<Dim>& problem, const Vector<Dim>& wave_vector, double time_step);

extern template std::vector<std::string> state_names(const Problem<1>&);
extern template Tensor<1> dynamical_matrix(const Problem<1>&, const Vector<1>&);
extern template ComplexMatrix amplification_matrix(const Problem<1>&, const Vector<1>&, double);
extern template ModeSpectrum mode_spectrum(const Problem<1>&, const Vector<1>&, double);
extern template std::vector<std::string> state_names(const Problem<2>&);
extern template Tensor<2> dynamical_matrix(const Problem<2>&, const Vector<2>&);
extern template ComplexMatrix amplification_matrix(const Problem<2>&, const Vector<2>&, double);
extern template ModeSpectrum mode_spectrum(const Problem<2>&, const Vector<2>&, double);
extern template std::vector<std::string> state_names(const Problem<3>&);
extern template Tensor<3> dynamical_matrix(const Problem<3>&, const Vector<3>&);
extern template ComplexMatrix amplification_matrix(const Problem<3>&, const Vector<3>&, double);
extern template ModeSpectrum mode_spectrum(const Problem<3>&, const Vector<3>&, double);

}  // namespace sphstab::analysis
