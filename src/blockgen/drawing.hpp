#pragma once

// The picture of the blocks of a region (SVG).

#include "blockgen/quality.hpp"
#include "gcpdda/model/scene.hpp"

#include <span>
#include <string>
#include <vector>

namespace gcpdda {

/// Picture of the blocks of a region: filled by material, those in openings darker, fixed ones grey; edges
/// in the colour of their joint law; the worst blocks in red with their names. Made of parts, so that every
/// rank can draw its own blocks: head, blocks of the ranks in their order, marks and legend.
class RegionDrawing {
public:
  static constexpr std::int64_t most_blocks = 200'000;

  explicit RegionDrawing(const Scene &scene);

  [[nodiscard]] std::string head() const;
  [[nodiscard]] std::string blocks(std::span<const SceneBlock> blocks) const;
  [[nodiscard]] std::string end(std::span<const PoorBlock> sharpest,
                                std::span<const PoorBlock> narrowest) const;

private:
  [[nodiscard]] double x(double world) const;
  [[nodiscard]] double y(double world) const;

  const Scene *scene_;
  Vec2 low_;
  Vec2 high_;
  double scale_ = 1.0; ///< pixels per m
};

} // namespace gcpdda
