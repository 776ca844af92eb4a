// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "model/body.hpp"

namespace sphstab {

/// A particle whose displacement, velocity and stress are recorded.
struct Probe {
  std::string name;
  int particle;
};

/// Particles as they are placed, held and loaded, with the scheme that moves them. The problem holds what all particles
/// share; its material and lattice are the defaults of the bodies. Particles of all bodies that are closer than the
/// support are neighbours: bodies that touch are bonded.
template <int Dim>
struct Scene {
  std::string name;
  Problem<Dim> problem;
  Body<Dim> body;
  std::vector<Probe> probes;
};

}  // namespace sphstab
