// SPDX-License-Identifier: MIT
#include "study/rigid_motion.hpp"

#include <catch2/catch.hpp>
#include <random>

using namespace sphstab;

namespace {

/// Sums over twelve particles of numbers of size one.
constexpr double rounding = 1e-13;
constexpr int particles = 12;

template <int Dim>
std::vector<Vector<Dim>> random_vectors(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> entry(0.5, 2.0);
  std::vector<Vector<Dim>> vectors(particles);
  for (auto& v : vectors) v = Vector<Dim>::NullaryExpr([&] { return entry(random); });
  return vectors;
}

/// Scattered, off the origin, of unequal particles of two materials.
template <int Dim>
Body<Dim> body() {
  Body<Dim> b;
  b.position = random_vectors<Dim>(1);
  b.materials = {Material::from_young_modulus(1.0, 1.0, 0.3), Material::from_young_modulus(7.0, 1.0, 0.3)};
  for (int a = 0; a < particles; ++a) {
    b.volume.push_back(1.0 + 0.1 * a);
    b.material.push_back(a % 2);
  }
  return b;
}

template <int Dim>
double largest(const std::vector<Vector<Dim>>& field) {
  double norm = 0.0;
  for (const auto& v : field) norm = std::max(norm, v.norm());
  return norm;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("what is left without rigid motion has no momentum, and no pair's distance has changed",
                       "[fast]", ((int Dim), Dim), 1, 2, 3) {
  const auto b = body<Dim>();
  const auto before = random_vectors<Dim>(2);
  const auto after = study::remove_rigid_motion<Dim>(b, before);
  Vector<Dim> momentum = Vector<Dim>::Zero();
  Tensor<Dim> angular_momentum = Tensor<Dim>::Zero();
  for (int a = 0; a < particles; ++a) {
    momentum += b.mass(a) * after[a];
    angular_momentum += b.mass(a) * (b.position[a] * after[a].transpose() - after[a] * b.position[a].transpose());
    for (int other = 0; other < particles; ++other) {
      const Vector<Dim> removed = (before[a] - after[a]) - (before[other] - after[other]);
      CHECK(std::abs(removed.dot(b.position[a] - b.position[other])) < rounding);
    }
  }
  CHECK(momentum.norm() < rounding * particles);
  CHECK(angular_momentum.norm() < rounding * particles);
  CHECK(largest<Dim>(after) > 0.1);
}

TEMPLATE_TEST_CASE_SIG("a displacement that is rigid leaves nothing", "[fast]", ((int Dim), Dim), 1, 2, 3) {
  const auto b = body<Dim>();
  Tensor<Dim> random;
  for (int i = 0; i < Dim; ++i) random.col(i) = random_vectors<Dim>(3)[i];
  const Tensor<Dim> spin = random - random.transpose();
  std::vector<Vector<Dim>> displacement;
  for (const auto& x : b.position) displacement.push_back(Vector<Dim>::Constant(0.7) + spin * x);
  CHECK(largest<Dim>(study::remove_rigid_motion<Dim>(b, displacement)) < rounding);
}
