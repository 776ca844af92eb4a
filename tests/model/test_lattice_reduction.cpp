// SPDX-License-Identifier: MIT
#include "model/lattice_reduction.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "model/lattice_index.hpp"
#include "tests/model/shapes.hpp"

using namespace sphstab;

namespace {

/// Sums of integer multiples up to a few thousand of vectors of order one.
constexpr double rounding = 1e-11;

/// The lengths of the shortest independent vectors of a lattice by a search among Σ n_i a_i, |n_i| ≤ 6: far enough for
/// the nearly reduced vectors that it is given.
template <int Dim>
Vector<Dim> successive_minima(const Tensor<Dim>& vectors) {
  std::vector<Vector<Dim>> candidates;
  const LatticeIndex<Dim> reach = LatticeIndex<Dim>::Constant(6);
  for_each_index<Dim>(-reach, reach, [&](const auto& n) {
    if (!n.isZero()) candidates.push_back(vectors * n.template cast<double>());
  });
  std::sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) { return a.norm() < b.norm(); });
  Vector<Dim> minima;
  Eigen::MatrixXd found(Dim, 0);
  for (const auto& candidate : candidates) {
    Eigen::MatrixXd more(Dim, found.cols() + 1);
    more << found, candidate;
    if (Eigen::FullPivLU<Eigen::MatrixXd>(more).rank() < more.cols()) continue;
    minima[found.cols()] = candidate.norm();
    if (more.cols() == Dim) break;
    found = more;
  }
  return minima;
}

template <int Dim>
void check_reductions() {
  std::mt19937 random(1);
  for (const auto& shape : shapes<Dim>()) {
    INFO(shape.name);
    const Vector<Dim> expected = successive_minima<Dim>(shape.vectors);
    for (int sample = 0; sample < 20; ++sample) {
      const Tensor<Dim> given = rotation<Dim>() * skewed<Dim>(shape.vectors, random);
      const Tensor<Dim> reduced = reduced_basis<Dim>(given);
      const Tensor<Dim> change = given.inverse() * reduced;
      CHECK((change - change.array().round().matrix()).norm() < 1e-6);  // whole numbers
      CHECK(std::abs(std::abs(change.determinant()) - 1.0) < 1e-6);     // and back
      Vector<Dim> lengths = reduced.colwise().norm();
      std::sort(lengths.begin(), lengths.end());
      CHECK((lengths - expected).norm() < rounding);
    }
  }
}

}  // namespace

TEST_CASE("a reduced basis spans the same lattice with vectors as long as its successive minima", "[fast]") {
  check_reductions<1>();
  check_reductions<2>();
  check_reductions<3>();
}

TEST_CASE("the named lattices are given in reduced bases, which stay as they are", "[fast]") {
  for (const LatticeKind kind : lattices_of(2)) {
    const Tensor<2> vectors = Lattice<2>(kind, 0.7).primitive_vectors();
    CHECK(reduced_basis<2>(vectors) == vectors);
  }
  for (const LatticeKind kind : lattices_of(3)) {
    const Tensor<3> vectors = Lattice<3>(kind, 0.7).primitive_vectors();
    CHECK(reduced_basis<3>(vectors) == vectors);
  }
}

TEST_CASE("lattice coordinates undo a sum of lattice vectors", "[fast]") {
  const Tensor<2> skew{{1.0, 100.0}, {0.0, 1.0}};
  CHECK(lattice_coordinates<2>(skew, {0.0, 1.0}) == LatticeIndex<2>(-100, 1));
  CHECK(lattice_coordinates<2>(skew, {3.0, -2.0}) == LatticeIndex<2>(203, -2));
}
