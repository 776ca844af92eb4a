// SPDX-License-Identifier: MIT
#include "analysis/acoustic_form.hpp"

#include <cmath>

namespace sphstab::analysis {

template <int Dim>
AcousticForm<Dim>::AcousticForm(const Problem<Dim>& problem, const Tensor<Dim>& consistency) {
  const LameConstants lame = problem.material.lame(problem.plane);
  const double rho0 = problem.material.density();
  double f = 1.0 / rho0;
  coupling = (lame.lambda + lame.shear_modulus) * Tensor<Dim>::Identity();
  if (problem.scheme.momentum_density == MomentumDensity::equation_of_state) {
    const Tensor<Dim> gradient = problem.displacement_gradient * consistency;
    const Tensor<Dim> e0 = 0.5 * (gradient + gradient.transpose());
    const Tensor<Dim> sigma0 = 2.0 * lame.shear_modulus * e0 + lame.lambda * e0.trace() * Tensor<Dim>::Identity();
    f *= std::exp(2.0 * lame.volume_factor * e0.trace());
    coupling += 2.0 * lame.volume_factor * sigma0;
  }
  shear = f * lame.shear_modulus;
  coupling *= f;
}

template struct AcousticForm<1>;
template struct AcousticForm<2>;
template struct AcousticForm<3>;

}  // namespace sphstab::analysis
