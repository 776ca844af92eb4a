// SPDX-License-Identifier: MIT
#include "analysis/dispersion.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/in_range.hpp"

namespace sphstab::analysis {

template <int Dim>
DispersionRelation<Dim>::DispersionRelation(const Problem<Dim>& problem)
    : symbol_(problem), form_(problem, symbol_.consistency()), steps_(problem) {}

template <int Dim>
std::array<WaveBranch<Dim>, Dim> DispersionRelation<Dim>::operator()(const Vector<Dim>& wave_vector) const {
  const Vector<Dim> D = symbol_.cleaned(wave_vector);
  const Tensor<Dim> jacobian = symbol_.jacobian(wave_vector), transverse = form_.shear * Tensor<Dim>::Identity();
  require_in_range(D.isZero(0.0) || std::isnormal(form_.transverse(D)));

  const auto wave = [&](Branch branch, const Tensor<Dim>& Q) {
    const Vector<Dim> image = Q * D;
    const double omega_squared = D.isZero(0.0) ? 0.0 : D.dot(image);
    require_in_range(std::isfinite(omega_squared));
    WaveBranch<Dim> result{branch, omega_squared, steps_(omega_squared).continuous_growth_rate(), {}, {}};
    if (omega_squared > 0.0) {
      const double omega = std::sqrt(omega_squared);
      result.phase_speed = omega / wave_vector.norm();
      result.group_velocity = jacobian * image / omega;
    }
    return result;
  };
  std::array<WaveBranch<Dim>, Dim> waves;
  waves.fill(wave(Branch::transverse, transverse));
  waves.back() = wave(Branch::longitudinal, form_.longitudinal());
  std::stable_sort(waves.begin(), waves.end(),
                   [](const auto& a, const auto& b) { return a.omega_squared < b.omega_squared; });
  return waves;
}

template class DispersionRelation<1>;
template class DispersionRelation<2>;
template class DispersionRelation<3>;

}  // namespace sphstab::analysis
