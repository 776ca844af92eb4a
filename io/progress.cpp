// SPDX-License-Identifier: MIT
#include "io/progress.hpp"

#include <fmt/format.h>

#include <utility>

namespace sphstab::io {
namespace {

constexpr int width = 30;
constexpr std::chrono::milliseconds redraw_interval{100};
constexpr std::chrono::seconds seconds_interval{1};

}  // namespace

Progress::Progress(std::string what, int descriptor, Clock::duration delay)
    : what_(std::move(what)), descriptor_(descriptor), next_(start_ + delay) {
  if (::isatty(descriptor) != 0) watcher_ = std::thread([this] { draw_seconds_until_done(); });
}

Progress::~Progress() {
  if (!watcher_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  end_.notify_one();
  watcher_.join();
  if (drawn_) print("\r\033[K");
}

void Progress::show(double fraction) {
  if (!watcher_.joinable()) return;
  const std::lock_guard lock(mutex_);
  fraction_ = fraction;
  if (const auto now = Clock::now(); now >= next_) draw(now);
}

void Progress::draw(Clock::time_point now) {
  next_ = now + redraw_interval;
  drawn_ = true;
  if (!fraction_)
    return print(
        fmt::format("\r\033[K{}: {} s", what_, std::chrono::duration_cast<std::chrono::seconds>(now - start_).count()));
  const int full = static_cast<int>(*fraction_ * width);
  print(fmt::format("\r\033[K{} [{:#<{}}{:.<{}}] {:3.0f} %", what_, "", full, "", width - full, 100.0 * *fraction_));
}

void Progress::draw_seconds_until_done() {
  std::unique_lock lock(mutex_);
  auto look = next_ + redraw_interval;
  while (!end_.wait_until(lock, look, [this] { return done_; })) {
    const auto now = Clock::now();
    if (!fraction_) draw(now);
    look = now + seconds_interval;
  }
}

void Progress::print(const std::string& text) const {
  // A terminal that went away takes the bar with it and nothing else.
  [[maybe_unused]] const auto written = ::write(descriptor_, text.data(), text.size());
}

}  // namespace sphstab::io
