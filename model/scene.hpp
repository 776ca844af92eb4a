// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "model/body.hpp"
#include "model/placement.hpp"

namespace sphstab {

/// A particle whose displacement, velocity and stress are recorded.
struct Probe {
  std::string name;
  int particle;
};

/// Particles as they are placed, held and loaded, with the scheme that moves them. The problem holds what all particles
/// share; its material and lattice are the defaults of the bodies. Particles of all bodies that are closer than the
/// support are neighbours: bodies that touch are bonded.
template <int Dim>
struct Scene {
  std::string name;
  Problem<Dim> problem;
  Body<Dim> body;
  std::vector<Probe> probes;
  std::vector<Vector<Dim>> velocity = {};  ///< of each particle at the start; empty: at rest
  /// The body is a periodic patch of so many cells of the lattice (periodic_patch); none: it has free surfaces.
  std::optional<LatticeIndex<Dim>> periodic_cells = {};
};

/// A body of a scene: where its particles are and which of the scene's materials they are made of.
template <int Dim>
struct ScenePart {
  std::string name;
  Placement<Dim> placement;
  int material = 0;
};

/// Particles that are held in some directions: those that lie in the region in the reference state.
template <int Dim>
struct Clamp {
  Shape<Dim> region;
  Directions<Dim> directions;
};

/// y(x) = value + gradient · (x − origin): a force per area, or a velocity.
template <int Dim>
struct AffineField {
  Vector<Dim> value;
  Tensor<Dim> gradient = Tensor<Dim>::Zero();
  Vector<Dim> origin = Vector<Dim>::Zero();
};

/// A force per area of constant parts along and across the radius r from a centre: t = radial e_r + shear e_θ, outwards
/// and anticlockwise. Where the surface is at the radius R = `at_radius` and the particles that carry its load are at
/// another, t is radial (R/r)^(d−1) e_r + shear (R/r)^d e_θ, which keeps the radial force and the torque of the
/// surface.
template <int Dim>
struct CentredTraction {
  Vector<Dim> centre;
  double radial = 0.0;
  double shear = 0.0;                    ///< 2-D
  std::optional<double> at_radius = {};  ///< none: t is that of the particles' own radius
};

/// A force (per thickness in 2-D, per area in 1-D) that the particles share in proportion to their mass: a point load
/// where they are few.
template <int Dim>
struct TotalForce {
  Vector<Dim> force;
};

/// A traction t on the particles of a region, which are a layer of the thickness D at the surface: the force t/(ρ D)
/// per mass. On cells of the area V/D each that cover the surface it adds up to the force on the surface. Or a force
/// that is given as a whole.
template <int Dim>
struct Traction {
  Shape<Dim> region;
  std::variant<AffineField<Dim>, CentredTraction<Dim>, TotalForce<Dim>> stress;
  std::optional<double> layer = {};  ///< D; none: the spacing, or the thickness of a ring of a polar arrangement
};

/// The first mode of a cantilever that is clamped at x = root and reaches to root + length, as velocities across (2-D):
/// v_y = tip Y((x − root)/length), v_x = 0, with Y(0) = Y'(0) = 0, Y(1) = 1 (Gray et al., Eqs. 7.3 and 7.4).
struct CantileverMode {
  double root;
  double length;
  double tip;  ///< velocity at the free end
};

/// How the particles of a region move at the start. Velocities of several regions add up; where a particle is held it
/// rests.
template <int Dim>
struct InitialVelocity {
  Shape<Dim> region;
  std::variant<AffineField<Dim>, CantileverMode> velocity;
};

/// The particle nearest to the position; of several at one distance that with the lowest index.
template <int Dim>
struct ProbeSite {
  std::string name;
  Vector<Dim> position;
};

/// What a scene file says, free of its format. Regions, positions and materials are those of the reference state.
template <int Dim>
struct SceneDescription {
  std::string name;
  Problem<Dim> problem;
  std::vector<Material> materials;  ///< that parts choose from
  std::vector<ScenePart<Dim>> parts;
  std::optional<LatticeIndex<Dim>> periodic_cells = {};  ///< a periodic patch of the problem's material, and no parts
  std::vector<Clamp<Dim>> clamps = {};
  std::vector<Traction<Dim>> tractions = {};
  std::vector<InitialVelocity<Dim>> velocities = {};
  Vector<Dim> gravity = Vector<Dim>::Zero();
  std::vector<ProbeSite<Dim>> probes = {};
};

/// Pairs of neighbours that a scene may have: some ten gigabytes.
inline constexpr double most_pairs = 5e8;

/// Places, holds and loads the particles and finds their neighbours. Throws InvalidInput beginning with the number of
/// the part ("body 2: …"), clamp, traction, velocity or probe where it cannot: see place_particles; where a region
/// holds no particle; where two particles are in one place or one has no neighbour; where there would be more than
/// `most_pairs`; where there are parts or tractions beside a periodic patch; and for the neighbours `nearest` where
/// particles are not on one lattice. Tested in tests/model/test_scene.cpp.
template <int Dim>
Scene<Dim> make_scene(const SceneDescription<Dim>& description);

extern template Scene<1> make_scene(const SceneDescription<1>&);
extern template Scene<2> make_scene(const SceneDescription<2>&);
extern template Scene<3> make_scene(const SceneDescription<3>&);

}  // namespace sphstab
