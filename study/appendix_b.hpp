// SPDX-License-Identifier: MIT
#pragma once

#include "model/material.hpp"
#include "model/tensor.hpp"

namespace sphstab::study {

/// Displacement, strain (ε_xy = γ_xy/2) and stress at one point.
struct ElasticState {
  Vector<2> displacement;
  Tensor<2> strain;
  Tensor<2> stress;
};

/// Case 1 of Zhang et al. (Fig. 3): the plate 0 ≤ x ≤ length, 0 ≤ y ≤ height, y upwards, pulled apart at its left and
/// right edge by σ_x = k (height − y): nothing at the top, most at the bottom.
struct StretchedPlate {
  double length;
  double height;
  double load_gradient;  ///< k, stress / length
  Material material;
  Plane plane;
};

/// Appendix B.1, free of body force, up to a rigid motion: with X = x − length/2, Y = height − y,
///   s_x = (k/E) X Y,   s_y = (k/2E) (ν Y² + X²),   σ_x = k Y alone.
/// The paper's y is Y, measured downwards from the edge without load: its s_y is −s_y here, and its relations are
/// right. They are those of plane stress; plane strain takes the moduli of study/plane_moduli.hpp. Tested in
/// tests/study/test_appendix_b.cpp: equilibrium, Hooke's law, strain, tractions.
ElasticState solution(const StretchedPlate& plate, const Vector<2>& position);

/// Case 2 (Fig. 8): an annulus around the origin under the shear tractions τ = −q/a² at its inner and q/b² at its outer
/// edge, positive along e_θ, which is counter-clockwise.
struct ShearedAnnulus {
  double shear_load;  ///< q, force (per unit thickness: stress · length²)
  Material material;
};

/// Appendix B.2, free of body force, up to a rigid motion, in plane stress and plane strain alike: at the distance r,
///   s_θ = −(q/2G)/r,   τ_rθ = q/r²,   γ_rθ = 2ε_rθ = q/(G r²)
/// and nothing else, with the textbook G = E/(2(1+ν)). The relations of the paper, in E and μ, are right; with its own
/// G = E/(1+μ) of Eq. 3, twice the textbook one, τ = G ε_rθ, not G γ_rθ. Tested as above.
ElasticState solution(const ShearedAnnulus& annulus, const Vector<2>& position);

}  // namespace sphstab::study
