// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <complex>
#include <functional>

namespace sphstab::analysis {

/// y = A x, A real.
using LinearOperator = std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& y)>;

/// Which eigenvalue is wanted.
enum class Extreme {
  rightmost,  ///< that of the largest real part
  leftmost,   ///< that of the smallest
  outermost   ///< that of the largest modulus
};

struct ArnoldiOptions {
  Extreme extreme = Extreme::rightmost;
  int dimension = 30;       ///< of the Krylov space, 4 or more: vectors that are kept, one more in all
  double tolerance = 1e-8;  ///< of the residual, relative to the largest modulus of a Ritz value
  long most = 4000;         ///< applications; `dimension` of them or fewer make an estimate without a restart
  std::function<void(long applications)> progress = nullptr;  ///< so far, at every restart
};

/// An eigenvalue as the last Krylov space shows it; of a complex pair that with a positive imaginary part.
struct ArnoldiResult {
  std::complex<double> value;
  double residual;  ///< ‖A v − value v‖
  double largest;   ///< modulus of a Ritz value: what the tolerance is relative to
  long applications;
  Eigen::VectorXcd vector;  ///< v, of norm 1; real for a real value
};

/// Arnoldi from a start of any norm, the Ritz vector of a state nearby for one, orthogonalised twice; restarted with
/// the half of the Ritz vectors nearest to what is wanted (thick restart: Wu & Simon 2000, with an orthonormal basis of
/// the real and imaginary parts; Krylov-Schur, Stewart 2001, in exact arithmetic). Nothing is known of eigenvectors
/// that the start is orthogonal to. Own code because an estimate from a few applications is wanted as well, of which
/// Spectra's solvers report nothing before they have converged. Tested in tests/analysis/test_arnoldi.cpp.
ArnoldiResult arnoldi(const LinearOperator& apply, const Eigen::VectorXd& start, const ArnoldiOptions& options = {});

}  // namespace sphstab::analysis
