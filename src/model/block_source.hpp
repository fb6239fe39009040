#pragma once

// What makes the blocks of a scene share by share, so that no rank holds them all.

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/model/scene.hpp"

#include <cstdint>
#include <vector>

namespace gcpdda {

/// Blocks that are made tile by tile. What a tile holds depends on the scene alone, so every rank can make
/// its share of the tiles without asking the others; ids follow the tiles. How many blocks there are is not
/// known before.
class BlockSource {
public:
  struct Made {
    std::vector<SceneBlock> blocks; ///< in the order of the tiles; names and positions stay empty
    Diagnostics faults;             ///< of these tiles
  };

  virtual ~BlockSource() = default;
  [[nodiscard]] virtual std::int64_t num_tiles() const = 0;
  /// How many blocks all tiles will hold, about, and how long one rank would take to make them, s: to the
  /// power of ten.
  [[nodiscard]] virtual double expected_blocks() const = 0;
  [[nodiscard]] virtual double expected_seconds() const = 0;
  /// Blocks of the tiles [first, last).
  [[nodiscard]] virtual Made make(std::int64_t first, std::int64_t last) const = 0;

protected:
  BlockSource() = default;
  BlockSource(const BlockSource &) = default;
  BlockSource &operator=(const BlockSource &) = default;
};

} // namespace gcpdda
