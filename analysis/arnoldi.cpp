// SPDX-License-Identifier: MIT
#include "analysis/arnoldi.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>
#include <vector>

namespace sphstab::analysis {
namespace {

/// A V = V H + v bᵀ with orthonormal columns (V v), H and below it bᵀ in one matrix of one row more.
class KrylovSpace {
 public:
  KrylovSpace(const Eigen::VectorXd& start, int dimension)
      : basis_(start.size(), dimension + 1),
        projection_(Eigen::MatrixXd::Zero(dimension + 1, dimension)),
        next_(start.size()) {
    basis_.col(0) = start.normalized();
  }

  int size() const { return size_; }
  int dimension() const { return static_cast<int>(projection_.cols()); }

  /// Adds A v to the space. False if it has it already, but for rounding.
  bool extend(const LinearOperator& apply) {
    const int k = size_++;
    apply(basis_.col(k), next_);
    const double before = next_.norm();
    auto column = projection_.col(k);
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::VectorXd parts = basis_.leftCols(k + 1).transpose() * next_;
      next_.noalias() -= basis_.leftCols(k + 1) * parts;
      column.head(k + 1) += parts;
    }
    column[k + 1] = next_.norm();
    if (!(column[k + 1] > rounding * before)) return false;
    basis_.col(k + 1) = next_ / column[k + 1];
    return true;
  }

  Eigen::MatrixXd projection() const { return projection_.topLeftCorner(size_, size_); }
  /// ‖A V y − θ V y‖ of a Ritz pair.
  double residual(const Eigen::VectorXcd& y) const { return std::abs(projection_.row(size_).head(size_).dot(y)); }
  Eigen::VectorXcd vector(const Eigen::VectorXcd& y) const { return basis_.leftCols(size_) * y; }

  /// Keeps the part V Y of the space, Y an invariant space of H with orthonormal columns, and v.
  void restart(const Eigen::MatrixXd& Y) {
    const auto kept = Y.cols();
    const Eigen::MatrixXd inner = Y.transpose() * projection() * Y;
    const Eigen::RowVectorXd below = projection_.row(size_).head(size_) * Y;
    projection_.setZero();
    projection_.topLeftCorner(kept, kept) = inner;
    projection_.row(kept).head(kept) = below;
    basis_.leftCols(kept) = (basis_.leftCols(size_) * Y).eval();
    basis_.col(kept) = basis_.col(size_).eval();
    size_ = static_cast<int>(kept);
  }

 private:
  static constexpr double rounding = 8.0 * std::numeric_limits<double>::epsilon();

  Eigen::MatrixXd basis_;
  Eigen::MatrixXd projection_;
  Eigen::VectorXd next_;
  int size_ = 0;
};

/// The eigenvalues of H from the wanted one on, the one of a complex pair with a positive imaginary part first.
std::vector<int> from_the_wanted(const Eigen::VectorXcd& values, Extreme extreme) {
  Eigen::VectorXd rank = extreme == Extreme::outermost ? values.cwiseAbs().eval() : values.real().eval();
  if (extreme == Extreme::leftmost) rank = -rank;
  std::vector<int> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return std::pair(rank[i], values[i].imag()) > std::pair(rank[j], values[j].imag()); });
  return order;
}

/// An orthonormal basis of half of the Ritz vectors, pairs undivided.
Eigen::MatrixXd wanted_half(const Eigen::EigenSolver<Eigen::MatrixXd>& ritz, const std::vector<int>& order) {
  const auto half = static_cast<Eigen::Index>(order.size() / 2);
  Eigen::MatrixXd parts(order.size(), half + 1);
  Eigen::Index count = 0;
  for (const int i : order) {
    if (count >= half) break;
    const std::complex<double> value = ritz.eigenvalues()[i];
    if (value.imag() < 0.0) continue;
    const Eigen::VectorXcd y = ritz.eigenvectors().col(i);
    parts.col(count++) = y.real();
    if (value.imag() > 0.0) parts.col(count++) = y.imag();
  }
  return Eigen::HouseholderQR<Eigen::MatrixXd>(parts.leftCols(count)).householderQ() *
         Eigen::MatrixXd::Identity(parts.rows(), count);
}

}  // namespace

ArnoldiResult arnoldi(const LinearOperator& apply, const Eigen::VectorXd& start, const ArnoldiOptions& options) {
  assert(options.dimension >= 4);  // half of them, and both of a pair, leave room
  KrylovSpace space(start, std::min<int>(options.dimension, static_cast<int>(start.size())));
  for (long applications = 0;;) {
    bool open = true;
    while (open && space.size() < space.dimension() && applications < options.most) {
      open = space.extend(apply);
      ++applications;
    }
    const Eigen::EigenSolver<Eigen::MatrixXd> ritz(space.projection());
    const std::vector<int> order = from_the_wanted(ritz.eigenvalues(), options.extreme);
    const Eigen::VectorXcd y = ritz.eigenvectors().col(order.front());
    const double residual = space.residual(y), largest = ritz.eigenvalues().cwiseAbs().maxCoeff();
    if (!open || residual <= options.tolerance * largest || applications >= options.most)
      return {ritz.eigenvalues()[order.front()], residual, largest, applications, space.vector(y)};
    space.restart(wanted_half(ritz, order));
    if (options.progress) options.progress(applications);
  }
}

}  // namespace sphstab::analysis
