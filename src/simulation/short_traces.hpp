#pragma once

// Ends of drawn traces that miss the line at which they were meant to end.

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/model/rock_region.hpp"

#include <string>
#include <vector>

namespace gcpdda {

/// A trace that ends in the region just before another line.
struct ShortTrace {
  std::string path; ///< of the fault or map, as messages name it
  SourcePosition where;
  Vec2 end;
  double gap = 0.0; ///< m
};

/// Ends of faults and of the traces of maps that are nearer than 1/1000 of the length of the trace, and
/// farther than rounding, to a fault, a trace of a map, or an outline of the region, an opening or a layer
/// that their trace does not meet. Such a trace ends in the rock and cuts nothing there.
std::vector<ShortTrace> short_traces(const RockRegion &region);

} // namespace gcpdda
