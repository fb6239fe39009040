#pragma once

// The connected pieces of the overlap of two blocks.

#include "contact/geometry/overlap.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace gcpdda {

/// Rotate the pieces of one block so that they start where its boundary comes in, the lowest leftmost such
/// place if there are several: a choice that cutting or renumbering the block elsewhere cannot change.
void start_at_entry(std::span<Piece> pieces);

/// Finds the regions of one pair after another; buffers are reused.
class RegionSplitter {
public:
  /// Cut the pieces of two blocks, `num_first` of them on the first one's edges, into regions and sort them
  /// accordingly. Pieces of regions without depth are dropped.
  void split(const BlockView &first, const BlockView &second, std::vector<Piece> &pieces,
             std::size_t num_first, std::vector<Region> &regions);

private:
  /// Edges of a block: their stretch, and where they begin along it.
  struct Outline {
    std::vector<std::int32_t> stretch;
    std::vector<double> arc;
    std::vector<bool> parts; ///< regions end at the edge's first vertex

    void follow(const BlockView &block);
  };
  /// A piece on its way into a region.
  struct Placed {
    std::size_t piece = 0;
    RegionFaces faces;
    std::size_t region = 0; ///< number of its first piece
    double low = 0.0;       ///< along the outline, with the gaps that its ends bridge
    double high = 0.0;
  };

  static void project(const Piece &piece, const BlockView &block, const Outline &outline, std::int32_t on,
                      Placed &placed);
  /// Give all pieces of a region that hang together on the outline the number of their first one; returns how
  /// many regions there are.
  std::size_t connect();
  /// All pieces with faces and region.
  void place(const BlockView &first, const BlockView &second, std::span<const Piece> pieces,
             std::size_t num_first);

  Outline on_first_;
  Outline on_second_;
  std::vector<Placed> placed_;
  std::vector<Piece> sorted_;
};

} // namespace gcpdda
