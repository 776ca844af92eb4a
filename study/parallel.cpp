// SPDX-License-Identifier: MIT
#include "study/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

namespace sphstab::study {

int all_cores() { return std::max(static_cast<int>(std::thread::hardware_concurrency()), 1); }

void parallel_for(int count, const std::function<void(int)>& work, int threads) {
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
  std::vector<std::thread> workers(std::min(threads, count));
  for (auto& thread : workers) thread = std::thread(worker);
  for (auto& thread : workers) thread.join();
  for (const auto& error : errors)
    if (error) std::rethrow_exception(error);
}

void run_all(const std::vector<std::function<void()>>& work, const std::function<void(double fraction)>& progress) {
  std::size_t finished = 0;
  std::mutex reporting;
  parallel_for(static_cast<int>(work.size()), [&](int i) {
    work[i]();
    const std::lock_guard lock(reporting);
    if (progress) progress(static_cast<double>(++finished) / static_cast<double>(work.size()));
  });
}

}  // namespace sphstab::study
