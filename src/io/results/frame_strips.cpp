#include "io/results/frame_strips.hpp"

#include "io/results/id_slabs.hpp"

#include <algorithm>

namespace gcpdda {

int Strips::size() const {
  const std::int64_t longest_slab = (num_blocks + num_ranks - 1) / num_ranks;
  return static_cast<int>((longest_slab + ids_per_strip - 1) / ids_per_strip);
}

IdRange Strips::of(int rank, int number) const {
  const std::int64_t end = slab_begin(num_blocks, num_ranks, rank + 1);
  const std::int64_t first = std::min(end, slab_begin(num_blocks, num_ranks, rank) + number * ids_per_strip);
  return {first, std::min(end, first + ids_per_strip)};
}

void FrameStrips::bring(int number) {
  for (std::size_t rank = 0; rank < leaving_rows_.size(); ++rank) {
    const IdRange ids = strips_.of(static_cast<int>(rank), number);
    source_.append(ids.first, ids.last, leaving_rows_[rank], leaving_vertices_[rank]);
  }
  communicator_.all_to_all(leaving_rows_, arrived_rows_);
  communicator_.all_to_all(leaving_vertices_, arrived_vertices_);

  // Each id has its place, so nothing is sorted.
  const IdRange ids = strips_.of(communicator_.rank(), number);
  rows_.assign(static_cast<std::size_t>(ids.last - ids.first), {});
  num_vertices_ = 0;
  for (std::size_t rank = 0; rank < arrived_rows_.size(); ++rank) {
    const Vec2 *vertex = arrived_vertices_[rank].data();
    for (const FrameRow &row : arrived_rows_[rank]) {
      const bool is_mine = ids.first <= row.block && row.block < ids.last && row.num_vertices > 0;
      if (!is_mine || rows_[static_cast<std::size_t>(row.block - ids.first)].first != nullptr) {
        are_sound_ = false;
        break;
      }
      rows_[static_cast<std::size_t>(row.block - ids.first)] = {&row, vertex};
      vertex += row.num_vertices;
    }
    are_sound_ = are_sound_ && vertex == arrived_vertices_[rank].data() + arrived_vertices_[rank].size();
    num_vertices_ += std::ssize(arrived_vertices_[rank]);
  }
  std::erase_if(rows_, [](const PlacedRow &row) { return row.first == nullptr; });
}

} // namespace gcpdda
