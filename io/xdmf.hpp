// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace sphstab::io {

/// A data set of the HDF5 file with a row a particle: 1 column is a scalar, 3 a vector, 6 a symmetric tensor in the
/// order xx, xy, xz, yy, yz, zz.
struct ParticleArray {
  std::string name;
  std::string data_set;
  int columns = 1;
  bool whole_numbers = false;
};

/// What is stored at one time.
struct StoredState {
  double time;
  std::vector<ParticleArray> arrays;
};

/// The XDMF text that tells ParaView how to read `particles` points and their arrays from the HDF5 file beside it:
/// positions and `constant` arrays are the same in every state.
std::string xdmf_of_particles(const std::string& hdf5_name, std::size_t particles, const ParticleArray& positions,
                              const std::vector<ParticleArray>& constant, const std::vector<StoredState>& states);

}  // namespace sphstab::io
