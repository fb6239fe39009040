#pragma once

// Joint traces in DXF drawings, which GDAL's program ogr2ogr converts.

#include "gcpdda/model/rock_region.hpp"

#include <string>

namespace gcpdda {

/// Whether the file of a joint map is a DXF drawing, by its name.
bool is_drawing(const std::string &path);

/// Lines, polylines, arcs and splines of a drawing (the curves as chords), of one layer or of all, as GeoJSON
/// in the unit of the drawing; or why there are none.
struct DrawnLines {
  std::string geojson;
  std::string what; ///< is wrong; empty where nothing is
  std::string why;
  std::string hint;
};

/// Runs ogr2ogr, without a shell, and waits for it; everything it writes goes to a temporary folder that is
/// removed. For one process: the others get the result from it.
DrawnLines lines_of_drawing(const JointMap &map);

} // namespace gcpdda
