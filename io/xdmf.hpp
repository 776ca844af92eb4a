// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
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

/// What no state changes.
struct ReferenceArrays {
  ParticleArray number;  ///< 0, 1, 2 …
  ParticleArray position;
  std::vector<ParticleArray> others;
};

/// The XDMF text that tells ParaView how to read `particles` points and their arrays from the HDF5 file beside it.
std::string xdmf_of_particles(const std::string& hdf5_name, std::size_t particles, const ReferenceArrays& reference,
                              const std::vector<StoredState>& states);

}  // namespace sphstab::io
