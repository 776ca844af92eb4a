// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/irreducible_domain.hpp"
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

template <int Dim>
analysis::ZoneMaximum<Dim> certified_maximum(const Problem<Dim>& posed) {
  const analysis::GradientSymbol<Dim> symbol(posed);
  const Tensor<Dim> unit = Tensor<Dim>::Identity();
  return analysis::zone_maximum<Dim>(symbol.series(), unit,
                                     analysis::irreducible_domain(BrillouinZone(posed.lattice), symbol, unit));
}

template <int Dim>
void run_certified(benchmark::State& state, const Problem<Dim>& posed) {
  analysis::ZoneMaximum<Dim> found{};
  for (auto _ : state) benchmark::DoNotOptimize(found = certified_maximum(posed));
  state.counters["neighbours"] =
      2.0 * static_cast<double>(analysis::GradientSymbol<Dim>(posed).series().terms().size());
  state.counters["width"] = 0.5 * (found.upper - found.lower) / found.value;
}

void certified(benchmark::State& state) {
  const Case& which = cases[static_cast<std::size_t>(state.range(0))];
  run_certified(state, problem(which));
  state.SetLabel(fmt::format("{} {}", name_of(which.kernel), which.h));
}

void plain_scan(benchmark::State& state) {
  const Case& which = cases[static_cast<std::size_t>(state.range(0))];
  const auto posed = problem(which);
  const auto neighbours = lattice_neighbours(posed.lattice, posed.kernel.support(), posed.neighbour_rule);
  double found = 0.0;
  for (auto _ : state) benchmark::DoNotOptimize(found = scan(posed.lattice, posed.kernel, neighbours));
  state.SetLabel(fmt::format("{} {}", name_of(which.kernel), which.h));
  state.counters["error"] = 1.0 - found / std::sqrt(certified_maximum(posed).value);
}

/// Cubic spline in space; the argument counts lattices of 3D and, below them, these h.
constexpr std::array<double, 3> space_h{1.0, 1.3, 2.0};

void certified_in_space(benchmark::State& state) {
  const auto lattice = lattices_of(3)[static_cast<std::size_t>(state.range(0)) / space_h.size()];
  const double h = space_h[static_cast<std::size_t>(state.range(0)) % space_h.size()];
  run_certified<3>(state, {.lattice = Lattice<3>(lattice, 1.0),
                           .kernel = Kernel<3>(KernelFamily::cubic_spline, h),
                           .material = Material::from_young_modulus(1.0, 1.3, 0.3)});
  state.SetLabel(fmt::format("{} {}", name_of(lattice), h));
}

BENCHMARK(certified)->DenseRange(0, cases.size() - 1)->Unit(benchmark::kMicrosecond);
BENCHMARK(certified_in_space)->DenseRange(0, 3 * space_h.size() - 1)->Unit(benchmark::kMicrosecond);
BENCHMARK(plain_scan)->DenseRange(0, cases.size() - 1)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
