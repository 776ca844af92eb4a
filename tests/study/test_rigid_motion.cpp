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

TEMPLATE_TEST_CASE_SIG("only what clamps leave free is taken for rigid motion", "[fast]", ((int Dim), Dim), 1, 2, 3) {
  auto b = body<Dim>();
  b.pairs = find_pairs<Dim>(b.position, 100.0);
  const auto field = random_vectors<Dim>(2);
  const auto left_by = [&](bool periodic) { return study::FreeMotion<Dim>(b, periodic).without(b.position, field); };
  CHECK(left_by(false) == study::remove_rigid_motion<Dim>(b, field));

  // Along x alone: the mean of mass goes, and nothing turns, as in a periodic box.
  Vector<Dim> mean = Vector<Dim>::Zero();
  double mass = 0.0;
  for (int a = 0; a < particles; ++a) mean += b.mass(a) * field[a], mass += b.mass(a);
  mean /= mass;
  const auto in_box = left_by(true);
  for (int a = 0; a < particles; ++a) CHECK((field[a] - mean - in_box[a]).norm() < rounding);
  b.clamped.assign(particles, Directions<Dim>::Constant(false));
  b.clamped[3] = Directions<Dim>::Constant(true);
  b.clamped[3][0] = false;
  if (Dim > 1)
    for (int a = 0; a < particles; ++a)
      CHECK((field[a] - mean[0] * Vector<Dim>::Unit(0) - left_by(false)[a]).norm() < rounding);
  b.clamped[3][0] = true;
  CHECK(left_by(false) == field);
}

TEMPLATE_TEST_CASE_SIG("each part moves by itself, and as a rigid one however far it has turned", "[fast]",
                       ((int Dim), Dim), 2, 3) {
  auto b = body<Dim>();
  b.position.resize(6);
  for (int a = 6; a < particles; ++a) b.position.push_back(b.position[a - 6] + Vector<Dim>::Constant(50.0));
  b.pairs = find_pairs<Dim>(b.position, 10.0);
  auto position = b.position;
  std::vector<Vector<Dim>> velocity;
  for (int a = 0; a < particles; ++a) {
    position[a].template head<2>() = Vector<2>(-b.position[a][1], b.position[a][0]);  // a quarter of a turn
    const double spin = a < 6 ? 0.3 : -0.7;
    velocity.push_back(Vector<Dim>::Constant(spin));
    velocity.back().template head<2>() += spin * Vector<2>(-position[a][1], position[a][0]);
  }
  // Distances of 50 about the origin.
  CHECK(largest<Dim>(study::FreeMotion<Dim>(b, false).without(position, velocity)) < 100.0 * rounding);
  CHECK(largest<Dim>(study::remove_rigid_motion<Dim>(b, velocity)) > 0.1);
}
