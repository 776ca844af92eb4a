// SPDX-License-Identifier: MIT
#pragma once

#include <random>

#include "solver/cases.hpp"

/// Disordered bodies of several materials in every dimension.
namespace sphstab::solver::test {

/// Numbers in [−1, 1], the same everywhere.
class Numbers {
 public:
  explicit Numbers(unsigned seed) : generator_(seed) {}
  double next() { return 2.0 * static_cast<double>(generator_()) / 4294967295.0 - 1.0; }
  template <int Dim>
  Vector<Dim> vector() {
    Vector<Dim> y;
    for (int i = 0; i < Dim; ++i) y[i] = next();
    return y;
  }

 private:
  std::mt19937 generator_;
};

template <int Dim>
Problem<Dim> problem_in(LatticeKind lattice) {
  return {.lattice = {lattice, spacing},
          .kernel = {KernelFamily::cubic_spline, smoothing_length},
          .material = Material::from_young_modulus(density, young_modulus, poisson_ratio),
          .scheme = {}};
}

/// Two materials with a density ratio of 1000.
inline const std::vector<Material> materials{Material::from_young_modulus(1.7, 2.3, 0.3),
                                             Material::from_young_modulus(1700.0, 31.0, 0.45)};

/// A block of particles 20 % off their lattice, of uneven volumes and materials in turn; nothing holds or loads it.
template <int Dim>
Body<Dim> disordered_block(const Problem<Dim>& problem, int side) {
  Numbers numbers(5);
  Body<Dim> body = periodic_patch<Dim>(problem, LatticeIndex<Dim>::Constant(side));
  for (int a = 0; a < body.size(); ++a) {
    body.position[a] += 0.2 * spacing * numbers.vector<Dim>();
    body.volume[a] *= 1.0 + 0.2 * numbers.next();
    body.material[a] = (a / 2) % 2;
  }
  body.materials = materials;
  body.site.clear();
  body.pairs = find_pairs(body.position, problem.kernel.support());
  return body;
}

template <int Dim>
Body<Dim> clamped_and_loaded(Body<Dim> body) {
  Numbers numbers(6);
  body.clamped.assign(body.size(), Directions<Dim>::Constant(false));
  body.clamped[0].setConstant(true);
  body.clamped[3][Dim - 1] = true;
  for (int a = 0; a < body.size(); ++a) body.load.push_back(0.1 * numbers.vector<Dim>());
  return body;
}

template <int Dim>
State<Dim> random_state_of(const Body<Dim>& body, double amplitude, unsigned seed) {
  Numbers numbers(seed);
  State<Dim> state(body.size());
  for (auto& s : state.displacement) s = amplitude * numbers.vector<Dim>();
  for (auto& v : state.velocity) v = amplitude * numbers.vector<Dim>();
  for (int a = 0; a < static_cast<int>(body.clamped.size()); ++a)
    for (int i = 0; i < Dim; ++i)
      if (body.clamped[a][i]) state.displacement[a][i] = state.velocity[a][i] = 0.0;
  return state;
}

/// Largest |ρ_a y_a|, the force density.
template <int Dim>
double largest_force(const Body<Dim>& body, const Field<Dim>& y) {
  double norm = 0.0;
  for (int a = 0; a < body.size(); ++a) norm = std::max(norm, body.material_of(a).density() * y[a].norm());
  return norm;
}

template <int Dim>
Field<Dim> difference(Field<Dim> left, const Field<Dim>& right) {
  for (std::size_t a = 0; a < left.size(); ++a) left[a] -= right[a];
  return left;
}

}  // namespace sphstab::solver::test
