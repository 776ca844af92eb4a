// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/body.hpp"

namespace sphstab::analysis {

/// What the linear operators of a body share, M d²s/dt² = −K s with s = (s_1, s_2, …), the components of a particle
/// adjacent and those that are clamped left out: the two sums over neighbours and the masses.
///   δG_a    = Σ_b V_b (s_b − s_a) ⊗ ∇_a W_ab
///   (K s)_a = −V_a Σ_b V_b (δτ_a + δτ_b) ∇_a W_ab,   δτ_a linear in δG_a
///   M_a     = ρ_a V_a N_a,   N = 1 or the kernel normalisation Σ V W, W(0) included
/// The schemes of finite strain renormalise the gradients, in δτ_a on both sides (Tran-Duc et al., Sec. 2.3; theory.md
/// §5): N_a = [Σ_b V_b (X_b − X_a) ⊗ ∇_a W_ab]⁻¹, a tensor. Keeps a reference to the body; one thread at a time.
template <int Dim>
class LinearisedBody {
 public:
  /// M^−½ x over all components: a displacement from an eigenvector.
  Eigen::VectorXd displacement(const Eigen::VectorXd& x) const { return root_inverse_mass_.cwiseProduct(x); }

  const Body<Dim>& body() const { return body_; }
  int components() const { return static_cast<int>(root_inverse_mass_.size()); }
  /// M^−½ of every component, 0 where it is clamped.
  const Eigen::VectorXd& root_inverse_mass() const { return root_inverse_mass_; }
  /// The components that are not clamped, ascending.
  const std::vector<int>& unknowns() const { return unknowns_; }
  /// The particle's position of each unknown, a column each.
  Eigen::MatrixXd places() const;

  /// Every unknown from a normal distribution: no direction is preferred.
  Eigen::VectorXd random_components(unsigned seed) const;

  /// V_b ∇_a W_ab of an entry of body().pairs.
  const Vector<Dim>& gradient(int pair) const { return gradient_[pair]; }

 protected:
  /// Throws InvalidInput for an updated-Lagrangian scheme, and where the neighbours of a particle do not span the space
  /// so that its gradients have no renormalisation.
  LinearisedBody(const Problem<Dim>& problem, const Body<Dim>& body);

  /// δG_a of displacement_.
  Tensor<Dim> displacement_gradient(int a) const {
    const Vector<Dim> s_a = displacement_[a];
    Tensor<Dim> sum = Tensor<Dim>::Zero();
    const int last = body_.pairs.first[a + 1];
    for (int p = body_.pairs.first[a]; p < last; ++p)
      sum.noalias() += (displacement_[body_.pairs.neighbour[p]] - s_a) * gradient_[p].transpose();
    return sum;
  }

  /// y = M^−½ K M^−½ x over all components, clamped ones 0, with δτ_a = stress_of(a, δG_a). Allocates nothing.
  template <class StressOf>
  void apply_with(const StressOf& stress_of, const Eigen::VectorXd& x, Eigen::VectorXd& y) {
    for (int a = 0; a < body_.size(); ++a)
      displacement_[a] = of_particle(root_inverse_mass_, a).cwiseProduct(of_particle(x, a));
    for (int a = 0; a < body_.size(); ++a) stress_[a] = stress_of(a, displacement_gradient(a));
    for (int a = 0; a < body_.size(); ++a) {
      const Tensor<Dim> stress = stress_[a];
      Vector<Dim> force = Vector<Dim>::Zero();
      const int last = body_.pairs.first[a + 1];
      for (int p = body_.pairs.first[a]; p < last; ++p)
        force.noalias() += (stress_[body_.pairs.neighbour[p]] + stress) * gradient_[p];
      y.template segment<Dim>(a * Dim) = -body_.volume[a] * of_particle(root_inverse_mass_, a).cwiseProduct(force);
    }
  }

  static auto of_particle(const Eigen::VectorXd& components, int a) {
    return components.template segment<Dim>(a * Dim);
  }

  const Body<Dim>& body_;
  std::vector<Vector<Dim>> gradient_;         ///< V_b ∇_a W_ab of an entry of body().pairs
  std::vector<Tensor<Dim>> renormalisation_;  ///< N_a of finite strain, symmetric; empty otherwise
  std::vector<double> normalisation_;         ///< N_a of the kernel, or 1
  Eigen::VectorXd root_inverse_mass_;
  std::vector<int> unknowns_;
  std::vector<Vector<Dim>> displacement_;

 private:
  std::vector<Tensor<Dim>> stress_;
};

/// The displacements of all particles as one vector, the components of a particle adjacent.
template <int Dim>
Eigen::VectorXd components_of(const std::vector<Vector<Dim>>& displacement) {
  Eigen::VectorXd components(Dim * static_cast<Eigen::Index>(displacement.size()));
  for (std::size_t a = 0; a < displacement.size(); ++a) components.template segment<Dim>(Dim * a) = displacement[a];
  return components;
}

extern template class LinearisedBody<1>;
extern template class LinearisedBody<2>;
extern template class LinearisedBody<3>;

}  // namespace sphstab::analysis
