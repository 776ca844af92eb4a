// SPDX-License-Identifier: MIT
#include "analysis/lattice_sums.hpp"

#include <cmath>

namespace sphstab::analysis {
namespace {

/// `along` on the direction e, `across` on every direction normal to it.
template <int Dim>
Tensor<Dim> axial(const Vector<Dim>& e, double along, double across) {
  return across * Tensor<Dim>::Identity() + (along - across) * e * e.transpose();
}

}  // namespace

template <int Dim>
LatticeSums<Dim> lattice_sums(const Lattice<Dim>& lattice, const Kernel<Dim>& kernel, NeighbourRule rule,
                              const Vector<Dim>& wave_vector, double artificial_stress_exponent) {
  const auto neighbours = lattice_neighbours(lattice, kernel.support(), rule);
  const double n = artificial_stress_exponent;
  const double V = lattice.cell_volume();
  const double W_spacing = kernel.value(lattice.spacing());
  LatticeSums<Dim> sums{Vector<Dim>::Zero(), Tensor<Dim>::Zero(), 0.0, Tensor<Dim>::Zero(),
                        static_cast<int>(neighbours.size())};
  for (const auto& neighbour : neighbours) {
    const double r = neighbour.distance;
    const Vector<Dim> e = neighbour.position / r;
    const double W = kernel.value(r), dW = kernel.slope(r), d2W = kernel.curvature(r);
    const double half_angle = 0.5 * wave_vector.dot(neighbour.position);
    const double weight = 2.0 * V * std::pow(std::sin(half_angle), 2);  // V (1 − cos k·d)
    sums.A += V * std::sin(2.0 * half_angle) * dW * e;
    sums.B += weight * axial<Dim>(e, d2W, dW / r);
    sums.beta_sum += weight * W;
    if (!(W_spacing > 0.0 && W > 0.0)) continue;
    const double phi = std::pow(W / W_spacing, n);
    sums.f += weight * axial<Dim>(e, phi * (d2W + n * dW * dW / W), phi * dW / r);
  }
  return sums;
}

template LatticeSums<1> lattice_sums(const Lattice<1>&, const Kernel<1>&, NeighbourRule, const Vector<1>&, double);
template LatticeSums<2> lattice_sums(const Lattice<2>&, const Kernel<2>&, NeighbourRule, const Vector<2>&, double);
template LatticeSums<3> lattice_sums(const Lattice<3>&, const Kernel<3>&, NeighbourRule, const Vector<3>&, double);

}  // namespace sphstab::analysis
