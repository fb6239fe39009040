#include "gcpdda/simulation/run.hpp"

#include "gcpdda/contact/contact_forces.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace gcpdda {

Diagnostics check_initial_overlaps(const Scene &scene) {
  BlockSystem blocks;
  for (const bool fixed : {false, true}) {
    for (std::size_t k = 0; k < scene.blocks.size(); ++k) {
      if (scene.blocks[k].fixed == fixed) {
        append_block(blocks, BlockId{static_cast<std::int64_t>(k)}, scene.blocks[k],
                     scene.materials[static_cast<std::size_t>(scene.blocks[k].material)]);
        ++(fixed ? blocks.num_fixed : blocks.num_owned);
      }
    }
  }
  pose(blocks, 0, blocks.num_rows());
  ContactForces contacts({scene.joints, 0.0, PotentialKind::exact});
  ContactHistory history;
  const Candidates candidates =
      make_candidates(blocks, find_pairs(blocks, blocks.box), contacts.parameters(), {}, history);
  contacts.evaluate(blocks, candidates, history);

  constexpr double deepest_share = 0.05;
  Diagnostics diagnostics;
  double deepest = 0.0;
  std::string deepest_pair;
  for (std::size_t k = 0; k < candidates.pairs.size(); ++k) {
    const PairForce &force = contacts.pairs()[k];
    const CandidatePair &pair = candidates.pairs[k];
    const BlockProperties &a = blocks.properties[pair.lower.value];
    const BlockProperties &b = blocks.properties[pair.higher.value];
    const SceneBlock &lower = scene.blocks[static_cast<std::size_t>(a.id.value)];
    const SceneBlock &higher = scene.blocks[static_cast<std::size_t>(b.id.value)];
    const double width = std::min(a.width, b.width);
    if (force.overlap > deepest_share * width) {
      diagnostics.push_back(
          {Severity::error, higher.where,
           fmt::format("blocks '{}' and '{}' overlap by {:.3g} m", lower.name, higher.name, force.overlap),
           fmt::format("more than 5 % of the narrower block's width {:.3g} m", width),
           "move or trim one of them"});
    } else if (force.overlap > deepest) {
      deepest = force.overlap;
      deepest_pair = fmt::format("'{}' and '{}'", lower.name, higher.name);
    }
  }
  if (deepest > 0.0 && diagnostics.empty()) {
    diagnostics.push_back(
        {Severity::info,
         {},
         fmt::format("the deepest initial overlap is {:.3g} m between blocks {}", deepest, deepest_pair),
         "initial overlaps are contacts",
         ""});
  }
  return diagnostics;
}

} // namespace gcpdda
