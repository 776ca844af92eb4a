// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "model/scene.hpp"

/// The oscillating plate of Gray, Monaghan & Swift, Sec. 7.1, in their units: lengths in cm, velocities in c0,
/// densities in ρ0, so that times are in cm/c0 and stresses in ρ0 c0².
namespace sphstab::study::gray {

/// A plate that is clamped at x = 0 and reaches to x = `plate_length`. Given by the paper: the length, h = 1.5 Δp,
/// the cubic spline, XSPH of 0.5, n = 4. Not given: the viscosity, the time step, and the size of the clamp.
struct Plate {
  double height = 2.0;  ///< H
  int across = 20;      ///< particles across the height
  double shear_modulus = 0.22;
  double tip_velocity = 0.01;  ///< V_f
  double epsilon = 0.3;        ///< of the artificial stress; 0: none
  double viscosity = 0.5;      ///< α; 0: none
  ViscousPairs viscous_pairs = ViscousPairs::all;
  Integrator integrator = Integrator::leapfrog;
  double courant_number = 1.6;  ///< Δt c_p/Δp; the limit is 2.5 for α = 0.5

  double spacing() const { return height / across; }
  double time_step() const;
};

inline constexpr double plate_length = 20.0;

/// The plate goes on to x < 0, between two layers of held particles, where its own particles move.
inline constexpr double clamp_length = 2.0;
inline constexpr int clamp_layers = 4;

/// The scene of scenes/gray-plate.toml with whatever plate, and the probes `tip`, `top` and `bottom`: the middle of the
/// free end and the surfaces where the plate enters the clamp.
SceneDescription<2> plate_scene(const Plate& plate);

/// 2π/ω of Eq. 7.1, a slender beam of this height in plane strain, ν = (3K/μ − 2)/(2(3K/μ + 1)) (errata.md G1).
double slender_period(double height, double shear_modulus);

/// Bar-like tension σ along x in plane strain at rest: what the surface of the bent plate feels. Viscosity on approach
/// alone counts as half on all pairs, so that there is a theory.
Problem<2> problem_in_tension(const Plate& plate, double tension);

/// The first pair of particles, neighbours on the lattice at the start, found farther apart than `parted` spacings.
struct Parting {
  double time;
  Vector<2> place;    ///< where its middle was at the start
  double tension;     ///< largest σ_xx at the probes `top` and `bottom` before
  double e_foldings;  ///< of the fastest mode in that tension, over its whole history: ∫ γ(σ_xx) dt
};

inline constexpr double parted = 1.5;

/// Particles at one of the times that were asked for.
struct PlateImage {
  double time;
  std::vector<Vector<2>> displacement;
  std::vector<double> stress;  ///< σ_xx
};

/// When y passes 0, between samples along straight lines.
std::vector<double> zero_crossings(const std::vector<double>& time, const std::vector<double>& y);

struct Oscillation {
  std::vector<double> time;
  std::vector<double> deflection;  ///< of the tip
  std::optional<double> period;    ///< when the tip crosses its place of rest for the second time
  std::optional<double> decay;     ///< 1 − second largest deflection upwards over the first
  std::optional<Parting> parting;
  bool failed;  ///< numbers that are none
  int lost_particles;
  std::vector<PlateImage> images;
};

/// Lets the plate swing for so many periods of Eq. 7.1 with H − Δp. `images` pictures are kept, at equal intervals.
/// Throws InvalidInput for whatever is wrong with the plate. Tested in tests/study/test_gray_plate.cpp.
Oscillation oscillate(const Plate& plate, double periods, int images = 0,
                      const std::function<void(double fraction)>& progress = nullptr);

}  // namespace sphstab::study::gray
