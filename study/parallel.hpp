// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

namespace sphstab::study {

/// The number of cores of the machine, or 1 where it does not say.
int all_cores();

/// Calls work(0) … work(count − 1), each once, on so many threads. Every call writes its own results only. The first
/// exception, in the order of the indices, is thrown again when all have ended.
void parallel_for(int count, const std::function<void(int)>& work, int threads = all_cores());

/// Does every piece of work once, on all cores, and tells which part of them is done after each.
void run_all(const std::vector<std::function<void()>>& work, const std::function<void(double fraction)>& progress);

}  // namespace sphstab::study
