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

/// Whether some piece of the common part of two blocks is as `says(piece, the smaller width)`.
template <class Says>
bool overlap_as(Says &&says, const BlockSystem &first, std::size_t i, const BlockSystem &second,
                std::size_t j) {
  std::array<TrialOutline, 2> outlines;
  const BlockView a = view_of(first, i, outlines[0]);
  const BlockView b = view_of(second, j, outlines[1]);
  Overlap overlap;
  if (!a.box.meets(b.box) || !overlap.find(a, b, PotentialKind::exact)) {
    return false;
  }
  const double width = std::min(first.properties[i].width, second.properties[j].width);
  return std::ranges::any_of(overlap.pieces(), [&](const Piece &piece) { return says(piece, width); });
}

bool is_too_deep(const Piece &piece, double width) {
  return std::max(piece.depth_begin, piece.depth_end) > largest_share * width;
}

/// A face on a face, and not a corner: of such a length, and deeper than rounding.
bool is_of_face(const Piece &piece, double width) {
  constexpr double rounding = 1e-6;
  return piece.length > largest_share * width &&
         std::max(piece.depth_begin, piece.depth_end) > rounding * width;
}

/// The driven blocks of the scene alone, row by row.
struct Driven {
  BlockSystem blocks;
  std::vector<PrescribedMotion> motions;
  std::vector<bool> told;

  /// Place all where they are at a time, s.
  void move_to(double time) {
    for (std::size_t i = 0; i < motions.size(); ++i) {
      blocks.trial[i] = motions[i].displacement(time);
    }
    pose(blocks, 0, motions.size());
  }
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

constexpr int looks = 500;

/// visit(i, id of the other, s) where driven block i overlaps a block so, until it has been told of i.
template <class Says, class Visit>
void follow_paths(double duration, Says &&says, const BlockSystem &blocks, Driven &driven, Visit &&visit) {
  const std::size_t count = driven.motions.size();
  for (int k = 1; k <= looks && count > 0; ++k) {
    const double time = duration * k / looks;
    driven.move_to(time);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t row = blocks.first_fixed(); row < blocks.num_rows() && !driven.told[i]; ++row) {
        if (overlap_as(says, driven.blocks, i, blocks, row)) {
          visit(i, blocks.properties[row].id, time);
        }
      }
      for (std::size_t j = i + 1; j < count && !driven.told[i]; ++j) {
        if (overlap_as(says, driven.blocks, i, driven.blocks, j)) {
          visit(i, driven.blocks.properties[j].id, time);
        }
      }
    }
  }
}

} // namespace

void warn_of_driven_paths(const Scene &scene, const BlockSystem &blocks, Diagnostics &notes) {
  Driven driven = driven_blocks(scene);
  if (driven.motions.empty()) {
    return;
  }
  const auto warn = [&](const char *how, const char *hint) {
    return [&, how, hint](std::size_t i, BlockId other, double time) {
      driven.told[i] = true;
      notes.push_back({Severity::warning,
                       scene.blocks[static_cast<std::size_t>(driven.blocks.properties[i].id.value)].where,
                       fmt::format("driven block '{}' {} block '{}' at about t = {:.3g} s",
                                   block_name(scene, driven.blocks.properties[i].id.value), how,
                                   block_name(scene, other.value), time),
                       "two blocks that keep their velocity whatever acts on them make no contact", hint});
    };
  };
  const double duration = scene.run.duration;
  follow_paths(duration, is_too_deep, blocks, driven,
               warn("passes through", "let one of them move freely or change the path"));
  follow_paths(duration, is_of_face, blocks, driven,
               warn("closes on",
                    "to shear a joint, drive one of its blocks, and load the other one and hold it "
                    "by stops"));
}

} // namespace gcpdda
