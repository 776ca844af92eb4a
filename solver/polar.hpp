// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <complex>

#include "solver/state.hpp"

/// The rotation R that is nearest to F, min ‖R − F‖ over the rotations, which is what Tran-Duc et al., Sec. 2.3,
/// extract by the iteration of Müller et al.: the factor of F = R U where det F > 0. Where a particle is turned inside
/// out it is a rotation still, without a jump at det F = 0. Checked against that iteration, started right (errata.md
/// T6), and against products of rotations and stretches in tests/solver/test_polar.cpp.
namespace sphstab::solver {

template <class Scalar>
Tensor<1, Scalar> rotation(const Tensor<1, Scalar>&) {
  return Tensor<1, Scalar>::Identity();
}

/// With c + is the direction of (F_11 + F_22) + i (F_21 − F_12). No number where both vanish, as in a reflection.
template <class Scalar>
Tensor<2, Scalar> rotation(const Tensor<2, Scalar>& F) {
  using std::sqrt;
  const Scalar x = F(0, 0) + F(1, 1), y = F(1, 0) - F(0, 1);
  const Scalar length = sqrt(x * x + y * y);
  const Scalar c = x / length, s = y / length;
  Tensor<2, Scalar> R;
  R << c, -s, s, c;
  return R;
}

/// A diag(1, 1, ±1) Bᵀ of the singular value decomposition F = A diag B ᵀ. Not finite where F is not.
template <class Scalar>
Tensor<3, Scalar> rotation(const Tensor<3, Scalar>& F) {
  const Eigen::JacobiSVD<Tensor<3, Scalar>> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.info() != Eigen::Success) return F;
  Tensor<3, Scalar> A = svd.matrixU();
  if ((A * svd.matrixV().transpose()).determinant() < 0) A.col(2) = -A.col(2);
  return A * svd.matrixV().transpose();
}

/// The same for a real F that carries a derivative D in its imaginary part, whose square vanishes: R + i R [ω]× with
/// (tr(U) I − U) ω the axial vector of RᵀD − DᵀR.
inline Tensor<3, std::complex<double>> rotation(const Tensor<3, std::complex<double>>& F) {
  const Tensor<3> R = rotation(Tensor<3>(F.real()));
  const Tensor<3> U = R.transpose() * F.real(), D = R.transpose() * F.imag();
  const Vector<3> axial(D(2, 1) - D(1, 2), D(0, 2) - D(2, 0), D(1, 0) - D(0, 1));
  const Vector<3> omega = (U.trace() * Tensor<3>::Identity() - U).inverse() * axial;
  Tensor<3> spin;
  spin << 0.0, -omega[2], omega[1], omega[2], 0.0, -omega[0], -omega[1], omega[0], 0.0;
  return R + std::complex<double>(0.0, 1.0) * (R * spin);
}

}  // namespace sphstab::solver
