#pragma once

// Pictures (SVG) of the blocks of a model and of how they fail.

#include "gcpdda/geometry/vec2.hpp"
#include "io/results/safety_report.hpp"

#include <array>
#include <string>
#include <vector>

namespace gcpdda {

/// A block of a picture.
struct DrawnBlock {
  std::vector<Vec2> vertices; ///< m
  int subdomain = -1;         ///< -1 for a fixed block
  bool deformable = false;
};

/// Picture of blocks coloured by subdomain, with axes: fixed ones grey, deformable ones with a thick outline.
std::string draw_svg(const std::vector<DrawnBlock> &blocks, int num_subdomains);

/// Largest motion of a block of the mechanism, m; 0 where none moves.
double farthest_motion(const std::vector<FailingBlock> &blocks);

/// Joints of the picture of a failure, each a line from end to end, m.
struct FailingJoints {
  using Line = std::array<Vec2, 2>;
  std::vector<Line> slipping;
  std::vector<Line> opened;  ///< two lines for a joint, on the edges of its two blocks
  bool knows_opened = false; ///< false where nothing says which joints were closed before
};

/// Picture of how the blocks fail at a factor, with axes and a colour bar: white to red with the motion,
/// fixed ones grey, arrows in the direction of those that move, one of several that are close together. The
/// scale is that of what counts as the mechanism. Joints that slip or have opened are drawn over the blocks
/// and explained in a legend.
std::string draw_mechanism(const std::vector<FailingBlock> &blocks, const FailingJoints &joints,
                           double factor);

} // namespace gcpdda
