// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/files.hpp"
#include "io/hdf5.hpp"
#include "io/xdmf.hpp"
#include "model/body.hpp"

namespace sphstab::io {

/// A quantity of every particle, in their order, a row of values each.
struct ParticleField {
  std::string name;
  int columns;
  std::vector<double> values;
};

ParticleField scalar_field(const std::string& name, const std::vector<double>& scalars);
/// Columns x, y, z; those that the dimension lacks are 0.
template <int Dim>
ParticleField vector_field(const std::string& name, const std::vector<Vector<Dim>>& vectors);
/// Columns xx, xy, xz, yy, yz, zz of symmetric tensors; those that the dimension lacks are 0.
template <int Dim>
ParticleField tensor_field(const std::string& name, const std::vector<Tensor<Dim>>& tensors);

/// States of a body in HDF5, with an XDMF file beside it that ParaView opens: motions at times, or modes at their
/// frequencies.
///
/// /reference/number, position, volume, density and material (its index) of the body, and /states/<i>/time and one data
/// set a field, i = 0, 1, …; one row a particle. Both files appear with finish(); without it nothing remains. Tested in
/// tests/io/test_particle_output.cpp.
class ParticleFile {
 public:
  /// The HDF5 file is `path`, the other the same with the extension .xdmf. Throws InvalidInput like check_output for
  /// both, and where `path` has that extension itself.
  template <int Dim>
  ParticleFile(const std::filesystem::path& path, const Body<Dim>& body, Existing existing = Existing::refuse);

  /// Adds a state. Throws InvalidInput naming the path and the reason where it cannot be written.
  void add_state(double time, const std::vector<ParticleField>& fields);

  /// Throws InvalidInput naming the path and the reason.
  void finish();

 private:
  std::filesystem::path path_;
  std::filesystem::path companion_;
  Existing existing_;
  PendingFile pending_;
  Hdf5File file_;
  std::size_t particles_;
  std::vector<StoredState> states_;
};

extern template ParticleField vector_field(const std::string&, const std::vector<Vector<1>>&);
extern template ParticleField tensor_field(const std::string&, const std::vector<Tensor<1>>&);
extern template ParticleFile::ParticleFile(const std::filesystem::path&, const Body<1>&, Existing);
extern template ParticleField vector_field(const std::string&, const std::vector<Vector<2>>&);
extern template ParticleField tensor_field(const std::string&, const std::vector<Tensor<2>>&);
extern template ParticleFile::ParticleFile(const std::filesystem::path&, const Body<2>&, Existing);
extern template ParticleField vector_field(const std::string&, const std::vector<Vector<3>>&);
extern template ParticleField tensor_field(const std::string&, const std::vector<Tensor<3>>&);
extern template ParticleFile::ParticleFile(const std::filesystem::path&, const Body<3>&, Existing);

}  // namespace sphstab::io
