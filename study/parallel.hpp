// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

namespace sphstab::study {

/// Calls work(0) … work(count − 1), each once, on as many threads as the machine has cores. Every call writes its own
/// results only. The first exception, in the order of the indices, is thrown again when all have ended.
void parallel_for(int count, const std::function<void(int)>& work);

}  // namespace sphstab::study
