// SPDX-License-Identifier: MIT
#pragma once

#include "analysis/linearised_body.hpp"
#include "analysis/tangent_moduli.hpp"

namespace sphstab::analysis {

/// The linear operator of a body of finite strain about any state x = F0 X + s, in equilibrium or not, with the sums of
/// LinearisedBody:
///   F_a = F0 + δG_a(s) N_a,   δP_a = A_a : δF_a,   δF_a = δG_a N_a,   δτ_a = δP_a N_a
/// with A_a of `tangent_moduli`; F0 is Problem::deformation_gradient, I for all but periodic patches. M^−½ K M^−½ is
/// symmetric for `tl-pk1`, where K is the second derivative of Σ V Ψ(F), not for `tl-corotated`: its ω² may be complex.
/// Keeps references to problem and body; one thread at a time. Tested in tests/analysis/test_deformed_body.cpp.
template <int Dim>
class DeformedBodyOperator : public LinearisedBody<Dim> {
 public:
  /// About s = 0. Throws InvalidInput unless the scheme is one of finite strain.
  DeformedBodyOperator(const Problem<Dim>& problem, const Body<Dim>& body);

  /// Linearises about this displacement of all components, clamped ones included. Throws InvalidInput where det F is
  /// not above 0: a particle is turned inside out.
  void set_state(const Eigen::VectorXd& displacement);

  /// y = M^−½ K M^−½ x over all components, clamped ones 0. Allocates nothing.
  void apply(const Eigen::VectorXd& x, Eigen::VectorXd& y);

  const Problem<Dim>& problem() const { return problem_; }

 private:
  using Base = LinearisedBody<Dim>;

  const Problem<Dim>& problem_;
  std::vector<LameConstants> lame_;              ///< of body().materials
  std::vector<TangentModuli<Dim>> of_gradient_;  ///< δτ_a = of_gradient_[a] : δG_a
};

extern template class DeformedBodyOperator<1>;
extern template class DeformedBodyOperator<2>;
extern template class DeformedBodyOperator<3>;

}  // namespace sphstab::analysis
