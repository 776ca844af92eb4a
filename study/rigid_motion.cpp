// SPDX-License-Identifier: MIT
#include "study/rigid_motion.hpp"

#include <Eigen/Cholesky>
#include <numeric>

#include "analysis/rigid_motions.hpp"

namespace sphstab::study {

namespace {

template <int Dim>
constexpr int rigid_motions = Dim + Dim*(Dim - 1) / 2;

/// Its columns are the displacements at x under unit translations and unit rotations in the planes of two axes.
template <int Dim>
Eigen::Matrix<double, Dim, rigid_motions<Dim>> motions_at(const Vector<Dim>& x) {
  Eigen::Matrix<double, Dim, rigid_motions<Dim>> motions = decltype(motions)::Zero();
  motions.template leftCols<Dim>().setIdentity();
  int column = Dim;
  for (int i = 0; i < Dim; ++i)
    for (int j = i + 1; j < Dim; ++j, ++column) {
      motions(i, column) = -x[j];
      motions(j, column) = x[i];
    }
  return motions;
}

/// Takes from the field of the particles listed, which are at `position`, the motions that fit it best: translations
/// along the directions that `moves`, and rotations if it `turns`.
template <int Dim>
void remove(const Body<Dim>& body, const std::vector<int>& particles, const Directions<Dim>& moves, bool turns,
            const std::vector<Vector<Dim>>& position, std::vector<Vector<Dim>>& field) {
  Eigen::Array<double, 1, rigid_motions<Dim>> allowed;
  allowed.setConstant(turns ? 1.0 : 0.0);
  allowed.template head<Dim>() = moves.template cast<double>().transpose();
  const Vector<Dim> origin = position[particles.front()];  // near them, so that rotations are little like translations
  const auto motions_of = [&](int a) {
    Eigen::Matrix<double, Dim, rigid_motions<Dim>> motions = motions_at<Dim>(position[a] - origin);
    motions.array().rowwise() *= allowed;
    return motions;
  };
  Eigen::Matrix<double, rigid_motions<Dim>, rigid_motions<Dim>> inertia = decltype(inertia)::Zero();
  Eigen::Matrix<double, rigid_motions<Dim>, 1> momentum = decltype(momentum)::Zero();
  for (const int a : particles) {
    const auto motions = motions_of(a);
    inertia += body.mass(a) * motions.transpose() * motions;
    momentum += body.mass(a) * motions.transpose() * field[a];
  }
  const decltype(momentum) amounts = inertia.ldlt().solve(momentum);  // 0 of a motion that moves nothing
  for (const int a : particles) field[a] -= motions_of(a) * amounts;
}

}  // namespace

template <int Dim>
std::vector<Vector<Dim>> remove_rigid_motion(const Body<Dim>& body, std::vector<Vector<Dim>> displacement) {
  std::vector<int> all(body.size());
  std::iota(all.begin(), all.end(), 0);
  remove<Dim>(body, all, Directions<Dim>::Constant(true), true, body.position, displacement);
  return displacement;
}

template <int Dim>
FreeMotion<Dim>::FreeMotion(const Body<Dim>& body, bool periodic) : body_(body) {
  for (auto& particles : analysis::connected_parts(body.pairs)) {
    Directions<Dim> moves = Directions<Dim>::Constant(true);
    if (!body.clamped.empty())
      for (const int a : particles) moves = moves && !body.clamped[a];
    if (moves.any()) parts_.push_back({std::move(particles), moves, moves.all() && !periodic});
  }
}

template <int Dim>
std::vector<Vector<Dim>> FreeMotion<Dim>::without(const std::vector<Vector<Dim>>& position,
                                                  std::vector<Vector<Dim>> velocity) const {
  for (const auto& part : parts_) remove<Dim>(body_, part.particles, part.moves, part.turns, position, velocity);
  return velocity;
}

template std::vector<Vector<1>> remove_rigid_motion(const Body<1>&, std::vector<Vector<1>>);
template std::vector<Vector<2>> remove_rigid_motion(const Body<2>&, std::vector<Vector<2>>);
template std::vector<Vector<3>> remove_rigid_motion(const Body<3>&, std::vector<Vector<3>>);
template class FreeMotion<1>;
template class FreeMotion<2>;
template class FreeMotion<3>;

}  // namespace sphstab::study
