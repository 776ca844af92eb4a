// SPDX-License-Identifier: MIT
#pragma once

#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace sphstab::io {

/// A progress bar on a terminal for work that takes longer than two seconds, the seconds it has taken as long as the
/// work tells no fraction; nothing where the descriptor is no terminal. The bar goes when the object goes.
class Progress {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Progress(std::string what, int descriptor = STDERR_FILENO, Clock::duration delay = std::chrono::seconds(2));
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `fraction` of the work, in [0, 1], is done.
  void show(double fraction);

 private:
  void draw(Clock::time_point now);
  void draw_seconds_until_done();
  void print(const std::string& text) const;

  std::string what_;
  int descriptor_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_;  ///< nothing is drawn earlier
  std::optional<double> fraction_;
  bool drawn_ = false;
  bool done_ = false;
  std::mutex mutex_;  ///< of all that changes
  std::condition_variable end_;
  std::thread watcher_;
};

}  // namespace sphstab::io
