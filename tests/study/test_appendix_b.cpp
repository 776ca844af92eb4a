// SPDX-License-Identifier: MIT
#include "study/appendix_b.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace sphstab;
using study::ElasticState;
using study::ShearedAnnulus;
using study::StretchedPlate;

namespace {

/// Of fields of size one a length one apart: differences of fourth order over 1e-3 are right to 5e-12.
constexpr double differences = 2e-11;
constexpr double rounding = 1e-14;

const Material material = Material::from_young_modulus(1.5, 0.39, 0.3);
const std::vector<Vector<2>> points = {{1.1, 0.2}, {0.7, 1.2}, {1.9, 0.1}, {-0.9, 1.0}, {-1.0, -1.1}};

StretchedPlate plate(Plane plane) {
  return {.length = 2.0, .height = 1.5, .load_gradient = 0.4, .material = material, .plane = plane};
}

const ShearedAnnulus annulus{.shear_load = 0.3, .material = material};

/// ∂f/∂x_i at the position by differences over four points, for a field of vectors or tensors.
template <class Field>
auto derivative(const Field& f, const Vector<2>& position, int i) {
  const Vector<2> step = 1e-3 * Vector<2>::Unit(i);
  return ((8.0 * (f(position + step) - f(position - step)) - (f(position + 2.0 * step) - f(position - 2.0 * step))) /
          12e-3)
      .eval();
}

/// Strain is the symmetric gradient of displacement, stress obeys Hooke's law and is in equilibrium.
template <class Problem>
void check_solves_elasticity(const Problem& problem, Plane plane) {
  const auto displacement = [&](const Vector<2>& x) { return solution(problem, x).displacement; };
  const auto stress = [&](const Vector<2>& x) { return solution(problem, x).stress; };
  const auto lame = material.lame(plane);
  for (const auto& x : points) {
    const ElasticState state = solution(problem, x);
    Tensor<2> gradient;
    gradient << derivative(displacement, x, 0), derivative(displacement, x, 1);
    const Tensor<2> strain = 0.5 * (gradient + gradient.transpose());
    const Vector<2> force = derivative(stress, x, 0).col(0) + derivative(stress, x, 1).col(1);
    const Tensor<2> hooke =
        2.0 * lame.shear_modulus * state.strain + lame.lambda * state.strain.trace() * Tensor<2>::Identity();
    CHECK((state.strain - strain).norm() < differences);
    CHECK((state.stress - hooke).norm() < rounding);
    CHECK(force.norm() < differences);
  }
}

}  // namespace

TEST_CASE("the solution of the stretched plate obeys strain, Hooke's law and equilibrium in either plane", "[fast]") {
  check_solves_elasticity(plate(Plane::stress), Plane::stress);
  check_solves_elasticity(plate(Plane::strain), Plane::strain);
}

TEST_CASE("the solution of the sheared annulus obeys strain, Hooke's law and equilibrium in either plane", "[fast]") {
  check_solves_elasticity(annulus, Plane::stress);
  check_solves_elasticity(annulus, Plane::strain);
}

TEST_CASE("the stretched plate is loaded on its left and right alone, most at the bottom, not at all at the top",
          "[fast]") {
  const auto p = plate(Plane::stress);
  for (const double part : {0.0, 0.3, 1.0}) {
    const double y = part * p.height, x = part * p.length;
    const double load = 0.4 * (1.5 - y);
    const Vector<2> right = solution(p, {p.length, y}).stress * Vector<2>::UnitX();
    const Vector<2> left = solution(p, {0.0, y}).stress * -Vector<2>::UnitX();
    CHECK((right - Vector<2>(load, 0.0)).norm() < rounding);
    CHECK((left + Vector<2>(load, 0.0)).norm() < rounding);
    CHECK((solution(p, {x, 0.0}).stress * Vector<2>::UnitY()).norm() == 0.0);
    CHECK((solution(p, {x, p.height}).stress * Vector<2>::UnitY()).norm() == 0.0);
  }
}

TEST_CASE("the sheared annulus is loaded by q/b² at its outer and −q/a² at its inner edge, along the edge", "[fast]") {
  for (const double angle : {0.0, 0.7, 2.5, -1.2}) {
    const Vector<2> outwards(std::cos(angle), std::sin(angle)), along(-std::sin(angle), std::cos(angle));
    const double a = 0.5, b = 1.25;
    const Vector<2> outer = solution(annulus, b * outwards).stress * outwards;
    const Vector<2> inner = solution(annulus, a * outwards).stress * -outwards;
    CHECK((outer - 0.3 / (b * b) * along).norm() < rounding);
    CHECK((inner + 0.3 / (a * a) * along).norm() < rounding);
  }
}

TEST_CASE("both solutions are Appendix B as printed", "[fast]") {
  const double E = 0.39, mu = 0.3, k = 0.4, l = 2.0, q = 0.3;
  for (const auto& position : points) {
    const double x = position.x(), y = 1.5 - position.y();  // the paper's y points down from the top
    const auto stretched = solution(plate(Plane::stress), position);
    CHECK(stretched.displacement.x() == Approx(k / E * (x - l / 2) * y));
    CHECK(-stretched.displacement.y() == Approx(k / (2 * E) * (-mu * y * y - (x - l / 2) * (x - l / 2))));
    CHECK(stretched.strain(1, 1) == Approx(-mu * k * y / E));

    const double r = position.norm();
    const Vector<2> e_r = position / r, e_theta(-e_r.y(), e_r.x());
    const auto sheared = solution(annulus, position);
    const double tau = e_theta.dot(sheared.stress * e_r), epsilon = e_theta.dot(sheared.strain * e_r);
    CHECK(std::abs(sheared.displacement.dot(e_r)) < rounding);
    CHECK(sheared.displacement.dot(e_theta) == Approx(-(1 + mu) / E * q / r));
    CHECK(tau == Approx(q / (r * r)));
    CHECK(2.0 * epsilon == Approx(2 * (1 + mu) / E * q / (r * r)));
    CHECK(tau == Approx(E / (1 + mu) * epsilon));  // Eq. 3 with the paper's G
  }
}
