// SPDX-License-Identifier: MIT
// Rungs 5 and 6: growth and critical steps of the running solver against theory.
#include <catch2/catch.hpp>
#include <cmath>

#include "analysis/critical_step.hpp"
#include "ladder/cases.hpp"
#include "study/growth_cases.hpp"
#include "study/patch_wave.hpp"
#include "study/step_comparison.hpp"

using namespace sphstab;
using study::PeriodicPatch;

namespace {

/// The bisection's own: both ends of its bracket were run, and it is this narrow.
constexpr double bisection_tolerance = 1e-6;

template <int Dim>
void check_bisection(const Problem<Dim>& problem, const study::BodyChoice<Dim>& choice,
                     study::RunOptions options = {.tolerance = bisection_tolerance}) {
  const auto found = study::compare_step(problem, choice, options);
  REQUIRE(found.run.critical_time_step);
  REQUIRE(found.theory.critical_time_step);
  CHECK(found.run.high - found.run.low <= bisection_tolerance * found.run.high);
  CHECK(*found.relative_difference() < bisection_tolerance);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("rung 5: above the limit a seeded wave grows by ln of the spectral radius a step", "[ladder]",
                       ((int Dim), Dim), 1, 2, 3) {
  const auto cells = ladder::running_patch<Dim>();
  for (auto& [name, problem] : ladder::every_variant<Dim>())
    for (const auto& [integrator, integrator_name] : total_lagrangian_integrators) {
      problem.integrator = integrator;
      INFO(name << ", " << integrator_name);
      const auto limit = std::get<analysis::ConditionallyStable<Dim>>(analysis::patch_limit(problem, cells));
      const double time_step = 1.01 * limit.critical_time_step;
      const auto wave = study::fastest_wave<Dim>(problem, cells, time_step);
      CHECK(wave.eigenvalue.real() < -1.0);
      CHECK(std::abs(study::seeded_growth<Dim>(wave, problem, cells, time_step) - wave.growth_per_step()) <
            study::seeded_tolerance);
    }
}

TEST_CASE("rung 5: a base state that theory calls never stable grows at the rate of its amplification matrix",
          "[ladder]") {
  const LatticeIndex<2> cells(6, 6);
  for (const LatticeKind lattice : {LatticeKind::square, LatticeKind::hexagonal, LatticeKind::staggered}) {
    auto problem = ladder::basic_problem<2>(lattice, KernelFamily::cubic_spline, 1.27);
    problem.displacement_gradient = -0.45 * Tensor<2>::Identity();
    problem.scheme.momentum_density = MomentumDensity::equation_of_state;
    const auto limit = std::get<analysis::NeverStable<2>>(analysis::patch_limit(problem, cells));
    const auto found =
        study::measure_growth<2>(std::string(name_of(lattice)), problem, cells, 0.05 / limit.growth_rate);
    INFO(ladder::describe(found));
    CHECK(found.theory > 0.045);
    CHECK(found.holds());
    CHECK(study::compare_step<2>(problem, PeriodicPatch<2>{cells}, {}).agrees(bisection_tolerance));
  }
}

TEST_CASE("rung 6: bisection finds the theory's limit for kernels, lattices, supports and integrators",
          "[ladder][theory-vs-bisection]") {
  for (const LatticeKind lattice : lattices_of(2))
    for (const auto kernel :
         {KernelFamily::cubic_spline, KernelFamily::gaussian, KernelFamily::wendland_c2, KernelFamily::sinc_5})
      for (const double h_over_spacing : {0.93, 1.31, 1.87})
        for (const auto& [integrator, integrator_name] : total_lagrangian_integrators) {
          INFO(name_of(kernel) << " " << name_of(lattice) << " h/spacing " << h_over_spacing << " " << integrator_name);
          auto problem = ladder::basic_problem<2>(lattice, kernel, h_over_spacing);
          problem.integrator = integrator;
          check_bisection<2>(problem, PeriodicPatch<2>{{8, 8}});
        }
}

TEMPLATE_TEST_CASE_SIG("rung 6: bisection finds the theory's limit for every term of the scheme",
                       "[ladder][theory-vs-bisection]", ((int Dim), Dim), 1, 2, 3) {
  for (auto& [name, problem] : ladder::every_variant<Dim>())
    for (const auto& [integrator, integrator_name] : total_lagrangian_integrators) {
      // A damped mode grows slowly near its limit, so that its runs are long: in 3D one case stands for all.
      const bool is_long = Dim == 3 && problem.scheme.damping;
      if (is_long && (integrator != Integrator::leapfrog || name != "damped cubic")) continue;
      problem.integrator = integrator;
      INFO(name << ", " << integrator_name);
      check_bisection<Dim>(problem, PeriodicPatch<Dim>{ladder::running_patch<Dim>()});
    }
}

TEST_CASE("rung 6: the limit of a patch approaches the bulk limit from above as the patch grows",
          "[ladder][theory-vs-bisection]") {
  for (const LatticeKind lattice : lattices_of(2)) {
    INFO(name_of(lattice));
    const auto problem = ladder::basic_problem<2>(lattice, KernelFamily::cubic_spline, 1.31);
    double deficit_before = 1.0;
    for (const int n : {16, 32, 64}) {
      INFO("patch " << n);
      const auto found = study::compare_step<2>(problem, PeriodicPatch<2>{{n, n}}, {.tolerance = bisection_tolerance});
      REQUIRE(found.relative_difference());
      CHECK(*found.relative_difference() < bisection_tolerance);
      CHECK(*found.run.critical_time_step > *found.bulk_theory * (1.0 - bisection_tolerance));
      // The wave vectors of a patch are among those of its double; the nearest one is at most half a mesh off: O(1/n²).
      CHECK(*found.patch_deficit() <= deficit_before);
      CHECK(*found.patch_deficit() < 10.0 / (n * n));
      deficit_before = *found.patch_deficit();
    }
  }
}

TEST_CASE("rung 6: bisection on free plates finds the largest eigenvalue of the assembled operator",
          "[ladder][theory-vs-bisection]") {
  for (const auto kernel : {KernelFamily::cubic_spline, KernelFamily::gaussian, KernelFamily::wendland_c4})
    for (const double h_over_spacing : {0.93, 1.31})
      for (const auto& [normalisation, normalisation_name] : Names<KernelNormalisation>::table)
        for (const Plane plane : {Plane::strain, Plane::stress}) {
          INFO(name_of(kernel) << " h/spacing " << h_over_spacing << " normalisation " << normalisation_name
                               << " plane " << name_of(plane));
          auto problem = ladder::basic_problem<2>(LatticeKind::square, kernel, h_over_spacing);
          problem.scheme.kernel_normalisation = normalisation;
          problem.plane = plane;
          check_bisection<2>(problem, free_plate<2>(problem, {9, 7}));
        }
}

TEST_CASE("rung 6: starting from the theory's mode or from other noise finds the same step",
          "[ladder][theory-vs-bisection]") {
  const auto hexagonal = ladder::basic_problem<2>(LatticeKind::hexagonal, KernelFamily::quintic_spline, 1.31);
  const auto square = ladder::basic_problem<2>(LatticeKind::square, KernelFamily::cubic_spline, 1.31);
  for (const study::RunOptions& options : {study::RunOptions{.start_from_mode = true},
                                           study::RunOptions{.noise_seed = 2}, study::RunOptions{.noise_seed = 3}}) {
    check_bisection<2>(hexagonal, PeriodicPatch<2>{{8, 6}}, options);
    check_bisection<2>(square, free_plate<2>(square, {8, 6}), options);
  }
}
