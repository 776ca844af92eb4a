// SPDX-License-Identifier: MIT
#include "io/particle_input.hpp"

#include <fmt/format.h>

#include <cmath>

#include "io/hdf5.hpp"
#include "model/errors.hpp"

namespace sphstab::io {
namespace {

/// Of positions, in spacings: what another compiler may round a scene to, and less than any scene moves a particle by.
constexpr double same_place = 1e-6;

constexpr int columns = 3;  // of a vector, whatever the dimension

std::string group_of(int number) { return fmt::format("/states/{}", number); }

int count_states(const Hdf5Input& file) {
  int count = 0;
  while (file.has("/states") && file.has(group_of(count))) ++count;
  return count;
}

template <int Dim>
std::vector<Vector<Dim>> read_vectors(const Hdf5Input& file, const std::string& name) {
  const std::vector<double> values = file.read(name);
  std::vector<Vector<Dim>> vectors;
  for (std::size_t i = 0; i + columns <= values.size(); i += columns)
    vectors.push_back(Eigen::Map<const Vector<Dim>>(values.data() + i));
  return vectors;
}

template <int Dim>
void require_same_particles(const std::filesystem::path& path, const Hdf5Input& file, const Body<Dim>& body) {
  const auto position = read_vectors<Dim>(file, "/reference/position");
  if (position.size() != body.position.size())
    throw InvalidInput(
        fmt::format("{}: has {} particles, the body has {}", path.string(), position.size(), body.position.size()));
  for (int a = 0; a < body.size(); ++a)
    if (!((position[a] - body.position[a]).norm() <= same_place * std::pow(body.volume[a], 1.0 / Dim)))
      throw InvalidInput(
          fmt::format("{}: particle {} is not where the body has it; it is of another scene", path.string(), a));
}

}  // namespace

template <int Dim>
ParticleState<Dim> read_state(const std::filesystem::path& path, const Body<Dim>& body, std::optional<int> number) {
  const Hdf5Input file(path);
  const int states = count_states(file);
  if (states == 0) throw InvalidInput(fmt::format("{}: holds no states of a run", path.string()));
  if (number && *number >= states)
    throw InvalidInput(fmt::format("{}: has no state {}, only 0 to {}", path.string(), *number, states - 1));
  require_same_particles(path, file, body);
  const int chosen = number.value_or(states - 1);
  ParticleState<Dim> state{chosen, file.read(group_of(chosen) + "/time").at(0),
                           read_vectors<Dim>(file, group_of(chosen) + "/displacement")};
  if (state.displacement.size() != body.position.size())
    throw InvalidInput(fmt::format("{}: state {} has {} displacements for {} particles", path.string(), chosen,
                                   state.displacement.size(), body.position.size()));
  return state;
}

template ParticleState<1> read_state(const std::filesystem::path&, const Body<1>&, std::optional<int>);
template ParticleState<2> read_state(const std::filesystem::path&, const Body<2>&, std::optional<int>);
template ParticleState<3> read_state(const std::filesystem::path&, const Body<3>&, std::optional<int>);

}  // namespace sphstab::io
