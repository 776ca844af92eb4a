// SPDX-License-Identifier: MIT
// Rung 6 of finite strain: critical steps of the running solver by bisection against theory.
#include <catch2/catch.hpp>
#include <cmath>

#include "analysis/deformed_limit.hpp"
#include "ladder/finite_strain_cases.hpp"
#include "study/bodies.hpp"
#include "study/growth_run.hpp"
#include "study/relaxation.hpp"
#include "study/step_comparison.hpp"

using namespace sphstab;
using study::PeriodicPatch;

namespace {

/// The bisection's own: both ends of its bracket were run, and it is this narrow.
constexpr double bisection_tolerance = 1e-6;

template <int Dim>
study::StepComparison check_bisection(const Problem<Dim>& problem, const study::BodyChoice<Dim>& choice,
                                      bool start_from_mode = false) {
  const auto found =
      study::compare_step<Dim>(problem, choice, {.start_from_mode = start_from_mode, .tolerance = bisection_tolerance});
  REQUIRE(found.run.critical_time_step);
  REQUIRE(found.theory.critical_time_step);
  CHECK(found.run.high - found.run.low <= bisection_tolerance * found.run.high);
  CHECK(*found.relative_difference() < bisection_tolerance);
  return found;
}

/// Every scheme and base state, with one lattice and one integrator each in turn.
template <int Dim>
std::vector<ladder::NamedProblem<Dim>> in_turn() {
  std::vector<ladder::NamedProblem<Dim>> subjects;
  const auto lattices = lattices_of(Dim);
  std::size_t next = 0;
  for (const auto& scheme : ladder::finite_strain_schemes)
    for (const auto& [state, gradient] : ladder::base_states<Dim>()) {
      const auto lattice = lattices[next % lattices.size()];
      const auto& [integrator, integrator_name] = total_lagrangian_integrators[next++ % 2];
      auto problem = ladder::finite_strain_problem<Dim>(scheme, lattice, KernelFamily::cubic_spline, 1.13);
      problem.integrator = integrator;
      problem.deformation_gradient = gradient;
      subjects.push_back({ladder::describe(problem.scheme) + ", " + state + ", " + std::string(name_of(lattice)) +
                              ", " + std::string(integrator_name),
                          problem});
    }
  return subjects;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("rung 6: bisection finds the theory's limit of uniform states of finite strain",
                       "[ladder][theory-vs-bisection]", ((int Dim), Dim), 1, 2, 3) {
  for (const auto& [name, problem] : in_turn<Dim>()) {
    INFO(name);
    check_bisection<Dim>(problem, PeriodicPatch<Dim>{ladder::small_patch<Dim>()});
  }
}

TEST_CASE("rung 6: bisection on free plates finds what renormalised edges make of the limit of finite strain",
          "[ladder][theory-vs-bisection]") {
  struct Edge {
    KernelFamily kernel;
    double h_over_spacing;
    double share;  ///< of the limit in bulk, errata.md T8; two or three digits, for plates of any size
  };
  constexpr double printed_digits = 5e-3;
  for (const auto& scheme : ladder::finite_strain_schemes)
    for (const auto& [kernel, h_over_spacing, share] :
         {Edge{KernelFamily::sinc_5, 1.2, 0.63}, Edge{KernelFamily::cubic_spline, 1.3, 0.585},
          Edge{KernelFamily::wendland_c2, 1.6, 0.586}}) {
      auto problem = ladder::finite_strain_problem<2>(scheme, LatticeKind::square, kernel, h_over_spacing);
      INFO(ladder::describe(problem.scheme) << ", " << name_of(kernel));
      if (kernel == KernelFamily::cubic_spline) problem.integrator = Integrator::verlet;
      const auto found = check_bisection<2>(problem, free_plate<2>(problem, {9, 8}));
      CHECK(1.0 + *found.patch_deficit() == Approx(share).margin(printed_digits));
    }
}

TEST_CASE("rung 6: bisection finds the limit of free bars and blocks, clamped and jittered bodies of finite strain",
          "[ladder][theory-vs-bisection]") {
  for (const auto& scheme : ladder::finite_strain_schemes) {
    const auto chain = ladder::finite_strain_problem<1>(scheme, LatticeKind::chain, KernelFamily::quintic_spline, 1.2);
    INFO(ladder::describe(chain.scheme));
    check_bisection<1>(chain, free_plate<1>(chain, LatticeIndex<1>(17)));
    const auto cubic = ladder::finite_strain_problem<3>(scheme, LatticeKind::cubic, KernelFamily::wendland_c2, 1.2);
    check_bisection<3>(cubic, free_plate<3>(cubic, {4, 3, 3}));
    auto square = study::test::plain_problem();
    square.scheme = chain.scheme;
    const auto plate = free_plate<2>(square, {10, 5});
    check_bisection<2>(square, study::test::jittered(study::test::clamped_at_left(plate), square, 3));
    check_bisection<2>(square, study::test::of_two_materials(study::test::clamped_at_left(plate), 10));
    check_bisection<2>(square, plate, true);
  }
}

TEST_CASE("rung 6: bisection finds the limit of damped bodies of finite strain", "[ladder][theory-vs-bisection]") {
  auto problem = study::test::plain_problem();
  problem.scheme.formulation = Formulation::total_lagrangian_corotated;
  problem.scheme.damping = Damping{0.3};
  check_bisection<2>(problem, free_plate<2>(problem, {5, 4}));
}

TEST_CASE("rung 6: a cantilever at rest under its load grows from the limit of its deformed state on",
          "[ladder][theory-vs-bisection]") {
  // A load across it bends it until its end hangs by 0.7 of its length; one that pulls at it as well moves the limit
  // more, since it strains every particle.
  for (const auto& scheme : ladder::finite_strain_schemes)
    for (const Vector<2>& load : {Vector<2>(0.0, -0.01), Vector<2>(0.05, -0.01)}) {
      auto problem = study::test::plain_problem();
      problem.scheme.formulation = scheme.formulation;
      problem.scheme.elastic_law = scheme.law;
      INFO(ladder::describe(problem.scheme) << ", load " << load.transpose());
      const auto body = study::test::loaded(study::test::clamped_at_left(free_plate<2>(problem, {12, 4})), load);
      analysis::DeformedBodyOperator<2> op(problem, body);
      const double rest = *analysis::deformed_limit(op).critical_time_step;
      const auto equilibrium = study::relax<2>(problem, body, {.time_step = 0.6 * rest, .tolerance = 1e-12});
      REQUIRE(equilibrium.converged);
      const auto displacement = analysis::components_of<2>(equilibrium.displacement);
      CHECK(displacement.lpNorm<Eigen::Infinity>() > 0.15 * body.position.back()[0]);
      op.set_state(displacement);
      const auto theory = analysis::deformed_limit(op, {.tolerance = 1e-10}).critical_time_step;
      REQUIRE(theory);
      CHECK(std::abs(*theory / rest - 1.0) > 100.0 * bisection_tolerance);
      const auto found = study::bisect(study::GrowthRun<2>(problem, body, equilibrium.displacement, 1),
                                       {.start = 0.5 * rest, .tolerance = bisection_tolerance});
      REQUIRE(found.critical_time_step);
      CHECK(*found.critical_time_step == Approx(*theory).epsilon(bisection_tolerance));
    }
}
