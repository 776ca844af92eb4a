// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "model/scene.hpp"

namespace sphstab::study {

/// Two particles, a < b.
struct Bond {
  int a, b;
};

/// The pairs of particles of a scene on a square lattice that are one spacing apart at the start. Keeps a reference to
/// the scene. Tested in tests/study/test_gray_plate.cpp and test_finite_strain_run.cpp.
class Bonds {
 public:
  explicit Bonds(const Scene<2>& scene) : scene_(scene) {
    const auto& pairs = scene.body.pairs;
    for (int a = 0; a < scene.body.size(); ++a)
      for (int entry = pairs.first[a]; entry < pairs.first[a + 1]; ++entry)
        if (a < pairs.neighbour[entry] && pairs.separation[entry].norm() < 1.1 * scene.problem.lattice.spacing())
          bonds_.push_back({a, pairs.neighbour[entry]});
  }

  /// The first one, by a, that is longer than so many spacings.
  std::optional<Bond> first_parted(const std::vector<Vector<2>>& displacement, double spacings) const {
    const auto position = [&](int a) { return Vector<2>(scene_.body.position[a] + displacement[a]); };
    for (const Bond& bond : bonds_)
      if ((position(bond.a) - position(bond.b)).norm() > spacings * scene_.problem.lattice.spacing()) return bond;
    return std::nullopt;
  }

 private:
  const Scene<2>& scene_;
  std::vector<Bond> bonds_;
};

}  // namespace sphstab::study
