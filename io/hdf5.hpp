// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace sphstab::io {

/// A new HDF5 file; the same contents give the same bytes. One thread at a time may use any of them. What cannot be
/// written is thrown as std::system_error.
class Hdf5File {
 public:
  explicit Hdf5File(const std::filesystem::path& path);
  /// Without close() the file is not usable.
  ~Hdf5File();
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  /// Adds a data set, and the groups of its name ("/states/0/stress"): rows of `columns` values one after the other,
  /// a plain list where `columns` is 1.
  void write(const std::string& name, const std::vector<double>& values, int columns = 1);
  void write(const std::string& name, const std::vector<int>& values);

  void close();

 private:
  std::int64_t file_;
};

/// An HDF5 file that is read. Throws InvalidInput naming the file, and what of it cannot be read.
class Hdf5Input {
 public:
  explicit Hdf5Input(const std::filesystem::path& path);
  ~Hdf5Input();
  Hdf5Input(const Hdf5Input&) = delete;
  Hdf5Input& operator=(const Hdf5Input&) = delete;

  /// Whether there is a group or data set of that name; its groups have to exist.
  bool has(const std::string& name) const;

  /// All values of a data set, row after row.
  std::vector<double> read(const std::string& name) const;

 private:
  std::filesystem::path path_;
  std::int64_t file_;
};

}  // namespace sphstab::io
