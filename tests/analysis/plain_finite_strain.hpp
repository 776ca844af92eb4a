// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/LU>
#include <boost/multiprecision/eigen.hpp>
#include <vector>

#include "tests/analysis/bodies.hpp"

namespace sphstab::bodies {

/// The nonlinear force of the schemes of finite strain written out over all pairs of particles with 50 digits, nothing
/// of it linearised; no list of neighbours is used:
///   F_a = Σ_b V_b (x_b − x_a) ⊗ N_a ∇_a W_ab,   force_a = V_a Σ_b V_b (P_a N_a + P_b N_b) ∇_a W_ab
/// The rotation of P = R S is the limit of R ← (R + R^−T)/2 from F (Higham 1986).
template <int Dim>
class PlainFiniteStrain {
 public:
  using PreciseVector = Vector<Dim, Precise>;
  using PreciseTensor = Tensor<Dim, Precise>;

  PlainFiniteStrain(const Problem<Dim>& problem, const Body<Dim>& body) : problem_(problem), body_(body) {
    for (int a = 0; a < body.size(); ++a) {
      neighbours_.emplace_back();
      PreciseTensor moments = PreciseTensor::Zero();
      for (int b = 0; b < body.size(); ++b) {
        const PreciseVector r = (body.position[a] - body.position[b]).template cast<Precise>();
        const Precise distance = sqrt(r.squaredNorm());
        if (a == b || distance >= problem.kernel.support() * (1.0 - tie_margin)) continue;
        const PreciseVector gradient = body.volume[b] * problem.kernel.slope(distance) / distance * r;
        neighbours_[a].push_back({b, gradient});
        moments -= r * gradient.transpose();
      }
      renormalisation_.push_back(moments.inverse());
    }
  }

  std::vector<PreciseVector> forces(const std::vector<PreciseVector>& x) const {
    std::vector<PreciseTensor> stress;
    for (int a = 0; a < body_.size(); ++a) {
      PreciseTensor sum = PreciseTensor::Zero();
      for (const auto& [b, gradient] : neighbours_[a])
        sum += (x[b] - x[a]) * (renormalisation_[a] * gradient).transpose();
      stress.push_back(first_piola_kirchhoff(sum, body_.material_of(a)) * renormalisation_[a]);
    }
    std::vector<PreciseVector> forces;
    for (int a = 0; a < body_.size(); ++a) {
      PreciseVector force = PreciseVector::Zero();
      for (const auto& [b, gradient] : neighbours_[a]) force += (stress[a] + stress[b]) * gradient;
      forces.push_back(body_.volume[a] * force);
    }
    return forces;
  }

  /// M^−½ K M^−½ over all components, clamped ones 0, K = −∂force/∂x by central differences at X + s: their error is
  /// the square of the difference.
  Eigen::MatrixXd stiffness(const Eigen::VectorXd& displacement) const {
    const Precise difference = Precise(1e-12);
    std::vector<PreciseVector> x;
    for (int a = 0; a < body_.size(); ++a)
      x.push_back((body_.position[a] + displacement.segment<Dim>(a * Dim)).template cast<Precise>());
    const auto is_clamped = [this](int i) { return !body_.clamped.empty() && body_.clamped[i / Dim][i % Dim]; };
    const int components = body_.size() * Dim;
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(components, components);
    for (int j = 0; j < components; ++j) {
      if (is_clamped(j)) continue;
      auto before = x, after = x;
      before[j / Dim][j % Dim] -= difference;
      after[j / Dim][j % Dim] += difference;
      const auto at_before = forces(before), at_after = forces(after);
      for (int i = 0; i < components; ++i)
        if (!is_clamped(i))
          K(i, j) = static_cast<double>((at_before[i / Dim][i % Dim] - at_after[i / Dim][i % Dim]) / (2 * difference) /
                                        sqrt(Precise(body_.mass(i / Dim)) * body_.mass(j / Dim)));
    }
    return K;
  }

 private:
  struct Neighbour {
    int b;
    PreciseVector gradient;  ///< V_b ∇_a W_ab
  };

  PreciseTensor first_piola_kirchhoff(const PreciseTensor& F, const Material& material) const {
    const Precise G = material.shear_modulus(), lambda = material.lame(Plane::strain).lambda;
    const PreciseTensor identity = PreciseTensor::Identity(), C = F.transpose() * F, E = (C - identity) / Precise(2);
    if (problem_.scheme.elastic_law == ElasticLaw::neo_hookean) {
      const PreciseTensor inverse = C.inverse();
      return F * (G * (identity - inverse) + lambda * log(F.determinant()) * inverse);
    }
    const PreciseTensor S = lambda * E.trace() * identity + 2 * G * E;
    if (problem_.scheme.formulation == Formulation::total_lagrangian_pk1) return F * S;
    PreciseTensor R = F;
    constexpr int doublings = 12;  // of the digits, once near
    for (int i = 0; i < doublings; ++i) R = ((R + R.inverse().transpose()) / Precise(2)).eval();
    return R * S;
  }

  const Problem<Dim>& problem_;
  const Body<Dim>& body_;
  std::vector<std::vector<Neighbour>> neighbours_;
  std::vector<PreciseTensor> renormalisation_;
};

struct FiniteStrainScheme {
  Formulation formulation;
  ElasticLaw law;
};

inline constexpr FiniteStrainScheme finite_strain_schemes[] = {
    {Formulation::total_lagrangian_corotated, ElasticLaw::saint_venant_kirchhoff},
    {Formulation::total_lagrangian_pk1, ElasticLaw::saint_venant_kirchhoff},
    {Formulation::total_lagrangian_pk1, ElasticLaw::neo_hookean}};

/// The problem of `bodies::problem` with such a scheme.
template <int Dim>
Problem<Dim> finite_strain_problem(const FiniteStrainScheme& scheme, KernelFamily kernel = KernelFamily::cubic_spline,
                                   double h_over_spacing = 1.3) {
  auto problem = bodies::problem<Dim>(kernel, h_over_spacing, KernelNormalisation::none);
  problem.scheme.formulation = scheme.formulation;
  problem.scheme.elastic_law = scheme.law;
  return problem;
}

/// A smooth displacement with strains of up to `strain` and rotations of as much, of bodies some ten spacings large.
template <int Dim>
Eigen::VectorXd bent(const Body<Dim>& body, double strain) {
  Eigen::VectorXd s(body.size() * Dim);
  for (int a = 0; a < body.size(); ++a)
    for (int i = 0; i < Dim; ++i) {
      const Vector<Dim>& X = body.position[a];
      s[a * Dim + i] = strain * (std::sin(0.7 * X[0] + i) - 0.8 * std::cos(0.5 * X[Dim - 1] - 2.0 * i));
    }
  return s;
}

/// The matrix that `apply` stands for, over all components.
template <class Operator>
Eigen::MatrixXd applied(Operator& op) {
  Eigen::MatrixXd result(op.components(), op.components());
  Eigen::VectorXd image(op.components());
  for (int i = 0; i < op.components(); ++i) {
    op.apply(Eigen::VectorXd::Unit(op.components(), i), image);
    result.col(i) = image;
  }
  return result;
}

}  // namespace sphstab::bodies
