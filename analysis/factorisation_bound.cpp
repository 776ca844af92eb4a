// SPDX-License-Identifier: MIT
#include "analysis/factorisation_bound.hpp"

#include <limits>

namespace sphstab::analysis {

FactorisationBound::Bound FactorisationBound::above(double approximation, double margin) {
  constexpr double wider = 16.0;
  for (;; margin *= wider) {
    const double sigma = approximation * (1.0 + margin);
    for (int i = 0; i < matrix_.cols(); ++i) matrix_.coeffRef(i, i) = sigma + diagonal_[i];
    if (cholesky_.factorise(matrix_, SparseCholesky::Keep::nothing))
      return {sigma * (1.0 + 4.0 * std::numeric_limits<double>::epsilon()) + cholesky_.backward_error() + rounding_,
              margin};
  }
}

}  // namespace sphstab::analysis
