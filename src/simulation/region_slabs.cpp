#include "simulation/region_slabs.hpp"

#include "base/check.hpp"
#include "io/results/id_slabs.hpp"
#include "model/block_source.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace gcpdda {

namespace {

/// A block of a region as it travels, followed by its vertices.
struct Head {
  std::int32_t material = 0;
  std::int32_t opening = -1;
  std::int32_t fixed = 0;
  std::int32_t num_vertices = 0;
};

struct Corner {
  Vec2 vertex;
  std::int64_t joint = -1;
};

void pack(const SceneBlock &block, std::vector<Head> &heads, std::vector<Corner> &corners) {
  heads.push_back(
      {block.material, block.opening, block.fixed ? 1 : 0, static_cast<std::int32_t>(block.vertices.size())});
  for (std::size_t k = 0; k < block.vertices.size(); ++k) {
    corners.push_back({block.vertices[k], block.edge_joint.empty() ? -1 : block.edge_joint[k]});
  }
}

void unpack(const std::vector<Head> &heads, const std::vector<Corner> &corners,
            std::vector<SceneBlock> &blocks) {
  std::size_t at = 0;
  for (const Head &head : heads) {
    SceneBlock &block = blocks.emplace_back();
    block.material = head.material;
    block.opening = head.opening;
    block.fixed = head.fixed != 0;
    for (std::int32_t k = 0; k < head.num_vertices; ++k, ++at) {
      block.vertices.push_back(corners[at].vertex);
      block.edge_joint.push_back(static_cast<std::int32_t>(corners[at].joint));
    }
    if (std::all_of(block.edge_joint.begin(), block.edge_joint.end(), [](std::int32_t j) { return j < 0; })) {
      block.edge_joint.clear();
    }
  }
}

} // namespace

Diagnostics all_faults(const Communicator &communicator, const Diagnostics &mine) {
  constexpr std::size_t most_faults = 20;
  std::int64_t total = static_cast<std::int64_t>(mine.size());
  communicator.sum(std::span(&total, 1));
  std::vector<char> text;
  const auto append = [&](const std::string &part) {
    text.insert(text.end(), part.begin(), part.end());
    text.push_back('\0');
  };
  for (std::size_t k = 0; k < std::min(mine.size(), most_faults); ++k) {
    const Diagnostic &d = mine[k];
    for (const std::string &part : {d.where.file, std::to_string(d.where.line),
                                    std::to_string(d.where.column), d.what, d.why, d.hint}) {
      append(part);
    }
  }
  Diagnostics faults;
  for (const std::vector<char> &theirs : communicator.all_gather(text)) {
    std::vector<std::string> parts(1);
    for (const char c : theirs) {
      if (c == '\0') {
        parts.emplace_back();
      } else {
        parts.back().push_back(c);
      }
    }
    constexpr std::size_t num_parts = 6;
    for (std::size_t i = 0; i + num_parts < parts.size() && faults.size() < most_faults; i += num_parts) {
      faults.push_back({Severity::error,
                        {parts[i], std::stoi(parts[i + 1]), std::stoi(parts[i + 2])},
                        parts[i + 3],
                        parts[i + 4],
                        parts[i + 5]});
    }
  }
  if (total > static_cast<std::int64_t>(faults.size())) {
    faults.push_back({Severity::error, faults.front().where,
                      fmt::format("{} more faults", total - static_cast<std::int64_t>(faults.size())),
                      fmt::format("only the first {} are written out", most_faults), "mend these first"});
  }
  return faults;
}

void send_to_slabs(const Communicator &communicator, std::int64_t num_blocks, std::int64_t first,
                   std::vector<SceneBlock> cut, std::vector<SceneBlock> &slab) {
  const std::vector<std::int64_t> count{static_cast<std::int64_t>(cut.size())};
  const auto counts = communicator.all_gather(count);
  std::int64_t id = first;
  for (int rank = 0; rank < communicator.rank(); ++rank) {
    id += counts[static_cast<std::size_t>(rank)][0];
  }
  std::vector<std::vector<Head>> heads(static_cast<std::size_t>(communicator.size()));
  std::vector<std::vector<Corner>> corners(heads.size());
  for (const SceneBlock &block : cut) {
    const auto owner = static_cast<std::size_t>(slab_owner(num_blocks, communicator.size(), id++));
    pack(block, heads[owner], corners[owner]);
  }
  std::vector<SceneBlock>().swap(cut);
  const auto all_heads = communicator.all_to_all(heads);
  const auto all_corners = communicator.all_to_all(corners);
  for (std::size_t rank = 0; rank < all_heads.size(); ++rank) {
    unpack(all_heads[rank], all_corners[rank], slab);
  }
}

std::vector<SceneBlock> cut_region(RunState &run) {
  if (!run.scene.region_blocks) {
    expect(!run.scene.region.present(), "a scene with a region comes with what cuts it");
    return {};
  }
  const std::int64_t tiles = run.scene.region_blocks->num_tiles();
  BlockSource::Made made =
      run.scene.region_blocks->make(slab_begin(tiles, run.communicator.size(), run.communicator.rank()),
                                    slab_begin(tiles, run.communicator.size(), run.communicator.rank() + 1));
  if (const Diagnostics faults = all_faults(run.communicator, made.faults); has_errors(faults)) {
    throw SceneError(faults);
  }
  std::int64_t count = static_cast<std::int64_t>(made.blocks.size());
  run.communicator.sum(std::span(&count, 1));
  run.scene.num_region_blocks = count;
  return std::move(made.blocks);
}

void note_groups(RunState &run, std::span<const SceneBlock> slab) {
  const std::int64_t first =
      slab_begin(num_blocks(run.scene), run.communicator.size(), run.communicator.rank());
  run.scene.groups.clear();
  for (std::size_t opening = 0; opening < run.scene.region.openings.size(); ++opening) {
    std::vector<std::int64_t> mine;
    for (std::size_t k = 0; k < slab.size(); ++k) {
      if (slab[k].opening == static_cast<std::int32_t>(opening)) {
        mine.push_back(first + static_cast<std::int64_t>(k));
      }
    }
    BlockGroup &group =
        run.scene.groups.emplace_back(BlockGroup{run.scene.region.openings[opening].name, {}});
    for (const std::vector<std::int64_t> &theirs : run.communicator.all_gather(mine)) {
      group.blocks.insert(group.blocks.end(), theirs.begin(), theirs.end());
    }
  }
}

} // namespace gcpdda
