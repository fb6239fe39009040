#pragma once

// SIGUSR1 asks a run to stop with a checkpoint.

namespace gcpdda {

/// From now on SIGUSR1 does not end the process: a run writes a checkpoint after its current step and stops.
void catch_stop_signal();

/// Whether SIGUSR1 has come to this process since it was last forgotten.
bool stop_signal_came();
void forget_stop_signal();

} // namespace gcpdda
