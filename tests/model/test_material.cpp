// SPDX-License-Identifier: MIT
#include "model/material.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <catch2/catch.hpp>
#include <cmath>

using namespace sphstab;

namespace {

using Precise = boost::multiprecision::cpp_bin_float_50;

/// A handful of operations in double precision.
constexpr double rounding = 2e-15;

}  // namespace

TEST_CASE("Zhang's data give Zhang's constants: E = 0.39 Pa, his G = 0.3 Pa, gamma of plane strain and stress",
          "[fast]") {
  const auto material = Material::from_young_modulus(1000.0, 0.39, 0.3);
  CHECK(2.0 * material.shear_modulus() == Approx(0.3).epsilon(rounding));
  CHECK(material.lame(Plane::strain).lambda == Approx(0.3 * 0.3 / 0.4).epsilon(rounding));
  CHECK(material.lame(Plane::stress).lambda == Approx(0.3 * 0.3 / 0.7).epsilon(rounding));
  CHECK(material.lame(Plane::strain).volume_factor == 1.0);
  CHECK(material.lame(Plane::stress).volume_factor == Approx(0.4 / 0.7).epsilon(rounding));
  CHECK(material.young_modulus() == Approx(0.39).epsilon(rounding));
}

TEST_CASE("plane stress is the state whose stress out of the plane vanishes", "[fast]") {
  const double nu = 0.37, strain_xx = 0.01, strain_yy = -0.004;
  const auto material = Material::from_young_modulus(1.0, 5.0, nu);
  const double strain_zz = -nu / (1.0 - nu) * (strain_xx + strain_yy);
  const auto space = material.lame(Plane::strain), plane = material.lame(Plane::stress);
  const double trace = strain_xx + strain_yy + strain_zz;
  CHECK(std::abs(space.lambda * trace + 2.0 * space.shear_modulus * strain_zz) < rounding);
  CHECK(plane.lambda * (strain_xx + strain_yy) == Approx(space.lambda * trace).epsilon(10 * rounding));
  CHECK(plane.volume_factor * (strain_xx + strain_yy) == Approx(trace).epsilon(10 * rounding));
}

TEST_CASE("nearly incompressible materials lose no digits, whichever moduli they come from", "[fast]") {
  for (const double ratio : {1.0, 1e3, 1e6, 1e9}) {
    INFO("K/G = " << ratio);
    const Precise bulk = ratio, shear = 1;
    CHECK(Material::from_bulk_modulus(1.0, ratio, 1.0).lame(Plane::strain).lambda ==
          Approx(static_cast<double>(bulk - 2 * shear / 3)).epsilon(4 * rounding));
  }
  const double nu = 0.499999;
  const Precise exact = Precise(3.0) * nu / ((1 + Precise(nu)) * (1 - 2 * Precise(nu)));
  CHECK(Material::from_young_modulus(1.0, 3.0, nu).lame(Plane::strain).lambda ==
        Approx(static_cast<double>(exact)).epsilon(rounding));
}

TEST_CASE("impossible materials are refused, and incompressible ones in plane strain only", "[fast]") {
  CHECK_THROWS_WITH(Material::from_young_modulus(1.0, 1.0, 0.5).lame(Plane::strain),
                    "poisson_ratio: 0.5 is not below 0.5 (plane strain)");
  CHECK(Material::from_young_modulus(1.0, 1.0, 0.5).lame(Plane::stress).volume_factor == 0.0);
  CHECK_THROWS_AS(Material::from_young_modulus(1.0, 1.0, 0.6), InvalidInput);
  CHECK_THROWS_AS(Material::from_young_modulus(1.0, 1.0, -1.0), InvalidInput);
  CHECK_THROWS_AS(Material::from_young_modulus(1.0, 0.0, 0.3), InvalidInput);
  CHECK_THROWS_AS(Material::from_young_modulus(std::nan(""), 1.0, 0.3), InvalidInput);
  CHECK_THROWS_AS(Material::from_bulk_modulus(1.0, -1.0, 0.3), InvalidInput);
}
