#pragma once

// Frames of bolts and of liners.

#include "gcpdda/io/frame_rows.hpp"
#include "gcpdda/parallel/communicator.hpp"
#include "io/hdf5/hdf5_collective_file.hpp"

namespace gcpdda {

/// A few rows, which the root writes; what the others hand over is not looked at. Collective.
void write_bolt_frame(const Communicator &communicator, CollectiveFile &file, double time,
                      const BoltFrame &frame);
void write_liner_frame(const Communicator &communicator, CollectiveFile &file, double time,
                       const std::vector<LinerRow> &rows);

} // namespace gcpdda
