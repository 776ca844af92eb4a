// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

namespace sphstab::study {

/// The number of cores of the machine, or 1 where it does not say.
int all_cores();

/// Calls work(0) … work(count − 1), each once, on so many threads. Every call writes its own results only. The first
/// exception, in the order of the indices, is thrown again when all have ended.
void parallel_for(int count, const std::function<void(int)>& work, int threads = all_cores());

}  // namespace sphstab::study
