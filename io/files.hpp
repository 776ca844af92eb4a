// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace sphstab::io {

/// What happens to what stands at the place of an output.
enum class Existing { refuse, replace };

/// The bytes of a file. Throws InvalidInput naming the path and the reason.
std::string read_file(const std::filesystem::path& path);

/// Writes `text` to `path`, so that the file appears whole or not at all, whatever happens to the program or the
/// machine. Throws InvalidInput naming the path and the reason, and then leaves nothing behind.
void write_file(const std::filesystem::path& path, std::string_view text, Existing existing = Existing::refuse);

/// A folder of results that appears when it is complete. The files are assembled in a hidden folder beside it; commit()
/// moves them in, among the files that are there already if the folder existed; without commit() nothing remains.
class OutputFolder {
 public:
  /// Throws InvalidInput naming the path if it is no folder, if its parent is missing or not writable, and, unless
  /// `existing` is `replace`, if it is not empty.
  explicit OutputFolder(const std::filesystem::path& path, Existing existing = Existing::refuse);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Adds a file; `name` is relative to the folder and may lie in folders below it, which are made. Throws InvalidInput
  /// like write_file, and if the name was written before.
  void write(const std::filesystem::path& name, std::string_view text);

  /// Throws InvalidInput, before anything is moved, where a folder stands in the place of a file or the reverse.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path assembly_;
};

}  // namespace sphstab::io
