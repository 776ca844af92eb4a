// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "model/kernel.hpp"
#include "model/lattice.hpp"
#include "model/scheme.hpp"

namespace sphstab::analysis {

/// The lattice sums of Gray, Monaghan & Swift (Sec. 5) over the neighbours d of a particle, V its volume:
///   A(k) = V Σ sin(k·d) ∇W(d)            B(k) = V Σ (1 − cos k·d) ∇∇W(d)
///   β_sum(k) = V Σ (1 − cos k·d) W(d)    f(k) = V Σ (1 − cos k·d) ∇(φ ∇W),  φ = (W(d)/W(Δp))ⁿ or (d/Δp)ⁿ
///   Aφ(k) = V Σ sin(k·d) φ ∇W(d)         Γ(k) = V Σ (1 − cos k·d) (W'/d) d dᵀ / (d² + (ηh)²)
/// 1 − cos is taken as 2 sin² of the half angle, so that nothing cancels for long waves. f and Aφ are zero without
/// artificial stress and where W(Δp) = 0; Γ is zero without viscosity. With a complex k the sums are the analytic
/// continuations, whose imaginary parts at k + iδ give derivatives. Tested in tests/analysis/test_lattice_sums.cpp.
template <int Dim, class Scalar = double>
struct LatticeSums {
  Vector<Dim, Scalar> A;      ///< 1 / length
  Tensor<Dim, Scalar> B;      ///< 1 / length²
  Scalar beta_sum;            ///< dimensionless; Gray's β is ε̃ times it
  Vector<Dim, Scalar> A_phi;  ///< 1 / length
  Tensor<Dim, Scalar> f;      ///< 1 / length²
  Tensor<Dim, Scalar> Gamma;  ///< 1 / length², negative semidefinite
};

/// Whether φ is a number: kernel-ratio divides by W(Δp).
template <int Dim>
bool has_weight(const Kernel<Dim>& kernel, double spacing, ArtificialStressWeight weight) {
  return weight == ArtificialStressWeight::distance_ratio || kernel.value(spacing) > 0.0;
}

/// Sums over one lattice at any k. What no term of the scheme needs is not summed.
template <int Dim>
class LatticeSummation {
 public:
  LatticeSummation(const Lattice<Dim>& lattice, const Kernel<Dim>& kernel, NeighbourRule rule,
                   const std::optional<ArtificialStress>& artificial_stress, const std::optional<Viscosity>& viscosity);

  template <class Scalar>
  LatticeSums<Dim, Scalar> operator()(const Vector<Dim, Scalar>& wave_vector) const;

  int neighbours() const { return 2 * static_cast<int>(pairs_.size()); }
  /// Bounds on |A|, |B| and |f| at every k: the sums of the sizes of their terms.
  double largest_A() const { return largest_A_; }
  double largest_B() const { return largest_B_; }
  double largest_f() const { return largest_f_; }
  /// a_n = Σ x φ ∂W/∂x / Σ x ∂W/∂x: Aφ over A for long waves along x.
  double long_wave_weight() const;

 private:
  /// A neighbour at d and one at −d, their weights times 2V.
  struct Pair {
    Vector<Dim> d;
    double W;
    Vector<Dim> slope;      ///< ∇W
    Tensor<Dim> curvature;  ///< ∇∇W
    Vector<Dim> weighted_slope;
    Tensor<Dim> weighted_curvature;
    Tensor<Dim> friction;
  };

  std::vector<Pair> pairs_;
  bool has_artificial_stress_;
  bool has_viscosity_;
  double largest_A_ = 0.0;
  double largest_B_ = 0.0;
  double largest_f_ = 0.0;
};

extern template class LatticeSummation<1>;
extern template class LatticeSummation<2>;
extern template class LatticeSummation<3>;

}  // namespace sphstab::analysis
