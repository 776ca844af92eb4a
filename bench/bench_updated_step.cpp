// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "solver/updated_simulation.hpp"

/// One step of the scheme `ul` on a periodic square patch with 20 neighbours, with each term alone and with all of
/// them: nanoseconds of CPU time per particle and step.
namespace {

using namespace sphstab;

constexpr double spacing = 1.0, smoothing_length = 1.3 * spacing;  // support 2.6: 20 neighbours
constexpr double tension = 0.05;                                   // of rho c0²
constexpr int steps_a_call = 10;  // Verlet and the predictor-corrector share evaluations

Problem<2> plain_problem(Integrator integrator) {
  Problem<2> problem{.lattice = {LatticeKind::square, spacing},
                     .kernel = {KernelFamily::cubic_spline, smoothing_length},
                     .material = Material::from_sound_speed(1.0, 1.0, 0.3),
                     .scheme = {},
                     .integrator = integrator};
  problem.scheme.formulation = Formulation::updated_lagrangian;
  problem.deviatoric_stress = Vector<2>(tension, -tension).asDiagonal();  // one principal stress of each sign
  return problem;
}

void report_per_particle(benchmark::State& timing, double times) {
  using benchmark::Counter;
  timing.counters["per_particle"] = Counter(times, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

struct Terms {
  bool artificial_stress = false, xsph = false, viscosity = false;
};

/// side² particles in a standing wave.
template <class Scalar>
void step(benchmark::State& timing, Integrator integrator, Terms terms) {
  const int side = static_cast<int>(timing.range(0));
  Problem<2> problem = plain_problem(integrator);
  if (terms.artificial_stress) problem.scheme.artificial_stress = ArtificialStress{.epsilon = 0.3};
  if (terms.xsph) problem.scheme.xsph = Xsph{0.5};
  if (terms.viscosity) problem.scheme.viscosity = Viscosity{1.0, 0.1};
  solver::UpdatedSimulation<2, Scalar> simulation(problem, LatticeIndex<2>(side, side));
  auto state = simulation.base_state();
  for (int a = 0; a < state.particles(); ++a)
    state.velocity[a].setConstant(static_cast<Scalar>(
        1e-3 * std::sin(2.0 * std::numbers::pi / side * static_cast<double>(state.position[a].sum()))));
  for (auto _ : timing) simulation.advance(state, 0.05, steps_a_call);
  benchmark::DoNotOptimize(state.position.data());
  report_per_particle(timing, state.particles() * steps_a_call);
  timing.counters["list_builds"] = static_cast<double>(simulation.work().list_builds);
}

constexpr Terms all_terms{true, true, true};

void sizes(benchmark::internal::Benchmark* bench) {
  for (const int side : {45, 141, 447}) bench->Arg(side);  // 2k, 20k, 200k particles
}

void step_double(benchmark::State& timing, Integrator integrator, Terms terms) {
  step<double>(timing, integrator, terms);
}
void step_float(benchmark::State& timing, Integrator integrator, Terms terms) {
  step<float>(timing, integrator, terms);
}

/// The search that a run repeats only when a particle has moved by half the skin.
void neighbour_list(benchmark::State& timing) {
  const int side = static_cast<int>(timing.range(0));
  const Problem<2> problem = plain_problem(Integrator::leapfrog);
  const auto patch = periodic_patch(problem, LatticeIndex<2>(side, side));
  const Tensor<2> box = side * problem.lattice.primitive_vectors();
  for (auto _ : timing) {
    solver::NeighbourList<2> list(problem.kernel.support(), box);
    list.update(patch.position);
    benchmark::DoNotOptimize(list.size());
  }
  report_per_particle(timing, patch.size());
}
BENCHMARK(neighbour_list)->Apply(sizes);

constexpr auto leapfrog = Integrator::leapfrog;
BENCHMARK_CAPTURE(step_double, leapfrog_plain, leapfrog, Terms{})->Apply(sizes);
BENCHMARK_CAPTURE(step_double, leapfrog_artificial_stress, leapfrog, Terms{.artificial_stress = true})->Apply(sizes);
BENCHMARK_CAPTURE(step_double, leapfrog_xsph, leapfrog, Terms{.xsph = true})->Apply(sizes);
BENCHMARK_CAPTURE(step_double, leapfrog_viscosity, leapfrog, Terms{.viscosity = true})->Apply(sizes);
BENCHMARK_CAPTURE(step_double, leapfrog_all, leapfrog, all_terms)->Apply(sizes);
BENCHMARK_CAPTURE(step_double, verlet_plain, Integrator::verlet, Terms{})->Apply(sizes);
BENCHMARK_CAPTURE(step_double, verlet_all, Integrator::verlet, all_terms)->Apply(sizes);
BENCHMARK_CAPTURE(step_double, pece_plain, Integrator::predictor_corrector, Terms{})->Apply(sizes);
BENCHMARK_CAPTURE(step_double, pece_all, Integrator::predictor_corrector, all_terms)->Apply(sizes);
BENCHMARK_CAPTURE(step_double, pec_all, Integrator::predictor_corrector_pec, all_terms)->Apply(sizes);
BENCHMARK_CAPTURE(step_float, leapfrog_all, leapfrog, all_terms)->Apply(sizes);

}  // namespace

BENCHMARK_MAIN();
