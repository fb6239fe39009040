#include "simulation/stage_changes.hpp"

#include "base/check.hpp"
#include "contact/contact_sums.hpp"
#include "contact/stiffness_bound.hpp"
#include "dynamics/deformable.hpp"
#include "dynamics/frequency_bound.hpp"
#include "dynamics/own_springs.hpp"
#include "geometry/holds_point.hpp"
#include "geometry/polygon.hpp"
#include "io/results/id_slabs.hpp"
#include "model/find_row.hpp"
#include "simulation/cut_bolts.hpp"
#include "simulation/wet_joints.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <limits>
#include <map>

namespace gcpdda {

namespace {

bool holds(const std::vector<std::int64_t> &ids, std::int64_t id) {
  return std::binary_search(ids.begin(), ids.end(), id);
}

/// Owned rows that stay, with those that are added, and fixed rows that stay; ghosts are dropped.
void rebuild(BlockSystem &system, const std::function<bool(std::size_t)> &stays, const BlockSystem &added) {
  BlockSystem next;
  std::size_t add = 0;
  const auto add_below = [&](std::int64_t id) {
    for (; add < added.num_rows() && added.properties[add].id.value < id; ++add) {
      append_row(next, added, add);
    }
  };
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    add_below(system.properties[row].id.value);
    if (stays(row)) {
      append_row(next, system, row);
    }
  }
  add_below(std::numeric_limits<std::int64_t>::max());
  next.num_owned = next.num_rows();
  for (std::size_t row = system.first_fixed(); row < system.num_rows(); ++row) {
    if (stays(row)) {
      append_row(next, system, row);
    }
  }
  next.num_fixed = next.num_rows() - next.num_owned;
  system = std::move(next);
}

void stop_heeding_forces(BlockSystem &system, std::size_t row) {
  system.properties[row].mass = std::numeric_limits<double>::infinity();
  system.properties[row].inertia = std::numeric_limits<double>::infinity();
  set_to_rest(system, row);
}

void let_go(BlockSystem &system, std::size_t row, double density) {
  const std::span<const Vec2> shape = system.of_row(system.reference_vertex, row);
  const Moments moments = polygon_moments(std::vector<Vec2>(shape.begin(), shape.end()));
  system.properties[row].mass = density * system.properties[row].area;
  system.properties[row].inertia = density * (moments.xx + moments.yy);
}

void adopt_materials(RunState &run, const std::vector<Material> &before) {
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    BlockProperties &block = run.blocks.properties[row];
    const Material &old = before[static_cast<std::size_t>(block.material)];
    const Material &now = run.scene.materials[static_cast<std::size_t>(block.material)];
    if (old.density != now.density) {
      const double ratio = now.density / old.density;
      if (!block.keeps_its_velocity()) {
        block.mass = now.density * block.area;
        block.inertia *= ratio;
      }
      if (run.blocks.is_deformable(row)) {
        run.blocks.deformation_of(row).second_moment = ratio * run.blocks.deformation_of(row).second_moment;
      }
    }
    if (run.blocks.is_deformable(row) &&
        (old.youngs_modulus != now.youngs_modulus || old.poissons_ratio != now.poissons_ratio)) {
      set_elasticity(run.blocks.deformation_of(row), block.area, now, run.scene.run.plane_strain);
    }
  }
}

// They belong to nobody yet: the owner of its slab takes each, and the next refresh brings it where it lies.
/// @param ids  ascending
/// @param blocks  of the scene, by id
void free_blocks(RunState &run, const std::vector<std::int64_t> &ids, const std::vector<SceneBlock> &blocks) {
  if (ids.empty()) {
    return;
  }
  BlockSystem freed;
  for (const std::int64_t id : ids) {
    if (slab_owner(num_blocks(run.scene), run.communicator.size(), id) == run.communicator.rank()) {
      const SceneBlock &block = blocks[static_cast<std::size_t>(id)];
      const Material &material = run.scene.materials[static_cast<std::size_t>(block.material)];
      const BlockKind kind = choose_fidelity(run.scene, run.scene.joints, block).kind;
      append_block(freed, BlockId{id}, block, material, kind, run.scene.run.plane_strain);
      part_sides(freed, run.scene.joints);
      keep_wet_joints(run.blocks, id, freed);
    }
  }
  rebuild(
      run.blocks, [&](std::size_t row) { return !holds(ids, run.blocks.properties[row].id.value); }, freed);
  run.clock.state.more_mobile += std::ssize(ids);
  stiffen_anchors(run.blocks, stiffest_joint(run.scene.joints));
  if (run.communicator.max(run.blocks.unshaken.empty() ? 0.0 : 1.0) > 0.0) {
    unshaken_rows(run.blocks); // a row without an entry would read that of another one
  }
}

void adopt_block(RunState &run, std::int64_t id, const SceneBlock &before, const SceneBlock &after) {
  const auto row = find_owned_row(run.blocks, id);
  if (!row) {
    return;
  }
  if (!before.driven && after.driven) {
    stop_heeding_forces(run.blocks, *row);
  } else if (before.driven && !after.driven) {
    let_go(run.blocks, *row, run.scene.materials[static_cast<std::size_t>(after.material)].density);
  }
  adopt_loads(run.blocks, *row, before.loads, after.loads);
}

// What the excavated blocks put on each of the others, summed in the order of their ids, and what each bolt
// from them pulls with: what it was grouted in goes as gradually as the rock does.
void unload(RunState &run, const std::vector<std::int64_t> &removed, double duration) {
  std::map<std::uint32_t, Unloading> loads; // by row
  const auto add = [&](const CandidatePair &pair, std::span<const RegionForce> regions, bool is_lower) {
    const std::uint32_t row = (is_lower ? pair.lower : pair.higher).value;
    const std::uint32_t other = (is_lower ? pair.higher : pair.lower).value;
    const std::int64_t id = run.blocks.properties[row].id.value;
    if (row >= run.blocks.num_owned || holds(removed, id) ||
        !holds(removed, run.blocks.properties[other].id.value)) {
      return;
    }
    Unloading &load = loads.try_emplace(row, Unloading{id, {}, {}, run.clock.time(), duration}).first->second;
    for (const RegionForce &force : regions) {
      const ContactPart part = contact_part(force, is_lower, run.blocks.motion[row].centroid);
      load.rigid += {part.force, part.dyad.xy - part.dyad.yx};
      const Rotation turn = Rotation::of(run.blocks.trial[row].r);
      const Mat2 to_reference = run.blocks.is_deformable(row)
                                    ? run.blocks.trial_inverse[run.blocks.deformation_begin[row]]
                                    : Mat2{turn.c, turn.s, -turn.s, turn.c};
      load.gradient += transposed(to_reference * part.dyad);
    }
  };
  for_regions(run, 0, run.neighbours.candidates.pairs.size(),
              [&](std::uint32_t pair, std::span<const RegionForce> regions) {
                add(run.neighbours.candidates.pairs[pair], regions, true);
                add(run.neighbours.candidates.pairs[pair], regions, false);
              });
  std::vector<Unloading> mine;
  for (const auto &[row, load] : loads) {
    mine.push_back(load);
  }
  const auto goes = [&](std::int64_t id) { return holds(removed, id); };
  for (const LinkPull &pull : run.bolts.pulls_from(goes, run.blocks)) {
    mine.push_back(
        {run.blocks.properties[pull.row].id.value, pull.rigid, pull.gradient, run.clock.time(), duration});
  }
  for (const auto &from_rank : run.communicator.all_gather(mine)) {
    run.clock.state.unloading.insert(run.clock.state.unloading.end(), from_rank.begin(), from_rank.end());
  }
  std::stable_sort(run.clock.state.unloading.begin(), run.clock.state.unloading.end(),
                   [](const Unloading &a, const Unloading &b) {
                     return std::pair(a.block, a.begin) < std::pair(b.block, b.begin);
                   });
}

} // namespace

void take_laws(RunState &run, const std::vector<JointLaw> &laws) {
  for (std::size_t i = 0; i < laws.size(); ++i) {
    JointLaw &law = run.scene.joints.laws[i];
    const JointLaw before = std::exchange(law, laws[i]);
    law.is_on_edges = before.is_on_edges;
    if (law.allowed_overlap > 0.0) { // it has been resolved for the start
      law.normal_stiffness = before.normal_stiffness;
    }
  }
}

// Laws keep their order and number, and so do materials and blocks: the scene's reader has seen to that.
void adopt(RunState &run, const Stage &stage, double begin) {
  if (!stage.after) {
    return;
  }
  const Scene &after = *stage.after;
  const Rise change{begin, stage.ramp};
  take_laws(run, after.joints.laws);
  run.scene.run = after.run;
  run.contacts = ContactForces(contact_parameters(run.scene));
  run.scene.water = after.water;
  run.scene.supports = after.supports;
  run.scene.bolts = after.bolts;
  run.scene.liners = after.liners;
  adopt_materials(run, std::exchange(run.scene.materials, after.materials));
  if (stage.changes_stress) {
    run.loads.change_side_stress(change);
  }
  std::vector<SceneBlock> blocks = after.blocks;
  std::vector<std::int64_t> freed;
  for (std::size_t i = 0; i < run.scene.blocks.size(); ++i) {
    const auto id = static_cast<std::int64_t>(i);
    const SceneBlock &before = run.scene.blocks[i];
    blocks[i].loads = run.loads.after(before.loads, after.blocks[i].loads, change);
    if (is_removed(run.clock.state, id)) {
      continue;
    }
    if (before.fixed && !blocks[i].fixed) {
      freed.push_back(id);
    } else {
      adopt_block(run, id, before, blocks[i]);
    }
  }
  free_blocks(run, freed, blocks);
  run.scene.blocks = std::move(blocks);
}

void change_strengths(RunState &run, const std::vector<JointLaw> &laws) {
  take_laws(run, laws);
  run.contacts = ContactForces(contact_parameters(run.scene));
  run.neighbours.candidates.laws = run.scene.joints.all_constants(); // those of mixed regions among them
}

namespace {

/// Indices of what is in place and was not.
template <class T>
std::vector<std::int64_t> put_in(const std::vector<T> &before, const std::vector<T> &after) {
  std::vector<std::int64_t> added;
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (after[i].active && !(i < before.size() && before[i].active)) {
      added.push_back(static_cast<std::int64_t>(i));
    }
  }
  return added;
}

} // namespace

void change_bolts(const RunState &run, const Scene &scene, const std::vector<Bolt> &before,
                  const std::function<bool(std::int64_t)> &is_gone, Bolts &bolts, Diagnostics &notes) {
  bolts.remove([&](const BoltLink &link) {
    const bool is_active = link.liner >= 0 ? scene.liners[static_cast<std::size_t>(link.liner)].active
                                           : scene.bolts[static_cast<std::size_t>(link.bolt)].active;
    return !is_active || is_gone(link.end[0].block) || is_gone(link.end[1].block);
  });
  bolts.install(run.communicator, scene, run.blocks, put_in(before, scene.bolts), is_gone, notes);
}

// Those that are in place now and were not are put in where the blocks are; those that are no longer, and all
// at blocks that are gone, are taken out.
void change_support(RunState &run, const std::vector<Bolt> &bolts, const std::vector<Liner> &liners) {
  const Scene &scene = run.scene;
  if (scene.bolts.empty() && scene.liners.empty()) {
    return;
  }
  const auto is_gone = [&](std::int64_t id) { return is_removed(run.clock.state, id); };
  if (run.clock.stage().kind == StageKind::excavate) { // rock beyond viscous sides goes on
    run.bolts.end_at_voids(is_gone);
  }
  change_bolts(run, scene, bolts, is_gone, run.bolts, run.notes);
  run.bolts.install_liners(run.communicator, scene, run.blocks, put_in(liners, scene.liners), run.notes);
  run.bolts.take_laws(scene);
}

std::vector<std::int64_t> select_blocks(const RunState &run, const BlockSelection &selection) {
  std::vector<std::int64_t> mine;
  for (std::size_t row = 0; row < run.blocks.num_rows(); ++row) {
    const std::int64_t id = run.blocks.properties[row].id.value;
    const bool inside = !selection.region.empty() && holds_point(selection.region, run.blocks.centroid(row));
    const bool in_opening =
        std::any_of(selection.openings.begin(), selection.openings.end(),
                    [&](std::size_t opening) { return holds(run.scene.groups[opening].blocks, id); });
    if ((row < run.blocks.num_owned || run.blocks.is_fixed(row)) &&
        (inside || in_opening || holds(selection.blocks, id))) {
      mine.push_back(id);
    }
  }
  std::vector<std::int64_t> all;
  for (const auto &from_rank : run.communicator.all_gather(mine)) {
    all.insert(all.end(), from_rank.begin(), from_rank.end());
  }
  std::sort(all.begin(), all.end()); // everybody has told of the fixed ones
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// @param relax  s, over which their forces fall to zero; infinite where they stay
void excavate(RunState &run, const std::vector<std::int64_t> &ids, double relax) {
  if (relax > 0.0) {
    unload(run, ids, relax);
  }
  run.clock.state.removed.insert(run.clock.state.removed.end(), ids.begin(), ids.end());
  std::sort(run.clock.state.removed.begin(), run.clock.state.removed.end());
}

// Blocks move, and earlier stages take blocks away: what a stage excavates is known when it begins.
void excavate(RunState &run, const Stage &stage) {
  const std::vector<std::int64_t> ids = select_blocks(run, stage.excavated);
  if (ids.empty()) {
    run.notes.push_back(
        {Severity::warning, stage.where, fmt::format("stage '{}' removes no blocks", stage.name),
         "no block that is left has its centroid in 'region', belongs to 'openings' or is named in 'blocks'",
         "move 'region' to where blocks are, or leave the stage out"});
  }
  if (!run.bolts.empty()) {
    CutBolts cut = cut_bolts(run, ids);
    cut.forget([&](std::int32_t bolt) {
      return stage.after && !stage.after->bolts[static_cast<std::size_t>(bolt)].active;
    });
    warn_of_cuts(run, stage, cut);
  }
  excavate(run, ids, stage.relax);
}

Unloading unloading_of(const RunState &run, BlockId block) {
  Unloading sum;
  if (run.clock.state.unloading.empty()) {
    return sum;
  }
  const auto below = [](const Unloading &load, std::int64_t id) { return load.block < id; };
  auto load = std::lower_bound(run.clock.state.unloading.begin(), run.clock.state.unloading.end(),
                               block.value, below);
  for (; load != run.clock.state.unloading.end() && load->block == block.value; ++load) {
    const double share = std::max(0.0, 1.0 - (run.loads.time - load->begin) / load->duration);
    sum.rigid += share * load->rigid;
    sum.gradient += share * load->gradient;
  }
  return sum;
}

void remove_blocks(RunState &run, const std::vector<std::int64_t> &ids) {
  const auto before = static_cast<std::int64_t>(run.blocks.num_owned);
  rebuild(run.blocks, [&](std::size_t row) { return !holds(ids, run.blocks.properties[row].id.value); }, {});
  std::int64_t gone = before - static_cast<std::int64_t>(run.blocks.num_owned);
  run.communicator.sum(std::span(&gone, 1));
  run.clock.state.more_mobile -= gone;
  double thinnest = std::numeric_limits<double>::infinity(); // of those that are left
  for (std::size_t row = 0; row < run.blocks.num_rows(); ++row) {
    thinnest = std::min(thinnest, run.blocks.properties[row].width);
  }
  run.thinnest = -run.communicator.max(-thinnest);
}

} // namespace gcpdda
