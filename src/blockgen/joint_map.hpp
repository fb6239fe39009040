#pragma once

// Joint maps: traces from GeoJSON or CSV text.

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/geometry/vec2.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace gcpdda {

struct JointMapReading {
  std::vector<std::vector<Vec2>> lines; ///< complete only without faults
  Diagnostics faults;                   ///< by file, line and column
};

/// Traces from the text of a file: GeoJSON (LineString and MultiLineString, alone, in features or in
/// collections; coordinates in m) where `path` ends with .geojson or .json, else CSV with rows trace,x,y,
/// where the rows of one trace follow each other and a first row of words is a heading.
JointMapReading read_joint_map(std::string_view text, const std::string &path);

} // namespace gcpdda
