// SPDX-License-Identifier: MIT
#include "model/lattice_reduction.hpp"

#include <Eigen/LU>
#include <cmath>

#include "model/lattice_index.hpp"

namespace sphstab {
namespace {

/// Subtracts from vector i the multiples of sums and differences of the others that shorten it.
template <int Dim>
bool shorten(Tensor<Dim>& vectors, int i) {
  bool shortened = false;
  const LatticeIndex<Dim> ones = LatticeIndex<Dim>::Ones();
  for_each_index<Dim>(-ones, ones, [&](const LatticeIndex<Dim>& n) {
    if (n.isZero() || n[i] != 0) return;
    const Vector<Dim> step = vectors * n.template cast<double>(), longer = vectors.col(i);
    const Vector<Dim> shorter = longer - std::round(longer.dot(step) / step.squaredNorm()) * step;
    if (!(shorter.squaredNorm() < (1.0 - shape_tolerance) * longer.squaredNorm())) return;
    vectors.col(i) = shorter;
    shortened = true;
  });
  return shortened;
}

}  // namespace

template <int Dim>
Tensor<Dim> reduced_basis(const Tensor<Dim>& vectors) {
  Tensor<Dim> reduced = vectors;
  for (bool shortened = true; shortened;) {
    shortened = false;
    for (int i = 0; i < Dim; ++i) shortened |= shorten<Dim>(reduced, i);
  }
  return reduced;
}

template <int Dim>
LatticeIndex<Dim> lattice_coordinates(const Tensor<Dim>& vectors, const Vector<Dim>& site) {
  return (vectors.inverse() * site).array().round().template cast<int>();
}

template Tensor<1> reduced_basis(const Tensor<1>&);
template LatticeIndex<1> lattice_coordinates(const Tensor<1>&, const Vector<1>&);
template Tensor<2> reduced_basis(const Tensor<2>&);
template LatticeIndex<2> lattice_coordinates(const Tensor<2>&, const Vector<2>&);
template Tensor<3> reduced_basis(const Tensor<3>&);
template LatticeIndex<3> lattice_coordinates(const Tensor<3>&, const Vector<3>&);

}  // namespace sphstab
