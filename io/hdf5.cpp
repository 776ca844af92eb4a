// SPDX-License-Identifier: MIT
#include "io/hdf5.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <type_traits>

#include "io/files.hpp"
#include "model/errors.hpp"

namespace sphstab::io {
namespace {

static_assert(std::is_same_v<hid_t, std::int64_t>);

/// The result of a call, which is negative where it failed; errno then says why if the system refused something.
template <class Result>
Result checked(Result result) {
  if (result < 0) throw std::system_error(errno != 0 ? errno : EIO, std::generic_category(), "HDF5");
  return result;
}

/// Something of HDF5 that is closed when it goes.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(checked(id)), close_(close) {}
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  hid_t get() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void write_set(hid_t file, const std::string& name, hid_t file_type, hid_t memory_type, const void* values,
               std::size_t size, int columns) {
  errno = 0;
  const std::array<hsize_t, 2> shape{size / columns, static_cast<hsize_t>(columns)};
  const Handle space(H5Screate_simple(columns == 1 ? 1 : 2, shape.data(), nullptr), H5Sclose);
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose), creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  checked(H5Pset_create_intermediate_group(links.get(), 1));
  checked(H5Pset_obj_track_times(creation.get(), false));
  const Handle set(H5Dcreate2(file, name.c_str(), file_type, space.get(), links.get(), creation.get(), H5P_DEFAULT),
                   H5Dclose);
  checked(H5Dwrite(set.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
}

/// Before a file is opened.
void keep_quiet() {
  H5dont_atexit();                              // at exit it would crash over a file that it could not write
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // it prints nothing
  errno = 0;
}

}  // namespace

Hdf5File::Hdf5File(const std::filesystem::path& path) {
  keep_quiet();
  file_ = checked(H5Fcreate(path.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT));
}

Hdf5File::~Hdf5File() {
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5File::write(const std::string& name, const std::vector<double>& values, int columns) {
  write_set(file_, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values.data(), values.size(), columns);
}

void Hdf5File::write(const std::string& name, const std::vector<int>& values) {
  write_set(file_, name, H5T_STD_I32LE, H5T_NATIVE_INT, values.data(), values.size(), 1);
}

void Hdf5File::close() {
  errno = 0;
  checked(H5Fflush(file_, H5F_SCOPE_LOCAL));
  checked(H5Fclose(file_));
  file_ = -1;
}

Hdf5Input::Hdf5Input(const std::filesystem::path& path) : path_(path) {
  check_input(path);
  keep_quiet();
  file_ = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file_ < 0) throw InvalidInput(fmt::format("{}: is no HDF5 file", path.string()));
}

Hdf5Input::~Hdf5Input() { H5Fclose(file_); }

bool Hdf5Input::has(const std::string& name) const { return H5Lexists(file_, name.c_str(), H5P_DEFAULT) > 0; }

std::vector<double> Hdf5Input::read(const std::string& name) const {
  try {
    const Handle set(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
    const Handle space(H5Dget_space(set.get()), H5Sclose);
    std::vector<double> values(checked(H5Sget_simple_extent_npoints(space.get())));
    checked(H5Dread(set.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
    return values;
  } catch (const std::system_error&) {
    throw InvalidInput(fmt::format("{}: has no data set {} that can be read", path_.string(), name));
  }
}

}  // namespace sphstab::io
