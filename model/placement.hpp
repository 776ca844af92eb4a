// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "model/lattice.hpp"
#include "model/shape.hpp"

namespace sphstab {

/// Particles at those points o + s Δp + Σ n_i a_i that lie in the shape, with the volume of a cell each; o is the
/// corner `from` of a box and the centre of a ball or annulus. With s = ½ a box of n spacings on a square lattice holds
/// n particles at the centres of its cells; with s = 0 the first particle is at the corner.
template <int Dim>
struct LatticeArrangement {
  Vector<Dim> offset = Vector<Dim>::Constant(0.5);  ///< s, in spacings
};

/// Rings of equal thickness T = (outer − inner)/rings, each cut into equal sectors, of a two-dimensional ball or
/// annulus: one particle a sector, at the middle radius r of the ring and at the angles 2πj/sectors, with the exact
/// area 2π r T / sectors. Order: innermost ring first, anticlockwise from the x axis.
struct PolarArrangement {
  int rings;
  int sectors;
};

template <int Dim>
using Arrangement = std::variant<LatticeArrangement<Dim>, PolarArrangement>;

/// Every component of every position moves by a number drawn from [−fraction, fraction) spacings. The same seed gives
/// the same positions on every platform (model/uniform.hpp): particle by particle, x first.
struct Jitter {
  double fraction;
  std::uint64_t seed;
};

/// How a body is made of particles. What is cut away is decided before the jitter.
template <int Dim>
struct Placement {
  Shape<Dim> shape;
  Arrangement<Dim> arrangement = LatticeArrangement<Dim>{};
  std::vector<Shape<Dim>> cut = {};
  std::optional<Jitter> jitter = {};
};

template <int Dim>
struct PlacedParticles {
  std::vector<Vector<Dim>> position;
  std::vector<double> volume;
  double layer;  ///< thickness of a layer of particles at the surface: the spacing, or that of a ring
};

/// A body has no more particles than this: a few gigabytes with their neighbours.
inline constexpr int most_particles = 10'000'000;

/// Points that are at most this many spacings outside a shape lie in it, and particles that are closer are in the same
/// place: far above the rounding of positions, far below what anybody means.
inline constexpr double placement_tolerance = 1e-9;

/// The particles of a body. Throws InvalidInput if the shape is none or holds no particle, if there are too many, or if
/// a polar arrangement is not given a two-dimensional ball or annulus. Tested in tests/model/test_placement.cpp.
template <int Dim>
PlacedParticles<Dim> place_particles(const Placement<Dim>& placement, const Lattice<Dim>& lattice);

extern template PlacedParticles<1> place_particles(const Placement<1>&, const Lattice<1>&);
extern template PlacedParticles<2> place_particles(const Placement<2>&, const Lattice<2>&);
extern template PlacedParticles<3> place_particles(const Placement<3>&, const Lattice<3>&);

}  // namespace sphstab
