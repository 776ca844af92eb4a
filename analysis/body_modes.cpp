// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <random>

#include "analysis/body_operator.hpp"
#include "analysis/rigid_motions.hpp"
#include "analysis/sparse_cholesky.hpp"
#include "analysis/spectrum.hpp"

namespace sphstab::analysis {
namespace {

/// All eigenpairs are computed, by dense matrices, of bodies with few unknowns, and of larger ones of which a good part
/// of the modes is asked for.
constexpr int few_unknowns = 600, most_dense_unknowns = 3000;
constexpr double good_part = 0.1;

/// Unknowns times columns of a block: a few more vectors than modes that are asked for, so that the last ones converge
/// as fast as the first; each restart adds two applications of the inverse.
constexpr int spare_vectors = 6, blocks = 3, most_restarts = 200;

/// The inverse is that of H + shift ‖H‖: H itself has null vectors. Small beside the squares of all frequencies of
/// interest; the modes do not depend on it.
constexpr double shift = 1e-8;

/// A mode is converged where its residual is below both parts of H: ω² is then right to the square of the first.
constexpr double relative_residual = 1e-6, absolute_residual = 1e-13;

/// ω² below this, relative to ‖H‖, is the rounding of zero; such modes are one eigenspace.
constexpr double null_eigenvalue = 1e-12;

/// What of the kinetic energy of a rigid mode is that of rigid motions. At most as many modes as there are motions can
/// have more than half.
constexpr double rigid_share = 0.9;

/// ω² of a zero-energy mode is below this part of what the differences of neighbours stand for (long waves have one or
/// more), and its displacements agree with those of their neighbours less than this: 1 is a long wave, 0 or less one
/// that alternates. Long waves with a trace of the other kind, which the first alone would take for it, have more.
constexpr double felt_share = 0.1, least_agreement = 0.5;

constexpr double most_memory = 6e9;

struct EigenPairs {
  Eigen::VectorXd values;   ///< ascending
  Eigen::MatrixXd vectors;  ///< orthonormal
};

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& X) {
  return Eigen::HouseholderQR<Eigen::MatrixXd>(X).householderQ() * Eigen::MatrixXd::Identity(X.rows(), X.cols());
}

/// The best approximations to the lowest eigenpairs in the span of orthonormal columns.
EigenPairs rayleigh_ritz(const Eigen::SparseMatrix<double>& lower, const Eigen::MatrixXd& basis, int count) {
  const Eigen::MatrixXd image = lower.selfadjointView<Eigen::Lower>() * basis;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz(basis.transpose() * image);
  return {ritz.eigenvalues().head(count), basis * ritz.eigenvectors().leftCols(count)};
}

Eigen::VectorXd residuals(const Eigen::SparseMatrix<double>& lower, const EigenPairs& pairs) {
  const Eigen::MatrixXd image = lower.selfadjointView<Eigen::Lower>() * pairs.vectors;
  return (image - pairs.vectors * pairs.values.asDiagonal()).colwise().norm();
}

bool converged(const Eigen::SparseMatrix<double>& lower, const EigenPairs& pairs, int count, double norm) {
  const Eigen::ArrayXd allowed = relative_residual * pairs.values.array().abs() + absolute_residual * norm;
  return (residuals(lower, pairs).array() <= allowed).head(count).all();
}

/// The lowest eigenpairs by restarted block Krylov spaces of the inverse. A block of as many vectors as eigenvalues
/// that are asked for finds every eigenspace among them whole.
EigenPairs lowest_pairs(const Eigen::SparseMatrix<double>& lower, const Eigen::MatrixXd& places, int count,
                        double norm) {
  const int n = static_cast<int>(lower.cols());
  if (n <= few_unknowns || (n <= most_dense_unknowns && count > good_part * n)) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> all{Eigen::MatrixXd(lower)};
    return {all.eigenvalues().head(count), all.eigenvectors().leftCols(count)};
  }
  const int width = std::min(count + spare_vectors, n / blocks);
  SparseCholesky cholesky(lower, places);
  if (cholesky.memory_with_factor() > most_memory || width < count)
    throw InvalidInput(fmt::format(
        "lowest_modes: {} of a body of {} unknowns would take {:.1f} GB, at most {:.0f} and a third of the modes",
        count, n, 1e-9 * cholesky.memory_with_factor(), 1e-9 * most_memory));
  Eigen::SparseMatrix<double> shifted = lower;
  for (int i = 0; i < n; ++i) shifted.coeffRef(i, i) += shift * norm;
  cholesky.factorise(shifted, SparseCholesky::Keep::factor);

  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  EigenPairs pairs{{}, Eigen::MatrixXd(n, width)};
  for (auto& component : pairs.vectors.reshaped()) component = normal(random);
  Eigen::MatrixXd space(n, blocks * width);
  for (int restart = 0; restart < most_restarts; ++restart) {
    Eigen::MatrixXd block = pairs.vectors;
    for (int k = 0; k < blocks; ++k) {
      if (k > 0) cholesky.solve(block);
      block = orthonormal(block);
      space.middleCols(k * width, width) = block;
    }
    pairs = rayleigh_ritz(lower, orthonormal(space), width);
    if (converged(lower, pairs, count, norm)) break;
  }
  return {pairs.values.head(count), pairs.vectors.leftCols(count)};
}

/// What the displacements of neighbours against each other stand for, as a quadratic form of displacements:
///   Σ_a (V_a/N_a) 2μ_a min_Ω Σ_b V_b (−W'/r) |s_b − s_a − Ω r_ba|²,  2μ = min(2G, Dim λ + 2G), Ω antisymmetric.
/// The inner sum is ε:ε for slow fields, so this is at most the elastic energy of theirs, whatever the material; it is
/// 0 for rigid motions, and unlike Eq. 9 it does not overlook displacements that alternate.
template <int Dim>
Eigen::MatrixXd energy_of_differences(const BodyOperator<Dim>& op, const Eigen::MatrixXd& s) {
  constexpr int rotations = Dim * (Dim - 1) / 2;
  const Body<Dim>& body = op.body();
  Eigen::MatrixXd energy = Eigen::MatrixXd::Zero(s.cols(), s.cols());
  for (int a = 0; a < body.size(); ++a) {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(s.cols(), s.cols());
    Eigen::MatrixXd torque = Eigen::MatrixXd::Zero(rotations, s.cols());
    Eigen::Matrix<double, rotations, rotations> inertia = Eigen::Matrix<double, rotations, rotations>::Zero();
    for (int p = body.pairs.first[a]; p < body.pairs.first[a + 1]; ++p) {
      const Vector<Dim>& r = body.pairs.separation[p];
      const double weight = -op.gradient(p).dot(r) / r.squaredNorm();
      const Eigen::MatrixXd difference = s.middleRows<Dim>(body.pairs.neighbour[p] * Dim) - s.middleRows<Dim>(a * Dim);
      sum += weight * difference.transpose() * difference;
      Eigen::Matrix<double, Dim, rotations> turned = Eigen::Matrix<double, Dim, rotations>::Zero();
      int column = 0;
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < i; ++j, ++column) {
          turned(i, column) = r[j];
          turned(j, column) = -r[i];
        }
      torque += weight * turned.transpose() * difference;
      inertia += weight * turned.transpose() * turned;
    }
    if constexpr (rotations > 0) sum -= torque.transpose() * inertia.ldlt().solve(torque);
    const auto& [shear, lambda] = op.moduli(a);
    energy += body.volume[a] * std::min(2.0 * shear, Dim * lambda + 2.0 * shear) * sum;
  }
  return energy;
}

/// Σ_a m_a s_a · (mean of s_b over the neighbours, weighted by V_b (−W'/r)) over Σ_a m_a |s_a|², for each column.
template <int Dim>
Eigen::VectorXd agreement_with_neighbours(const BodyOperator<Dim>& op, const Eigen::MatrixXd& s) {
  const Body<Dim>& body = op.body();
  Eigen::VectorXd agreement = Eigen::VectorXd::Zero(s.cols()), square = agreement;
  for (int a = 0; a < body.size(); ++a) {
    const Eigen::MatrixXd own = s.middleRows<Dim>(a * Dim);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(Dim, s.cols());
    double weights = 0.0;
    for (int p = body.pairs.first[a]; p < body.pairs.first[a + 1]; ++p) {
      const Vector<Dim>& r = body.pairs.separation[p];
      const double weight = -op.gradient(p).dot(r) / r.squaredNorm();
      sum += weight * s.middleRows<Dim>(body.pairs.neighbour[p] * Dim);
      weights += weight;
    }
    if (weights > 0.0) agreement += body.mass(a) / weights * own.cwiseProduct(sum).colwise().sum().transpose();
    square += body.mass(a) * own.colwise().squaredNorm().transpose();
  }
  return agreement.cwiseQuotient(square);
}

/// An orthonormal basis of M^½ (rigid motions), over all components.
template <int Dim>
Eigen::MatrixXd rigid_basis(const BodyOperator<Dim>& op) {
  Eigen::MatrixXd motions = rigid_motions(op.body());
  for (const int i : op.unknowns()) motions.row(i) /= op.root_inverse_mass()[i];
  return motions.cols() == 0 ? motions : orthonormal(motions);
}

}  // namespace

template <int Dim>
std::vector<BodyMode> lowest_modes(const Problem<Dim>& problem, const Body<Dim>& body, int count) {
  if (count < 1) throw InvalidInput(fmt::format("lowest_modes: {} is not positive", count));
  const BodyOperator<Dim> op(problem, body);
  const double norm = op.norm_bound();
  const auto unknowns = static_cast<int>(op.unknowns().size());
  const Eigen::SparseMatrix<double> matrix = op.matrix();
  const EigenPairs pairs = lowest_pairs(matrix, op.places(), std::min(count, unknowns), norm);

  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(op.components(), pairs.values.size());
  x(op.unknowns(), Eigen::all) = pairs.vectors;
  const auto displacements = [&] { return Eigen::MatrixXd(op.root_inverse_mass().asDiagonal() * x); };
  // The vectors of the null space come in any mixture: sort them by what they stand for, rigid ones first.
  const auto nulls = (pairs.values.array() < null_eigenvalue * norm).count();
  if (nulls > 1) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> sorted(
        energy_of_differences(op, displacements().leftCols(nulls)));
    x.leftCols(nulls) = (x.leftCols(nulls) * sorted.eigenvectors()).eval();
  }
  const Eigen::MatrixXd s = displacements();
  const Eigen::VectorXd differences = energy_of_differences(op, s).diagonal();
  const Eigen::VectorXd agreement = agreement_with_neighbours(op, s);
  const Eigen::VectorXd rigid = (rigid_basis(op).transpose() * x).colwise().squaredNorm();

  const Eigen::VectorXd residual = residuals(matrix, pairs);
  std::vector<BodyMode> modes;
  for (int i = 0; i < static_cast<int>(pairs.values.size()); ++i) {
    const bool hardly_felt = pairs.values[i] < felt_share * differences[i] && agreement[i] < least_agreement;
    const BodyModeKind kind = rigid[i] > rigid_share ? BodyModeKind::rigid
                              : hardly_felt          ? BodyModeKind::zero_energy
                                                     : BodyModeKind::vibration;
    modes.push_back({std::sqrt(std::max(0.0, pairs.values[i])), kind, residual[i], s.col(i)});
  }
  return modes;
}

template std::vector<BodyMode> lowest_modes(const Problem<1>&, const Body<1>&, int);
template std::vector<BodyMode> lowest_modes(const Problem<2>&, const Body<2>&, int);
template std::vector<BodyMode> lowest_modes(const Problem<3>&, const Body<3>&, int);

}  // namespace sphstab::analysis
