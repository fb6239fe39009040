#pragma once

// The rows of a frame on their way from the ranks that have them to those that write them.

#include "gcpdda/io/frame_rows.hpp"
#include "gcpdda/io/frame_writer.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace gcpdda {

/// Ids [first, last).
struct IdRange {
  std::int64_t first = 0;
  std::int64_t last = 0;
};

/// A slab of ids is written strip by strip, all ranks at once: what passes through a rank stays small, and in
/// its cache.
struct Strips {
  std::int64_t num_blocks;
  int num_ranks;
  std::int64_t ids_per_strip;

  /// Of each slab; the last ones of a shorter slab may be empty.
  [[nodiscard]] int size() const;
  [[nodiscard]] IdRange of(int rank, int number) const;
};

/// Short enough for a cache, 4 MB of quadrilaterals, and for the disk to get a strip while the next one is
/// made.
constexpr std::int64_t usual_ids_per_strip = 16384;

/// Rows of a frame on their way to the ranks that write them.
class FrameStrips {
public:
  FrameStrips(const Communicator &communicator, const Strips &strips, const FrameSource &source)
      : communicator_(communicator), strips_(strips), source_(source),
        leaving_rows_(static_cast<std::size_t>(communicator.size())),
        leaving_vertices_(leaving_rows_.size()) {}

  [[nodiscard]] int size() const { return strips_.size(); }
  /// Every rank gets the rows of its strip of this number, those of the last one go. Collective.
  void bring(int number);

  /// A row with its first vertex.
  using PlacedRow = std::pair<const FrameRow *, const Vec2 *>;
  /// In BlockId order.
  [[nodiscard]] const std::vector<PlacedRow> &rows() const { return rows_; }
  [[nodiscard]] std::int64_t num_vertices() const { return num_vertices_; }
  /// So far each block came once and each row with its vertices.
  [[nodiscard]] bool are_sound() const { return are_sound_; }

private:
  Communicator communicator_;
  Strips strips_;
  const FrameSource &source_;
  std::vector<std::vector<FrameRow>> leaving_rows_; ///< by rank
  std::vector<std::vector<Vec2>> leaving_vertices_;
  std::vector<std::vector<FrameRow>> arrived_rows_;
  std::vector<std::vector<Vec2>> arrived_vertices_;
  std::vector<PlacedRow> rows_;
  std::int64_t num_vertices_ = 0;
  bool are_sound_ = true;
};

} // namespace gcpdda
