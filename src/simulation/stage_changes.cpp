// What stages do at once: blocks go, parameters change. Every change is made in the same order by a run and
// by a restart into a later stage, so that both have the same bits.

#include "base/check.hpp"
#include "contact/stiffness_bound.hpp"
#include "dynamics/deformable.hpp"
#include "dynamics/frequency_bound.hpp"
#include "gcpdda/io/result_files.hpp"
#include "geometry/holds_point.hpp"
#include "geometry/polygon.hpp"
#include "model/fidelity.hpp"
#include "simulation/simulation.hpp"

#include <algorithm>
#include <cmath>
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

void hold(BlockSystem &system, std::size_t row) {
  system.properties[row].mass = std::numeric_limits<double>::infinity();
  system.properties[row].inertia = std::numeric_limits<double>::infinity();
  system.velocity[row] = {};
  system.acceleration[row] = {};
  if (system.is_deformable(row)) {
    system.deformation_of(row).rate = {};
    system.deformation_of(row).acceleration = {};
  }
}

void let_go(BlockSystem &system, std::size_t row, double density) {
  const std::span<const Vec2> shape = system.of_row(system.reference_vertex, row);
  const Moments moments = polygon_moments(std::vector<Vec2>(shape.begin(), shape.end()));
  system.properties[row].mass = density * system.properties[row].area;
  system.properties[row].inertia = density * (moments.xx + moments.yy);
}

std::optional<std::size_t> row_of(const BlockSystem &system, std::int64_t id) {
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    if (system.properties[row].id.value == id) {
      return row;
    }
  }
  return std::nullopt;
}

} // namespace

// Each block is made as heavy as its joints need it to be to swing no faster than the slowest block: the step
// is then as long as for that one. By powers of two, which can be taken back without rounding.
void Simulation::scale_masses() {
  const Stage &stage = stages_[static_cast<std::size_t>(stage_.index)];
  if (!stage.mass_scaling || stage_.ended) {
    return;
  }
  std::vector<double> squared(blocks_.num_owned);
  double minus_slowest = -std::numeric_limits<double>::infinity();
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    const StiffnessBound stiffness = stiffness_bound(scene_.joints, blocks_.properties[row].material);
    squared[row] = contact_frequency_bound(blocks_, row, stiffness.normal, stiffness.tangential,
                                           elasticity_of(scheme_, scene_.run.elasticity),
                                           bolts_.springs_at(blocks_.properties[row].id.value));
    if (squared[row] > 0.0) {
      minus_slowest = std::max(minus_slowest, -squared[row]);
    }
  }
  communicator_.max(std::span(&minus_slowest, 1));
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    BlockProperties &block = blocks_.properties[row];
    if (squared[row] > 0.0) {
      const double scaling = std::exp2(std::ceil(std::log2(squared[row] / -minus_slowest) - 1e-9));
      block.mass_scaling = scaling;
      block.mass *= scaling;
      block.inertia *= scaling;
      if (blocks_.is_deformable(row)) {
        blocks_.deformation_of(row).second_moment = scaling * blocks_.deformation_of(row).second_moment;
      }
    }
  }
}

void Simulation::unscale_masses() {
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    BlockProperties &block = blocks_.properties[row];
    const double back = 1.0 / block.mass_scaling;
    block.mass *= back;
    block.inertia *= back;
    block.mass_scaling = 1.0;
    if (blocks_.is_deformable(row)) {
      blocks_.deformation_of(row).second_moment = back * blocks_.deformation_of(row).second_moment;
    }
  }
}

void Simulation::begin_as_restored(const Scene &start, const BlockSystem &rows, const StageState &saved,
                                   const RunFacts &facts) {
  scene_ = start;
  list_courses();
  blocks_ = rows;
  stage_ = {};
  if (saved.index >= std::ssize(stages_)) {
    throw FileError("its stage is not in the scene");
  }
  for (std::int64_t k = 0; k <= saved.index; ++k) {
    adopt(stages_[static_cast<std::size_t>(k)], start_of_stage(k, saved));
  }
  remove_blocks(saved.removed);
  stage_ = saved;
  bolts_ = Bolts::from_numbers(facts.bolt_counts, facts.bolt_numbers);
  restored_statics_ = to_static_state(facts.static_counts, facts.static_numbers);
  for (const BoltLink &link : bolts_.links()) {
    if (link.bolt < 0 || link.bolt >= std::ssize(scene_.bolts)) {
      throw FileError("a bolt of it is not in the scene");
    }
  }
  list_applied(blocks_, !scene_.water.empty() || !stage_.unloading.empty());
  blocks_.body = {{facts.gravity_x, facts.gravity_y}, {facts.shaking_x, facts.shaking_y}};
}

bool Simulation::is_removed(std::int64_t block) const {
  return holds(stage_.removed, block);
}

// Laws keep their order and number, and so do materials and blocks: the scene's reader has seen to that.
void Simulation::adopt(const Stage &stage, double begin) {
  if (!stage.after) {
    return;
  }
  const Scene &after = *stage.after;
  const Rise change{begin, stage.ramp};
  const std::vector<JointLaw> laws = std::exchange(scene_.joints, after.joints).laws;
  for (std::size_t i = 0; i < laws.size(); ++i) {
    JointLaw &law = scene_.joints.laws[i];
    law.is_on_edges = laws[i].is_on_edges;
    if (law.allowed_overlap > 0.0) { // it has been resolved for the start
      law.normal_stiffness = laws[i].normal_stiffness;
    }
  }
  scene_.run = after.run;
  contacts_ = ContactForces(contact_parameters(scene_));
  scene_.water = after.water;
  scene_.supports = after.supports;
  scene_.bolts = after.bolts;
  adopt_materials(std::exchange(scene_.materials, after.materials));
  if (stage.changes_stress) {
    change_side_stress(change);
  }
  std::vector<SceneBlock> blocks = after.blocks;
  for (std::size_t i = 0; i < scene_.blocks.size(); ++i) {
    const auto id = static_cast<std::int64_t>(i);
    blocks[i].loads = loads_after(scene_.blocks[i].loads, after.blocks[i].loads, change);
    if (!is_removed(id)) {
      adopt_block(id, scene_.blocks[i], blocks[i]);
    }
  }
  scene_.blocks = std::move(blocks);
}

// Those that are in place now and were not are put in where the blocks are; those that are no longer, and all
// at blocks that are gone, are taken out.
void Simulation::change_bolts(const std::vector<Bolt> &before) {
  if (scene_.bolts.empty()) {
    return;
  }
  std::vector<std::int64_t> added;
  for (std::size_t i = 0; i < scene_.bolts.size(); ++i) {
    if (scene_.bolts[i].active && !(i < before.size() && before[i].active)) {
      added.push_back(static_cast<std::int64_t>(i));
    }
  }
  bolts_.remove([&](const BoltLink &link) {
    return !scene_.bolts[static_cast<std::size_t>(link.bolt)].active || is_removed(link.end[0].block) ||
           is_removed(link.end[1].block);
  });
  bolts_.install(communicator_, scene_, blocks_, added, notes_);
  bolts_.take_laws(scene_);
}

void Simulation::adopt_materials(const std::vector<Material> &before) {
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    BlockProperties &block = blocks_.properties[row];
    const Material &old = before[static_cast<std::size_t>(block.material)];
    const Material &now = scene_.materials[static_cast<std::size_t>(block.material)];
    if (old.density != now.density) {
      const double ratio = now.density / old.density;
      if (!block.keeps_its_velocity()) {
        block.mass = now.density * block.area;
        block.inertia *= ratio;
      }
      if (blocks_.is_deformable(row)) {
        blocks_.deformation_of(row).second_moment = ratio * blocks_.deformation_of(row).second_moment;
      }
    }
    if (blocks_.is_deformable(row) &&
        (old.youngs_modulus != now.youngs_modulus || old.poissons_ratio != now.poissons_ratio)) {
      set_elasticity(blocks_.deformation_of(row), block.area, now, scene_.run.plane_strain);
    }
  }
}

void Simulation::adopt_block(std::int64_t id, const SceneBlock &before, const SceneBlock &after) {
  if (before.fixed && !after.fixed) {
    free_block(id, after);
    return;
  }
  const auto row = row_of(blocks_, id);
  if (!row) {
    return;
  }
  if (!before.driven && after.driven) {
    hold(blocks_, *row);
  } else if (before.driven && !after.driven) {
    let_go(blocks_, *row, scene_.materials[static_cast<std::size_t>(after.material)].density);
  }
  adopt_loads(*row, before.loads, after.loads);
}

// It belongs to nobody yet: the owner of its slab takes it, and the next refresh brings it where it lies.
void Simulation::free_block(std::int64_t id, const SceneBlock &block) {
  BlockSystem freed;
  if (slab_owner(num_blocks(), communicator_.size(), id) == communicator_.rank()) {
    const Material &material = scene_.materials[static_cast<std::size_t>(block.material)];
    const FidelityChoice choice =
        choose_fidelity(block, signed_area(block.vertices), material,
                        stiffness_bound(scene_.joints, block.material).normal, scene_.run);
    append_block(freed, BlockId{id}, block, material, choice.kind, scene_.run.plane_strain);
  }
  rebuild(
      blocks_, [&](std::size_t row) { return blocks_.properties[row].id.value != id; }, freed);
  ++stage_.more_mobile;
}

std::vector<std::int64_t> Simulation::select_blocks(const BlockSelection &selection) const {
  std::vector<std::int64_t> mine;
  for (std::size_t row = 0; row < blocks_.num_rows(); ++row) {
    const std::int64_t id = blocks_.properties[row].id.value;
    const bool inside = !selection.region.empty() && holds_point(selection.region, blocks_.centroid(row));
    const bool in_opening =
        std::any_of(selection.openings.begin(), selection.openings.end(),
                    [&](std::size_t opening) { return holds(scene_.groups[opening].blocks, id); });
    if ((row < blocks_.num_owned || blocks_.is_fixed(row)) &&
        (inside || in_opening || holds(selection.blocks, id))) {
      mine.push_back(id);
    }
  }
  std::vector<std::int64_t> all;
  for (const auto &from_rank : communicator_.all_gather(mine)) {
    all.insert(all.end(), from_rank.begin(), from_rank.end());
  }
  std::sort(all.begin(), all.end()); // everybody has told of the fixed ones
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// @param relax  s, over which their forces fall to zero; infinite where they stay
void Simulation::excavate(const std::vector<std::int64_t> &ids, double relax) {
  if (relax > 0.0) {
    unload(ids, relax);
  }
  stage_.removed.insert(stage_.removed.end(), ids.begin(), ids.end());
  std::sort(stage_.removed.begin(), stage_.removed.end());
}

// What the excavated blocks put on each of the others, summed in the order of their ids, and what each bolt
// from them pulls with: what it was grouted in goes as gradually as the rock does.
void Simulation::unload(const std::vector<std::int64_t> &removed, double duration) {
  std::map<std::uint32_t, Unloading> loads; // by row
  const auto add = [&](const CandidatePair &pair, std::span<const RegionForce> regions, bool is_lower) {
    const std::uint32_t row = (is_lower ? pair.lower : pair.higher).value;
    const std::uint32_t other = (is_lower ? pair.higher : pair.lower).value;
    const std::int64_t id = blocks_.properties[row].id.value;
    if (row >= blocks_.num_owned || holds(removed, id) ||
        !holds(removed, blocks_.properties[other].id.value)) {
      return;
    }
    Unloading &load = loads.try_emplace(row, Unloading{id, {}, {}, time(), duration}).first->second;
    for (const RegionForce &force : regions) {
      const ContactPart part = contact_part(force, is_lower, blocks_.motion[row].centroid);
      load.rigid += {part.force, part.dyad.xy - part.dyad.yx};
      if (blocks_.is_deformable(row)) {
        load.gradient += transposed(blocks_.trial_inverse[blocks_.deformation_begin[row]] * part.dyad);
      }
    }
  };
  for_regions(0, candidates_.pairs.size(), [&](std::uint32_t pair, std::span<const RegionForce> regions) {
    add(candidates_.pairs[pair], regions, true);
    add(candidates_.pairs[pair], regions, false);
  });
  std::vector<Unloading> mine;
  for (const auto &[row, load] : loads) {
    mine.push_back(load);
  }
  const auto goes = [&](std::int64_t id) { return holds(removed, id); };
  for (const LinkPull &pull : bolts_.pulls_from(goes, blocks_)) {
    mine.push_back({blocks_.properties[pull.row].id.value, pull.rigid, pull.gradient, time(), duration});
  }
  for (const auto &from_rank : communicator_.all_gather(mine)) {
    stage_.unloading.insert(stage_.unloading.end(), from_rank.begin(), from_rank.end());
  }
  std::stable_sort(stage_.unloading.begin(), stage_.unloading.end(),
                   [](const Unloading &a, const Unloading &b) {
                     return std::pair(a.block, a.begin) < std::pair(b.block, b.begin);
                   });
}

Unloading Simulation::unloading_of(BlockId block) const {
  Unloading sum;
  if (stage_.unloading.empty()) {
    return sum;
  }
  const auto below = [](const Unloading &load, std::int64_t id) { return load.block < id; };
  auto load = std::lower_bound(stage_.unloading.begin(), stage_.unloading.end(), block.value, below);
  for (; load != stage_.unloading.end() && load->block == block.value; ++load) {
    const double share = std::max(0.0, 1.0 - (load_time_ - load->begin) / load->duration);
    sum.rigid += share * load->rigid;
    sum.gradient += share * load->gradient;
  }
  return sum;
}

void Simulation::remove_blocks(const std::vector<std::int64_t> &ids) {
  const auto before = static_cast<std::int64_t>(blocks_.num_owned);
  rebuild(blocks_, [&](std::size_t row) { return !holds(ids, blocks_.properties[row].id.value); }, {});
  std::int64_t gone = before - static_cast<std::int64_t>(blocks_.num_owned);
  communicator_.sum(std::span(&gone, 1));
  stage_.more_mobile -= gone;
}

} // namespace gcpdda
