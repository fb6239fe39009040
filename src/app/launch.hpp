#pragma once

// How the process was started, as main() has to know it before anything else.

#include <string>

namespace gcpdda {

/// Number of processes the launcher of this very step announced; 1 without one.
int announced_ranks();

/// Whether the command of these arguments heeds SIGUSR1, which asks it to stop (driver/stop_signal.hpp).
bool heeds_stop_signal(int argc, const char *const *argv);

} // namespace gcpdda
