#pragma once

// A region of rock and everything that cuts it into blocks, as the scene states it. Angles of traces are
// those of the trace against the x axis, counter-clockwise.

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/geometry/vec2.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gcpdda {

enum class Spread { none, normal, lognormal, exponential, power_law, fisher };

/// A quantity of a joint set that may vary from joint to joint. Values outside [lowest_share, highest_share]
/// times the mean are drawn again (not of angles, and not of a power law, which has its own limits).
struct Scattered {
  static constexpr double lowest_share = 0.01;
  static constexpr double highest_share = 100.0;
  double mean = 0.0;
  Spread spread = Spread::none;
  /// Standard deviation in the unit of the mean (normal, lognormal), Fisher's concentration, or the exponent
  /// a of a power law, density ~ x^-a.
  double width = 0.0;
  double low = 0.0; ///< limits of a power law, m
  double high = 0.0;

  /// Mean between the limits.
  [[nodiscard]] double mean_of_power_law() const;
};

/// A joint plane in space. Angles are those of the plane against the section.
struct JointPlane {
  double dip = 0.0;     ///< rad, 0 to pi/2
  double bearing = 0.0; ///< from the x axis to the dip direction, clockwise from above, rad
  double fisher = 0.0;  ///< Fisher's constant of the scatter of the poles; 0: all planes are parallel
  double spacing = 0.0; ///< mean, across the planes, m
};

/// Parallel joints: lines `spacing` apart, the first through `origin`, on each of them traces and gaps.
struct JointSet {
  std::string name;
  std::int32_t joint = -1; ///< index into JointLaws::laws, -1: by the materials
  Scattered dip;           ///< rad
  Scattered spacing;       ///< m, across the mean dip, in the section
  double intensity = 0.0;  ///< length of traces per area as the scene gives it, m/m2; 0: by the spacing
  std::optional<JointPlane> plane; ///< where the scene gives the set in space; dip has its mean trace
  bool through_going = true;
  Scattered trace; ///< m, where not through-going
  Scattered gap;   ///< m
  /// Share of trace + gap by which the pattern of a line is shifted against that of the line before; drawn at
  /// random for each line where the scene gives none.
  std::optional<double> stagger;
  Vec2 origin; ///< m
  std::int64_t seed = 0;
  std::vector<Vec2> within; ///< only here; empty: everywhere
  SourcePosition where;

  /// Mean share of a line that is joint.
  [[nodiscard]] double persistence() const {
    return through_going ? 1.0 : trace.mean / (trace.mean + gap.mean);
  }
  /// Its joints differ in direction.
  [[nodiscard]] bool is_turned() const {
    return dip.spread != Spread::none || (plane && plane->fisher > 0.0);
  }
};

/// Measures of a joint set in the region, or in the part of it that the set is for. Zero: none to measure.
struct JointSetMeasures {
  double spacing = 0.0;      ///< between neighbouring lines, in the section, m
  double intensity = 0.0;    ///< P21: length of joint per area, m/m2
  double trace_length = 0.0; ///< mean, m; through-going joints have none
  double angle = 0.0;        ///< mean angle of the traces against the x axis, rad
  double scatter = 0.0;      ///< standard deviation of this angle, rad
};

/// A single joint or fault.
struct FaultLine {
  std::string name;
  std::int32_t joint = -1;
  std::vector<Vec2> points; ///< two or more
  SourcePosition where;
};

/// Joint traces in a file (CSV, GeoJSON or DXF).
struct JointMap {
  std::string path;  ///< as the program opens it
  std::string layer; ///< of a drawing; empty: all of them
  std::int32_t joint = -1;
  std::vector<std::vector<Vec2>> lines; ///< empty until the file has been read
  SourcePosition where;
  /// GeoJSON to which a drawing was converted, which a run keeps for restarts; on the root only.
  std::shared_ptr<const std::string> converted = {};
};

/// A named part of the region: a tunnel, say. Blocks end at its outline.
struct Opening {
  std::string name;
  std::int32_t joint = -1;
  std::vector<Vec2> outline; ///< counter-clockwise
  bool excavated = false;    ///< its blocks are not made at all
  SourcePosition where;
};

/// Where the rock is another one; of several layers at a place the last one counts.
struct Layer {
  std::int32_t joint = -1;
  std::int32_t material = 0;
  std::vector<Vec2> outline; ///< counter-clockwise
  SourcePosition where;
};

/// Irregular polygons about one random point in each cell of a square grid.
struct VoronoiCells {
  double size = 0.0;         ///< side of a grid cell = square root of the mean area, m
  double irregularity = 1.0; ///< 1: anywhere in its cell, 0: in its middle
  std::int64_t seed = 0;
  std::int32_t joint = -1;
  SourcePosition where;
};

/// Masonry: bed joints and head joints.
struct BrickPattern {
  Vec2 size;   ///< m
  Vec2 origin; ///< lower left corner of one brick, m
  double bond = 0.5;
  std::int32_t joint = -1;
  SourcePosition where;
};

enum class SliverRule { merge, refuse, keep };
enum class Side { bottom, left, right, top };

/// A region with all that lies in it; `present()` says whether a scene has one.
struct RockRegion {
  static constexpr std::size_t num_sides = 4;

  std::vector<Vec2> outline; ///< counter-clockwise; empty: the scene has no region
  std::int32_t material = 0; ///< where no layer says otherwise
  double azimuth = 0.0;      ///< direction of the x axis, clockwise from north, rad
  double min_width = 0.0;    ///< m; a narrower block is a sliver
  double min_area = 0.0;     ///< m2; so is a smaller one
  SliverRule slivers = SliverRule::merge;
  std::int64_t max_blocks = 0;         ///< more are not expected by the person who wrote the scene
  std::array<bool, num_sides> fixed{}; ///< a fixed block lies along this side of the bounding box, by Side
  double fixed_thickness = 0.0;        ///< m
  std::vector<JointSet> joint_sets;
  std::vector<FaultLine> faults;
  std::vector<JointMap> maps;
  std::vector<Opening> openings;
  std::vector<Layer> layers;
  std::vector<VoronoiCells> voronoi;
  std::vector<BrickPattern> bricks;
  SourcePosition where;

  /// Whether the scene has a region.
  [[nodiscard]] bool present() const { return !outline.empty(); }
};

/// How many blocks the region will be cut into, about: the strips between its through-going joints, the
/// crossings of all joints and the area of its cells. Through-going or not, scattered or not, only lengths of
/// joints per area count for crossings.
double expected_blocks(const RockRegion &region);

/// How many traces, cells or bricks are drawn around the region, about: over its bounding box.
double expected_traces(const JointSet &set, const RockRegion &region);
double expected_cells(const VoronoiCells &cells, const RockRegion &region);
double expected_bricks(const BrickPattern &bricks, const RockRegion &region);

} // namespace gcpdda
