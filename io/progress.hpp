// SPDX-License-Identifier: MIT
#pragma once

#include <unistd.h>

#include <chrono>
#include <string>

namespace sphstab::io {

/// A progress bar on a terminal for work that takes longer than two seconds; nothing where the descriptor is no
/// terminal. The bar goes when the object goes.
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
  void print(const std::string& text) const;

  std::string what_;
  int descriptor_;
  Clock::time_point next_;  ///< nothing is drawn earlier
  bool drawn_ = false;
};

}  // namespace sphstab::io
