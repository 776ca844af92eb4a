// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "solver/total_lagrangian.hpp"

/// One leapfrog step on a periodic square patch with 20 neighbours, and beside it a triad over arrays of the size that
/// a step reads, so that figures of different machines compare as ratios. Both report nanoseconds of CPU time per
/// particle.
namespace {

using namespace sphstab;

constexpr double spacing = 1.0, smoothing_length = 1.3 * spacing;  // support 2.6: 20 neighbours
constexpr int neighbours = 20;
/// What a step reads of each pair in each of its two passes: g and b.
constexpr int bytes_per_pair = 2 * sizeof(double) + sizeof(int);

void report_per_particle(benchmark::State& timing, double particles) {
  using benchmark::Counter;
  timing.counters["particles"] = particles;
  timing.counters["per_particle"] = Counter(particles, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

const Scheme linear{};
const Scheme equation_of_state{.momentum_density = MomentumDensity::equation_of_state};
const Scheme corotated{.formulation = Formulation::total_lagrangian_corotated};
const Scheme pk1{.formulation = Formulation::total_lagrangian_pk1};
const Scheme neo_hookean{.formulation = Formulation::total_lagrangian_pk1, .elastic_law = ElasticLaw::neo_hookean};

/// side² particles, moving as a standing wave far below the critical step.
template <class Scalar, const Scheme& scheme>
void step(benchmark::State& timing) {
  const int side = static_cast<int>(timing.range(0));
  const Problem<2> problem{.lattice = {LatticeKind::square, spacing},
                           .kernel = {KernelFamily::cubic_spline, smoothing_length},
                           .material = Material::from_young_modulus(1.0, 1.0, 0.3),
                           .scheme = scheme};
  const auto body = periodic_patch(problem, LatticeIndex<2>(side, side));
  const auto simulation = solver::make_simulation<2, Scalar>(problem, body);
  solver::State<2, Scalar> state(body.size());
  for (int a = 0; a < body.size(); ++a)
    state.velocity[a].setConstant(
        static_cast<Scalar>(1e-3 * std::sin(2.0 * std::numbers::pi / side * body.position[a].sum())));
  for (auto _ : timing) simulation->advance(state, 0.1);
  benchmark::DoNotOptimize(state.displacement.data());
  report_per_particle(timing, body.size());
}

/// a = b + x c over three arrays that together hold the bytes of all pairs, read twice as a step does.
void triad(benchmark::State& timing) {
  const double particles = static_cast<double>(timing.range(0) * timing.range(0));
  const auto size = static_cast<std::size_t>(particles * neighbours * bytes_per_pair / (3 * sizeof(double)));
  std::vector<double> a(size, 0.0), b(size, 1.0), c(size, 2.0);
  for (auto _ : timing)
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t i = 0; i < size; ++i) a[i] = b[i] + 3.0 * c[i];
      benchmark::ClobberMemory();
    }
  report_per_particle(timing, particles);
}

void sizes(benchmark::internal::Benchmark* bench) {
  for (const int side : {45, 141, 447}) bench->Arg(side);  // 2k, 20k, 200k particles
}

BENCHMARK(triad)->Apply(sizes);
BENCHMARK(step<double, linear>)->Apply(sizes);
BENCHMARK(step<double, equation_of_state>)->Apply(sizes);
BENCHMARK(step<double, corotated>)->Apply(sizes);
BENCHMARK(step<double, pk1>)->Apply(sizes);
BENCHMARK(step<double, neo_hookean>)->Apply(sizes);
BENCHMARK(step<float, linear>)->Apply(sizes);
BENCHMARK(step<float, corotated>)->Apply(sizes);
BENCHMARK(step<float, pk1>)->Apply(sizes);

}  // namespace

BENCHMARK_MAIN();
