// SPDX-License-Identifier: MIT
#include "analysis/sparse_cholesky.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCore>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace sphstab::analysis;

namespace {

/// n ε of a few thousand unknowns, times a condition number below 100.
constexpr double solve_tolerance = 1e-12;

/// The five-point Laplacian of an n × n grid, its lower triangle, and where its unknowns are.
struct Grid {
  explicit Grid(int n) : n_(n), lower(n * n, n * n), place(2, n * n) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < n * n; ++i) {
      place.col(i) << i % n, i / n;
      entries.emplace_back(i, i, 4.0);
      if ((i + 1) % n != 0) entries.emplace_back(i + 1, i, -1.0);
      if (i + n < n * n) entries.emplace_back(i + n, i, -1.0);
    }
    lower.setFromTriplets(entries.begin(), entries.end());
  }

  /// 8 sin²(π/(2(n+1))).
  double lowest_eigenvalue() const {
    const double s = std::sin(0.5 * std::numbers::pi / (n_ + 1));
    return 8.0 * s * s;
  }

  Eigen::SparseMatrix<double> shifted(double shift) const {
    Eigen::SparseMatrix<double> result = lower;
    for (int i = 0; i < result.cols(); ++i) result.coeffRef(i, i) -= shift;
    return result;
  }

  int n_;
  Eigen::SparseMatrix<double> lower;
  Eigen::MatrixXd place;
};

}  // namespace

TEST_CASE("a factorisation succeeds below the lowest eigenvalue of a grid and fails above it", "[fast]") {
  for (const int n : {5, 60}) {  // one front, and many
    const Grid grid(n);
    SparseCholesky cholesky(grid.lower, grid.place);
    const double lowest = grid.lowest_eigenvalue();
    REQUIRE(cholesky.factorise(grid.shifted(0.5 * lowest), SparseCholesky::Keep::nothing));
    const double margin = 2.0 * cholesky.backward_error();
    CHECK(margin < 1e-10);  // the norm is 8
    CHECK(cholesky.factorise(grid.shifted(lowest - margin), SparseCholesky::Keep::nothing));
    CHECK(!cholesky.factorise(grid.shifted(lowest + margin), SparseCholesky::Keep::nothing));
  }
}

TEST_CASE("a factor that is kept solves, several right-hand sides at once", "[fast]") {
  const Grid grid(60);
  SparseCholesky cholesky(grid.lower, grid.place);
  REQUIRE(cholesky.factorise(grid.shifted(-0.1), SparseCholesky::Keep::factor));
  const Eigen::MatrixXd expected = Eigen::MatrixXd::Random(3600, 3);
  Eigen::MatrixXd X = grid.shifted(-0.1).selfadjointView<Eigen::Lower>() * expected;
  cholesky.solve(X);
  CHECK((X - expected).cwiseAbs().maxCoeff() < solve_tolerance);
}

TEST_CASE("nested dissection needs far less than a band, and a factor that is not kept far less memory", "[fast]") {
  const Grid grid(250);
  const SparseCholesky cholesky(grid.lower, grid.place);
  const double band = std::pow(250.0, 4) / 2.0;
  CHECK(cholesky.multiplications() < 0.25 * band);
  CHECK(cholesky.memory() < 0.5 * cholesky.memory_with_factor());
}

TEST_CASE("the stated backward error covers the difference of the product of the factors", "[fast]") {
  // L Lᵀ e_i from solving: A (L Lᵀ)⁻¹ = I + E (L Lᵀ)⁻¹, so ‖E‖ ≥ ‖A X − I‖ / ‖X‖ apart from the rounding of the solve.
  const Grid grid(30);
  SparseCholesky cholesky(grid.lower, grid.place);
  REQUIRE(cholesky.factorise(grid.lower, SparseCholesky::Keep::factor));
  Eigen::MatrixXd X = Eigen::MatrixXd::Identity(900, 900);
  cholesky.solve(X);
  const Eigen::MatrixXd error = grid.lower.selfadjointView<Eigen::Lower>() * X - Eigen::MatrixXd::Identity(900, 900);
  CHECK(error.operatorNorm() < cholesky.backward_error() * X.operatorNorm());
  CHECK(cholesky.backward_error() > 0.0);
}
