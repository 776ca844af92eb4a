// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "model/tensor.hpp"

namespace sphstab::solver::test {

/// Bounds the steps of the iteration, each of which leaves at most the largest stretch over their sum of the error:
/// 0.97^3000 is no number any more.
inline constexpr int mueller_steps = 3000;

/// The rotation nearest to A as Tran-Duc et al., Sec. 2.3, find it: with columns r of R and a of A, R is turned about
/// v = Σ r × a / |Σ r · a| by the angle |v| until that is nothing. Their start r_2 = a_3 × r_1 / |a_3| is a unit vector
/// only where a_3 is normal to r_1; here it is made one (errata.md T6). det A > 0.
template <class Scalar>
Tensor<3, Scalar> mueller_rotation(const Tensor<3, Scalar>& A) {
  Tensor<3, Scalar> R;
  R.col(0) = A.col(0).normalized();
  R.col(1) = A.col(2).cross(R.col(0)).normalized();
  R.col(2) = R.col(0).cross(R.col(1));
  for (int step = 0; step < mueller_steps; ++step) {
    Vector<3, Scalar> v = Vector<3, Scalar>::Zero();
    for (int j = 0; j < 3; ++j) v += R.col(j).cross(A.col(j));
    v /= std::abs(R.cwiseProduct(A).sum()) + std::numeric_limits<Scalar>::min();
    const Scalar angle = v.norm();
    if (angle < std::numeric_limits<Scalar>::epsilon()) break;
    R = Eigen::AngleAxis<Scalar>(angle, v / angle).toRotationMatrix() * R;
  }
  return R;
}

}  // namespace sphstab::solver::test
