// SPDX-License-Identifier: MIT
#include "analysis/sparse_cholesky.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>

namespace sphstab::analysis {
namespace {

/// Parts of at most this many unknowns are not divided.
constexpr int smallest_part = 100;

double bytes(double entries) { return entries * static_cast<double>(sizeof(double)); }

}  // namespace

SparseCholesky::SparseCholesky(const Pattern& lower, const Eigen::MatrixXd& place) : rank_(lower.cols()) {
  const Pattern graph = lower.selfadjointView<Eigen::Lower>();
  std::vector<int> all(lower.cols());
  for (int i = 0; i < lower.cols(); ++i) all[i] = i;
  dissect(graph, place, std::move(all));
  for (int i = 0; i < lower.cols(); ++i) rank_[order_[i]] = i;
  find_boundaries(graph);
  count();
}

/// Orders the unknowns of a part: one half, the other, and last those of the first half that are coupled to the second.
/// Returns the front of the latter.
int SparseCholesky::dissect(const Pattern& graph, const Eigen::MatrixXd& place, std::vector<int> part) {
  std::vector<int> children;
  if (static_cast<int>(part.size()) > smallest_part) {
    Eigen::VectorXd low = place.col(part[0]), high = low;
    for (const int i : part) {
      low = low.cwiseMin(place.col(i));
      high = high.cwiseMax(place.col(i));
    }
    int axis = 0;
    (high - low).maxCoeff(&axis);
    const auto middle = part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2);
    std::nth_element(part.begin(), middle, part.end(),
                     [&](int i, int j) { return std::pair(place(axis, i), i) < std::pair(place(axis, j), j); });
    // rank_ serves as a mark until the order is known.
    std::vector<int> first, second(middle, part.end()), separator;
    for (const int i : second) rank_[i] = 1;
    for (auto i = part.begin(); i != middle; ++i) {
      bool coupled = false;
      for (Pattern::InnerIterator entry(graph, *i); entry && !coupled; ++entry) coupled = rank_[entry.row()] == 1;
      (coupled ? separator : first).push_back(*i);
    }
    for (const int i : second) rank_[i] = 0;
    if (!first.empty()) {
      children = {dissect(graph, place, std::move(first)), dissect(graph, place, std::move(second))};
      part = std::move(separator);
    }
  }
  const int begin = static_cast<int>(order_.size());
  order_.insert(order_.end(), part.begin(), part.end());
  fronts_.push_back({begin, static_cast<int>(part.size()), {}, std::move(children)});
  return static_cast<int>(fronts_.size()) - 1;
}

void SparseCholesky::find_boundaries(const Pattern& graph) {
  std::vector<int> seen(order_.size(), -1);
  for (int f = 0; f < static_cast<int>(fronts_.size()); ++f) {
    Front& front = fronts_[f];
    const auto see = [&](int i) {
      if (i < front.first + front.own || seen[i] == f) return;
      seen[i] = f;
      front.boundary.push_back(i);
    };
    for (int i = front.first; i < front.first + front.own; ++i)
      for (Pattern::InnerIterator entry(graph, order_[i]); entry; ++entry) see(rank_[entry.row()]);
    for (const int child : front.children)
      for (const int i : fronts_[child].boundary) see(i);
    std::sort(front.boundary.begin(), front.boundary.end());
  }
}

void SparseCholesky::count() {
  double waiting = 0.0;  // entries of the updates of fronts whose parents have not come
  for (const Front& front : fronts_) {
    const double own = front.own, boundary = static_cast<double>(front.boundary.size());
    multiplications_ += own * (own * own / 6.0 + own * boundary / 2.0 + boundary * boundary / 2.0);
    factor_memory_ += bytes((own + boundary) * own);
    const double front_and_children = waiting + (own + boundary) * (own + boundary);
    for (const int child : front.children) {
      const double of_child = static_cast<double>(fronts_[child].boundary.size());
      waiting -= of_child * of_child;
    }
    waiting += boundary * boundary;
    const double front_and_update = waiting + (own + boundary) * (own + boundary);
    fronts_memory_ = std::max({fronts_memory_, bytes(front_and_children), bytes(front_and_update)});
  }
}

/// The lower triangle of a front: the columns of its own unknowns, and the updates of its children, which it consumes.
/// `local`: room for the place of each unknown in the front.
Eigen::MatrixXd SparseCholesky::assemble(const Pattern& permuted, const Front& front,
                                         std::vector<Eigen::MatrixXd>& updates, std::vector<int>& local) const {
  const int others = static_cast<int>(front.boundary.size());
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(front.own + others, front.own + others);
  for (int i = 0; i < front.own; ++i) local[front.first + i] = i;
  for (int i = 0; i < others; ++i) local[front.boundary[i]] = front.own + i;
  for (int j = 0; j < front.own; ++j)
    for (Pattern::InnerIterator entry(permuted, front.first + j); entry; ++entry)
      F(local[entry.row()], j) = entry.value();
  for (const int child : front.children) {
    const auto& boundary = fronts_[child].boundary;
    for (std::size_t j = 0; j < boundary.size(); ++j)
      for (std::size_t i = j; i < boundary.size(); ++i)
        F(local[boundary[i]], local[boundary[j]]) += updates[child](i, j);
    updates[child].resize(0, 0);
  }
  return F;
}

bool SparseCholesky::factorise(const Pattern& lower, Keep keep) {
  const int n = static_cast<int>(order_.size());
  Pattern permuted(n, n);
  permuted.selfadjointView<Eigen::Lower>() = lower.selfadjointView<Eigen::Lower>().twistedBy(
      Eigen::PermutationWrapper<const Eigen::Map<const Eigen::VectorXi>>(
          Eigen::Map<const Eigen::VectorXi>(rank_.data(), n)));

  factor_.clear();
  std::vector<Eigen::MatrixXd> updates(fronts_.size());
  Eigen::VectorXd row_sum = Eigen::VectorXd::Zero(n);
  std::vector<int> row_entries(n, 0), local(n);
  double largest_column_sum = 0.0;
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    const Front& front = fronts_[f];
    const int own = front.own, others = static_cast<int>(front.boundary.size());
    Eigen::MatrixXd F = assemble(permuted, front, updates, local);
    auto corner = F.topLeftCorner(own, own);
    if (Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>(corner).info() != Eigen::Success) return false;
    corner.triangularView<Eigen::StrictlyUpper>().setZero();
    auto below = F.bottomLeftCorner(others, own);
    corner.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(below);
    auto rest = F.bottomRightCorner(others, others);
    rest.selfadjointView<Eigen::Lower>().rankUpdate(below, -1.0);

    const auto panel = F.leftCols(own);
    if (own > 0) largest_column_sum = std::max(largest_column_sum, panel.cwiseAbs().colwise().sum().maxCoeff());
    const Eigen::VectorXd sums = panel.cwiseAbs().rowwise().sum();
    for (int i = 0; i < own + others; ++i) {
      const int row = i < own ? front.first + i : front.boundary[i - own];
      row_sum[row] += sums[i];
      row_entries[row] += own;
    }
    if (keep == Keep::factor) factor_.push_back(panel);
    updates[f] = rest;
  }
  constexpr int of_a_division = 3;  // by the reciprocal of the pivot, and its root
  const double k = *std::max_element(row_entries.begin(), row_entries.end()) + of_a_division;
  backward_error_ = k * std::numeric_limits<double>::epsilon() * largest_column_sum * row_sum.maxCoeff();
  return true;
}

void SparseCholesky::solve(Eigen::MatrixXd& X) const {
  Eigen::MatrixXd Y = X(order_, Eigen::all);
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    const Front& front = fronts_[f];
    auto own = Y.middleRows(front.first, front.own);
    factor_[f].topRows(front.own).triangularView<Eigen::Lower>().solveInPlace(own);
    Y(front.boundary, Eigen::all) -= factor_[f].bottomRows(front.boundary.size()) * own;
  }
  for (std::size_t f = fronts_.size(); f-- > 0;) {
    const Front& front = fronts_[f];
    auto own = Y.middleRows(front.first, front.own);
    own.noalias() -= factor_[f].bottomRows(front.boundary.size()).transpose() * Y(front.boundary, Eigen::all);
    factor_[f].topRows(front.own).triangularView<Eigen::Lower>().transpose().solveInPlace(own);
  }
  X(order_, Eigen::all) = Y;
}

}  // namespace sphstab::analysis
