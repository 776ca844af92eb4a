// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "analysis/gradient_symbol.hpp"
#include "analysis/zone_maximum.hpp"

// The certified maximum of |D| over the Brillouin zone against the scan of 1000 × 1000 modes that a user would write.
// Counters: `neighbours`; `width`, the relative enclosure of max |D|; `error`, of the scan, relative to the certified
// value.

namespace {

using namespace sphstab;

struct Case {
  KernelFamily kernel;
  double h;
  double cutoff;
};

constexpr std::array<Case, 8> cases{{{KernelFamily::cubic_spline, 0.65, 3.0},
                                     {KernelFamily::cubic_spline, 1.3, 3.0},
                                     {KernelFamily::cubic_spline, 1.55, 3.0},
                                     {KernelFamily::cubic_spline, 2.525, 3.0},
                                     {KernelFamily::cubic_spline, 4.03, 3.0},
                                     {KernelFamily::gaussian, 2.0, 3.0},
                                     {KernelFamily::gaussian, 2.0, 7.0},
                                     {KernelFamily::wendland_c6, 4.0, 3.0}}};

Problem<2> problem(const Case& which) {
  return {Lattice<2>(LatticeKind::square, 1.0),
          Kernel<2>(which.kernel, which.h, which.cutoff),
          NeighbourRule::support,
          Material::from_young_modulus(1.0, 1.3, 0.3),
          Plane::strain,
          Scheme{}};
}

void label(benchmark::State& state, const Case& which, std::size_t neighbours) {
  state.SetLabel(std::string(name_of(which.kernel)));
  state.counters["h"] = which.h;
  state.counters["neighbours"] = static_cast<double>(neighbours);
}

/// max |D| by the loop over modes and neighbours.
double scan(const Lattice<2>& lattice, const Kernel<2>& kernel, const std::vector<LatticeNeighbour<2>>& neighbours) {
  constexpr int modes = 1000;
  std::vector<Vector<2>> weights;
  for (const auto& d : neighbours)
    weights.push_back(-lattice.cell_volume() * kernel.slope(d.distance) / d.distance * d.position);
  double largest = 0.0;
  for (int i = 0; i < modes; ++i)
    for (int j = 0; j < modes; ++j) {
      const Vector<2> k = lattice.reciprocal_vectors() * Vector<2>(i, j) / modes;
      Vector<2> D = Vector<2>::Zero();
      for (std::size_t n = 0; n < neighbours.size(); ++n) D += std::sin(k.dot(neighbours[n].position)) * weights[n];
      largest = std::max(largest, D.squaredNorm());
    }
  return std::sqrt(largest);
}

void certified_maximum(benchmark::State& state) {
  const Case which = cases[static_cast<std::size_t>(state.range(0))];
  const auto posed = problem(which);
  analysis::ZoneMaximum<2> found{};
  for (auto _ : state) {
    const analysis::GradientSymbol<2> symbol(posed);
    found = analysis::zone_maximum<2>(symbol.series(), Tensor<2>::Identity());
    benchmark::DoNotOptimize(found);
  }
  label(state, which, 2 * analysis::GradientSymbol<2>(posed).series().terms().size());
  state.counters["width"] = 0.5 * (found.upper - found.lower) / found.value;
}

void plain_scan(benchmark::State& state) {
  const Case which = cases[static_cast<std::size_t>(state.range(0))];
  const auto posed = problem(which);
  const auto neighbours = lattice_neighbours(posed.lattice, posed.kernel.support(), posed.neighbour_rule);
  double found = 0.0;
  for (auto _ : state) benchmark::DoNotOptimize(found = scan(posed.lattice, posed.kernel, neighbours));
  label(state, which, neighbours.size());
  const analysis::GradientSymbol<2> symbol(posed);
  state.counters["error"] =
      1.0 - found / std::sqrt(analysis::zone_maximum<2>(symbol.series(), Tensor<2>::Identity()).value);
}

BENCHMARK(certified_maximum)->DenseRange(0, cases.size() - 1)->Unit(benchmark::kMicrosecond);
BENCHMARK(plain_scan)->DenseRange(0, cases.size() - 1)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
