#pragma once

// Pictures (SVG) of the blocks of a model and of how they fail.

#include "gcpdda/geometry/vec2.hpp"
#include "io/results/safety_report.hpp"

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

/// Picture of how the blocks fail at a factor, with axes and a colour bar: white to red with the motion,
/// fixed ones grey, arrows in the direction of those that move. The scale is that of what counts as the
/// mechanism.
std::string draw_mechanism(const std::vector<FailingBlock> &blocks, double factor);

} // namespace gcpdda
