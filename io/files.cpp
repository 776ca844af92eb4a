// SPDX-License-Identifier: MIT
#include "io/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <system_error>

#include "model/errors.hpp"

namespace sphstab::io {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, std::string_view reason) {
  throw InvalidInput(fmt::format("{}: {}", path.string(), reason));
}

[[noreturn]] void throw_errno() { throw std::system_error(errno, std::generic_category()); }

}  // namespace

/// An open file.
class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags) : value_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {
    if (value_ < 0) throw_errno();
  }
  ~Descriptor() { ::close(value_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return value_; }

 private:
  int value_;
};

namespace {

/// Returns work(); what the system refuses it becomes an InvalidInput that names `path`.
template <class Work>
auto naming(const fs::path& path, const Work& work) {
  try {
    return work();
  } catch (const std::system_error& error) {
    fail(path, error.code().message());
  }
}

/// Repeats a read or a write that a signal interrupted.
template <class Transfer>
std::size_t transferred(const Transfer& transfer) {
  for (;;) {
    const ssize_t count = transfer();
    if (count >= 0) return static_cast<std::size_t>(count);
    if (errno != EINTR) throw_errno();
  }
}

/// Removes what stands at `path` when it goes, which is nothing if it was moved to its place.
struct Discard {
  const fs::path& path;
  ~Discard() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

/// A name beside `path` that no other thread or process takes.
fs::path hidden_neighbour(const fs::path& path) {
  static std::atomic<unsigned> count = 0;
  return path.parent_path() / fmt::format(".{}.{}.{}", path.filename().string(), ::getpid(), count++);
}

void write_all(int file, std::string_view text) {
  while (!text.empty()) text.remove_prefix(transferred([&] { return ::write(file, text.data(), text.size()); }));
}

std::string read_all(int file) {
  std::string text, block(65536, '\0');
  while (const std::size_t count = transferred([&] { return ::read(file, block.data(), block.size()); }))
    text.append(block, 0, count);
  return text;
}

void write_to_disk(const fs::path& path, std::string_view text) {
  const Descriptor file(path, O_WRONLY | O_CREAT | O_EXCL);
  write_all(file.get(), text);
  if (::fsync(file.get()) != 0) throw_errno();
}

void require_folder(const fs::path& folder) {
  if (!fs::is_directory(folder)) fail(folder, fs::exists(folder) ? "is no folder" : "no such folder");
}

/// The path with its links followed and no slash at its end.
fs::path resolved(const fs::path& path) {
  const fs::path full = fs::weakly_canonical(fs::absolute(path));
  return full.has_filename() ? full : full.parent_path();
}

/// The place of a file that `path` names. Throws where no file can be put there.
fs::path output_place(const fs::path& path, Existing existing) {
  const fs::path target = resolved(path);
  require_folder(target.parent_path());
  if (fs::exists(target)) {
    if (!fs::is_regular_file(target)) fail(path, "is no regular file");
    if (existing == Existing::refuse) fail(path, "exists already");
  }
  return target;
}

/// The text up to the end of its last whole line.
std::string_view whole_lines(std::string_view text) { return text.substr(0, text.find_last_of('\n') + 1); }

}  // namespace

std::string read_file(const fs::path& path) {
  return naming(path, [&] { return read_all(Descriptor(path, O_RDONLY).get()); });
}

void check_input(const fs::path& path) {
  naming(path, [&] { Descriptor(path, O_RDONLY); });
}

void write_file(const fs::path& path, std::string_view text, Existing existing) {
  PendingFile file(path, existing);
  naming(path, [&] { write_to_disk(file.assembly(), text); });
  file.commit();
}

void check_output(const fs::path& path, Existing existing) {
  naming(path, [&] { output_place(path, existing); });
}

PendingFile::PendingFile(const fs::path& path, Existing existing) {
  naming(path, [&] {
    path_ = output_place(path, existing);
    assembly_ = hidden_neighbour(path_);
  });
}

PendingFile::~PendingFile() { const Discard discard{assembly_}; }

void PendingFile::commit() {
  naming(path_, [&] {
    if (::fsync(Descriptor(assembly_, O_RDONLY).get()) != 0) throw_errno();
    fs::rename(assembly_, path_);
  });
}

OutputFolder::OutputFolder(const fs::path& path, Existing existing) {
  naming(path, [&] {
    path_ = resolved(path);
    require_folder(path_.parent_path());
    if (fs::exists(path_)) {
      require_folder(path_);
      if (existing == Existing::refuse && !fs::is_empty(path_)) fail(path, "exists already and is not empty");
    }
    assembly_ = hidden_neighbour(path_);
    fs::create_directory(assembly_);
  });
}

OutputFolder::~OutputFolder() { const Discard discard{assembly_}; }

fs::path OutputFolder::assembly(const fs::path& name) {
  return naming(path_ / name, [&] {
    if (fs::exists(assembly_ / name)) fail(path_ / name, "is written twice");
    fs::create_directories((assembly_ / name).parent_path());
    return assembly_ / name;
  });
}

void OutputFolder::write(const fs::path& name, std::string_view text) {
  naming(path_ / name, [&] { write_to_disk(assembly(name), text); });
}

void OutputFolder::commit() {
  naming(path_, [&] {
    if (!fs::exists(path_)) return fs::rename(assembly_, path_);
    for (const auto& entry : fs::recursive_directory_iterator(assembly_)) {
      const fs::path target = path_ / entry.path().lexically_relative(assembly_);
      if (fs::exists(target) && fs::is_directory(target) != entry.is_directory())
        fail(target, entry.is_directory() ? "is no folder" : "is a folder");
    }
    if (!series_.empty())
      for (const auto& entry :
           std::vector<fs::directory_entry>(fs::directory_iterator(path_), fs::directory_iterator()))
        if (entry.is_regular_file() && entry.path().filename().string().starts_with(series_)) fs::remove(entry.path());
    for (const auto& entry : fs::recursive_directory_iterator(assembly_)) {
      const fs::path target = path_ / entry.path().lexically_relative(assembly_);
      if (entry.is_directory())
        fs::create_directory(target);
      else
        fs::rename(entry.path(), target);
    }
  });
}

Journal::Journal(const fs::path& path, std::string_view first, Existing other) : path_(path) {
  naming(path_, [&] {
    file_ = std::make_unique<Descriptor>(path_, O_RDWR | O_CREAT | O_APPEND);
    if (::flock(file_->get(), LOCK_EX | LOCK_NB) != 0) fail(path_, "is in use by another run");
    const std::string begin = std::string(first) + '\n', text = read_all(file_->get());
    const bool same = text.starts_with(begin) || begin.starts_with(text);
    if (!same && other == Existing::refuse) fail(path_, "was begun by another run, not by this one");
    std::string_view kept = same ? whole_lines(text) : std::string_view();
    if (::ftruncate(file_->get(), static_cast<off_t>(kept.size())) != 0) throw_errno();
    if (kept.empty()) return write_all(file_->get(), begin);
    for (kept.remove_prefix(begin.size()); !kept.empty(); kept.remove_prefix(lines_.back().size() + 1))
      lines_.emplace_back(kept.substr(0, kept.find('\n')));
  });
}

Journal::~Journal() = default;

void Journal::append(std::string_view line) {
  naming(path_, [&] {
    write_all(file_->get(), std::string(line) + '\n');
    const auto now = std::chrono::steady_clock::now();
    if (now - synchronised_ < std::chrono::seconds(1)) return;
    synchronised_ = now;
    if (::fdatasync(file_->get()) != 0) throw_errno();
  });
}

void Journal::remove() {
  naming(path_, [&] { fs::remove(path_); });
}

}  // namespace sphstab::io
