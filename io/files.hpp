// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace sphstab::io {

/// What happens to what stands at the place of an output.
enum class Existing { refuse, replace };

/// The bytes of a file. Throws InvalidInput naming the path and the reason.
std::string read_file(const std::filesystem::path& path);

/// Throws what read_file would throw where the file cannot be opened.
void check_input(const std::filesystem::path& path);

/// Writes `text` to `path`, so that the file appears whole or not at all, whatever happens to the program or the
/// machine. Throws InvalidInput naming the path and the reason, and then leaves nothing behind.
void write_file(const std::filesystem::path& path, std::string_view text, Existing existing = Existing::refuse);

/// Throws what write_file would throw for the place alone, so that it is known before the work.
void check_output(const std::filesystem::path& path, Existing existing = Existing::refuse);

/// A file that a library writes for itself: at a hidden place beside its own, where commit() moves it; without commit()
/// nothing remains.
class PendingFile {
 public:
  /// Throws what check_output throws.
  explicit PendingFile(const std::filesystem::path& path, Existing existing = Existing::refuse);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  /// Where to write it.
  const std::filesystem::path& assembly() const { return assembly_; }

  /// Throws InvalidInput naming the path and the reason.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path assembly_;
};

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

  /// Where a library may write such a file for itself, before commit(). Throws like write().
  std::filesystem::path assembly(const std::filesystem::path& name);

  /// Files of the folder whose names begin so and that are not written again go at commit(): the rest of a longer
  /// series.
  void replace_series(const std::string& beginning) { series_ = beginning; }

  /// Throws InvalidInput, before anything is moved, where a folder stands in the place of a file or the reverse.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path assembly_;
  std::string series_;
};

class Descriptor;

/// A file of lines that grows while long work goes on and outlives its interruption: what append() was given is kept
/// when the program is killed, and all but the last second of it when the machine goes down.
class Journal {
 public:
  /// Begins the journal with the line `first`, which says what work it is of, or opens the one that an interrupted run
  /// of the same work left; the end of it that is no whole line is dropped. Throws InvalidInput naming the path where
  /// it cannot be written, another process has it open or, unless `other` is `replace`, it is of other work.
  Journal(const std::filesystem::path& path, std::string_view first, Existing other = Existing::refuse);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// The lines after the first that were there when it was opened.
  const std::vector<std::string>& lines() const { return lines_; }

  /// Adds a line, given without its end. Throws InvalidInput naming the path.
  void append(std::string_view line);

  /// Removes the file: the work is done.
  void remove();

 private:
  std::filesystem::path path_;
  std::unique_ptr<Descriptor> file_;
  std::vector<std::string> lines_;
  std::chrono::steady_clock::time_point synchronised_;  ///< with the disk
};

}  // namespace sphstab::io
