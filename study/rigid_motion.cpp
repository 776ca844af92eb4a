// SPDX-License-Identifier: MIT
#include "study/rigid_motion.hpp"

#include <Eigen/Cholesky>

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

}  // namespace

template <int Dim>
std::vector<Vector<Dim>> remove_rigid_motion(const Body<Dim>& body, std::vector<Vector<Dim>> displacement) {
  using Amounts = Eigen::Matrix<double, rigid_motions<Dim>, 1>;
  const Vector<Dim> origin = body.position.front();  // near the body, so that rotations are little like translations
  Eigen::Matrix<double, rigid_motions<Dim>, rigid_motions<Dim>> inertia = decltype(inertia)::Zero();
  Amounts momentum = Amounts::Zero();
  for (int a = 0; a < body.size(); ++a) {
    const auto motions = motions_at<Dim>(body.position[a] - origin);
    inertia += body.mass(a) * motions.transpose() * motions;
    momentum += body.mass(a) * motions.transpose() * displacement[a];
  }
  const Amounts amounts = inertia.ldlt().solve(momentum);
  for (int a = 0; a < body.size(); ++a) displacement[a] -= motions_at<Dim>(body.position[a] - origin) * amounts;
  return displacement;
}

template std::vector<Vector<1>> remove_rigid_motion(const Body<1>&, std::vector<Vector<1>>);
template std::vector<Vector<2>> remove_rigid_motion(const Body<2>&, std::vector<Vector<2>>);
template std::vector<Vector<3>> remove_rigid_motion(const Body<3>&, std::vector<Vector<3>>);

}  // namespace sphstab::study
