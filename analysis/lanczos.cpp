// SPDX-License-Identifier: MIT
#include "analysis/lanczos.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace sphstab::analysis {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// T of the recurrence: off_diagonal[i] couples i and i + 1; its last entry leads out of the space.
struct Tridiagonal {
  std::vector<double> diagonal;
  std::vector<double> off_diagonal;

  std::size_t size() const { return diagonal.size(); }
  double coupling(std::size_t i) const { return i == 0 ? 0.0 : off_diagonal[i - 1]; }

  /// Pivots of T − x I that are positive: eigenvalues above x (Sturm).
  int above(double x) const {
    int count = 0;
    double pivot = 1.0;
    for (std::size_t i = 0; i < size(); ++i) {
      pivot = diagonal[i] - x - coupling(i) * coupling(i) / pivot;
      if (pivot == 0.0) pivot = -std::numeric_limits<double>::min();
      count += pivot > 0.0;
    }
    return count;
  }

  /// The eigenvalue with `larger` others above it, to the last bits.
  double eigenvalue(int larger) const {
    double high = 0.0;
    for (std::size_t i = 0; i < size(); ++i)
      high = std::max(high, std::abs(diagonal[i]) + std::abs(coupling(i)) + std::abs(off_diagonal[i]));
    double low = -high;
    while (high - low > epsilon * high) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) break;
      (above(middle) > larger ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

  /// The eigenvector of an eigenvalue, of norm 1: pivots from both ends meet where their sum is least (twisted
  /// factorisation, Dhillon & Parlett 2004).
  Eigen::VectorXd eigenvector(double eigenvalue) const {
    const std::size_t n = size();
    const double tiny = epsilon * epsilon * std::abs(eigenvalue) + std::numeric_limits<double>::min();
    const auto safe = [tiny](double pivot) { return std::abs(pivot) < tiny ? tiny : pivot; };
    std::vector<double> down(n), up(n);
    for (std::size_t i = 0; i < n; ++i)
      down[i] = safe(diagonal[i] - eigenvalue - (i == 0 ? 0.0 : coupling(i) * coupling(i) / down[i - 1]));
    for (std::size_t i = n; i-- > 0;)
      up[i] = safe(diagonal[i] - eigenvalue - (i + 1 == n ? 0.0 : off_diagonal[i] * off_diagonal[i] / up[i + 1]));
    std::size_t twist = 0;
    const auto gap = [&](std::size_t i) { return std::abs(down[i] + up[i] - (diagonal[i] - eigenvalue)); };
    for (std::size_t i = 1; i < n; ++i)
      if (gap(i) < gap(twist)) twist = i;
    Eigen::VectorXd s(n);
    s[twist] = 1.0;
    for (std::size_t i = twist; i-- > 0;) s[i] = -off_diagonal[i] / down[i] * s[i + 1];
    for (std::size_t i = twist + 1; i < n; ++i) s[i] = -coupling(i) / up[i] * s[i - 1];
    return s.normalized();
  }
};

/// One step after the other from a start; `visit(q, i)` sees the i-th vector.
template <class Visit>
Tridiagonal recurrence(const SymmetricOperator& apply, const Eigen::VectorXd& start, const Visit& visit) {
  Tridiagonal T;
  Eigen::VectorXd q = start.normalized(), previous = Eigen::VectorXd::Zero(start.size()), next(start.size());
  double beta = 0.0, largest = 0.0;
  for (;;) {
    apply(q, next);
    const double alpha = q.dot(next);
    next -= alpha * q + beta * previous;
    beta = next.norm();
    largest = std::max({largest, std::abs(alpha), beta});
    // The space is exhausted where only rounding leads out of it.
    const bool exhausted = !(beta > epsilon * largest);
    T.diagonal.push_back(alpha);
    T.off_diagonal.push_back(exhausted ? 0.0 : beta);
    if (visit(T, q) || exhausted) return T;
    previous.swap(q);
    q = next / beta;
  }
}

/// Eigenvalues that differ by no more than the residual are seen as one, with their mean for its value, and the gap is
/// that to the others: so the residual itself has to be below this many tolerances.
constexpr double spread = 100.0;

/// Residual and gap bound the error of a Ritz value: the lesser of r and r²/gap.
bool converged(const Tridiagonal& T, double tolerance) {
  const double theta = T.eigenvalue(0);
  const double residual = T.off_diagonal.back() * std::abs(T.eigenvector(theta)[T.size() - 1]);
  const double allowed = tolerance * std::abs(theta);
  if (residual <= allowed || T.size() < 2) return residual <= allowed;
  return residual <= spread * allowed && residual * residual <= allowed * (theta - T.eigenvalue(1));
}

double log_share(double failure_probability, int dimension, int unknowns) {
  return std::log(1.648 * std::sqrt(unknowns) * 2.0 * dimension * dimension / failure_probability);
}

}  // namespace

LanczosResult largest_eigenvalue(const SymmetricOperator& apply, const Eigen::VectorXd& start,
                                 const LanczosOptions& options) {
  std::size_t next_check = 4;
  const Tridiagonal T = recurrence(apply, start, [&](const Tridiagonal& so_far, const Eigen::VectorXd&) {
    const std::size_t k = so_far.size();
    if (k >= static_cast<std::size_t>(options.most)) return true;
    if (k < next_check) return false;
    next_check = k + 4 + k / 16;
    if (options.progress) options.progress(static_cast<double>(k) / (2 * options.most));
    return k >= static_cast<std::size_t>(options.fewest) && converged(so_far, options.tolerance);
  });

  const Eigen::VectorXd s = T.eigenvector(T.eigenvalue(0));
  LanczosResult result{0.0, 0.0, static_cast<int>(T.size()), 2 * static_cast<long>(T.size()) + 1, {}};
  result.vector = Eigen::VectorXd::Zero(start.size());
  recurrence(apply, start, [&](const Tridiagonal& so_far, const Eigen::VectorXd& q) {
    result.vector += s[so_far.size() - 1] * q;
    return so_far.size() == T.size();
  });
  result.vector.normalize();
  Eigen::VectorXd image(start.size());
  apply(result.vector, image);
  result.rayleigh_quotient = result.vector.dot(image);
  result.residual = (image - result.rayleigh_quotient * result.vector).norm();
  return result;
}

double probable_ratio(double failure_probability, int dimension, int unknowns) {
  const double root = log_share(failure_probability, dimension, unknowns) / (2 * dimension - 1);
  return root < 1.0 ? 1.0 / (1.0 - root * root) : std::numeric_limits<double>::infinity();
}

int dimension_for_ratio(double ratio, double failure_probability, int unknowns) {
  int dimension = 1;
  while (probable_ratio(failure_probability, dimension, unknowns) > ratio) dimension += 1 + dimension / 16;
  return dimension;
}

}  // namespace sphstab::analysis
