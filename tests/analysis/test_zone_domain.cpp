// SPDX-License-Identifier: MIT
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "analysis/irreducible_domain.hpp"
#include "analysis/zone_maximum.hpp"
#include "analysis/zone_zeros.hpp"
#include "tests/analysis/problems.hpp"

using namespace sphstab;
using namespace sphstab::analysis;

namespace {

/// Two searches enclose the maximum to some 1e-13 each.
constexpr double enclosure = 1e-12;
/// Newton ends within some 1e-13 of a zero, mapped by integers below ten.
constexpr double same_zero = 1e-10;

template <int Dim>
Problem<Dim> problem(const Lattice<Dim>& lattice, KernelFamily kernel, double h) {
  return {lattice, Kernel<Dim>(kernel, h), NeighbourRule::support, zhang_material(), Plane::strain, Scheme{}};
}

template <int Dim>
std::vector<Lattice<Dim>> lattices() {
  std::vector<Lattice<Dim>> all;
  for (const auto kind : lattices_of(Dim)) all.emplace_back(kind, 1.0);
  Tensor<Dim> stretched = Tensor<Dim>::Identity(), skewed = Tensor<Dim>::Identity();
  stretched(Dim - 1, Dim - 1) = 1.25;
  skewed(0, Dim - 1) = 0.3;
  skewed(Dim - 1, Dim - 1) = 0.9;
  all.emplace_back(stretched, 1.0);
  all.emplace_back(skewed, 1.0);
  return all;
}

/// Forms that keep all, some and only the inversion of the symmetries of a square or a cube.
template <int Dim>
std::vector<Tensor<Dim>> forms() {
  Tensor<Dim> along_axes = Tensor<Dim>::Identity(), generic;
  along_axes(0, 0) = 1.7;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) generic(i, j) = i == j ? 1.0 + 0.4 * i : 0.23 / (1.0 + i + j);
  return {Tensor<Dim>::Identity(), along_axes, generic};
}

template <int Dim>
void check_maximum(const Problem<Dim>& which, const Tensor<Dim>& form) {
  const GradientSymbol<Dim> symbol(which);
  const auto domain = irreducible_domain<Dim>(BrillouinZone(which.lattice), symbol, form);
  const auto whole = zone_maximum<Dim>(symbol.series(), form), part = zone_maximum<Dim>(symbol.series(), form, domain);
  INFO("dimension " << Dim << " lattice " << name_of(which.lattice.kind()) << " form " << form);
  CHECK(std::abs(part.value - whole.value) <= enclosure * whole.value);
  CHECK(part.lower <= whole.upper);
  CHECK(whole.lower <= part.upper);
  CHECK(part.upper - part.lower <= enclosure * part.value);
}

/// Every θ has an image in the domain; no more than a few parts in a thousand of all have two, those on its walls.
template <int Dim>
void check_covers(const Problem<Dim>& which, const Tensor<Dim>& form, std::mt19937& random) {
  const GradientSymbol<Dim> symbol(which);
  const auto domain = irreducible_domain<Dim>(BrillouinZone(which.lattice), symbol, form);
  std::uniform_real_distribution<double> uniform(-std::numbers::pi, std::numbers::pi);
  INFO("dimension " << Dim << " lattice " << name_of(which.lattice.kind()) << " form " << form);
  for (int i = 0; i < 200; ++i) {
    Vector<Dim> phases;
    for (double& phase : phases) phase = uniform(random);
    const auto images = domain.images(phases, 0.0);
    REQUIRE(images.size() == 1);
    const Vector<Dim> D = symbol.series()(phases), image = symbol.series()(images.front());
    CHECK(std::abs(image.dot(form * image) - D.dot(form * D)) <=
          4.0 * form.norm() * symbol.series().rounding() * D.norm());
  }
}

template <int Dim>
void check_zeros(const Problem<Dim>& which) {
  const GradientSymbol<Dim> symbol(which);
  const auto domain = irreducible_domain<Dim>(BrillouinZone(which.lattice), symbol, Tensor<Dim>::Identity());
  const auto whole = zone_zeros(symbol.series()), part = zone_zeros(symbol.series(), domain);
  INFO("dimension " << Dim << " lattice " << name_of(which.lattice.kind()));
  REQUIRE(whole.complete);
  REQUIRE(part.complete);
  REQUIRE(part.phases.size() == whole.phases.size());
  for (const auto& zero : whole.phases)
    CHECK(std::any_of(part.phases.begin(), part.phases.end(),
                      [&](const Vector<Dim>& other) { return wrapped<Dim>(zero - other).norm() < same_zero; }));
}

template <int Dim>
void check_all(double narrow, double wide) {
  std::mt19937 random(5);
  for (const auto& lattice : lattices<Dim>()) {
    for (const auto& form : forms<Dim>()) {
      check_maximum<Dim>(problem<Dim>(lattice, KernelFamily::cubic_spline, narrow), form);
      check_covers<Dim>(problem<Dim>(lattice, KernelFamily::wendland_c4, wide), form, random);
    }
    check_zeros<Dim>(problem<Dim>(lattice, KernelFamily::cubic_spline, narrow));
    check_zeros<Dim>(problem<Dim>(lattice, KernelFamily::wendland_c2, narrow));
  }
}

}  // namespace

TEST_CASE("every phase has one image in the irreducible domain, where D Q D is the same", "[fast]") {
  check_all<1>(2.1, 3.0);
  check_all<2>(1.1, 1.6);
  check_all<3>(0.9, 1.2);
}

TEST_CASE("the irreducible domain is the part of the zone that the order of the group says", "[fast]") {
  const Problem<2> square = problem<2>(Lattice<2>(LatticeKind::square, 2.0), KernelFamily::cubic_spline, 2.6);
  const GradientSymbol<2> symbol(square);
  const auto domain = irreducible_domain<2>(BrillouinZone(square.lattice), symbol, Tensor<2>::Identity());
  CHECK(domain.group().size() == 8);
  // k_x ≥ k_y ≥ 0 within the zone: the triangle Γ, X, M.
  CHECK(domain.low().norm() <= 1e-14);
  CHECK((domain.high() - Vector<2>::Constant(std::numbers::pi)).norm() <= 1e-14);
  CHECK(domain.touches(Vector<2>(3.0, 1.0), 0.0));
  CHECK_FALSE(domain.touches(Vector<2>(1.0, 3.0), 0.0));
  CHECK(domain.touches(Vector<2>(1.0, 3.0), 1.5));
  CHECK(domain.touches(PhaseBox<2>{Vector<2>(1.0, 2.0), 0.6}));
  CHECK_FALSE(domain.touches(PhaseBox<2>{Vector<2>(1.0, 2.0), 0.4}));
  // A shear of the form leaves inversion and the two diagonals, a stretch the two axes.
  Tensor<2> shear = Tensor<2>::Identity(), stretch = shear;
  shear(0, 1) = shear(1, 0) = 0.2;
  stretch(0, 0) = 2.0;
  CHECK(irreducible_domain<2>(BrillouinZone(square.lattice), symbol, shear).group().size() == 4);
  CHECK(irreducible_domain<2>(BrillouinZone(square.lattice), symbol, stretch).group().size() == 4);
}

TEST_CASE("symmetries that hold to more than rounding do not count", "[fast]") {
  const Problem<2> square = problem<2>(Lattice<2>(LatticeKind::square, 1.0), KernelFamily::cubic_spline, 1.3);
  Tensor<2> form = Tensor<2>::Identity(), vectors = form;
  form(0, 0) += 1e-12;
  CHECK(irreducible_domain<2>(BrillouinZone(square.lattice), GradientSymbol<2>(square), form).group().size() == 4);
  vectors(0, 0) += 1e-12;
  const Problem<2> nearly = problem<2>(Lattice<2>(vectors, 1.0), KernelFamily::cubic_spline, 1.3);
  const auto domain =
      irreducible_domain<2>(BrillouinZone(nearly.lattice), GradientSymbol<2>(nearly), Tensor<2>::Identity());
  CHECK(domain.group().size() == 4);
}

TEST_CASE("the symmetries that pass the rounding of a turned lattice still make a group", "[fast]") {
  // fcc, turned, in another basis and with 15 digits: of its 48 symmetries some just pass and their products do not.
  Tensor<3> vectors;
  vectors << 0.455701552739102, 0.94571128098778, 2.025069232112264, 0.385041802270238, -0.251012339708501,
      0.957974671014762, -0.802545266845216, -0.206453332078987, -3.997671714241479;
  const auto turned = problem<3>(Lattice<3>(vectors, 1.0), KernelFamily::cubic_spline, 1.1);
  const GradientSymbol<3> symbol(turned);
  const auto domain = irreducible_domain<3>(BrillouinZone(turned.lattice), symbol, Tensor<3>::Identity());
  for (const auto& left : domain.group())
    for (const auto& right : domain.group())
      CHECK(std::any_of(domain.group().begin(), domain.group().end(),
                        [&](const Tensor<3>& other) { return other == left * right; }));
  CHECK(zone_zeros(symbol.series(), domain).phases.size() == 25);  // those of fcc as it is named
}

TEST_CASE("a shell that rounding parts at the support takes its symmetries with it", "[fast]") {
  // A turned square whose support is a rounding away from the third shell: some of its four sites are inside.
  Tensor<2> vectors;
  vectors << 0.982207881565826, 0.32846705061810677, 0.18779690463362914, 0.944515429550117;
  Problem<2> parted{.lattice = Lattice<2>(vectors, 1.0),
                    .kernel = Kernel<2>(KernelFamily::gaussian, 0.8660254037853048, 2.0),
                    .material = zhang_material()};
  check_maximum<2>(parted, Tensor<2>::Identity());
}
