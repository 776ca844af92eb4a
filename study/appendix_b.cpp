// SPDX-License-Identifier: MIT
#include "study/appendix_b.hpp"

#include "study/plane_moduli.hpp"

namespace sphstab::study {

ElasticState solution(const StretchedPlate& plate, const Vector<2>& position) {
  const auto [E, nu] = plane_moduli(plate.material, plate.plane);
  const double X = position.x() - 0.5 * plate.length, Y = plate.height - position.y();
  const double stress = plate.load_gradient * Y, strain = stress / E;
  return {.displacement = {strain * X, 0.5 * plate.load_gradient / E * (nu * Y * Y + X * X)},
          .strain = Vector<2>(strain, -nu * strain).asDiagonal(),
          .stress = Vector<2>(stress, 0.0).asDiagonal()};
}

ElasticState solution(const ShearedAnnulus& annulus, const Vector<2>& position) {
  const double r_squared = position.squaredNorm(), double_G = 2.0 * annulus.material.shear_modulus();
  const Vector<2> along(-position.y(), position.x());  // r e_θ
  const Tensor<2> shear =
      (position * along.transpose() + along * position.transpose()) / r_squared;  // e_r e_θ + e_θ e_r
  const Tensor<2> stress = annulus.shear_load / r_squared * shear;
  return {.displacement = -annulus.shear_load / (double_G * r_squared) * along,
          .strain = stress / double_G,
          .stress = stress};
}

}  // namespace sphstab::study
