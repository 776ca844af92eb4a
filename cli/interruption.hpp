// SPDX-License-Identifier: MIT
#pragma once

namespace sphstab::cli {

/// From now on the first Ctrl-C or request to end is only noted; a second one ends the program at once.
void note_signals();

/// The number of the signal that was noted; 0: none.
int signal_received();

/// The exit status that shells give a program that a signal has ended.
int exit_status_of(int signal);

/// Thrown where work stops because of a signal, so that it leaves nothing half done.
struct Interruption {
  int signal;
};

}  // namespace sphstab::cli
