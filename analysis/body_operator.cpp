// SPDX-License-Identifier: MIT
#include "analysis/body_operator.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/mode_step.hpp"

namespace sphstab::analysis {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// Sums of pair weights below this, relative to the largest weight, are the rounding of zero (ten times a few dozen ε).
constexpr double cancelled = 1e-13;

/// N_a for each particle.
template <int Dim>
std::vector<double> normalisation(const Problem<Dim>& problem, const Body<Dim>& body) {
  std::vector<double> N(body.position.size(), 1.0);
  if (problem.scheme.kernel_normalisation == KernelNormalisation::none) return N;
  for (int a = 0; a < body.size(); ++a) {
    N[a] = body.volume[a] * problem.kernel.value(0.0);
    for (int p = body.pairs.first[a]; p < body.pairs.first[a + 1]; ++p)
      N[a] += body.volume[body.pairs.neighbour[p]] * problem.kernel.value(body.pairs.separation[p].norm());
  }
  return N;
}

/// B: the strain sums of Eq. 9, row (a Dim + i) Dim + j for ε_ij of particle a, before the division by N.
template <int Dim>
SparseMatrix strain_rows(const Problem<Dim>& problem, const Body<Dim>& body) {
  std::vector<Eigen::Triplet<double>> entries;
  double largest = 0.0;
  for (int a = 0; a < body.size(); ++a)
    for (int p = body.pairs.first[a]; p < body.pairs.first[a + 1]; ++p) {
      const int b = body.pairs.neighbour[p];
      const Vector<Dim>& r_ab = body.pairs.separation[p];
      const double distance = r_ab.norm();
      const Vector<Dim> weight = body.volume[b] * problem.kernel.slope(distance) / distance * r_ab;
      largest = std::max(largest, weight.norm());
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < Dim; ++j)
          for (const int row : {(a * Dim + i) * Dim + j, (a * Dim + j) * Dim + i}) {
            entries.emplace_back(row, b * Dim + i, 0.5 * weight[j]);
            entries.emplace_back(row, a * Dim + i, -0.5 * weight[j]);
          }
    }
  SparseMatrix B(body.size() * Dim * Dim, body.size() * Dim);
  B.setFromTriplets(entries.begin(), entries.end());
  B.prune(largest, cancelled);  // the sums of interior particles, and of images that outweigh each other
  return B;
}

/// Bᵀ (V C / N) B / ρ0 = (N V) K, symmetric.
template <int Dim>
Eigen::MatrixXd weighted_operator(const Problem<Dim>& problem, const Body<Dim>& body, const std::vector<double>& N) {
  if (problem.scheme.momentum_density == MomentumDensity::equation_of_state &&
      !problem.displacement_gradient.isZero(0.0))
    throw InvalidInput(
        "density_in_momentum: equation-of-state with a displacement_gradient is for infinite lattices, bodies take "
        "frozen");
  const LameConstants lame = problem.material.lame(problem.plane);
  std::vector<Eigen::Triplet<double>> entries;
  for (int a = 0; a < body.size(); ++a) {
    const double factor = body.volume[a] / (N[a] * problem.material.density());
    for (int ij = 0; ij < Dim * Dim; ++ij)
      entries.emplace_back(a * Dim * Dim + ij, a * Dim * Dim + ij, factor * 2.0 * lame.shear_modulus);
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j)
        entries.emplace_back((a * Dim + i) * Dim + i, (a * Dim + j) * Dim + j, factor * lame.lambda);
  }
  const SparseMatrix B = strain_rows(problem, body);
  SparseMatrix C(B.rows(), B.rows());
  C.setFromTriplets(entries.begin(), entries.end());
  return Eigen::MatrixXd(SparseMatrix(B.transpose() * SparseMatrix(C * B)));
}

/// N V of the particle of each degree of freedom.
template <int Dim>
Eigen::VectorXd weights(const Body<Dim>& body, const std::vector<double>& N) {
  Eigen::VectorXd NV(body.size() * Dim);
  for (int a = 0; a < body.size(); ++a) NV.segment<Dim>(a * Dim).setConstant(N[a] * body.volume[a]);
  return NV;
}

/// (N V)^½ K (N V)^−½, and the (N V)^−½ that turns its eigenvectors into displacements.
struct SymmetrisedOperator {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd scale;
};

template <int Dim>
SymmetrisedOperator symmetrised_operator(const Problem<Dim>& problem, const Body<Dim>& body) {
  const auto N = normalisation(problem, body);
  const Eigen::VectorXd scale = weights(body, N).cwiseSqrt().cwiseInverse();
  return {scale.asDiagonal() * weighted_operator(problem, body, N) * scale.asDiagonal(), scale};
}

}  // namespace

template <int Dim>
Eigen::MatrixXd dense_operator(const Problem<Dim>& problem, const Body<Dim>& body) {
  const auto N = normalisation(problem, body);
  return weights(body, N).cwiseInverse().asDiagonal() * weighted_operator(problem, body, N);
}

template <int Dim>
BodyLimit dense_body_limit(const Problem<Dim>& problem, const Body<Dim>& body) {
  const SymmetrisedOperator op = symmetrised_operator(problem, body);
  const Eigen::VectorXd omega_squared = op.matrix.selfadjointView<Eigen::Lower>().eigenvalues();

  const double largest = omega_squared[omega_squared.size() - 1];
  const double error = static_cast<double>(op.matrix.rows()) * std::numeric_limits<double>::epsilon();
  const auto limit = [&](double relative) {
    return ModeStep(problem.integrator, problem.scheme.damping, largest * (1.0 + relative)).limit();
  };
  const auto critical = limit(0.0);
  if (!critical) throw InvalidInput("smoothing_length: no particle of this body feels a force");
  BodyLimit result{*critical, {*limit(error), *limit(-error)}, std::sqrt(largest), {}};
  for (const double value : omega_squared) result.omega.push_back(std::sqrt(std::max(0.0, value)));
  return result;
}

template <int Dim>
Eigen::VectorXd critical_displacement(const Problem<Dim>& problem, const Body<Dim>& body) {
  const SymmetrisedOperator op = symmetrised_operator(problem, body);
  return op.scale.cwiseProduct(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(op.matrix).eigenvectors().rightCols<1>());
}

template Eigen::MatrixXd dense_operator(const Problem<1>&, const Body<1>&);
template Eigen::VectorXd critical_displacement(const Problem<1>&, const Body<1>&);
template BodyLimit dense_body_limit(const Problem<1>&, const Body<1>&);
template Eigen::MatrixXd dense_operator(const Problem<2>&, const Body<2>&);
template Eigen::VectorXd critical_displacement(const Problem<2>&, const Body<2>&);
template BodyLimit dense_body_limit(const Problem<2>&, const Body<2>&);
template Eigen::MatrixXd dense_operator(const Problem<3>&, const Body<3>&);
template Eigen::VectorXd critical_displacement(const Problem<3>&, const Body<3>&);
template BodyLimit dense_body_limit(const Problem<3>&, const Body<3>&);

}  // namespace sphstab::analysis
