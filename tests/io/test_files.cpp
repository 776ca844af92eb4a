// SPDX-License-Identifier: MIT
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "io/files.hpp"
#include "io/full_disk.hpp"
#include "io/scratch_folder.hpp"
#include "model/errors.hpp"

using namespace sphstab;
using namespace sphstab::io;
using Catch::Matchers::Contains;
using Names = std::vector<std::string>;

TEST_CASE("a file is read back byte for byte", "[fast]") {
  const ScratchFolder folder;
  std::string text("zero \0 inside\r\n", 15);
  text.append(200000, 'x');
  write_file(folder / "a b.txt", text);
  CHECK(read_file(folder / "a b.txt") == text);
  CHECK(folder.names() == Names{"a b.txt"});
}

TEST_CASE("a file that exists is replaced only if asked", "[fast]") {
  const ScratchFolder folder;
  write_file(folder / "a", "old");
  CHECK_THROWS_WITH(write_file(folder / "a", "new"), (folder / "a").string() + ": exists already");
  CHECK(read_file(folder / "a") == "old");
  write_file(folder / "a", "new", Existing::replace);
  CHECK(read_file(folder / "a") == "new");
  CHECK(folder.names() == Names{"a"});
}

TEST_CASE("a file that cannot be written whole does not appear and leaves nothing behind", "[fast]") {
  const ScratchFolder folder;
  write_file(folder / "old", "old");
  {
    const FullDisk full(1000);
    CHECK_THROWS_WITH(write_file(folder / "new", std::string(5000, 'x')),
                      (folder / "new").string() + ": File too large");
    CHECK_THROWS_AS(write_file(folder / "old", std::string(5000, 'x'), Existing::replace), InvalidInput);
  }
  CHECK(folder.names() == Names{"old"});
  CHECK(read_file(folder / "old") == "old");
}

TEST_CASE("writing where no folder is names the folder and the reason", "[fast]") {
  const ScratchFolder folder;
  write_file(folder / "file", "");
  CHECK_THROWS_WITH(write_file(folder / "missing/a", ""), Contains("missing: no such folder"));
  CHECK_THROWS_WITH(write_file(folder / "file/a", ""), Contains("file: is no folder"));
  CHECK_THROWS_WITH(write_file(folder.path(), "", Existing::replace), Contains("is no regular file"));
  CHECK_THROWS_WITH(OutputFolder(folder / "missing/a"), Contains("missing: no such folder"));
  CHECK_THROWS_WITH(OutputFolder(folder / "file/a"), Contains("file: is no folder"));
  CHECK_THROWS_WITH(OutputFolder(folder / "file", Existing::replace), Contains("file: is no folder"));
  CHECK(folder.names() == Names{"file"});
}

TEST_CASE("what is neither file nor folder, such as a pipe or a device, is never replaced by a file", "[fast]") {
  const ScratchFolder folder;
  REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
  CHECK_THROWS_WITH(write_file(folder / "pipe", "", Existing::replace),
                    (folder / "pipe").string() + ": is no regular file");
  CHECK(std::filesystem::is_fifo(folder / "pipe"));
}

TEST_CASE("a file that cannot be read is named with the reason", "[fast]") {
  const ScratchFolder folder;
  CHECK_THROWS_WITH(read_file(folder / "none"), (folder / "none").string() + ": No such file or directory");
  CHECK_THROWS_WITH(read_file(folder.path()), folder.path().string() + ": Is a directory");
}

TEST_CASE("an output folder appears complete on commit and not before", "[fast]") {
  const ScratchFolder folder;
  {
    OutputFolder output(folder / "out/");
    output.write("index.md", "index");
    output.write("plate/figure.svg", "figure");
    CHECK_FALSE(std::filesystem::exists(folder / "out"));
    output.commit();
  }
  CHECK(folder.names() == Names{"out", "out/index.md", "out/plate", "out/plate/figure.svg"});
  CHECK(read_file(folder / "out/plate/figure.svg") == "figure");
}

TEST_CASE("an output folder that is not committed leaves nothing behind", "[fast]") {
  const ScratchFolder folder;
  {
    OutputFolder output(folder / "out");
    output.write("a/b", "text");
  }
  CHECK(folder.names().empty());
}

TEST_CASE("an output folder refuses a folder with files unless it may replace them", "[fast]") {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "out");
  OutputFolder(folder / "out").commit();
  write_file(folder / "out/kept", "kept");
  write_file(folder / "out/a", "old");
  CHECK_THROWS_WITH(OutputFolder(folder / "out"), (folder / "out").string() + ": exists already and is not empty");

  OutputFolder output(folder / "out", Existing::replace);
  output.write("a", "new");
  output.write("sub/b", "b");
  CHECK(read_file(folder / "out/a") == "old");
  output.commit();
  CHECK(read_file(folder / "out/a") == "new");
  CHECK(read_file(folder / "out/kept") == "kept");
  CHECK(read_file(folder / "out/sub/b") == "b");
}

TEST_CASE("a commit that cannot place every file places none", "[fast]") {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder / "out/b");
  {
    OutputFolder output(folder / "out", Existing::replace);
    output.write("a", "a");
    output.write("b", "a folder is in the way");
    output.write("c", "c");
    CHECK_THROWS_WITH(output.commit(), Contains("out/b: is a folder"));
  }
  CHECK(folder.names() == Names{"out", "out/b"});
}

TEST_CASE("an output folder takes each name once", "[fast]") {
  const ScratchFolder folder;
  OutputFolder output(folder / "out");
  output.write("a", "1");
  CHECK_THROWS_WITH(output.write("a", "2"), Contains("out/a: is written twice"));
}

TEST_CASE("a place where no file can be put is known before the file is written", "[fast]") {
  const ScratchFolder folder;
  write_file(folder / "old", "");
  check_output(folder / "new");
  check_output(folder / "old", Existing::replace);
  CHECK_THROWS_WITH(check_output(folder / "old"), Contains("old: exists already"));
  CHECK_THROWS_WITH(check_output(folder / "missing/a"), Contains("missing: no such folder"));
  CHECK_THROWS_WITH(check_output(folder.path(), Existing::replace), Contains("is no regular file"));
  CHECK(folder.names() == Names{"old"});
}

TEST_CASE("a journal gives back the lines of the same work until it is removed", "[fast]") {
  const ScratchFolder folder;
  {
    Journal journal(folder / "j", "work");
    CHECK(journal.lines().empty());
    journal.append("one");
    journal.append("");
    CHECK(read_file(folder / "j") == "work\none\n\n");
  }
  {
    Journal journal(folder / "j", "work");
    CHECK(journal.lines() == Names{"one", ""});
    journal.append("three");
  }
  Journal journal(folder / "j", "work", Existing::replace);
  CHECK(journal.lines() == Names{"one", "", "three"});
  journal.remove();
  CHECK(folder.names().empty());
}

TEST_CASE("the end of a journal that is no whole line is dropped, and the next line stands alone", "[fast]") {
  const ScratchFolder folder;
  for (const std::string torn : {"", "w", "work"}) {
    write_file(folder / "j", torn, Existing::replace);
    CHECK(Journal(folder / "j", "work").lines().empty());
    CHECK(read_file(folder / "j") == "work\n");
  }
  write_file(folder / "j", "work\none\ntw", Existing::replace);
  {
    Journal journal(folder / "j", "work");
    CHECK(journal.lines() == Names{"one"});
    journal.append("three");
  }
  CHECK(read_file(folder / "j") == "work\none\nthree\n");
}

TEST_CASE("a journal of other work is refused, or begun anew if asked", "[fast]") {
  const ScratchFolder folder;
  for (const std::string other : {"works\none\n", "wor\n", "\n", "play"}) {
    write_file(folder / "j", other, Existing::replace);
    CHECK_THROWS_WITH(Journal(folder / "j", "work"),
                      (folder / "j").string() + ": was begun by another run, not by this one");
    CHECK(read_file(folder / "j") == other);
    CHECK(Journal(folder / "j", "work", Existing::replace).lines().empty());
    CHECK(read_file(folder / "j") == "work\n");
  }
}

TEST_CASE("a journal is written by one at a time", "[fast]") {
  const ScratchFolder folder;
  {
    const Journal first(folder / "j", "work");
    CHECK_THROWS_WITH(Journal(folder / "j", "work"), Contains("j: is in use by another run"));
  }
  CHECK(Journal(folder / "j", "work").lines().empty());
}

TEST_CASE("a journal that cannot be written says so", "[fast]") {
  const ScratchFolder folder;
  CHECK_THROWS_WITH(Journal(folder / "missing/j", "work"), Contains("missing/j: No such file or directory"));
  Journal journal(folder / "j", "work");
  const FullDisk full(1000);
  CHECK_THROWS_WITH(journal.append(std::string(2000, 'x')), Contains("j: File too large"));
}

TEST_CASE("a file that a library writes for itself appears with commit, in its place or in a folder", "[fast]") {
  const ScratchFolder folder;
  write_file(folder / "taken", "old");
  CHECK_THROWS_WITH(PendingFile(folder / "taken"), (folder / "taken").string() + ": exists already");
  {
    PendingFile file(folder / "new");
    write_file(file.assembly(), "text");
    CHECK_FALSE(std::filesystem::exists(folder / "new"));
  }
  CHECK(folder.names() == Names{"taken"});
  PendingFile file(folder / "new");
  write_file(file.assembly(), "text");
  file.commit();
  CHECK(read_file(folder / "new") == "text");
  CHECK(folder.names() == Names{"new", "taken"});

  OutputFolder results(folder / "results");
  write_file(results.assembly("states/run.h5"), "numbers");
  CHECK_THROWS_WITH(results.write("states/run.h5", ""), Contains("run.h5: is written twice"));
  CHECK_FALSE(std::filesystem::exists(folder / "results"));
  results.commit();
  CHECK(read_file(folder / "results/states/run.h5") == "numbers");
}
