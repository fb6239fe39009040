#include "gcpdda/simulation/results.hpp"

#include "gcpdda/dynamics/deformable.hpp"

#include <algorithm>
#include <functional>
#include <unordered_map>

namespace gcpdda {

namespace {

/// What one mobile block puts on a fixed one.
struct Reaction {
  std::int64_t fixed = 0;
  std::int64_t mobile = 0;
  ContactPart part;
};

FrameRow row_of(const BlockSystem &blocks, std::size_t row) {
  const BlockProperties &block = blocks.properties[row];
  FrameRow out;
  out.block = block.id.value;
  out.material = block.material;
  out.kind = static_cast<std::uint8_t>(block.kind);
  out.num_vertices = static_cast<std::int32_t>(blocks.num_vertices(row));
  out.centroid = blocks.centroid(row);
  out.displacement = blocks.displacement[row].u;
  out.rotation = blocks.displacement[row].r;
  out.velocity = {blocks.velocity[row].u.x, blocks.velocity[row].u.y, blocks.velocity[row].r};
  return out;
}

/// Reactions on the fixed blocks of this rank's id slab, by fixed id, then by mobile id.
std::vector<Reaction> collect_reactions(const Simulation &simulation) {
  const BlockSystem &blocks = simulation.blocks();
  const int num_ranks = simulation.communicator().size();
  std::vector<std::vector<Reaction>> outgoing(static_cast<std::size_t>(num_ranks));
  for (const RegionForce &force : simulation.contacts().regions()) {
    const CandidatePair &pair = simulation.candidates().pairs[force.pair];
    const bool lower_fixed = blocks.is_fixed(pair.lower.value);
    if (!lower_fixed && !blocks.is_fixed(pair.higher.value)) {
      continue;
    }
    const std::size_t fixed = lower_fixed ? pair.lower.value : pair.higher.value;
    const std::size_t mobile = lower_fixed ? pair.higher.value : pair.lower.value;
    const std::int64_t id = blocks.properties[fixed].id.value;
    const auto writer = static_cast<std::size_t>(slab_owner(simulation.num_blocks(), num_ranks, id));
    outgoing[writer].push_back({id, blocks.properties[mobile].id.value,
                                contact_part(force, lower_fixed, blocks.trial_centroid[fixed])});
  }
  std::vector<Reaction> reactions;
  for (const auto &arrived : simulation.communicator().all_to_all(outgoing)) {
    reactions.insert(reactions.end(), arrived.begin(), arrived.end());
  }
  // Regions of one pair come from one rank, in order.
  std::stable_sort(reactions.begin(), reactions.end(), [](const Reaction &a, const Reaction &b) {
    return std::pair(a.fixed, a.mobile) < std::pair(b.fixed, b.mobile);
  });
  return reactions;
}

/// Position and velocity at t_n of the material point that was at `start` at t = 0.
BlockHistoryRow point_row(const BlockSystem &blocks, std::size_t index, Vec2 start) {
  const Vec2 reference = start - blocks.properties[index].centroid;
  const RigidDof &v = blocks.velocity[index];
  BlockHistoryRow row;
  Vec2 velocity;
  if (blocks.is_deformable(index)) {
    const Deformation &d = blocks.deformation_of(index);
    row.position = blocks.centroid(index) + d.gradient(reference);
    velocity = v.u + d.rate(reference);
  } else {
    const Vec2 arm = Rotation::of(blocks.displacement[index].r)(reference);
    row.position = blocks.centroid(index) + arm;
    velocity = v.u + v.r * perp(arm);
  }
  row.velocity = {velocity.x, velocity.y, 0.0};
  return row;
}

FrameRow mobile_row(const Simulation &simulation, std::size_t index) {
  const BlockSystem &blocks = simulation.blocks();
  const ContactForces &contacts = simulation.contacts();
  FrameRow row = row_of(blocks, index);
  row.stress = blocks.is_deformable(index)
                   ? mean_cauchy_stress(blocks.deformation_of(index), blocks.properties[index].area)
                   : mean_stress(blocks, simulation.candidates(), contacts, index);
  const RigidDof force = sum_contacts(simulation.candidates(), contacts, index).force;
  row.contact_force = {force.u.x, force.u.y, force.r};
  return row;
}

/// Of the fixed block whose reactions come next in `reaction`, which moves on behind them.
FrameRow fixed_row(const BlockSystem &blocks, std::size_t index,
                   std::vector<Reaction>::const_iterator &reaction,
                   std::vector<Reaction>::const_iterator end) {
  const BlockProperties &block = blocks.properties[index];
  Vec2 force;
  Mat2 dyad;
  for (; reaction != end && reaction->fixed == block.id.value; ++reaction) {
    force += reaction->part.force;
    dyad += reaction->part.dyad;
  }
  FrameRow row = row_of(blocks, index);
  row.stress = {dyad.xx / block.area, dyad.yy / block.area, 0.5 * (dyad.xy + dyad.yx) / block.area};
  row.contact_force = {force.x, force.y, dyad.xy - dyad.yx};
  return row;
}

/// Ascending by BlockId.
FrameData collect_rows(const Simulation &simulation, const std::function<bool(std::int64_t)> &wanted,
                       std::size_t expected) {
  const BlockSystem &blocks = simulation.blocks();
  FrameData data;
  data.rows.reserve(expected);
  data.vertices.reserve(4 * expected);
  const auto append = [&](const FrameRow &row, std::size_t index) {
    if (wanted(row.block)) {
      data.rows.push_back(row);
      append_current_vertices(blocks, index, data.vertices);
    }
  };
  const std::vector<Reaction> reactions = collect_reactions(simulation);
  auto reaction = reactions.begin();
  std::size_t fixed = blocks.first_fixed();
  const auto append_fixed_below = [&](std::int64_t id) {
    for (; fixed < blocks.num_rows() && blocks.properties[fixed].id.value < id; ++fixed) {
      if (slab_owner(simulation.num_blocks(), simulation.communicator().size(),
                     blocks.properties[fixed].id.value) == simulation.communicator().rank()) {
        append(fixed_row(blocks, fixed, reaction, reactions.end()), fixed);
      }
    }
  };
  for (std::size_t index = 0; index < blocks.num_owned; ++index) {
    const std::int64_t id = blocks.properties[index].id.value;
    append_fixed_below(id);
    if (wanted(id)) {
      append(mobile_row(simulation, index), index);
    }
  }
  append_fixed_below(simulation.num_blocks());
  return data;
}

} // namespace

FrameData collect_frame(const Simulation &simulation) {
  return collect_rows(
      simulation, [](std::int64_t) { return true; }, simulation.blocks().num_owned + 1);
}

std::vector<ContactRow> collect_contacts(const Simulation &simulation) {
  const BlockSystem &blocks = simulation.blocks();
  const ContactForces &contacts = simulation.contacts();
  const Candidates &candidates = simulation.candidates();
  std::vector<ContactRow> rows;
  rows.reserve(contacts.regions().size());
  for (std::size_t k = 0; k < candidates.pairs.size(); ++k) { // in the order of the file
    const CandidatePair &pair = candidates.pairs[k];
    if (!simulation.counts_here(pair)) {
      continue;
    }
    std::int32_t position = 0;
    for (const RegionForce &force : contacts.of_pair(k)) {
      const auto region = static_cast<std::size_t>(&force - contacts.regions().data());
      const RegionMemory &memory = simulation.history().regions[region];
      const Vec2 tangent = perp(force.normal);
      ContactRow row;
      row.lower = blocks.properties[pair.lower.value].id.value;
      row.higher = blocks.properties[pair.higher.value].id.value;
      row.position = position++;
      row.joint = memory.law >= 0 ? memory.law : pair.law;
      row.state = static_cast<std::uint8_t>(memory.state);
      row.begin = force.point + force.extent_begin * tangent;
      row.end = force.point + force.extent_end * tangent;
      row.normal_force = force.normal_force;
      row.shear_force = force.shear;
      row.overlap = force.overlap;
      row.slip = memory.slip;
      rows.push_back(row);
    }
  }
  return rows;
}

std::vector<BlockHistoryRow> collect_monitors(const Simulation &simulation) {
  struct Found {
    std::int64_t monitor;
    BlockHistoryRow row;
  };
  const std::vector<Monitor> &monitors = simulation.scene().monitors;
  std::vector<BlockHistoryRow> rows(monitors.size());
  if (monitors.empty()) {
    return rows;
  }
  std::unordered_multimap<std::int64_t, std::size_t> monitor_of;
  for (std::size_t m = 0; m < monitors.size(); ++m) {
    monitor_of.emplace(monitors[m].block, m);
  }
  std::vector<Found> mine;
  const FrameData data = collect_rows(
      simulation, [&](std::int64_t block) { return monitor_of.contains(block); }, monitors.size());
  for (const FrameRow &row : data.rows) {
    const auto [first, last] = monitor_of.equal_range(row.block);
    std::for_each(first, last, [&](const auto &entry) {
      if (!monitors[entry.second].is_point) {
        mine.push_back({static_cast<std::int64_t>(entry.second),
                        {row.centroid, row.rotation, row.velocity, row.stress,
                         Vec2{row.contact_force[0], row.contact_force[1]}}});
      }
    });
  }
  const BlockSystem &blocks = simulation.blocks();
  for (std::size_t index = 0; index < blocks.num_rows(); ++index) {
    const bool mine_to_write = index < blocks.num_owned || blocks.is_fixed(index);
    const auto [first, last] = monitor_of.equal_range(blocks.properties[index].id.value);
    std::for_each(first, last, [&](const auto &entry) {
      if (monitors[entry.second].is_point && mine_to_write) {
        mine.push_back({static_cast<std::int64_t>(entry.second),
                        point_row(blocks, index, monitors[entry.second].point)});
      }
    });
  }
  for (const auto &found : simulation.communicator().all_gather(mine)) {
    for (const Found &f : found) {
      rows[static_cast<std::size_t>(f.monitor)] = f.row;
    }
  }
  return rows;
}

std::vector<BoltHistoryRow> collect_bolts(const Simulation &simulation) {
  std::vector<BoltHistoryRow> rows;
  if (simulation.bolts().empty()) {
    return rows;
  }
  const Scene &scene = simulation.scene();
  for (const BoltReport &bolt :
       simulation.bolts().report(simulation.communicator(), scene, simulation.blocks())) {
    rows.push_back({scene.bolts[static_cast<std::size_t>(bolt.bolt)].name, bolt.head, bolt.tip, bolt.axial,
                    bolt.shear, bolt.extension, bolt.slide, bolt.links, bolt.yielded, bolt.broken});
  }
  return rows;
}

BoltFrame collect_bolt_lines(const Simulation &simulation) {
  const Scene &scene = simulation.scene();
  BoltFrame frame;
  for (const LinkLine &line : simulation.bolts().lines(simulation.communicator(), simulation.blocks())) {
    const BoltLink &link = simulation.bolts().links()[line.link];
    const std::int32_t number = scene.bolts[static_cast<std::size_t>(link.bolt)].support;
    const SupportType &support = scene.supports[static_cast<std::size_t>(number)];
    BoltRow row;
    row.bolt = link.bolt;
    row.support = number;
    row.state = line.memory.broken ? 2 : line.memory.yielded ? 1 : 0;
    row.axial_force = support.spacing * line.memory.axial;
    row.shear_force = support.spacing * line.memory.shear;
    row.extension = line.memory.extension;
    row.slide = line.memory.slide;
    if (support.kind == SupportType::Kind::anchored) { // straight from end to end
      frame.points.insert(frame.points.end(), {line.points.front(), line.points.back()});
      row.num_points = 2;
    } else {
      frame.points.insert(frame.points.end(), line.points.begin(), line.points.end());
      row.num_points = 4;
    }
    frame.rows.push_back(row);
  }
  return frame;
}

// A bolt is put in when it becomes active, at the end of the stage before.
std::vector<BoltLoad> with_installation(std::vector<BoltLoad> loads, const std::vector<Bolt> &at_start,
                                        const Simulation &simulation) {
  const StageState &stage = simulation.stage();
  const std::vector<BoltLink> &links = simulation.bolts().links();
  for (BoltLoad &load : loads) {
    const auto found = std::find_if(at_start.begin(), at_start.end(),
                                    [&](const Bolt &bolt) { return bolt.name == load.last.name; });
    if (found == at_start.end()) {
      continue;
    }
    const auto number = static_cast<std::size_t>(found - at_start.begin());
    bool is_active = found->active;
    for (std::size_t k = 1; k <= static_cast<std::size_t>(stage.index); ++k) {
      if (const auto &after = simulation.stages()[k].after) {
        load.installed =
            after->bolts[number].active && !is_active ? stage.results[k - 1].time : load.installed;
        is_active = after->bolts[number].active;
      }
    }
    load.in_place = std::any_of(links.begin(), links.end(), [&](const BoltLink &link) {
      return static_cast<std::size_t>(link.bolt) == number;
    });
    load.support = simulation.scene().supports[static_cast<std::size_t>(found->support)].name;
  }
  return loads;
}

} // namespace gcpdda
