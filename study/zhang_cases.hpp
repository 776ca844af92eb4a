// SPDX-License-Identifier: MIT
#pragma once

#include "model/scene.hpp"
#include "study/appendix_b.hpp"

/// Validation Cases 1 and 2 of Zhang, Hu, Cui & Wang as scenes: those of scenes/zhang-case-1.toml and -2.toml with
/// whatever smoothing length, plane and scheme. Tested against the files in tests/study/test_zhang_cases.cpp.
namespace sphstab::study::zhang {

/// Data of both cases. G = 0.3 Pa of the paper is E/(1+μ), twice the shear modulus, so that μ = 0.3.
inline constexpr double particle_spacing = 2.5e-5, density = 1000.0, young_modulus = 0.39, poisson_ratio = 0.3;
/// Twice the textbook shear modulus (errata.md Z10).
inline constexpr double papers_shear_modulus = young_modulus / (1.0 + poisson_ratio);
inline constexpr double gaussian_cutoff = 5.0;  // W = 1e-11 W(0): 7 moves no limit by more than 1e-9, at twice the cost

/// Case 1: plate l = h, so many particles a side, σ_x = k (h − y) at its left and right edge.
inline constexpr double side = 5e-4, load_gradient = 50.0;
inline constexpr int particles_a_side = 20;

/// Case 2: radii, the torque's q = τ r², rings and sectors.
inline constexpr double inner_radius = 2.5e-4, outer_radius = 5e-4, shear_load = 1.7227e-9;
inline constexpr int ring_count = 10, sector_count = 36;

inline Material material() { return Material::from_young_modulus(density, young_modulus, poisson_ratio); }

/// Either case: square lattice, Gaussian kernel. H is not in the paper (errata.md Z7).
Problem<2> problem(double smoothing_length, KernelNormalisation normalisation, Plane plane = Plane::stress,
                   double spacing = particle_spacing);

/// Case 1 under `load` times its load, which is on the outer columns as a force t/(ρΔ) per mass.
SceneDescription<2> stretched_plate(const Problem<2>& problem, double load = 1.0);

/// Case 2, with the shear on the innermost and outermost ring, corrected to the torque of the edge.
SceneDescription<2> sheared_annulus(const Problem<2>& problem, int rings = ring_count, int sectors = sector_count);

/// What Appendix B says of them.
StretchedPlate plate_theory(const Problem<2>& problem, double load = 1.0);
ShearedAnnulus annulus_theory(const Problem<2>& problem);

}  // namespace sphstab::study::zhang
