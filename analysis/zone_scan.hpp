// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "analysis/zone_domain.hpp"
#include "model/problem.hpp"

namespace sphstab::analysis {

/// A wave vector and the value of a function there.
template <int Dim>
struct ZonePoint {
  Vector<Dim> wave_vector;
  double value;
};

/// The least and the largest eigenvalue of a symmetric matrix.
struct EigenvalueRange {
  double low;
  double high;
};

/// Of the symmetric part of M: every real part of an eigenvalue of M lies between.
template <int Dim>
EigenvalueRange symmetric_range(const Tensor<Dim>& M);

/// Functions of k sampled over the whole Brillouin zone, or over given wave vectors, and their maxima. The grid covers
/// the irreducible wedge of those symmetries of the lattice that leave the base stress of `ul`, or F0ᵀ F0 of finite
/// strain, as it is, which the ω² of these schemes obey; it is fine enough for the support: its boxes of phases have
/// half a width w with σ w = scan_resolution, σ the exponential type of the lattice sums. Zero-energy modes are points
/// of their own, because a small stress makes narrow dips there (theory.md §9). Tested in
/// tests/analysis/test_zone_scan.cpp.
template <int Dim>
class ZoneScan {
 public:
  using Function = std::function<double(const Vector<Dim>&)>;

  explicit ZoneScan(const Problem<Dim>& problem);
  /// These alone: no point is moved.
  explicit ZoneScan(std::vector<Vector<Dim>> wave_vectors);

  const std::vector<Vector<Dim>>& points() const { return points_; }
  /// `function` at every point.
  std::vector<double> sampled(const Function& function) const;

  /// The points whose neighbours on the grid have no larger value, and one a smaller one; of the points of their own
  /// those above the least value.
  std::vector<std::size_t> local_maxima(const std::vector<double>& values) const;

  /// The local maximum that is reached from here: the best of a 3^Dim stencil and of the maximum of the parabola
  /// through it, with steps down to 1e-9 in phase. Values are right to rounding where the function is smooth.
  ZonePoint<Dim> polished(const Function& function, const Vector<Dim>& start) const;
  /// The largest of the polished local maxima of sampled values. Points of a ridge, local maxima in one direction, are
  /// starts too where they are high enough to hide the maximum: wide kernels have rings of near-maxima.
  ZonePoint<Dim> maximum(const Function& function, const std::vector<double>& values) const;
  ZonePoint<Dim> maximum(const Function& function) const { return maximum(function, sampled(function)); }

  /// An upper bound on the largest eigenvalue of a symmetric matrix that is a trigonometric polynomial of type `order`
  /// times that of the lattice sums, at least `found`, a value it takes. With all eigenvalues in [m, M] and τ the type,
  /// the largest is at least m + (M − m) cos²(τd/2) at max-norm distance d in phase from where it is M (M. Riesz; for
  /// the fixed direction of that eigenvector), so that boxes with less at their centre do not matter; the others are
  /// split until the bound is tight to 1e-10 or a budget of evaluations is spent. m and M − m follow from the grid in
  /// the same way. Of given wave vectors the bound is `found`.
  double upper_bound(const std::function<EigenvalueRange(const Vector<Dim>&)>& eigenvalues, int order,
                     double found) const;

 private:
  std::vector<std::size_t> summits_above(const std::vector<double>& values, double ridge_level) const;
  Vector<Dim> wave_vector(const Vector<Dim>& phases) const { return phase_axes_ * phases; }

  std::vector<Vector<Dim>> points_;
  ZoneDomain<Dim> domain_;
  Tensor<Dim> phase_axes_;  ///< columns: k of one radian of each phase
  double type_ = 0.0;       ///< σ
  double half_width_ = 0.0;
  LatticeIndex<Dim> cells_;           ///< boxes on each axis
  std::vector<long> point_of_cell_;   ///< −1 for a box outside the domain
  std::vector<PhaseBox<Dim>> boxes_;  ///< of the points of the grid, which come first
};

extern template class ZoneScan<1>;
extern template EigenvalueRange symmetric_range(const Tensor<1>&);
extern template class ZoneScan<2>;
extern template EigenvalueRange symmetric_range(const Tensor<2>&);
extern template class ZoneScan<3>;
extern template EigenvalueRange symmetric_range(const Tensor<3>&);

}  // namespace sphstab::analysis
