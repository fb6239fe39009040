#pragma once

// HDF5 files that could not be closed.

namespace gcpdda {

/// Whether HDF5 failed to close a file on this rank (its last bytes found no place). It then still counts the
/// file as open and crashes in MPI_Finalize: the process must end by MpiScope::abort.
bool has_unclosed_files();

} // namespace gcpdda
