// SPDX-License-Identifier: MIT
#include "io/progress.hpp"

#include <fmt/format.h>

#include <utility>

namespace sphstab::io {
namespace {

constexpr int width = 30;
constexpr std::chrono::milliseconds redraw_interval{100};

}  // namespace

Progress::Progress(std::string what, int descriptor, Clock::duration delay)
    : what_(std::move(what)),
      descriptor_(descriptor),
      next_(::isatty(descriptor) != 0 ? Clock::now() + delay : Clock::time_point::max()) {}

Progress::~Progress() {
  if (drawn_) print("\r\033[K");
}

void Progress::show(double fraction) {
  const auto now = Clock::now();
  if (now < next_) return;
  next_ = now + redraw_interval;
  drawn_ = true;
  const int full = static_cast<int>(fraction * width);
  print(fmt::format("\r\033[K{} [{:#<{}}{:.<{}}] {:3.0f} %", what_, "", full, "", width - full, 100.0 * fraction));
}

void Progress::print(const std::string& text) const {
  // A terminal that went away takes the bar with it and nothing else.
  [[maybe_unused]] const auto written = ::write(descriptor_, text.data(), text.size());
}

}  // namespace sphstab::io
