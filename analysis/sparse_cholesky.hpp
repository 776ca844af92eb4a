// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

namespace sphstab::analysis {

/// Cholesky factorisation of a sparse symmetric matrix whose unknowns have places, multifrontal: nested dissection by
/// planes through the median, and a dense factorisation of each front (Duff & Reid 1983; George 1973). A factor that is
/// not kept needs no more memory than the fronts at hand: to know that a matrix is positive definite costs no factor.
/// Tested in tests/analysis/test_sparse_cholesky.cpp.
class SparseCholesky {
 public:
  /// `lower`: the lower triangle of the pattern, diagonal included; `place`: a column for each unknown.
  SparseCholesky(const Eigen::SparseMatrix<double>& lower, const Eigen::MatrixXd& place);

  double multiplications() const { return multiplications_; }
  /// Bytes at once, if the factor is kept and if it is not.
  double memory() const { return fronts_memory_; }
  double memory_with_factor() const { return fronts_memory_ + factor_memory_; }

  enum class Keep { nothing, factor };

  /// Factorises the matrix of that lower triangle, of the pattern given before. False if a pivot is not positive.
  bool factorise(const Eigen::SparseMatrix<double>& lower, Keep keep);

  /// ‖A − L Lᵀ‖₂ of the last factorisation is at most this: γ_{k} ‖ |L| |Lᵀ| ‖ (Higham, Accuracy and Stability, Thm.
  /// 10.3, whatever the order of the sums), k the largest number of entries of a row of L and the roundings of a
  /// division, ‖ |L| ‖₂² ≤ ‖L‖₁ ‖L‖_∞. So a matrix that has a factor has no eigenvalue below −backward_error().
  double backward_error() const { return backward_error_; }

  /// X := A⁻¹ X, of a factor that was kept.
  void solve(Eigen::MatrixXd& X) const;

 private:
  struct Front {
    int first;                  ///< of its own unknowns, in the order of elimination
    int own;                    ///< how many they are
    std::vector<int> boundary;  ///< later unknowns that they are coupled to, ascending
    std::vector<int> children;
  };
  using Pattern = Eigen::SparseMatrix<double>;

  int dissect(const Pattern& graph, const Eigen::MatrixXd& place, std::vector<int> part);
  void find_boundaries(const Pattern& graph);
  void count();
  Eigen::MatrixXd assemble(const Pattern& permuted, const Front& front, std::vector<Eigen::MatrixXd>& updates,
                           std::vector<int>& local) const;

  std::vector<Front> fronts_;  ///< children before parents
  std::vector<int> order_;     ///< the unknown that is eliminated n-th
  std::vector<int> rank_;      ///< its inverse
  std::vector<Eigen::MatrixXd> factor_;
  double multiplications_ = 0.0;
  double fronts_memory_ = 0.0;
  double factor_memory_ = 0.0;
  double backward_error_ = 0.0;
};

}  // namespace sphstab::analysis
