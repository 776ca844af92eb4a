// SPDX-License-Identifier: MIT
#include "io/particle_output.hpp"

#include <fmt/format.h>

#include <cassert>
#include <numeric>
#include <system_error>
#include <utility>

#include "model/errors.hpp"

namespace sphstab::io {
namespace {

namespace fs = std::filesystem;

const ReferenceArrays reference{.number = {"number", "/reference/number", 1, true},
                                .position = {"position", "/reference/position", 3},
                                .others = {{"volume", "/reference/volume"},
                                           {"density", "/reference/density"},
                                           {"material", "/reference/material", 1, true}}};

fs::path companion_of(fs::path path) {
  const fs::path given = path;
  if (path.replace_extension(".xdmf") == given)
    throw InvalidInput(fmt::format("{}: is the name of the file beside the one of HDF5", given.string()));
  return path;
}

/// Returns work(); what HDF5 could not do becomes an InvalidInput that names `path`.
template <class Work>
auto naming(const fs::path& path, const Work& work) {
  try {
    return work();
  } catch (const std::system_error& error) {
    throw InvalidInput(fmt::format("{}: {}", path.string(), error.code().message()));
  }
}

}  // namespace

ParticleField scalar_field(const std::string& name, const std::vector<double>& scalars) { return {name, 1, scalars}; }

template <int Dim>
ParticleField vector_field(const std::string& name, const std::vector<Vector<Dim>>& vectors) {
  ParticleField field{name, 3, {}};
  for (const auto& v : vectors)
    for (int i = 0; i < 3; ++i) field.values.push_back(i < Dim ? v[i] : 0.0);
  return field;
}

template <int Dim>
ParticleField tensor_field(const std::string& name, const std::vector<Tensor<Dim>>& tensors) {
  ParticleField field{name, 6, {}};
  for (const auto& t : tensors)
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) field.values.push_back(j < Dim ? t(i, j) : 0.0);
  return field;
}

template <int Dim>
ParticleFile::ParticleFile(const fs::path& path, const Body<Dim>& body, Existing existing)
    : path_(path),
      companion_(companion_of(path)),
      existing_(existing),
      pending_(path, existing),
      file_(naming(path, [&] { return Hdf5File(pending_.assembly()); })),
      particles_(body.position.size()) {
  check_output(companion_, existing);
  std::vector<int> number(particles_);
  std::iota(number.begin(), number.end(), 0);
  std::vector<double> density;
  for (int a = 0; a < body.size(); ++a) density.push_back(body.material_of(a).density());
  naming(path_, [&] {
    file_.write("/reference/number", number);
    file_.write("/reference/position", vector_field<Dim>("position", body.position).values, 3);
    file_.write("/reference/volume", body.volume);
    file_.write("/reference/density", density);
    file_.write("/reference/material", body.material);
  });
}

void ParticleFile::add_state(double time, const std::vector<ParticleField>& fields) {
  StoredState state{time, {}};
  const std::string group = fmt::format("/states/{}/", states_.size());
  naming(path_, [&] {
    file_.write(group + "time", std::vector<double>{time});
    for (const auto& field : fields) {
      assert(field.values.size() == particles_ * field.columns);
      state.arrays.push_back({field.name, group + field.name, field.columns});
      file_.write(group + field.name, field.values, field.columns);
    }
  });
  states_.push_back(std::move(state));
}

void ParticleFile::finish() {
  naming(path_, [&] { file_.close(); });
  pending_.commit();
  write_file(companion_, xdmf_of_particles(path_.filename().string(), particles_, reference, states_), existing_);
}

template ParticleField vector_field(const std::string&, const std::vector<Vector<1>>&);
template ParticleField tensor_field(const std::string&, const std::vector<Tensor<1>>&);
template ParticleFile::ParticleFile(const fs::path&, const Body<1>&, Existing);
template ParticleField vector_field(const std::string&, const std::vector<Vector<2>>&);
template ParticleField tensor_field(const std::string&, const std::vector<Tensor<2>>&);
template ParticleFile::ParticleFile(const fs::path&, const Body<2>&, Existing);
template ParticleField vector_field(const std::string&, const std::vector<Vector<3>>&);
template ParticleField tensor_field(const std::string&, const std::vector<Tensor<3>>&);
template ParticleFile::ParticleFile(const fs::path&, const Body<3>&, Existing);

}  // namespace sphstab::io
