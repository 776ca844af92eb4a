// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <chrono>
#include <string>

#include "io/progress.hpp"

using namespace sphstab::io;

namespace {

/// Both ends of a terminal that nobody looks at.
class Terminal {
 public:
  Terminal() : reader_(::posix_openpt(O_RDWR | O_NOCTTY)) {
    ::grantpt(reader_);
    ::unlockpt(reader_);
    writer_ = ::open(::ptsname(reader_), O_RDWR | O_NOCTTY);
  }
  ~Terminal() {
    ::close(writer_);
    ::close(reader_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  int writer() const { return writer_; }

  /// What was printed since the last call.
  std::string printed() const {
    std::string text;
    std::array<char, 4096> block{};
    pollfd ready{reader_, POLLIN, 0};
    while (::poll(&ready, 1, 50) > 0 && (ready.revents & POLLIN) != 0) {
      const auto count = ::read(reader_, block.data(), block.size());
      text.append(block.data(), static_cast<std::size_t>(count));
    }
    return text;
  }

 private:
  int reader_;
  int writer_;
};

}  // namespace

TEST_CASE("a progress bar shows the share that is done and goes when the work is done", "[fast]") {
  const Terminal terminal;
  {
    Progress progress("bisection", terminal.writer(), std::chrono::seconds(0));
    progress.show(0.5);
    CHECK(terminal.printed() == "\r\033[Kbisection [###############...............]  50 %");
  }
  CHECK(terminal.printed() == "\r\033[K");
}

TEST_CASE("a progress bar is not redrawn more often than eyes follow", "[fast]") {
  const Terminal terminal;
  Progress progress("runs", terminal.writer(), std::chrono::seconds(0));
  for (int i = 0; i < 1000; ++i) progress.show(1e-3 * i);
  CHECK(terminal.printed().size() < 200);
}

TEST_CASE("short work shows no progress bar", "[fast]") {
  const Terminal terminal;
  {
    Progress progress("runs", terminal.writer());
    progress.show(0.5);
  }
  CHECK(terminal.printed().empty());
}

TEST_CASE("no progress bar goes where no terminal is", "[fast]") {
  std::array<int, 2> pipe{};
  REQUIRE(::pipe2(pipe.data(), O_NONBLOCK) == 0);
  {
    Progress progress("runs", pipe[1], std::chrono::seconds(0));
    progress.show(0.5);
  }
  char c = 0;
  CHECK(::read(pipe[0], &c, 1) == -1);
  ::close(pipe[0]);
  ::close(pipe[1]);
}

TEST_CASE("work that tells no fraction shows its seconds, and a bar as soon as it does", "[fast]") {
  const Terminal terminal;
  {
    Progress progress("growth", terminal.writer(), std::chrono::seconds(0));
    std::string seconds;
    for (int wait = 0; wait < 200 && seconds.empty(); ++wait) seconds = terminal.printed();
    CHECK(seconds.starts_with("\r\033[Kgrowth: "));
    CHECK(seconds.ends_with(" s"));
    std::string bar;
    for (int wait = 0; wait < 200 && bar.empty(); ++wait) {
      progress.show(1.0);
      bar = terminal.printed();
    }
    CHECK(bar.ends_with("\r\033[Kgrowth [##############################] 100 %"));
  }
  CHECK(terminal.printed() == "\r\033[K");
}
