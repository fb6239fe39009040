#pragma once

// Frames of contacts.

#include "gcpdda/io/frame_writer.hpp"
#include "gcpdda/parallel/communicator.hpp"
#include "io/hdf5/hdf5_collective_file.hpp"
#include "io/results/frame_strips.hpp"

namespace gcpdda {

/// Each region on the rank whose slab of ids its lower block is in, strip by strip. Collective.
void write_contact_frame(const Communicator &communicator, CollectiveFile &file, double time,
                         const Strips &strips, const ContactSource &source);

} // namespace gcpdda
