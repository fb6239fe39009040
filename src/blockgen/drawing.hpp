#pragma once

// The picture of the blocks of a region (SVG).

#include "blockgen/quality.hpp"
#include "gcpdda/model/scene.hpp"
#include "geometry/plan_drawing.hpp"

#include <span>
#include <string>
#include <vector>

namespace gcpdda {

/// Picture of the blocks of a region: filled by material, those in openings darker, fixed ones grey; edges
/// in the colour of their joint law; the worst blocks in red with their names; axes in metres. Made of parts,
/// so that every rank can draw its own blocks: head, blocks of the ranks in their order, marks and legend.
class RegionDrawing {
public:
  static constexpr std::int64_t most_blocks = 200'000;

  explicit RegionDrawing(const Scene &scene);

  [[nodiscard]] std::string head() const;
  [[nodiscard]] std::string blocks(std::span<const SceneBlock> blocks) const;
  [[nodiscard]] std::string end(std::span<const PoorBlock> sharpest,
                                std::span<const PoorBlock> narrowest) const;

private:
  const Scene *scene_;
  PlanDrawing page_;
};

} // namespace gcpdda
