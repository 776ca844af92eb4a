// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "model/scene.hpp"

/// Beams in large deformation, in SI: those of Tran-Duc, Meylan & Thamwattana, Secs. 3.1 and 3.2, and the elastic bar
/// of Turek & Hron (2006), whose tests CSM1 to CSM3 are the bar without the fluid under its own weight.
namespace sphstab::study::beams {

/// A scheme and how it moves.
struct Method {
  std::string_view name;
  Scheme scheme;
  Integrator integrator;
};

/// `tl-corotated` (the paper's ICB-SPH), `tl-pk1`, `ul` (its CCB-SPH) and `ul` with artificial stress ε = 0.3, n = 6
/// and viscosity α = 1 on approach (its CCBWAT-SPH).
std::vector<Method> methods();

inline constexpr double beam_length = 0.2, beam_density = 1000.0;

/// What holds a beam at x = 0.
enum class Support {
  clamp,    ///< a block of its own material beyond x = 0, held, as wide as the support of the kernel
  symmetry  ///< nothing: beam and mirror image are one body, pushed in the middle by what pushes the two ends
};

/// A beam that is held at x = 0, of particles at the centres of cells, with a force on its free end.
struct Beam {
  double height;
  double young_modulus;
  double force_x;  ///< a width of 1
  double force_y;
  double spacing;
  double poisson_ratio = 0.0;  ///< the paper gives none
  double length = beam_length;
  Support support = Support::clamp;
};

/// H = 2 cm and E = 20 MPa (errata.md T7), a force downwards at the free end.
Beam cantilever(double force, double spacing);
/// H = 5 cm and E = 2 MPa, a pull at the free end.
Beam truss(double force, double spacing);

SceneDescription<2> beam_scene(const Beam& beam, const Method& method);

/// The bar of Turek & Hron: 0.35 × 0.02 and clamped in a cylinder of radius 0.05, its axis at (0.2, 0.2).
struct Bar {
  double shear_modulus;  ///< 0.5e6 in CSM1 and CSM3, 2e6 in CSM2
  double spacing;
};

/// Where the published displacements are of: the middle of the free end.
inline const Vector<2> bar_end{0.6, 0.2};

/// In plane strain, ν = 0.4, ρ = 1000, under the gravity 2.
SceneDescription<2> bar_scene(const Bar& bar, const Method& method);

/// A displacement between particles, or at the end of a row of them.
struct PointReading {
  std::vector<int> particles;
  std::vector<double> weights;

  Vector<2> operator()(const std::vector<Vector<2>>& displacement) const;
};

/// The linear function that fits the displacements of the particles within 2.3 spacings of a point best, at the point:
/// exact for an affine displacement. Throws InvalidInput (`position`) where fewer than three are so near.
PointReading reading_at(const Scene<2>& scene, const Vector<2>& point);

/// Where a scene comes to rest, and how it was got.
struct Rest {
  bool converged;
  std::vector<Vector<2>> displacement;
  long steps;
  double time_step;
  /// Neighbours on the lattice that are more than 1.5 spacings from each other: the beam breaks.
  bool is_broken;
};

/// A beam is broken where neighbours on the lattice are farther apart than so many spacings.
inline constexpr double broken_gap = 1.5;

/// What relaxation takes of the critical step unless it is told.
inline constexpr double resting_fraction = 0.85;

/// By damped steps of a fraction, at most 0.85, of the critical step, to a relative error of `tolerance`; ends where
/// the beam breaks.
Rest rest_of(const Scene<2>& scene, double tolerance, double fraction = resting_fraction);

/// A step that is safe to run with: the given part of the critical one of the body at rest, of `ul` of the lattice.
double step_of(const Scene<2>& scene, double fraction);

}  // namespace sphstab::study::beams
