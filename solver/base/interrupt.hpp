// SPDX-License-Identifier: GPL-3.0-or-later
// What ends a run from outside: signals (batch systems send them), a file STOP for those who cannot signal, a limit of time.
#pragma once
#include <string>

namespace hilo {

/// From now on SIGINT, SIGTERM, SIGHUP and SIGUSR1 are noted, not obeyed; one that comes more than a second later ends the process.
void note_signals();
/// They end the process again, as where nothing was noted: it has nothing more to save.
void obey_signals();
/// Name of the signal that came ("SIGTERM"), or "".
std::string noted_signal();

/// Seconds of "3h50m", "90s", "1d", "2:30:00" or a number of seconds.  Error (exit 1) for anything else; `option` is what it was given to.
double parse_duration(const std::string& text, const std::string& option);

}  // namespace hilo
