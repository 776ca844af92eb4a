// SPDX-License-Identifier: MIT
#pragma once

#include "model/names.hpp"

namespace sphstab {

/// Two-dimensional elasticity: no strain, or no stress, out of the plane. One- and three-dimensional problems are
/// strain.
enum class Plane { strain, stress };

template <>
struct Names<Plane> {
  static constexpr std::array<Named<Plane>, 2> table{{{Plane::strain, "strain"}, {Plane::stress, "stress"}}};
};

/// The constants of σ = 2 G ε + λ tr(ε) I with the trace over the dimensions that are modelled.
struct LameConstants {
  double lambda;         ///< Zhang's γ: λ in plane strain, 2Gν/(1−ν) in plane stress (a pressure)
  double shear_modulus;  ///< G, the textbook one: Zhang's G = E/(1+μ) is twice it (errata.md Z10)
  double volume_factor;  ///< κ = tr₃ε / tr₂ε: 1 in plane strain, (1−2ν)/(1−ν) in plane stress

  double p_wave_modulus() const { return lambda + 2.0 * shear_modulus; }
};

/// An isotropic linear elastic material. Keeps 1 − 2ν, so that nearly incompressible materials lose no digits.
class Material {
 public:
  /// Throw InvalidInput naming the key. Allowed: density > 0; moduli > 0; −1 < ν ≤ 0.5, where ν = 0.5 can be used in
  /// plane stress only (`lame` refuses it in plane strain).
  static Material from_young_modulus(double density, double young_modulus, double poisson_ratio);
  static Material from_bulk_modulus(double density, double bulk_modulus, double shear_modulus);
  /// Bulk modulus ρ0 c0² (Gray et al., after Eq. 2.7). A shear modulus of 0 makes a fluid.
  static Material from_sound_speed(double density, double sound_speed, double shear_modulus);

  double density() const { return density_; }
  double shear_modulus() const { return shear_modulus_; }
  double poisson_ratio() const { return poisson_ratio_; }
  double young_modulus() const { return 2.0 * shear_modulus_ * (1.0 + poisson_ratio_); }
  /// K of three dimensions; infinite for ν = 0.5 unless it is a fluid.
  double bulk_modulus() const { return bulk_modulus_; }
  /// K + 4G/3.
  double p_wave_modulus() const { return bulk_modulus_ + 4.0 / 3.0 * shear_modulus_; }
  /// Throws InvalidInput in plane strain if ν is not below 0.5.
  LameConstants lame(Plane plane) const;

 private:
  static Material from_moduli(double density, double bulk_modulus, double shear_modulus);
  Material(double density, double bulk_modulus, double shear_modulus, double poisson_ratio, double one_minus_two_nu);

  double density_;
  double bulk_modulus_;
  double shear_modulus_;
  double poisson_ratio_;
  double one_minus_two_nu_;
};

}  // namespace sphstab
