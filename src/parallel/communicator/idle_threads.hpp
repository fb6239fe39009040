#pragma once

// Waiting until the other threads of the process sleep, before MPI is finalised.

#include <chrono>

namespace gcpdda {

/// Waits until all other threads of this process sleep, at most so long. Where the system does not tell (it
/// has no /proc), there is no wait.
void wait_for_idle_threads(std::chrono::seconds at_most);

} // namespace gcpdda
