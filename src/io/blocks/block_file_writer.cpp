
#include "io/blocks/block_file_writer.hpp"

#include "base/check.hpp"
#include "io/hdf5/hdf5_collective_file.hpp"

namespace gcpdda {

void write_block_file(const Communicator &communicator, const std::filesystem::path &path,
                      std::span<const SceneBlock> mine) {
  std::vector<double> points;
  std::vector<std::int32_t> edge_joint;
  std::vector<std::int32_t> material;
  std::vector<std::uint8_t> fixed;
  for (const SceneBlock &block : mine) {
    material.push_back(block.material);
    fixed.push_back(block.fixed ? 1 : 0);
    for (std::size_t k = 0; k < block.vertices.size(); ++k) {
      points.insert(points.end(), {block.vertices[k].x, block.vertices[k].y});
      edge_joint.push_back(block.edge_joint.empty() ? -1 : block.edge_joint[k]);
    }
  }
  const RowRange of_blocks = rows_in_rank_order(communicator, static_cast<std::int64_t>(mine.size()));
  const RowRange of_points = rows_in_rank_order(communicator, static_cast<std::int64_t>(edge_joint.size()));
  if (of_blocks.total == 0) { // agreed on by all ranks
    throw FileError(path.string() +
                    ": error: there are no blocks to write, no run could read such a file, check "
                    "what is excavated");
  }
  std::vector<std::int64_t> offsets;
  std::int64_t offset = of_points.first;
  for (const SceneBlock &block : mine) {
    offsets.push_back(offset);
    offset += static_cast<std::int64_t>(block.vertices.size());
  }
  RowRange of_offsets{of_blocks.first, of_blocks.count, of_blocks.total + 1};
  if (communicator.rank() == communicator.size() - 1) { // and the end of the last one
    offsets.push_back(offset);
    ++of_offsets.count;
  }
  CollectiveFile file(communicator, path);
  file.dataset("points", of_points, points, 2);
  file.dataset("offsets", of_offsets, offsets);
  file.dataset("material", of_blocks, material);
  file.dataset("fixed", of_blocks, fixed);
  file.dataset("edge_joint", of_points, edge_joint);
  file.publish();
}

} // namespace gcpdda
