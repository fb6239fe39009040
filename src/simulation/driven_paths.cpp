#include "simulation/driven_paths.hpp"

#include "contact/block_view.hpp"
#include "contact/contact_forces.hpp"
#include "dynamics/integrate.hpp"
#include "model/generators.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace gcpdda {

namespace {

/// Depth of an overlap, as a share of the smaller width, that a user would call a contact and not two blocks
/// in one place: that of initial overlaps.
constexpr double largest_share = 0.05;

bool overlap_too_deep(const BlockSystem &first, std::size_t i, const BlockSystem &second, std::size_t j) {
  std::array<TrialOutline, 2> outlines;
  const BlockView a = view_of(first, i, outlines[0]);
  const BlockView b = view_of(second, j, outlines[1]);
  Overlap overlap;
  if (!a.box.meets(b.box) || !overlap.find(a, b, PotentialKind::exact)) {
    return false;
  }
  const double limit = largest_share * std::min(first.properties[i].width, second.properties[j].width);
  return std::ranges::any_of(overlap.pieces(), [&](const Piece &piece) {
    return std::max(piece.depth_begin, piece.depth_end) > limit;
  });
}

/// The driven blocks of the scene alone, row by row.
struct Driven {
  BlockSystem blocks;
  std::vector<PrescribedMotion> motions;
  std::vector<bool> told;
};

Driven driven_blocks(const Scene &scene) {
  Driven driven;
  for (std::size_t i = 0; i < scene.blocks.size(); ++i) {
    const SceneBlock &block = scene.blocks[i];
    if (!block.driven) {
      continue;
    }
    append_block(driven.blocks, BlockId{static_cast<std::int64_t>(i)}, block,
                 scene.materials[static_cast<std::size_t>(block.material)]);
    const std::vector<VelocityRow> constant{{0.0, block.velocity}};
    driven.motions.emplace_back(block.velocity_table.empty() ? constant : block.velocity_table);
  }
  driven.told.assign(driven.motions.size(), false);
  return driven;
}

} // namespace

void warn_of_driven_paths(const Scene &scene, const BlockSystem &blocks, Diagnostics &notes) {
  Driven driven = driven_blocks(scene);
  const std::size_t count = driven.motions.size();
  const auto warn = [&](std::size_t i, BlockId other, double time) {
    driven.told[i] = true;
    notes.push_back({Severity::warning,
                     scene.blocks[static_cast<std::size_t>(driven.blocks.properties[i].id.value)].where,
                     fmt::format("driven block '{}' passes through block '{}' at about t = {:.3g} s",
                                 block_name(scene, driven.blocks.properties[i].id.value),
                                 block_name(scene, other.value), time),
                     "two blocks that keep their velocity whatever acts on them make no contact",
                     "let one of them move freely or change the path"});
  };
  constexpr int looks = 500;
  for (int k = 1; k <= looks && count > 0; ++k) {
    const double time = scene.run.duration * k / looks;
    for (std::size_t i = 0; i < count; ++i) {
      driven.blocks.trial[i] = driven.motions[i].displacement(time);
    }
    pose(driven.blocks, 0, count);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t row = blocks.first_fixed(); row < blocks.num_rows() && !driven.told[i]; ++row) {
        if (overlap_too_deep(driven.blocks, i, blocks, row)) {
          warn(i, blocks.properties[row].id, time);
        }
      }
      for (std::size_t j = i + 1; j < count && !driven.told[i]; ++j) {
        if (overlap_too_deep(driven.blocks, i, driven.blocks, j)) {
          warn(i, driven.blocks.properties[j].id, time);
        }
      }
    }
  }
}

} // namespace gcpdda
