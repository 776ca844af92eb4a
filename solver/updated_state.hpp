// SPDX-License-Identifier: MIT
#pragma once

#include "solver/state.hpp"

namespace sphstab::solver {

/// One symmetric tensor a particle, all components stored.
template <int Dim, class Scalar = double>
using TensorField = std::vector<Tensor<Dim, Scalar>>;

/// F, the force per mass, and D, the rates of density and deviatoric stress, of `ul`; indexed by particle.
template <int Dim, class Scalar = double>
struct UpdatedRates {
  explicit UpdatedRates(int particles = 0)
      : acceleration(particles, Vector<Dim, Scalar>::Zero()),
        density(particles, Scalar(0)),
        deviatoric_stress(particles, Tensor<Dim, Scalar>::Zero()) {}

  Field<Dim, Scalar> acceleration;
  std::vector<Scalar> density;
  TensorField<Dim, Scalar> deviatoric_stress;
};

/// What moves in `ul`: a structure of arrays, each indexed by particle.
template <int Dim, class Scalar = double>
struct UpdatedState {
  int particles() const { return static_cast<int>(position.size()); }

  Field<Dim, Scalar> position;                 ///< r, never folded back into a periodic box
  Field<Dim, Scalar> velocity;                 ///< v, not smoothed
  std::vector<Scalar> density;                 ///< ρ
  TensorField<Dim, Scalar> deviatoric_stress;  ///< S in the modelled directions
  /// F and D of the step before, which predictor-corrector-pec starts from; empty: not known yet.
  UpdatedRates<Dim, Scalar> stored = UpdatedRates<Dim, Scalar>(0);
};

/// Numbers a particle: [x, y, vx, vy, ρ, Sxx, Syy, Sxy], and with stored rates [Fx, Fy, dρ, dSxx, dSyy, dSxy] after
/// them; in 1-D and 3-D likewise.
template <int Dim, class Scalar>
int numbers_per_particle(const UpdatedState<Dim, Scalar>& state) {
  const int rates = Dim + 1 + symmetric_size<Dim>;
  return Dim + rates + (state.stored.density.empty() ? 0 : rates);
}

template <class Scalar>
using FlatVector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

/// The whole state, particle after particle. Checked, with its inverse, in tests/solver/test_updated_state.cpp.
template <int Dim, class Scalar>
FlatVector<Scalar> flat_state(const UpdatedState<Dim, Scalar>& state) {
  const int size = numbers_per_particle(state);
  FlatVector<Scalar> flat(size * state.particles());
  for (int a = 0; a < state.particles(); ++a) {
    auto numbers = flat.segment(size * a, size);
    numbers.template head<Dim>() = state.position[a];
    numbers.template segment<Dim>(Dim) = state.velocity[a];
    numbers[2 * Dim] = state.density[a];
    numbers.template segment<symmetric_size<Dim>>(2 * Dim + 1) =
        symmetric_components<Dim, Scalar>(state.deviatoric_stress[a]);
    if (state.stored.density.empty()) continue;
    auto rates = numbers.template tail<Dim + 1 + symmetric_size<Dim>>();
    rates.template head<Dim>() = state.stored.acceleration[a];
    rates[Dim] = state.stored.density[a];
    rates.template tail<symmetric_size<Dim>>() = symmetric_components<Dim, Scalar>(state.stored.deviatoric_stress[a]);
  }
  return flat;
}

/// Puts a flat state into a state of the same size, with or without stored rates as it is.
template <int Dim, class Scalar>
void set_flat_state(const FlatVector<Scalar>& flat, UpdatedState<Dim, Scalar>& state) {
  const int size = numbers_per_particle(state);
  for (int a = 0; a < state.particles(); ++a) {
    const auto numbers = flat.segment(size * a, size);
    state.position[a] = numbers.template head<Dim>();
    state.velocity[a] = numbers.template segment<Dim>(Dim);
    state.density[a] = numbers[2 * Dim];
    state.deviatoric_stress[a] =
        symmetric_tensor<Dim, Scalar>(numbers.template segment<symmetric_size<Dim>>(2 * Dim + 1));
    if (state.stored.density.empty()) continue;
    const auto rates = numbers.template tail<Dim + 1 + symmetric_size<Dim>>();
    state.stored.acceleration[a] = rates.template head<Dim>();
    state.stored.density[a] = rates[Dim];
    state.stored.deviatoric_stress[a] = symmetric_tensor<Dim, Scalar>(rates.template tail<symmetric_size<Dim>>());
  }
}

}  // namespace sphstab::solver
