// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <complex>
#include <optional>
#include <variant>

#include "analysis/acoustic_form.hpp"
#include "analysis/branch.hpp"
#include "analysis/critical_step.hpp"
#include "analysis/finite_strain.hpp"
#include "analysis/gradient_symbol.hpp"
#include "analysis/updated_lagrangian.hpp"

namespace sphstab::analysis {

/// One wave e^{i(k·x − ωt)} of the infinite lattice in continuous time. The speeds are those of the undamped wave and
/// absent where ω² ≤ 0: such a wave does not travel.
template <int Dim>
struct WaveBranch {
  Branch branch;
  std::complex<double> omega_squared;         ///< eigenvalue of M(k), real but in `ul`; 1 / time²
  double growth_rate;                         ///< of e^{rt}, r² + c r + ω² = 0, c the damping rate; 1 / time
  std::optional<double> phase_speed;          ///< Re ω/|k|; k as given, not its equivalent in the first zone
  std::optional<Vector<Dim>> group_velocity;  ///< Re ∂ω/∂k; absent too where branches cross
};

/// The waves of `tl-linear` (theory.md §2): with D the gradient symbol at k,
///   ω_L² = D · Q D, Q the longitudinal form of AcousticForm, and ω_T² = shear |D|² (twice in 3-D),
///   ∂ω/∂k = (∂D/∂k) Q D / ω, Q = shear I for the transverse branch; ∂D/∂k and Q are symmetric.
/// ω is exactly zero where D vanishes to rounding: at Γ and at zero-energy modes.
template <int Dim>
class LinearWaves {
 public:
  explicit LinearWaves(const Problem<Dim>& problem);
  std::array<WaveBranch<Dim>, Dim> operator()(const Vector<Dim>& wave_vector) const;

 private:
  GradientSymbol<Dim> symbol_;
  AcousticForm<Dim> form_;
  ModeSteps steps_;
};

/// The waves of `tl-corotated` and `tl-pk1` (theory.md §5): ω² the eigenvalues of M(k) of FiniteStrain, the group
/// velocity as in UpdatedWaves. k and the speeds are those of the reference state, X in e^{i(k·X − ωt)}; longitudinal
/// is a polarisation nearer to F0⁻ᵀ k, normal to the fronts in the present state, than to its normal. ω is exactly zero
/// at Γ and at zero-energy modes.
template <int Dim>
class FiniteStrainWaves {
 public:
  explicit FiniteStrainWaves(const Problem<Dim>& problem);
  std::array<WaveBranch<Dim>, Dim> operator()(const Vector<Dim>& wave_vector) const;

 private:
  FiniteStrain<Dim> scheme_;
  ModeSteps steps_;
};

/// Longitudinal where the polarisation is nearer to k than to its normal.
template <int Dim>
Branch branch_of(const Vector<Dim, std::complex<double>>& polarisation, const Vector<Dim>& wave_vector);

/// The waves of `ul` without viscosity (theory.md §3): ω² the eigenvalues of M(k), and from its right and left
/// eigenvectors x, y the group velocity ∂ω/∂k_j = y·(∂M/∂k_j) x / (2ω y·x); of equal ω² the same with all their
/// eigenvectors, where that is one velocity. A real branch is longitudinal where x is nearer to k than to its normal;
/// complex pairs are `coupled`.
template <int Dim>
class UpdatedWaves {
 public:
  /// Throws InvalidInput (`viscosity_alpha`) if there is viscosity.
  explicit UpdatedWaves(const Problem<Dim>& problem);
  std::array<WaveBranch<Dim>, Dim> operator()(const Vector<Dim>& wave_vector) const;

 private:
  UpdatedLagrangian<Dim> scheme_;
};

/// The dispersion relation of a problem. Tested in tests/analysis/test_dispersion.cpp.
template <int Dim>
class DispersionRelation {
 public:
  explicit DispersionRelation(const Problem<Dim>& problem);

  /// Every branch at k, the least ω² first. Throws InvalidInput where ω² leaves the range of a double.
  std::array<WaveBranch<Dim>, Dim> operator()(const Vector<Dim>& wave_vector) const;

 private:
  std::variant<LinearWaves<Dim>, FiniteStrainWaves<Dim>, UpdatedWaves<Dim>> waves_;
};

extern template class DispersionRelation<1>;
extern template Branch branch_of(const Vector<1, std::complex<double>>&, const Vector<1>&);
extern template class DispersionRelation<2>;
extern template Branch branch_of(const Vector<2, std::complex<double>>&, const Vector<2>&);
extern template class DispersionRelation<3>;
extern template Branch branch_of(const Vector<3, std::complex<double>>&, const Vector<3>&);

}  // namespace sphstab::analysis
