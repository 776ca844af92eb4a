// SPDX-License-Identifier: MIT
#pragma once

#include "model/kernel.hpp"
#include "model/lattice.hpp"

namespace sphstab::analysis {

/// The lattice sums of Gray, Monaghan & Swift (Sec. 5) over the neighbours d of a particle, V its volume:
///   A(k) = V Σ sin(k·d) ∇W(d)            B(k) = V Σ (1 − cos k·d) ∇∇W(d)
///   β_sum(k) = V Σ (1 − cos k·d) W(d)    f(k) = V Σ (1 − cos k·d) ∇(φ ∇W),  φ = (W(d)/W(Δp))ⁿ
/// 1 − cos is taken as 2 sin² of the half angle, so that nothing cancels for long waves. f is zero where W(Δp) = 0.
/// Tested in tests/analysis/test_lattice_sums.cpp.
template <int Dim>
struct LatticeSums {
  Vector<Dim> A;    ///< 1 / length
  Tensor<Dim> B;    ///< 1 / length²
  double beta_sum;  ///< dimensionless; Gray's β is ε̃ times it
  Tensor<Dim> f;    ///< 1 / length²
  int neighbours;
};

template <int Dim>
LatticeSums<Dim> lattice_sums(const Lattice<Dim>& lattice, const Kernel<Dim>& kernel, NeighbourRule rule,
                              const Vector<Dim>& wave_vector, double artificial_stress_exponent);

extern template LatticeSums<1> lattice_sums(const Lattice<1>&, const Kernel<1>&, NeighbourRule, const Vector<1>&,
                                            double);
extern template LatticeSums<2> lattice_sums(const Lattice<2>&, const Kernel<2>&, NeighbourRule, const Vector<2>&,
                                            double);
extern template LatticeSums<3> lattice_sums(const Lattice<3>&, const Kernel<3>&, NeighbourRule, const Vector<3>&,
                                            double);

}  // namespace sphstab::analysis
