// SPDX-License-Identifier: MIT
#include "analysis/linearised_body.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <random>

namespace sphstab::analysis {
namespace {

/// Neighbours in a plane or on a line: the least of the principal moments, relative to the largest, is the square of a
/// rounding of positions or of what is as good as one.
constexpr double flat = 1e-10;

/// N_a of the kernel.
template <int Dim>
double kernel_normalisation(const Problem<Dim>& problem, const Body<Dim>& body, int a) {
  if (problem.scheme.kernel_normalisation == KernelNormalisation::none) return 1.0;
  double N = body.volume[a] * problem.kernel.value(0.0);
  for (int p = body.pairs.first[a]; p < body.pairs.first[a + 1]; ++p)
    N += body.volume[body.pairs.neighbour[p]] * problem.kernel.value(body.pairs.separation[p].norm());
  return N;
}

}  // namespace

template <int Dim>
LinearisedBody<Dim>::LinearisedBody(const Problem<Dim>& problem, const Body<Dim>& body)
    : body_(body),
      root_inverse_mass_(Eigen::VectorXd::Zero(body.size() * Dim)),
      displacement_(body.size()),
      stress_(body.size()) {
  require_total_lagrangian(problem.scheme, "the spectrum of a body");
  const auto& pairs = body.pairs;
  gradient_.reserve(pairs.neighbour.size());
  for (int a = 0; a < body.size(); ++a) {
    Tensor<Dim> moments = Tensor<Dim>::Zero();  // Σ_b V_b (X_b − X_a) ⊗ ∇_a W_ab
    for (int p = pairs.first[a]; p < pairs.first[a + 1]; ++p) {
      const Vector<Dim>& r_ab = pairs.separation[p];
      const double distance = r_ab.norm();
      gradient_.push_back(body.volume[pairs.neighbour[p]] * problem.kernel.slope(distance) / distance * r_ab);
      moments -= r_ab * gradient_.back().transpose();
    }
    if (is_finite_strain(problem.scheme.formulation)) {
      const Vector<Dim> principal = moments.template selfadjointView<Eigen::Lower>().eigenvalues();
      if (!(principal.minCoeff() > flat * principal.maxCoeff()))
        throw InvalidInput(fmt::format(
            "smoothing_length: the neighbours of particle {} do not span the space, so that {} has no gradient there",
            a, name_of(problem.scheme.formulation)));
      renormalisation_.push_back(moments.inverse());
    }
    normalisation_.push_back(kernel_normalisation(problem, body, a));
    for (int i = 0; i < Dim; ++i) {
      if (!body.clamped.empty() && body.clamped[a][i]) continue;
      root_inverse_mass_[a * Dim + i] = 1.0 / std::sqrt(body.mass(a) * normalisation_[a]);
      unknowns_.push_back(a * Dim + i);
    }
  }
}

template <int Dim>
Eigen::MatrixXd LinearisedBody<Dim>::places() const {
  Eigen::MatrixXd places(Dim, unknowns_.size());
  for (std::size_t i = 0; i < unknowns_.size(); ++i) places.col(i) = body_.position[unknowns_[i] / Dim];
  return places;
}

template <int Dim>
Eigen::VectorXd LinearisedBody<Dim>::random_components(unsigned seed) const {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Eigen::VectorXd components = Eigen::VectorXd::Zero(root_inverse_mass_.size());
  for (const int i : unknowns_) components[i] = normal(random);
  return components;
}

template class LinearisedBody<1>;
template class LinearisedBody<2>;
template class LinearisedBody<3>;

}  // namespace sphstab::analysis
