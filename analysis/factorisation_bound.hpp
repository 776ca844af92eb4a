// SPDX-License-Identifier: MIT
#pragma once

#include "analysis/body_operator.hpp"
#include "analysis/sparse_cholesky.hpp"

namespace sphstab::analysis {

/// Proven upper bounds on the largest ω² of a body: σ − M^−½ S M^−½ has a Cholesky factorisation, and what rounding may
/// hide is added to σ (docs/spectrum.md). Tested in tests/analysis/test_spectrum.cpp.
class FactorisationBound {
 public:
  /// Assembles the matrix and orders its unknowns.
  template <int Dim>
  explicit FactorisationBound(const BodyOperator<Dim>& body_operator)
      : matrix_(-body_operator.matrix()),
        diagonal_(matrix_.diagonal()),
        rounding_(body_operator.rounding()),
        cholesky_(matrix_, body_operator.places()) {}

  double multiplications() const { return cholesky_.multiplications(); }
  double memory() const { return cholesky_.memory(); }

  struct Bound {
    double value;
    double margin;  ///< relative, above the approximation
  };

  /// A bound `margin` (relative) above an approximation; where that is none, 16 times the margin above it, and so on.
  Bound above(double approximation, double margin);

 private:
  Eigen::SparseMatrix<double> matrix_;
  Eigen::VectorXd diagonal_;
  double rounding_;
  SparseCholesky cholesky_;
};

}  // namespace sphstab::analysis
