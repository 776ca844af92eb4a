// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "analysis/growth.hpp"
#include "analysis/updated_lagrangian.hpp"
#include "analysis/zone_scan.hpp"
#include "model/problem.hpp"

namespace sphstab::analysis {

/// A radius above 1 by no more than this, a step, does not count as growth (interface.md, `critical_time_step`).
inline constexpr double negligible_growth_per_step = 1e-9;

/// The modes of `ul`, over the whole Brillouin zone or at given wave vectors, and what follows from them for any step.
/// Tested in tests/analysis/test_updated_modes.cpp.
template <int Dim>
class UpdatedModes {
 public:
  explicit UpdatedModes(const Problem<Dim>& problem);
  UpdatedModes(const Problem<Dim>& problem, std::vector<Vector<Dim>> wave_vectors);

  /// Never stable: growth in continuous time, viscosity included (r² − F_v r + M = 0). Otherwise
  ///   leapfrog and verlet without viscosity: 2/√(max ω²), in a bracket certified by ZoneScan::upper_bound of the
  ///     symmetric part of M, which no real part of an eigenvalue of M exceeds: tight where M is symmetric;
  ///   predictor-corrector without viscosity: weakly unstable with max |λ| − 1 → c Δt², c = max ¼ (1 − 1/κ) ω_r²,
  ///     where XSPH meets a stress, else c Δt⁴, c = max ω² ω_s²/8 (/4 for -pec): ω² = ω_r² + ω_s², the geometric and
  ///     the stress part (theory.md §4 and the expansion of E, whose position update leaves F0 unsmoothed);
  ///   all else: the first exit of any mode, searched.
  StepLimit<Dim> limit() const;

  /// Largest spectral radius of E.
  double spectral_radius(double time_step) const;

  /// The largest Δt such that no smaller one has a spectral radius above 1 + growth_per_step. Nothing where every Δt
  /// qualifies, or none does. Throws InvalidInput (`tolerated_growth_per_step`) if negative.
  std::optional<double> step_for_growth(double growth_per_step) const;

 private:
  UpdatedModes(const Problem<Dim>& problem, ZoneScan<Dim> scan);

  bool inviscid_kicks() const;
  double radius(const Vector<Dim>& wave_vector, double time_step) const;
  Eigen::Matrix<double, 2 * Dim, 2 * Dim> generator(const Vector<Dim>& wave_vector) const;
  double damped_growth(const Vector<Dim>& wave_vector) const;
  std::optional<NeverStable<Dim>> continuous_growth() const;
  StepLimit<Dim> frequency_limit() const;
  std::optional<WeaklyUnstable<Dim>> weak_growth() const;
  std::optional<double> exit(const Vector<Dim>& wave_vector, double threshold, double cap) const;
  std::optional<ZonePoint<Dim>> first_exit(double threshold) const;
  CriticalMode<Dim> stiffest_at(const Vector<Dim>& wave_vector) const;
  CriticalMode<Dim> mode_of(const Vector<Dim>& wave_vector, const Vector<Dim, std::complex<double>>& motion) const;

  Problem<Dim> problem_;
  UpdatedLagrangian<Dim> scheme_;
  ZoneScan<Dim> scan_;
  GrowthRange<Dim> range_;
};

extern template class UpdatedModes<1>;
extern template class UpdatedModes<2>;
extern template class UpdatedModes<3>;

}  // namespace sphstab::analysis
