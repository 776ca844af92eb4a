// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>

namespace sphstab::analysis {

/// y = A x, A symmetric and not negative.
using SymmetricOperator = std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& y)>;

struct LanczosOptions {
  double tolerance = 1e-10;  ///< relative error of the eigenvalue, as estimated from residual and gap
  int fewest = 0;            ///< applications, unless the space is exhausted
  int most = 4000;           ///< applications
  std::function<void(double fraction)> progress = nullptr;
};

/// The largest eigenvalue as the space of a start vector shows it.
struct LanczosResult {
  double rayleigh_quotient;  ///< of `vector`: no larger than the eigenvalue, rounding apart
  double residual;           ///< ‖A x − θ x‖ / ‖x‖
  int dimension;             ///< of the Krylov space: applications of the first of two passes
  long applications;         ///< in all
  Eigen::VectorXd vector;    ///< of norm 1
};

/// Lanczos' three-term recurrence without reorthogonalisation: three vectors, a second pass from the same start for the
/// eigenvector, and one application for what is reported of it. Tested in tests/analysis/test_spectrum.cpp.
LanczosResult largest_eigenvalue(const SymmetricOperator& apply, const Eigen::VectorXd& start,
                                 const LanczosOptions& options);

/// For a start of any direction with equal probability, λ_max > ratio · (Ritz value) has at most this probability
/// (Kuczyński & Woźniakowski 1992, Thm. 4.1: P[θ_k < (1 − ε) λ_max] ≤ 1.648 √n exp(−√ε (2k − 1)), A not negative;
/// exact arithmetic). As the dimension k is chosen while running, the k-th has the share 1/(2k²) of the probability.
double probable_ratio(double failure_probability, int dimension, int unknowns);

/// The dimension at which probable_ratio reaches `ratio`.
int dimension_for_ratio(double ratio, double failure_probability, int unknowns);

}  // namespace sphstab::analysis
