// SPDX-License-Identifier: MIT
#include "cli/interruption.hpp"

#include <atomic>
#include <csignal>

namespace sphstab::cli {
namespace {

std::atomic<int> received = 0;
static_assert(std::atomic<int>::is_always_lock_free);

}  // namespace

void note_signals() {
  struct sigaction action {};
  action.sa_handler = [](int signal) { received = signal; };
  action.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);
  for (const int signal : {SIGINT, SIGTERM}) ::sigaction(signal, &action, nullptr);
}

int signal_received() { return received; }

int exit_status_of(int signal) { return 128 + signal; }

}  // namespace sphstab::cli
