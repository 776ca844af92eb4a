// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <set>

#include "solver/allocations.hpp"
#include "solver/updated_cases.hpp"

using namespace sphstab;
using namespace sphstab::solver;
using namespace sphstab::solver::test;

namespace {

constexpr double support = 1.3;

/// A pair as a < b and r_ab in millionths of the support, which tells images apart.
using Pair = std::tuple<int, int, std::vector<long>>;

template <int Dim>
Pair make_pair_of(int a, int b, const Vector<Dim>& r_ab) {
  std::vector<long> rounded;
  for (int i = 0; i < Dim; ++i) rounded.push_back(std::lround(r_ab[i] / support * 1e6));
  return {a, b, rounded};
}

template <int Dim>
std::multiset<Pair> pairs_of(const NeighbourList<Dim>& list, const Field<Dim>& position) {
  std::multiset<Pair> pairs;
  for (int a = 0; a < static_cast<int>(position.size()); ++a)
    for (const auto& [b, image] : list.candidates(a)) {
      const Vector<Dim> r_ab = position[a] - position[b] - list.shift(image);
      if (r_ab.norm() < support) pairs.insert(make_pair_of<Dim>(a, b, r_ab));
    }
  return pairs;
}

template <int Dim>
std::multiset<Pair> brute_force(const Field<Dim>& position, const std::optional<Tensor<Dim>>& box) {
  std::multiset<Pair> pairs;
  const int images = box ? 8 : 0;
  for (int a = 0; a < static_cast<int>(position.size()); ++a)
    for (int b = a + 1; b < static_cast<int>(position.size()); ++b)
      for_each_index<Dim>(LatticeIndex<Dim>::Constant(-images), LatticeIndex<Dim>::Constant(images),
                          [&](const LatticeIndex<Dim>& n) {
                            Vector<Dim> r_ab = position[a] - position[b];
                            if (box) r_ab += *box * n.template cast<double>();
                            if (r_ab.norm() < support) pairs.insert(make_pair_of<Dim>(a, b, r_ab));
                          });
  return pairs;
}

/// Particles that wander by up to a tenth of the skin a step, so that rebuilds fall between.
template <int Dim>
void check_while_moving(int particles, double extent, const std::optional<Tensor<Dim>>& box) {
  Noise noise(1);
  Field<Dim> position, velocity;
  for (int a = 0; a < particles; ++a) {
    position.push_back(0.5 * extent * (noise.vector<Dim>() + Vector<Dim>::Ones()));
    velocity.push_back(0.1 * skin_fraction * support * noise.vector<Dim>());
  }
  NeighbourList<Dim> list(support, box);
  int builds = 0;
  for (int step = 0; step < 60; ++step) {
    builds += list.update(position) ? 1 : 0;
    CHECK(pairs_of(list, position) == brute_force(position, box));
    for (int a = 0; a < particles; ++a) position[a] += velocity[a];
  }
  // Half the skin takes five of the longest steps in 1-D, and 60 steps as many as twelve builds.
  CHECK(builds > 1);
  CHECK(builds <= 1 + 60 / 3);
}

}  // namespace

TEST_CASE("ul: neighbours of wandering free particles are those of brute force", "[fast]") {
  check_while_moving<1>(40, 20.0, std::nullopt);
  check_while_moving<2>(60, 8.0, std::nullopt);
  check_while_moving<3>(60, 4.0, std::nullopt);
}

TEST_CASE("ul: neighbours in periodic boxes are those of brute force, images and skewed boxes included", "[fast]") {
  check_while_moving<1>(20, 10.0, Tensor<1>(10.0));
  check_while_moving<1>(3, 0.7, Tensor<1>(0.7));
  check_while_moving<2>(40, 6.0, Tensor<2>((Tensor<2>() << 6.0, 1.5, 0.0, 5.0).finished()));
  check_while_moving<2>(5, 1.0, Tensor<2>((Tensor<2>() << 1.0, 0.5, 0.0, 0.9).finished()));
  check_while_moving<3>(8, 1.2, Tensor<3>(1.2 * Tensor<3>::Identity()));
}

TEST_CASE("ul: the list is built again when a particle has moved by more than half the skin, and not before",
          "[fast]") {
  for (const bool periodic : {false, true}) {
    const auto box = periodic ? std::optional(Tensor<2>(10.0 * Tensor<2>::Identity())) : std::nullopt;
    NeighbourList<2> list(support, box);
    Field<2> position{{0.0, 0.0}, {1.4, 0.0}, {5.0, 5.0}};  // the first two within the skin
    CHECK(list.update(position));
    CHECK(list.size() == 1);
    CHECK(!list.update(position));
    const double half_skin = 0.5 * skin_fraction * support;
    position[2] += Vector<2>(0.999 * half_skin, 0.0);
    CHECK(!list.update(position));
    position[2] += Vector<2>(0.002 * half_skin, 0.0);
    CHECK(list.update(position));
    CHECK(!list.update(position));
    // The displacement counts from the last build.
    position[2] += Vector<2>(0.0, 0.999 * half_skin);
    CHECK(!list.update(position));
    position[2] = {std::numeric_limits<double>::quiet_NaN(), 0.0};
    CHECK(!list.update(position));
  }
}

TEST_CASE("ul: particles thrown far out of a periodic box do no harm", "[fast]") {
  NeighbourList<2> list(support, Tensor<2>(10.0 * Tensor<2>::Identity()));
  Field<2> position{{0.0, 0.0}, {1.0, 0.0}, {1e100, -1e200}};
  CHECK(list.update(position));
  CHECK(list.size() == 1);
}

TEST_CASE("ul: a step allocates nothing but where it builds the list", "[fast]") {
  for (const auto integrator : updated_integrators) {
    Problem<2> problem = with_all_terms(updated_problem<2>());
    problem.integrator = integrator;
    UpdatedSimulation<2> simulation(problem, LatticeIndex<2>(8, 8));
    auto state = disturbed(simulation.base_state(), 0.01, 1);
    simulation.advance(state, 0.01);  // builds the list, stores rates
    const long allocated = allocations();
    simulation.advance(state, 0.01, 10);
    const long allocated_by_steps = allocations() - allocated;
    CHECK(allocated_by_steps == 0);
    CHECK(simulation.work().list_builds == 1);
  }
}

TEST_CASE("ul: a run across the box rebuilds its list as often as it must and forgets no pair", "[fast]") {
  // All particles drift by a hundredth of the skin a step; 51 of them are more than half, which fit into 300 five
  // times.
  Problem<2> problem = updated_problem<2>();
  problem.integrator = Integrator::leapfrog;
  UpdatedSimulation<2> simulation(problem, LatticeIndex<2>(6, 6));
  auto state = simulation.base_state();
  const double skin = skin_fraction * problem.kernel.support();
  for (auto& v : state.velocity) v = Vector<2>(1.0, 0.0);
  simulation.advance(state, 0.01 * skin, 300);
  CHECK(simulation.work().list_builds == 1 + 5);
  CHECK(simulation.pairs() == 36 * 20 / 2);
}
