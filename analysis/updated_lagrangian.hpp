// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <complex>

#include "analysis/dynamics.hpp"
#include "analysis/lattice_sums.hpp"
#include "model/problem.hpp"

namespace sphstab::analysis {

/// The scheme of Gray, Monaghan & Swift (`ul`), linearised about a uniform stress σ = −P I + S, for one wave e^{ik·x}:
///   dr/dt = κ v,   dv/dt = F_r r + F_v v + i G q,   dq/dt = i H v,   q = (ρ, S).
template <int Dim, class Scalar = double>
struct UpdatedWave {
  static constexpr int rates = 1 + symmetric_size<Dim>;

  Scalar smoothing;                              ///< κ = 1 − β of XSPH: v̂ = κ v
  Tensor<Dim, Scalar> of_position;               ///< F_r, 1 / time²
  Tensor<Dim, Scalar> of_velocity;               ///< F_v of the viscosity, 1 / time
  Eigen::Matrix<Scalar, Dim, rates> of_state;    ///< G
  Eigen::Matrix<Scalar, rates, Dim> state_rate;  ///< H, κ included
  double rounding;                               ///< of an entry of M

  /// The part of M that the moving particles make at constant ρ and S (geometric), and the rest (of the stress).
  Tensor<Dim, Scalar> geometric_matrix() const { return -smoothing * of_position; }
  Tensor<Dim, Scalar> stress_matrix() const { return of_state * state_rate; }
  /// M of d²r/dt² = −M r without viscosity, 1 / time² (theory.md §3). Real for real k, in general not symmetric.
  Tensor<Dim, Scalar> dynamical_matrix() const { return geometric_matrix() + stress_matrix(); }
  Dynamics<Dim> dynamics() const { return {dynamical_matrix(), rounding}; }
};

/// The linearised scheme at any k. With the sums of LatticeSums and R = −ε σ₊/ρ̄² (σ₊ the positive part of σ):
///   F_r = (2/ρ̄) σ B + 2ρ̄ R f                                                     (Gray 5.6 corrected, G3, and 5.13)
///   F_v = α h c0 Γ
///   i G q = −iρ̄ [δ(σ/ρ²) A + δR Aφ],  δσ = δS − c0² δρ I,  δ(σ/ρ²) = δσ/ρ̄² − 2σ δρ/ρ̄³
///   H v: δρ' = iρ̄κ A·v (3.8),  δS' = −iκ [2μ (ε − ⅓ tr ε I) + wS − Sw],  ε = sym(A vᵀ),  w = ½(v Aᵀ − A vᵀ)
///   (3.10, 5.7) δR = −(ε/ρ̄²) P₊'[δσ] − (2/ρ̄) R δρ, or zero if the linearisation is `frozen`,
/// P₊' the derivative of the positive part: in principal axes of σ it multiplies component ij by (σ_i₊ − σ_j₊)/(σ_i −
/// σ_j), which is 1, 0 or σ_i/(σ_i − σ_j) by the signs and needs no limit where σ_i = σ_j. Tested in
/// tests/analysis/test_updated_lagrangian.cpp.
template <int Dim>
class UpdatedLagrangian {
 public:
  explicit UpdatedLagrangian(const Problem<Dim>& problem);

  UpdatedWave<Dim> operator()(const Vector<Dim>& wave_vector) const;
  /// The analytic continuation to complex k.
  UpdatedWave<Dim, std::complex<double>> operator()(const Vector<Dim, std::complex<double>>& wave_vector) const;

  /// 1/Δp, the scale on which the sums vary with k.
  double wave_number_unit() const { return wave_number_unit_; }
  /// 1 − ε a_n: what artificial stress leaves of the modulus of long waves along x in tension (theory.md §3), whatever
  /// the stress.
  double tension_modulus_factor() const;

 private:
  static constexpr int rates = UpdatedWave<Dim>::rates;

  template <class Scalar>
  UpdatedWave<Dim, Scalar> wave(const Vector<Dim, Scalar>& wave_vector) const;

  LatticeSummation<Dim> sums_;
  double wave_number_unit_;
  double epsilon_;   ///< of the artificial stress
  double xsph_;      ///< ε̃
  double friction_;  ///< α h c0
  double shear_modulus_;
  double density_;      ///< ρ̄
  Tensor<Dim> stress_;  ///< σ
  Tensor<Dim> deviatoric_;
  Tensor<Dim> artificial_;                              ///< R
  std::array<Tensor<Dim>, rates> stress_by_state_;      ///< ∂(σ/ρ²)/∂q
  std::array<Tensor<Dim>, rates> artificial_by_state_;  ///< ∂R/∂q
  double largest_geometric_;                            ///< bound on |F_r|
  double stiffness_;                                    ///< times |A|: bound on the stress part of M, nearly
};

/// M of the elastic continuum in the same base state, without artificial stress and viscosity: what long waves see of a
/// perfect lattice. Gray Eqs. 4.9, 4.10 and their like in other dimensions,
///   M X = c0² k (k·X) + (μ/ρ̄) [|k|² X + k (k·X)/3] + (1/ρ̄) (w S − S w) k,  w = ½ (X kᵀ − k Xᵀ).
/// Tested in tests/analysis/test_continuum.cpp.
template <int Dim>
Tensor<Dim> continuum_matrix(const Problem<Dim>& problem, const Vector<Dim>& wave_vector);

/// Whether the base state has two linearisations, one a ZeroStressSide: a principal stress is zero and artificial
/// stress follows it.
template <int Dim>
bool has_one_sided_states(const Problem<Dim>& problem);

extern template class UpdatedLagrangian<1>;
extern template Tensor<1> continuum_matrix(const Problem<1>&, const Vector<1>&);
extern template bool has_one_sided_states(const Problem<1>&);
extern template class UpdatedLagrangian<2>;
extern template Tensor<2> continuum_matrix(const Problem<2>&, const Vector<2>&);
extern template bool has_one_sided_states(const Problem<2>&);
extern template class UpdatedLagrangian<3>;
extern template Tensor<3> continuum_matrix(const Problem<3>&, const Vector<3>&);
extern template bool has_one_sided_states(const Problem<3>&);

}  // namespace sphstab::analysis
