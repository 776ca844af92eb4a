// SPDX-License-Identifier: MIT
#include "study/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <vector>

namespace sphstab::study {

void parallel_for(int count, const std::function<void(int)>& work) {
  std::atomic<int> next{0};
  std::vector<std::exception_ptr> errors(count);
  const auto worker = [&] {
    for (int i; (i = next++) < count;) {
      try {
        work(i);
      } catch (...) {
        errors[i] = std::current_exception();
      }
    }
  };
  std::vector<std::thread> threads(std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, count));
  for (auto& thread : threads) thread = std::thread(worker);
  for (auto& thread : threads) thread.join();
  for (const auto& error : errors)
    if (error) std::rethrow_exception(error);
}

}  // namespace sphstab::study
