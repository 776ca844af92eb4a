// SPDX-License-Identifier: MIT
#include "io/particle_output.hpp"

#include <hdf5.h>

#include <catch2/catch.hpp>
#include <numeric>
#include <regex>

#include "io/full_disk.hpp"
#include "io/particle_input.hpp"
#include "io/scratch_folder.hpp"

using namespace sphstab;
using namespace sphstab::io;
using Words = std::vector<std::string>;

namespace {

/// A data set as it stands in a file.
struct DataSet {
  std::vector<hsize_t> shape;
  std::vector<double> values;
};

DataSet data_set(const std::filesystem::path& path, const std::string& name) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  REQUIRE(file >= 0);
  const hid_t set = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  REQUIRE(set >= 0);
  const hid_t space = H5Dget_space(set);
  DataSet found;
  found.shape.resize(H5Sget_simple_extent_ndims(space));
  H5Sget_simple_extent_dims(space, found.shape.data(), nullptr);
  found.values.resize(H5Sget_simple_extent_npoints(space));
  CHECK(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, found.values.data()) >= 0);
  H5Sclose(space);
  H5Dclose(set);
  H5Fclose(file);
  return found;
}

/// Every match of the groups of a pattern, one list a match.
std::vector<Words> matches(const std::string& text, const std::string& pattern) {
  std::vector<Words> found;
  const std::regex expression(pattern);
  for (std::sregex_iterator match(text.begin(), text.end(), expression), end; match != end; ++match) {
    found.emplace_back();
    for (std::size_t group = 1; group < match->size(); ++group) found.back().push_back((*match)[group]);
  }
  return found;
}

template <int Dim>
Body<Dim> body_of(int size) {
  Body<Dim> body;
  body.materials = {Material::from_young_modulus(2.0, 1.0, 0.3), Material::from_young_modulus(7.0, 1.0, 0.3)};
  for (int a = 0; a < size; ++a) {
    body.position.push_back(Vector<Dim>::Constant(a) + Vector<Dim>::LinSpaced(Dim, 0.125, 0.5));
    body.volume.push_back(1.0 + a);
    body.material.push_back(a % 2);
  }
  return body;
}

template <int Dim>
std::vector<Tensor<Dim>> symmetric_tensors(int size) {
  std::vector<Tensor<Dim>> tensors;
  for (int a = 0; a < size; ++a) {
    Tensor<Dim> t;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) t(i, j) = 100 * a + 10 * std::min(i, j) + std::max(i, j);
    tensors.push_back(t);
  }
  return tensors;
}

void write_two_states(const std::filesystem::path& path, Existing existing = Existing::refuse) {
  const auto body = body_of<2>(3);
  ParticleFile file(path, body, existing);
  file.add_state(0.0, {scalar_field("von_mises", {1.0, 2.0, 3.0})});
  file.add_state(0.1, {vector_field<2>("displacement", {{1.0, 2.0}, {3.0, 4.0}, {5.0, 6.0}}),
                       tensor_field<2>("stress", symmetric_tensors<2>(3))});
  file.finish();
}

}  // namespace

TEST_CASE("particles and their states are read back from HDF5", "[fast]") {
  const ScratchFolder folder;
  const auto path = folder / "run.h5";
  write_two_states(path);
  CHECK(folder.names() == Words{"run.h5", "run.xdmf"});

  const auto position = data_set(path, "/reference/position");
  CHECK(position.shape == std::vector<hsize_t>{3, 3});
  CHECK(position.values == std::vector<double>{0.125, 0.5, 0.0, 1.125, 1.5, 0.0, 2.125, 2.5, 0.0});
  CHECK(data_set(path, "/reference/number").values == std::vector<double>{0.0, 1.0, 2.0});
  const auto volume = data_set(path, "/reference/volume");
  CHECK(volume.shape == std::vector<hsize_t>{3});
  CHECK(volume.values == std::vector<double>{1.0, 2.0, 3.0});
  CHECK(data_set(path, "/reference/density").values == std::vector<double>{2.0, 7.0, 2.0});
  CHECK(data_set(path, "/reference/material").values == std::vector<double>{0.0, 1.0, 0.0});
  CHECK(data_set(path, "/states/0/time").values == std::vector<double>{0.0});
  CHECK(data_set(path, "/states/1/time").values == std::vector<double>{0.1});
  CHECK(data_set(path, "/states/0/von_mises").values == std::vector<double>{1.0, 2.0, 3.0});
  CHECK(data_set(path, "/states/1/displacement").values ==
        std::vector<double>{1.0, 2.0, 0.0, 3.0, 4.0, 0.0, 5.0, 6.0, 0.0});
  const auto stress = data_set(path, "/states/1/stress");  // xx, xy, xz, yy, yz, zz
  CHECK(stress.shape == std::vector<hsize_t>{3, 6});
  CHECK(std::vector<double>(stress.values.begin() + 6, stress.values.begin() + 12) ==
        std::vector<double>{100.0, 101.0, 0.0, 111.0, 0.0, 0.0});
}

TEST_CASE("vectors and tensors of every dimension have their places", "[fast]") {
  CHECK(vector_field<1>("u", {Vector<1>(3.0)}).values == std::vector<double>{3.0, 0.0, 0.0});
  CHECK(vector_field<3>("u", {{1.0, 2.0, 3.0}}).values == std::vector<double>{1.0, 2.0, 3.0});
  CHECK(tensor_field<1>("s", {Tensor<1>(3.0)}).values == std::vector<double>{3.0, 0.0, 0.0, 0.0, 0.0, 0.0});
  CHECK(tensor_field<3>("s", symmetric_tensors<3>(1)).values == std::vector<double>{0.0, 1.0, 2.0, 11.0, 12.0, 22.0});
  for (const int dimension : {1, 3}) {
    const ScratchFolder folder;
    const auto write = [&](const auto& body) { ParticleFile(folder / "a.h5", body).finish(); };
    if (dimension == 1) write(body_of<1>(2));
    if (dimension == 3) write(body_of<3>(2));
    CHECK(data_set(folder / "a.h5", "/reference/position").values ==
          (dimension == 1 ? std::vector<double>{0.5, 0.0, 0.0, 1.5, 0.0, 0.0}
                          : std::vector<double>{0.125, 0.3125, 0.5, 1.125, 1.3125, 1.5}));
  }
}

TEST_CASE("the XDMF file names every array of the HDF5 file in its shape", "[fast]") {
  const ScratchFolder folder;
  write_two_states(folder / "a & b.h5");
  const std::string text = read_file(folder / "a & b.xdmf");
  // Every element that is opened is closed, in order.
  Words open;
  for (const auto& tag : matches(text, "<(/?)(\\w+)[^<>]*?(/?)>")) {
    if (tag[0].empty() && tag[2].empty()) open.push_back(tag[1]);
    if (tag[0].empty()) continue;
    REQUIRE_FALSE(open.empty());
    CHECK(open.back() == tag[1]);
    open.pop_back();
  }
  CHECK(open.empty());
  CHECK(matches(text, "<Time Value=\"(.*?)\"/>") == std::vector<Words>{{"0"}, {"0.1"}});
  CHECK(matches(text, "TopologyType=\"(\\w+)\" NumberOfElements=\"(\\d+)\"") ==
        std::vector<Words>{{"Polyvertex", "3"}, {"Polyvertex", "3"}});
  CHECK(matches(text, "<Attribute Name=\"(\\w+)\" AttributeType=\"(\\w+)\"") ==
        std::vector<Words>{{"volume", "Scalar"},
                           {"density", "Scalar"},
                           {"material", "Scalar"},
                           {"von_mises", "Scalar"},
                           {"volume", "Scalar"},
                           {"density", "Scalar"},
                           {"material", "Scalar"},
                           {"displacement", "Vector"},
                           {"stress", "Tensor6"}});
  const auto items = matches(text, "<DataItem Dimensions=\"([\\d ]+)\".*?>([^:<]+):([^<]+)</DataItem>");
  CHECK(items.size() == 4 + 9);  // numbers and positions twice
  for (const auto& item : items) {
    CHECK(item[1] == "a &amp; b.h5");
    std::string shape;
    for (const auto length : data_set(folder / "a & b.h5", item[2]).shape)
      shape += (shape.empty() ? "" : " ") + std::to_string(length);
    CHECK(item[0] == shape);
  }
}

TEST_CASE("particle files appear whole, together, or not at all", "[fast]") {
  const ScratchFolder folder;
  {
    ParticleFile file(folder / "run.h5", body_of<2>(3));
    file.add_state(0.0, {});
  }
  CHECK(folder.names().empty());
  write_file(folder / "run.xdmf", "old");
  CHECK_THROWS_WITH(write_two_states(folder / "run.h5"), (folder / "run.xdmf").string() + ": exists already");
  CHECK(folder.names() == Words{"run.xdmf"});
  CHECK(read_file(folder / "run.xdmf") == "old");
  write_two_states(folder / "run.h5", Existing::replace);
  const auto bytes = read_file(folder / "run.h5");
  CHECK_THROWS_WITH(write_two_states(folder / "run.h5"), (folder / "run.h5").string() + ": exists already");
  CHECK_THROWS_WITH(write_two_states(folder / "run.xdmf", Existing::replace), Catch::Contains("is the name of"));
  CHECK_THROWS_WITH(write_two_states(folder / "missing/run.h5"), Catch::EndsWith("missing: no such folder"));
  write_two_states(folder / "run.h5", Existing::replace);
  CHECK(read_file(folder / "run.h5") == bytes);  // the same contents, the same bytes
}

TEST_CASE("a state is read back to the last digit, by its number or as the last one", "[fast]") {
  const ScratchFolder folder;
  const auto path = folder / "run.h5";
  const auto body = body_of<3>(2);
  const std::vector<Vector<3>> first{{0.1, 0.2, 0.3}, {1.0 / 3.0, -2.0, 1e-300}},
      last{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
  ParticleFile file(path, body);
  file.add_state(0.1, {vector_field<3>("displacement", first), scalar_field("von_mises", {1.0, 2.0})});
  file.add_state(0.7, {vector_field<3>("displacement", last)});
  file.finish();
  const auto by_number = read_state<3>(path, body, 0), without = read_state<3>(path, body);
  CHECK(by_number.number == 0);
  CHECK(by_number.time == 0.1);
  CHECK(by_number.displacement == first);
  CHECK(without.number == 1);
  CHECK(without.time == 0.7);
  CHECK(without.displacement == last);
}

TEST_CASE("states that are missing or of other particles are refused by name", "[fast]") {
  const ScratchFolder folder;
  const auto path = folder / "run.h5";
  const std::string name = path.string();
  const auto body = body_of<2>(3);
  CHECK_THROWS_WITH(read_state<2>(path, body), name + ": No such file or directory");
  write_file(folder / "text.h5", "states");
  CHECK_THROWS_WITH(read_state<2>(folder / "text.h5", body), (folder / "text.h5").string() + ": is no HDF5 file");
  ParticleFile(folder / "empty.h5", body).finish();
  CHECK_THROWS_WITH(read_state<2>(folder / "empty.h5", body),
                    (folder / "empty.h5").string() + ": holds no states of a run");
  write_two_states(path);
  CHECK_THROWS_WITH(read_state<2>(path, body, 2), name + ": has no state 2, only 0 to 1");
  CHECK_THROWS_WITH(read_state<2>(path, body, 0), name + ": has no data set /states/0/displacement that can be read");
  CHECK_THROWS_WITH(read_state<2>(path, body_of<2>(4)), name + ": has 3 particles, the body has 4");
  auto moved = body;
  moved.position[1][0] += 1e-5;
  CHECK_THROWS_WITH(read_state<2>(path, moved),
                    name + ": particle 1 is not where the body has it; it is of another scene");
  moved.position[1][0] = body.position[1][0] + 1e-9;
  CHECK(read_state<2>(path, moved).displacement[2] == Vector<2>(5.0, 6.0));
}

TEST_CASE("a full disk is named, and leaves nothing of a particle file behind", "[fast]") {
  const ScratchFolder folder;
  write_two_states(folder / "whole.h5");
  const auto whole = std::filesystem::file_size(folder / "whole.h5");
  for (const rlim_t bytes : {rlim_t{50}, whole / 2, whole - 1}) {
    INFO(bytes);
    const FullDisk full(bytes);
    CHECK_THROWS_WITH(write_two_states(folder / "run.h5"), (folder / "run.h5").string() + ": File too large");
  }
  CHECK(folder.names() == Words{"whole.h5", "whole.xdmf"});
  write_two_states(folder / "run.h5");
  CHECK(data_set(folder / "run.h5", "/states/0/von_mises").values.size() == 3);
}
