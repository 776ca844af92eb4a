// SPDX-License-Identifier: MIT
#include "solver/stress.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace sphstab;
using namespace sphstab::solver;

namespace {

/// A dozen roundings of quantities of order 1.
constexpr double rounding = 12 * 2.2e-16;
constexpr double young_modulus = 2.3, poisson_ratio = 0.3;

Material material() { return Material::from_young_modulus(1.7, young_modulus, poisson_ratio); }

Tensor<2> strain(double xx, double yy, double xy) { return (Tensor<2>() << xx, xy, xy, yy).finished(); }

double von_mises_of(const Tensor<2>& strain, Plane plane) {
  return von_mises_stress(stress_in_space(strain, material().lame(plane), plane));
}

}  // namespace

TEST_CASE("von Mises stress is the stress of uniaxial tension and sqrt 3 times that of shear", "[fast]") {
  Tensor<3> tension = Tensor<3>::Zero(), shear = Tensor<3>::Zero();
  tension(1, 1) = -0.7;
  shear(0, 2) = shear(2, 0) = 0.4;
  CHECK(von_mises_stress(tension) == Approx(0.7).epsilon(rounding));
  CHECK(von_mises_stress(shear) == Approx(0.4 * std::sqrt(3.0)).epsilon(rounding));
}

TEST_CASE("a pressure gives no von Mises stress, and a power of two takes no digits from one", "[fast]") {
  const Tensor<3> pressure = 8.0 * Tensor<3>::Identity();
  CHECK(von_mises_stress(pressure) == 0.0);
  Tensor<3> shear = Tensor<3>::Zero();
  shear(0, 1) = shear(1, 0) = 1e-9;
  CHECK(von_mises_stress<double>(shear + 1e6 * pressure) == Approx(1e-9 * std::sqrt(3.0)).epsilon(rounding));
}

TEST_CASE("uniaxial strain gives 2 G times the strain in one, two and three dimensions", "[fast]") {
  const LameConstants lame = material().lame(Plane::strain);
  const double expected = 2.0 * lame.shear_modulus * 0.01;
  CHECK(von_mises_stress(stress_in_space(Tensor<1>(0.01), lame, Plane::strain)) == Approx(expected).epsilon(rounding));
  CHECK(von_mises_of(strain(0.01, 0.0, 0.0), Plane::strain) == Approx(expected).epsilon(rounding));
  Tensor<3> in_space = Tensor<3>::Zero();
  in_space(0, 0) = 0.01;
  CHECK(von_mises_stress(stress_in_space(in_space, lame, Plane::strain)) == Approx(expected).epsilon(rounding));
}

TEST_CASE("plane strain is the strain in space that has no third direction", "[fast]") {
  const Tensor<2> in_plane = strain(0.01, -0.004, 0.007);
  Tensor<3> in_space = Tensor<3>::Zero();
  in_space.topLeftCorner<2, 2>() = in_plane;
  const LameConstants lame = material().lame(Plane::strain);
  const Tensor<3> expected = linear_elastic_stress(in_space, lame);
  CHECK((stress_in_space(in_plane, lame, Plane::strain) - expected).norm() < rounding * expected.norm());
}

TEST_CASE("a bar under tension s has the von Mises stress s in plane stress and s sqrt(1 - nu + nu^2) in plane strain",
          "[fast]") {
  const double s = 0.05, nu = poisson_ratio, E = young_modulus;
  CHECK(von_mises_of(strain(s / E, -nu * s / E, 0.0), Plane::stress) == Approx(s).epsilon(rounding));
  const Tensor<2> thick = strain((1.0 - nu * nu) * s / E, -nu * (1.0 + nu) * s / E, 0.0);
  CHECK(von_mises_of(thick, Plane::strain) == Approx(s * std::sqrt(1.0 - nu + nu * nu)).epsilon(rounding));
}
