// SPDX-License-Identifier: MIT
#pragma once

#include <time.h>

namespace sphstab::study {

/// CPU time of the calling thread in seconds: what other programs on the machine do does not count.
inline double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace sphstab::study
