// SPDX-License-Identifier: MIT
// Rung 6 for whole bodies: the largest frequency of the assembled operator against the running solver.
#include <catch2/catch.hpp>

#include "analysis/spectrum.hpp"
#include "model/scene.hpp"
#include "study/step_comparison.hpp"

using namespace sphstab;

namespace {

/// The bisection's own: both ends of its bracket were run, and it is this narrow.
constexpr double bisection_tolerance = 1e-6;

template <int Dim>
Problem<Dim> problem(KernelNormalisation normalisation = KernelNormalisation::none, double poisson_ratio = 0.3) {
  constexpr LatticeKind kinds[] = {LatticeKind::chain, LatticeKind::square, LatticeKind::cubic};
  Problem<Dim> problem{.lattice = Lattice<Dim>(kinds[Dim - 1], 1.0),
                       .kernel = Kernel<Dim>(KernelFamily::cubic_spline, 1.3),
                       .material = Material::from_young_modulus(1.7, 2.3, poisson_ratio)};
  problem.scheme.kernel_normalisation = normalisation;
  return problem;
}

template <int Dim>
SceneDescription<Dim> scene(const Problem<Dim>& problem, const Placement<Dim>& placement) {
  return {.name = "", .problem = problem, .materials = {problem.material}, .parts = {{"body", placement}}};
}

Placement<2> rectangle(double from, double to, double height) { return {.shape = Box<2>{{from, 0.0}, {to, height}}}; }

/// The critical step of the spectrum lies in its bracket and both ends of the run's bracket are on the right side of
/// it: no step below grew, none above stayed bounded.
template <int Dim>
void check(const SceneDescription<Dim>& description) {
  const auto scene = make_scene(description);
  const auto limit = analysis::body_limit(scene.problem, scene.body);
  const auto found = study::compare_step<Dim>(scene.problem, scene.body, {.tolerance = bisection_tolerance});
  REQUIRE(found.run.critical_time_step);
  CHECK(*found.run.critical_time_step == Approx(limit.critical_time_step).epsilon(bisection_tolerance));
  CHECK(found.run.low <= limit.bracket.high);
  CHECK(found.run.high >= limit.bracket.low);
  CHECK(found.run.high - found.run.low <= bisection_tolerance * found.run.high);
}

}  // namespace

TEST_CASE("rung 6: bisection finds the step of the spectrum for a jittered body", "[ladder][theory-vs-bisection]") {
  for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum}) {
    auto plate = rectangle(0.0, 12.0, 10.0);
    plate.jitter = Jitter{0.2, 5};
    check(scene(problem<2>(normalisation), plate));
  }
}

TEST_CASE("rung 6: bisection finds the step of the spectrum for a clamped beam", "[ladder][theory-vs-bisection]") {
  auto beam = scene(problem<2>(KernelNormalisation::sum), rectangle(0.0, 20.0, 5.0));
  beam.clamps = {{Box<2>{{0.0, 0.0}, {2.0, 5.0}}, Directions<2>::Constant(true)},
                 {Box<2>{{19.0, 0.0}, {20.0, 5.0}}, Directions<2>(false, true)}};
  check(beam);
}

TEST_CASE("rung 6: bisection finds the step of the spectrum for a bar whose halves differ a thousandfold in density",
          "[ladder][theory-vs-bisection]") {
  for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum}) {
    auto bar = scene(problem<2>(normalisation), rectangle(0.0, 10.0, 5.0));
    bar.materials.push_back(Material::from_young_modulus(1700.0, 31.0, 0.45));
    bar.parts.push_back({"dense half", rectangle(10.0, 20.0, 5.0), 1});
    check(bar);
  }
}

TEST_CASE("rung 6: bisection finds the step of the spectrum for an almost incompressible plate",
          "[ladder][theory-vs-bisection]") {
  check(scene(problem<2>(KernelNormalisation::none, 0.4999), rectangle(0.0, 12.0, 12.0)));
}

TEST_CASE("rung 6: bisection finds the step of the spectrum for rings of particles of different volumes",
          "[ladder][theory-vs-bisection]") {
  for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum}) {
    const Placement<2> annulus{.shape = Annulus<2>{Vector<2>::Zero(), 3.0, 7.0},
                               .arrangement = PolarArrangement{.rings = 5, .sectors = 24}};
    check(scene(problem<2>(normalisation), annulus));
  }
}

TEST_CASE("rung 6: bisection finds the step of the spectrum in one and three dimensions",
          "[ladder][theory-vs-bisection]") {
  for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum}) {
    const Placement<1> bar{.shape = Box<1>{Vector<1>(0.0), Vector<1>(17.0)}, .jitter = Jitter{0.1, 3}};
    check(scene(problem<1>(normalisation), bar));
    const Placement<3> block{.shape = Box<3>{{0.0, 0.0, 0.0}, {5.0, 4.0, 3.0}}};
    check(scene(problem<3>(normalisation), block));
  }
}
