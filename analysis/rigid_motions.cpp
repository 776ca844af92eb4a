// SPDX-License-Identifier: MIT
#include "analysis/rigid_motions.hpp"

#include <Eigen/LU>

namespace sphstab::analysis {
namespace {

/// A clamp that moves less than this, of a part of size 1 turned by 1, does not hold the turning.
constexpr double held = 1e-9;

/// Translations, then rotations about `centre` by one radian in units of `size`, of the particles listed: rows
/// (particle, component).
template <int Dim>
Eigen::MatrixXd motions_of_part(const Body<Dim>& body, const std::vector<int>& part) {
  Vector<Dim> centre = Vector<Dim>::Zero();
  for (const int a : part) centre += body.position[a] / static_cast<double>(part.size());
  double size = 0.0;
  for (const int a : part) size = std::max(size, (body.position[a] - centre).norm());
  const int rotations = part.size() > 1 ? Dim * (Dim - 1) / 2 : 0;

  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(part.size() * Dim, Dim + rotations);
  for (std::size_t n = 0; n < part.size(); ++n) {
    auto rows = motions.template middleRows<Dim>(n * Dim);
    rows.template leftCols<Dim>().setIdentity();
    if (rotations == 0) continue;
    const Vector<Dim> r = (body.position[part[n]] - centre) / size;
    int column = Dim;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < i; ++j, ++column) {
        rows(i, column) = r[j];
        rows(j, column) = -r[i];
      }
  }
  return motions;
}

}  // namespace

template <int Dim>
std::vector<std::vector<int>> connected_parts(const NeighbourPairs<Dim>& pairs) {
  std::vector<std::vector<int>> parts;
  std::vector<char> seen(pairs.particles(), 0);
  for (int start = 0; start < pairs.particles(); ++start) {
    if (seen[start]) continue;
    seen[start] = 1;
    std::vector<int> part{start};
    for (std::size_t next = 0; next < part.size(); ++next)
      for (int p = pairs.first[part[next]]; p < pairs.first[part[next] + 1]; ++p) {
        const int b = pairs.neighbour[p];
        if (seen[b]) continue;
        seen[b] = 1;
        part.push_back(b);
      }
    parts.push_back(std::move(part));
  }
  return parts;
}

template <int Dim>
Eigen::MatrixXd rigid_motions(const Body<Dim>& body) {
  Eigen::MatrixXd result(body.size() * Dim, 0);
  for (const auto& part : connected_parts(body.pairs)) {
    Eigen::MatrixXd motions = motions_of_part(body, part);
    Eigen::MatrixXd of_clamps = motions;
    for (std::size_t n = 0; n < part.size(); ++n)
      for (int i = 0; i < Dim; ++i)
        if (body.clamped.empty() || !body.clamped[part[n]][i]) of_clamps.row(n * Dim + i).setZero();
    Eigen::FullPivLU<Eigen::MatrixXd> lu(of_clamps.transpose() * of_clamps);
    lu.setThreshold(held);
    if (lu.dimensionOfKernel() == 0) continue;
    motions *= lu.kernel();
    const auto before = result.cols();
    result.conservativeResizeLike(Eigen::MatrixXd::Zero(result.rows(), before + motions.cols()));
    for (std::size_t n = 0; n < part.size(); ++n)
      result.block(part[n] * Dim, before, Dim, motions.cols()) = motions.middleRows(n * Dim, Dim);
  }
  return result;
}

template std::vector<std::vector<int>> connected_parts(const NeighbourPairs<1>&);
template std::vector<std::vector<int>> connected_parts(const NeighbourPairs<2>&);
template std::vector<std::vector<int>> connected_parts(const NeighbourPairs<3>&);
template Eigen::MatrixXd rigid_motions(const Body<1>&);
template Eigen::MatrixXd rigid_motions(const Body<2>&);
template Eigen::MatrixXd rigid_motions(const Body<3>&);

}  // namespace sphstab::analysis
