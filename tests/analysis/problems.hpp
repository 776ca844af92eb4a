// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Eigenvalues>
#include <complex>
#include <vector>

#include "model/problem.hpp"

namespace sphstab {

/// E = 1.3, μ = 0.3, ρ = 1, so that Zhang's G = E/(1+μ) = 1 and, in plane strain, γ = 0.75.
inline Material zhang_material() { return Material::from_young_modulus(1.0, 1.3, 0.3); }

/// Eigenvalues by Eigen's dense solver, the oracle of closed forms; order unspecified.
inline std::vector<std::complex<double>> numerical_eigenvalues(const Eigen::MatrixXcd& matrix) {
  const Eigen::VectorXcd eigenvalues = matrix.eigenvalues();
  return {eigenvalues.begin(), eigenvalues.end()};
}

inline Problem<2> problem_2d(LatticeKind lattice, KernelFamily kernel, double smoothing_length,
                             double gaussian_cutoff = default_gaussian_cutoff) {
  return {Lattice<2>(lattice, 1.0),
          Kernel<2>(kernel, smoothing_length, gaussian_cutoff),
          NeighbourRule::support,
          zhang_material(),
          Plane::strain,
          Scheme{}};
}

}  // namespace sphstab
