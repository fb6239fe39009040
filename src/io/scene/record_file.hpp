#pragma once

// Records of ground motion, as CSV: rows time,x or time,x,y, with a heading or none; # begins a remark.

#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace gcpdda {

struct RecordReading {
  std::vector<RecordRow> rows; ///< at least two where nothing is at fault; times rise
  Diagnostics faults;
};

/// @param path  as messages name it
RecordReading read_record(std::string_view text, const std::string &path);

/// Puts the record of the scene's [earthquake] into the scene; nothing where it has none, or
/// where the rows are there. Collective.
/// @return its faults, the same on all ranks
Diagnostics open_record(const Communicator &communicator, Scene &scene);

} // namespace gcpdda
