// SPDX-License-Identifier: MIT
#pragma once

namespace sphstab::study {

/// A cantilever that bends without stretching under a force across its undeformed axis at the free end.
struct Elastica {
  double end_angle;   ///< θ_B, radians, > 0
  double drop;        ///< displacement of the end along the force, over the length
  double shortening;  ///< displacement of the end towards the clamp along the undeformed axis, over the length
};

/// The equilibrium of θ'' + α cos θ = 0, θ(0) = 0, θ'(1) = 0 with α = F L²/(EI) > 0: Tran-Duc, Meylan & Thamwattana,
/// before Eq. 3.1, where EI is that of the plane (E/(1 − ν²) in plane strain) and I = H³/12 a width (errata.md T7).
/// With μ² = (1 + sin θ_B)/2 and φ = arcsin(1/(√2 μ)),
///   √α = K(μ) − F(φ, μ),   drop = 1 − (2/√α) (E(μ) − E(φ, μ)) (3.1),   shortening = 1 − √(2 sin θ_B/α) (3.2),
/// where (3.2) without cancellation is used. θ_B solves the first to rounding. Throws InvalidInput unless
/// 0 < α ≤ 200. Accuracy: 1e-12. Tested in tests/study/test_elastica.cpp against an integration of the equation.
Elastica elastica(double load);

/// A strip of unit width, height H and Young's modulus E without Poisson's effect, its section's stiffnesses
/// EA = E H, EI = E H³/12 and κGA = (5/6)(E/2) H.
struct Strip {
  double length;
  double height;
  double young_modulus;
};

/// The same cantilever with shear and stretch (Reissner 1972): with the constant force f of the section, its directions
/// t(θ) and n(θ) and the moment M,
///   θ' = M/EI,   r' = (1 + f·t/EA) t + (f·n/κGA) n,   M' = −(r' × f),   θ(0) = 0, M(L) = 0,
/// solved by shooting. Displacements over the length, for a force (F_x, F_y) at the end with F_y < 0. What it leaves
/// out of a solid is of the order of (H/L)² times its strain. Accuracy: 1e-10. Tested in tests/study/test_elastica.cpp.
Elastica shearable_elastica(const Strip& strip, double force_y);

/// θ_B by the paper's series, Eq. 3.3, for 0 < α < 1.5.
double printed_end_angle(double load);

}  // namespace sphstab::study
