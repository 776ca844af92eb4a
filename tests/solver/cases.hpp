// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "solver/simulation.hpp"

/// Problems, bodies and fields that the tests of the solver share.
namespace sphstab::solver::test {

inline constexpr double density = 1.7, young_modulus = 2.3, poisson_ratio = 0.3;
inline constexpr double spacing = 0.8, smoothing_length = 1.3 * spacing;  // support 2.6 spacings
inline constexpr Damping some_damping{0.37};

inline Problem<2> plain_problem(LatticeKind lattice = LatticeKind::square) {
  return {.lattice = {lattice, spacing},
          .kernel = {KernelFamily::cubic_spline, smoothing_length},
          .material = Material::from_young_modulus(density, young_modulus, poisson_ratio),
          .scheme = {}};
}

/// A base state that is neither symmetric nor traceless.
inline Tensor<2> some_displacement_gradient() { return (Tensor<2>() << 0.05, 0.03, -0.01, -0.02).finished(); }

/// Displacements and velocities uniform in ±amplitude, from a generator whose numbers the standard fixes.
inline State<2> random_state(int particles, double amplitude, unsigned seed) {
  std::mt19937 generator(seed);
  const auto next = [&] { return amplitude * (2.0 * static_cast<double>(generator()) / 4294967295.0 - 1.0); };
  State<2> state(particles);
  for (int a = 0; a < particles; ++a) {
    state.displacement[a] = Vector<2>(next(), next());
    state.velocity[a] = Vector<2>(next(), next());
  }
  return state;
}

/// A free plate whose particles differ in volume, so that V_a in the place of V_b shows.
inline Body<2> uneven_plate(const Problem<2>& problem, const LatticeIndex<2>& particles) {
  Body<2> body = free_plate(problem, particles);
  for (int a = 0; a < body.size(); ++a) body.volume[a] *= 1.0 + 0.2 * std::sin(a);
  return body;
}

inline double largest(const Field<2>& field) {
  double norm = 0.0;
  for (const auto& y : field) norm = std::max(norm, y.norm());
  return norm;
}

inline double largest_difference(const Field<2>& left, const Field<2>& right) {
  double norm = 0.0;
  for (std::size_t a = 0; a < left.size(); ++a) norm = std::max(norm, (left[a] - right[a]).norm());
  return norm;
}

/// Σ_a m_a left_a · right_a with m = ρ0 V.
inline double mass_product(const Body<2>& body, const Field<2>& left, const Field<2>& right) {
  double sum = 0.0;
  for (int a = 0; a < body.size(); ++a) sum += density * body.volume[a] * left[a].dot(right[a]);
  return sum;
}

/// Every combination of normalisation, density, plane, base state and damping, applied to `problem`.
inline std::vector<Problem<2>> all_variants(const Problem<2>& problem) {
  std::vector<Problem<2>> variants;
  for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum})
    for (const auto momentum_density : {MomentumDensity::frozen, MomentumDensity::equation_of_state})
      for (const auto plane : {Plane::strain, Plane::stress})
        for (const bool strained : {false, true})
          for (const bool damped : {false, true}) {
            Problem<2> variant = problem;
            variant.plane = plane;
            variant.scheme.kernel_normalisation = normalisation;
            variant.scheme.momentum_density = momentum_density;
            if (strained) variant.displacement_gradient = some_displacement_gradient();
            if (damped) variant.scheme.damping = some_damping;
            variants.push_back(variant);
          }
  return variants;
}

inline std::string describe(const Problem<2>& problem) {
  std::string words;
  for (const auto word :
       {name_of(problem.lattice.kind()), name_of(problem.scheme.kernel_normalisation),
        name_of(problem.scheme.momentum_density), name_of(problem.plane), name_of(problem.integrator)})
    words += std::string(word) + " ";
  return words + (problem.displacement_gradient.isZero() ? "unstrained " : "strained ") +
         (problem.scheme.damping ? "damped" : "undamped");
}

}  // namespace sphstab::solver::test
