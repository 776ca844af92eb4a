// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "solver/pair_terms.hpp"
#include "solver/simulation.hpp"
#include "solver/stress.hpp"

/// What it saves to evaluate kernels once (Zhang et al., conclusion 2): leapfrog steps of a free plate with the
/// kernel gradients kept, with kernels evaluated again in every step, and with neighbours searched again as well. All
/// three take the same sums over the same pairs. Nanoseconds of CPU time per particle and step.
namespace {

using namespace sphstab;
using solver::Field;

constexpr double time_step = 0.1;

enum class Refresh { nothing, kernels, neighbours };

Problem<2> problem(KernelFamily kernel) {
  // 20 neighbours for the cubic spline (support 2.6 spacings), 28 for the Gaussian (cut at 3h = 3 spacings).
  return {.lattice = {LatticeKind::square, 1.0},
          .kernel = {kernel, kernel == KernelFamily::gaussian ? 1.0 : 1.3},
          .material = Material::from_young_modulus(1.0, 1.0, 0.3)};
}

/// side² particles that move as a standing wave far below the critical step.
solver::State<2> standing_wave(const Body<2>& body, int side) {
  solver::State<2> state(body.size());
  for (int a = 0; a < body.size(); ++a)
    state.velocity[a].setConstant(1e-3 * std::sin(2.0 * std::numbers::pi / side * body.position[a].sum()));
  return state;
}

void report(benchmark::State& timing, const Body<2>& body) {
  using benchmark::Counter;
  const auto particles = static_cast<double>(body.size());
  timing.counters["neighbours"] = static_cast<double>(body.pairs.neighbour.size()) / particles;
  timing.counters["per_particle"] = Counter(particles, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

/// The step of the solver with everything that it keeps renewed as asked.
class Step {
 public:
  Step(const Problem<2>& problem, const Body<2>& body)
      : problem_(problem),
        lame_(problem.material.lame(problem.plane)),
        body_(body),
        stress_(body.size()),
        position_(body.position) {
    evaluate_kernels();
  }

  template <Refresh refresh>
  void advance(solver::State<2>& state) {
    if constexpr (refresh != Refresh::nothing) {
      for (int a = 0; a < body_.size(); ++a) position_[a] = body_.position[a] + state.displacement[a];
      if constexpr (refresh == Refresh::neighbours) body_.pairs = find_pairs(position_, problem_.kernel.support());
      if constexpr (refresh == Refresh::kernels) separate();
      evaluate_kernels();
    }
    for (int a = 0; a < body_.size(); ++a) {
      Tensor<2> gradient = Tensor<2>::Zero();
      for (int pair = body_.pairs.first[a]; pair < body_.pairs.first[a + 1]; ++pair)
        gradient += solver::displacement_gradient_term(state.displacement[a],
                                                       state.displacement[body_.pairs.neighbour[pair]], g_[pair]);
      stress_[a] = solver::linear_elastic_stress<double, 2>((gradient + gradient.transpose()) / 2, lame_);
    }
    const double factor = time_step / problem_.material.density();
    for (int a = 0; a < body_.size(); ++a) {
      Vector<2> sum = Vector<2>::Zero();
      for (int pair = body_.pairs.first[a]; pair < body_.pairs.first[a + 1]; ++pair)
        sum += solver::momentum_term(stress_[a], stress_[body_.pairs.neighbour[pair]], g_[pair]);
      state.velocity[a] += factor * sum;
      state.displacement[a] += time_step * state.velocity[a];
    }
  }

 private:
  void separate() {
    for (int a = 0; a < body_.size(); ++a)
      for (int pair = body_.pairs.first[a]; pair < body_.pairs.first[a + 1]; ++pair)
        body_.pairs.separation[pair] = position_[a] - position_[body_.pairs.neighbour[pair]];
  }

  void evaluate_kernels() {
    g_.resize(body_.pairs.neighbour.size());
    for (std::size_t pair = 0; pair < g_.size(); ++pair)
      g_[pair] = solver::kernel_gradient(problem_.kernel, body_.pairs.separation[pair],
                                         body_.volume[body_.pairs.neighbour[pair]]);
  }

  Problem<2> problem_;
  LameConstants lame_;
  Body<2> body_;
  Field<2> g_;
  std::vector<Tensor<2>> stress_;
  std::vector<Vector<2>> position_;
};

template <KernelFamily kernel, Refresh refresh>
void step(benchmark::State& timing) {
  const int side = static_cast<int>(timing.range(0));
  const auto body = free_plate(problem(kernel), LatticeIndex<2>(side, side));
  auto state = standing_wave(body, side);
  Step step(problem(kernel), body);
  for (auto _ : timing) step.template advance<refresh>(state);
  benchmark::DoNotOptimize(state.displacement.data());
  report(timing, body);
}

/// The solver itself, which keeps them.
template <KernelFamily kernel>
void solver_step(benchmark::State& timing) {
  const int side = static_cast<int>(timing.range(0));
  const auto body = free_plate(problem(kernel), LatticeIndex<2>(side, side));
  auto state = standing_wave(body, side);
  solver::Simulation<2> simulation(problem(kernel), body);
  for (auto _ : timing) simulation.advance(state, time_step);
  benchmark::DoNotOptimize(state.displacement.data());
  report(timing, body);
}

void sizes(benchmark::internal::Benchmark* bench) {
  for (const int side : {20, 100, 316}) bench->Arg(side);  // 400, 10 000, 100 000 particles
}

BENCHMARK(solver_step<KernelFamily::cubic_spline>)->Apply(sizes);
BENCHMARK(step<KernelFamily::cubic_spline, Refresh::nothing>)->Apply(sizes);
BENCHMARK(step<KernelFamily::cubic_spline, Refresh::kernels>)->Apply(sizes);
BENCHMARK(step<KernelFamily::cubic_spline, Refresh::neighbours>)->Apply(sizes);
BENCHMARK(solver_step<KernelFamily::gaussian>)->Apply(sizes);
BENCHMARK(step<KernelFamily::gaussian, Refresh::nothing>)->Apply(sizes);
BENCHMARK(step<KernelFamily::gaussian, Refresh::kernels>)->Apply(sizes);
BENCHMARK(step<KernelFamily::gaussian, Refresh::neighbours>)->Apply(sizes);

}  // namespace

BENCHMARK_MAIN();
