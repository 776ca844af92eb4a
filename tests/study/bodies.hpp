// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "model/body.hpp"

/// Bodies of which no formula knows the answer: clamped, jittered, of several materials.
namespace sphstab::study::test {

inline const Material soft = Material::from_young_modulus(1.7, 2.3, 0.3);
/// A thousand times denser.
inline const Material heavy = Material::from_young_modulus(1700.0, 31.0, 0.45);
inline const Material nearly_incompressible = Material::from_young_modulus(1.7, 2.3, 0.4999);

inline Problem<2> plain_problem(const Material& material = soft) {
  return {.lattice = {LatticeKind::square, 0.8},
          .kernel = {KernelFamily::cubic_spline, 1.3 * 0.8},
          .material = material,
          .scheme = {}};
}

inline Body<2> clamped_at_left(Body<2> body) {
  body.clamped.assign(body.size(), Directions<2>::Constant(false));
  for (int a = 0; a < body.size(); ++a)
    if (body.site[a][0] < 2) body.clamped[a].setConstant(true);
  return body;
}

inline Body<2> loaded(Body<2> body, const Vector<2>& load) {
  body.load.assign(body.size(), load);
  return body;
}

/// Moved by up to 20 % of the spacing.
inline Body<2> jittered(Body<2> body, const Problem<2>& problem, unsigned seed) {
  std::mt19937 generator(seed);
  const auto next = [&] { return 2.0 * static_cast<double>(generator()) / 4294967295.0 - 1.0; };
  for (auto& x : body.position)
    for (int i = 0; i < 2; ++i) x[i] += 0.2 * problem.lattice.spacing() * next();
  body.pairs = find_pairs(body.position, problem.kernel.support());
  return body;
}

/// Its right half is heavy.
inline Body<2> of_two_materials(Body<2> body, int columns) {
  body.materials = {soft, heavy};
  for (int a = 0; a < body.size(); ++a) body.material[a] = body.site[a][0] < columns / 2 ? 0 : 1;
  return body;
}

}  // namespace sphstab::study::test
