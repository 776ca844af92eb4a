// SPDX-License-Identifier: MIT
#include "model/body.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>

#include "model/lattice_index.hpp"

namespace sphstab {
namespace {

/// The index of a cell along an axis is kept modulo this power of two, so that three of them fit into 63 bits. Cells
/// that far apart share a key, which costs a distance; neighbouring ones never do.
constexpr int bits_per_axis = 21;
constexpr std::int64_t cells_per_axis = std::int64_t{1} << bits_per_axis;
/// Indices of cells stop here: so far out no two doubles that differ are within a support of each other.
constexpr double farthest_cell = 0x1p60;

enum class Boundary { periodic, free };

template <int Dim>
int flat_index(const LatticeIndex<Dim>& n, const LatticeIndex<Dim>& counts) {
  int index = 0;
  for (int axis = Dim - 1; axis >= 0; --axis) index = index * counts[axis] + n[axis];
  return index;
}

template <int Dim>
Body<Dim> block_of_lattice(const Problem<Dim>& problem, const LatticeIndex<Dim>& counts, Boundary boundary) {
  const auto neighbours = lattice_neighbours(problem.lattice, problem.kernel.support(), problem.neighbour_rule);
  const int size = counts.prod();

  Body<Dim> body;
  body.volume.assign(size, problem.lattice.cell_volume());
  body.materials.push_back(problem.material);
  body.material.assign(size, 0);
  for_each_index<Dim>(LatticeIndex<Dim>::Zero(), counts.array() - 1, [&](const LatticeIndex<Dim>& n) {
    body.site.push_back(n);
    body.position.push_back(problem.lattice.site(n));
  });
  body.pairs.first.push_back(0);
  for (int a = 0; a < size; ++a) {
    for (const auto& offset : neighbours) {
      LatticeIndex<Dim> n = body.site[a] + offset.index;
      bool inside = true;
      for (int axis = 0; axis < Dim; ++axis) {
        if (boundary == Boundary::periodic) n[axis] = ((n[axis] % counts[axis]) + counts[axis]) % counts[axis];
        inside = inside && n[axis] >= 0 && n[axis] < counts[axis];
      }
      if (!inside) continue;
      body.pairs.neighbour.push_back(flat_index<Dim>(n, counts));
      body.pairs.separation.push_back(-offset.position);
    }
    body.pairs.first.push_back(static_cast<int>(body.pairs.neighbour.size()));
  }
  return body;
}

template <int Dim>
void require_counts(std::string_view key, const LatticeIndex<Dim>& counts, int smallest) {
  if (counts.minCoeff() < smallest)
    throw InvalidInput(
        fmt::format("{}: {} has a count below {}", key, fmt::join(counts.data(), counts.data() + Dim, ","), smallest));
}

}  // namespace

template <int Dim>
NeighbourPairs<Dim> find_pairs(const std::vector<Vector<Dim>>& position, double support) {
  NeighbourPairs<Dim> pairs;
  pairs.first.push_back(0);

  // Particles sorted by cell; cells are kept sorted by key, so that empty ones take no room.
  using Cell = Eigen::Matrix<std::int64_t, Dim, 1>;
  const auto cell_of = [&](int a) -> Cell {
    return (position[a] / support).array().floor().max(-farthest_cell).min(farthest_cell).template cast<std::int64_t>();
  };
  const auto key_of = [](const Cell& cell) {
    std::int64_t key = 0;
    for (int axis = Dim - 1; axis >= 0; --axis) key = key << bits_per_axis | (cell[axis] & (cells_per_axis - 1));
    return key;
  };
  std::vector<std::pair<std::int64_t, int>> sorted;
  for (int a = 0; a < static_cast<int>(position.size()); ++a) sorted.emplace_back(key_of(cell_of(a)), a);
  std::sort(sorted.begin(), sorted.end());

  // The particles of a cell and of those around it; many particles that follow one another share them.
  using Entries = std::span<const std::pair<std::int64_t, int>>;
  const auto entries_of = [&](std::int64_t key) -> Entries {
    const auto begin = std::lower_bound(sorted.begin(), sorted.end(), std::pair<std::int64_t, int>(key, 0));
    return {begin, std::find_if(begin, sorted.end(), [&](const auto& entry) { return entry.first != key; })};
  };
  std::vector<Entries> around;
  const auto look_around = [&](const Cell& home) {
    around.clear();
    for_each_index<Dim>(LatticeIndex<Dim>::Constant(-1), LatticeIndex<Dim>::Constant(1),
                        [&](const LatticeIndex<Dim>& n) {
                          around.push_back(entries_of(key_of(home + n.template cast<std::int64_t>())));
                        });
  };

  const double limit = support * (1.0 - tie_margin);
  std::vector<int> near;
  std::int64_t home_key = -1;  // no cell's
  for (int a = 0; a < static_cast<int>(position.size()); ++a) {
    near.clear();
    const Cell home = cell_of(a);
    if (std::exchange(home_key, key_of(home)) != key_of(home)) look_around(home);
    for (const Entries& entries : around)
      for (const auto& [key, b] : entries)
        if (b != a && (position[a] - position[b]).squaredNorm() < limit * limit) near.push_back(b);
    std::sort(near.begin(), near.end());
    for (const int b : near) {
      pairs.neighbour.push_back(b);
      pairs.separation.push_back(position[a] - position[b]);
    }
    pairs.first.push_back(static_cast<int>(pairs.neighbour.size()));
  }
  return pairs;
}

template <int Dim>
Body<Dim> periodic_patch(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells) {
  require_counts<Dim>("patch", cells, 1);
  return block_of_lattice(problem, cells, Boundary::periodic);
}

template <int Dim>
Body<Dim> free_plate(const Problem<Dim>& problem, const LatticeIndex<Dim>& particles) {
  require_counts<Dim>("plate", particles, 2);
  constexpr std::array rectangular{LatticeKind::chain, LatticeKind::square, LatticeKind::cubic};
  if (problem.lattice.kind() != rectangular[Dim - 1])
    throw InvalidInput(fmt::format("plate: a free plate needs the lattice {}, not {}", name_of(rectangular[Dim - 1]),
                                   name_of(problem.lattice.kind())));
  return block_of_lattice(problem, particles, Boundary::free);
}

template struct NeighbourPairs<1>;
template NeighbourPairs<1> find_pairs(const std::vector<Vector<1>>&, double);
template Body<1> periodic_patch(const Problem<1>&, const LatticeIndex<1>&);
template Body<1> free_plate(const Problem<1>&, const LatticeIndex<1>&);
template struct NeighbourPairs<2>;
template NeighbourPairs<2> find_pairs(const std::vector<Vector<2>>&, double);
template Body<2> periodic_patch(const Problem<2>&, const LatticeIndex<2>&);
template Body<2> free_plate(const Problem<2>&, const LatticeIndex<2>&);
template struct NeighbourPairs<3>;
template NeighbourPairs<3> find_pairs(const std::vector<Vector<3>>&, double);
template Body<3> periodic_patch(const Problem<3>&, const LatticeIndex<3>&);
template Body<3> free_plate(const Problem<3>&, const LatticeIndex<3>&);

}  // namespace sphstab
