// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>

#include "model/body.hpp"

namespace sphstab::io {

/// A state of a run.
template <int Dim>
struct ParticleState {
  int number;  ///< in its file
  double time;
  std::vector<Vector<Dim>> displacement;
};

/// State `number` of a file that a ParticleFile has written of this body, the last one if absent. Throws InvalidInput
/// naming the file: where it cannot be read, has no such state, or is of other particles, the positions of which differ
/// by more than 1e-6 of a spacing. Tested in tests/io/test_particle_output.cpp.
template <int Dim>
ParticleState<Dim> read_state(const std::filesystem::path& path, const Body<Dim>& body, std::optional<int> number = {});

extern template ParticleState<1> read_state(const std::filesystem::path&, const Body<1>&, std::optional<int>);
extern template ParticleState<2> read_state(const std::filesystem::path&, const Body<2>&, std::optional<int>);
extern template ParticleState<3> read_state(const std::filesystem::path&, const Body<3>&, std::optional<int>);

}  // namespace sphstab::io
