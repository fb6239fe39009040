#include "simulation/results.hpp"

#include "io/results/id_slabs.hpp"

#include "dynamics/deformable.hpp"
#include "model/find_row.hpp"
#include "simulation/stage_changes.hpp"
#include "simulation/water_loads.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace gcpdda {

namespace {

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
  out.velocity = {blocks.velocity[row].u.x, blocks.velocity[row].u.y, spin_of(blocks, row)};
  return out;
}

/// Reactions on the fixed blocks of this rank's id slab, by fixed id, then by mobile id.
std::vector<Reaction> collect_reactions(Simulation &simulation) {
  const BlockSystem &blocks = simulation.blocks();
  const int num_ranks = simulation.communicator().size();
  std::vector<std::vector<Reaction>> outgoing(static_cast<std::size_t>(num_ranks));
  for (const ContactDigest::OnFixed &on_fixed : contact_digest(simulation.state()).on_fixed) {
    const std::int64_t id = blocks.properties[on_fixed.row].id.value;
    const auto writer = static_cast<std::size_t>(slab_owner(simulation.num_blocks(), num_ranks, id));
    outgoing[writer].push_back({id, blocks.properties[on_fixed.other].id.value, on_fixed.part});
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

/// Position, displacement and velocity at t_n of the material point that was at `start` at t = 0.
BlockHistoryRow point_row(const BlockSystem &blocks, std::size_t index, Vec2 start) {
  const Vec2 reference = start - blocks.properties[index].centroid;
  const RigidDof &v = blocks.velocity[index];
  BlockHistoryRow row;
  Vec2 velocity;
  if (blocks.is_deformable(index)) {
    const Deformation &d = blocks.deformation_of(index);
    row.position = blocks.centroid(index) + d.gradient(reference);
    row.displacement = blocks.displacement[index].u + (d.gradient(reference) - reference);
    velocity = v.u + d.rate(reference);
  } else {
    const Vec2 arm = Rotation::of(blocks.displacement[index].r)(reference);
    row.position = blocks.centroid(index) + arm;
    row.displacement = blocks.displacement[index].u + (arm - reference);
    velocity = v.u + v.r * perp(arm);
  }
  row.velocity = {velocity.x, velocity.y, 0.0};
  return row;
}

/// int f x^T of what acts on a rigid row beside its contacts: loads, water, fixed points and what is left of
/// the forces of excavated blocks, N.
Mat2 dyad_of_loads(const RunState &run, std::size_t index) {
  const BlockSystem &blocks = run.blocks;
  const RigidDof &trial = blocks.trial[index];
  const Rotation turn = Rotation::of(trial.r);
  Mat2 dyad;
  for (const MaterialLoad &load : blocks.loads_of(index)) {
    dyad += outer(run.loads.force_of(load), turn(load.point));
  }
  for (const Anchor &anchor : blocks.anchors_of(index)) {
    const Vec2 arm = turn(anchor.point);
    dyad += outer(-anchor.stiffness * (trial.u + arm - anchor.point - anchor.held), arm);
  }
  dyad += unloading_of(run, blocks.properties[index].id).gradient * Mat2{turn.c, turn.s, -turn.s, turn.c};
  if (!run.scene.water.empty()) {
    TrialOutline outline;
    dyad += water_on(run, index, -run.loads.gravity(run.scene.run).y, outline).dyad;
  }
  return dyad;
}

/// (1/area) int sym(x f) of a rigid row's contacts and loads: on an edge under load half of it is the load's.
std::array<double, 3> mean_rigid_stress(Simulation &simulation, std::size_t index) {
  const BlockSystem &blocks = simulation.blocks();
  std::array<double, 3> stress = contact_digest(simulation.state()).mean_stress(blocks, index);
  const Mat2 dyad = dyad_of_loads(simulation.state(), index);
  const double area = blocks.properties[index].area;
  stress[0] += dyad.xx / area;
  stress[1] += dyad.yy / area;
  stress[2] += 0.5 * (dyad.xy + dyad.yx) / area;
  return stress;
}

FrameRow mobile_row(Simulation &simulation, std::size_t index) {
  const BlockSystem &blocks = simulation.blocks();
  const ContactDigest &contacts = contact_digest(simulation.state());
  FrameRow row = row_of(blocks, index);
  row.stress = blocks.is_deformable(index)
                   ? mean_cauchy_stress(blocks.deformation_of(index), blocks.properties[index].area)
                   : mean_rigid_stress(simulation, index);
  const RigidDof &force = contacts.on_rows[index].force;
  row.contact_force = {force.u.x, force.u.y, force.r};
  return row;
}

/// @param reactions  by fixed id, of this block and others
FrameRow fixed_row(const BlockSystem &blocks, std::size_t index, const std::vector<Reaction> &reactions) {
  const BlockProperties &block = blocks.properties[index];
  Vec2 force;
  Mat2 dyad;
  auto reaction = std::lower_bound(reactions.begin(), reactions.end(), block.id.value,
                                   [](const Reaction &r, std::int64_t id) { return r.fixed < id; });
  for (; reaction != reactions.end() && reaction->fixed == block.id.value; ++reaction) {
    force += reaction->part.force;
    dyad += reaction->part.dyad;
  }
  FrameRow row = row_of(blocks, index);
  row.stress = {dyad.xx / block.area, dyad.yy / block.area, 0.5 * (dyad.xy + dyad.yx) / block.area};
  row.contact_force = {force.x, force.y, dyad.xy - dyad.yx};
  return row;
}

} // namespace

SimulationFrame::SimulationFrame(Simulation &simulation)
    : simulation_(simulation), reactions_(collect_reactions(simulation)) {}

std::int64_t SimulationFrame::num_rows() const {
  const BlockSystem &blocks = simulation_.blocks();
  const Communicator &world = simulation_.communicator();
  const std::int64_t num_blocks = simulation_.num_blocks();
  const std::size_t begin = first_row_from(blocks, blocks.first_fixed(), blocks.num_rows(),
                                           slab_begin(num_blocks, world.size(), world.rank()));
  const std::size_t end = first_row_from(blocks, blocks.first_fixed(), blocks.num_rows(),
                                         slab_begin(num_blocks, world.size(), world.rank() + 1));
  return static_cast<std::int64_t>(blocks.num_owned + end - begin);
}

// Ascending by BlockId.
void SimulationFrame::append(std::int64_t first, std::int64_t last, std::vector<FrameRow> &rows,
                             std::vector<Vec2> &vertices) const {
  const BlockSystem &blocks = simulation_.blocks();
  const Communicator &world = simulation_.communicator();
  std::size_t fixed = first_row_from(blocks, blocks.first_fixed(), blocks.num_rows(), first);
  const auto append_fixed_below = [&](std::int64_t id) {
    for (; fixed < blocks.num_rows() && blocks.properties[fixed].id.value < id; ++fixed) {
      if (slab_owner(simulation_.num_blocks(), world.size(), blocks.properties[fixed].id.value) ==
          world.rank()) {
        rows.push_back(fixed_row(blocks, fixed, reactions_));
        append_current_vertices(blocks, fixed, vertices);
      }
    }
  };
  const std::size_t end = first_row_from(blocks, 0, blocks.num_owned, last);
  const std::size_t begin = first_row_from(blocks, 0, blocks.num_owned, first);
  rows.reserve(rows.size() + end - begin); // growing by doubling would touch far more fresh memory
  vertices.reserve(vertices.size() + blocks.vertex_begin[end] - blocks.vertex_begin[begin]);
  for (std::size_t index = begin; index < end; ++index) {
    append_fixed_below(blocks.properties[index].id.value);
    rows.push_back(mobile_row(simulation_, index));
    append_current_vertices(blocks, index, vertices);
  }
  append_fixed_below(last);
}

// Pairs are in the order of the file.
SimulationContacts::Pairs SimulationContacts::pairs_from(std::int64_t first, std::int64_t last) const {
  const std::vector<CandidatePair> &pairs = simulation_.candidates().pairs;
  const auto first_from = [&](std::int64_t id) {
    const auto found = std::partition_point(pairs.begin(), pairs.end(), [&](const CandidatePair &pair) {
      return simulation_.blocks().properties[pair.lower.value].id.value < id;
    });
    return static_cast<std::size_t>(found - pairs.begin());
  };
  return {first_from(first), first_from(last)};
}

std::int64_t SimulationContacts::count(std::int64_t first, std::int64_t last) const {
  std::int64_t count = 0;
  const auto [begin, end] = pairs_from(first, last);
  for (std::size_t pair = begin; pair < end; ++pair) {
    if (simulation_.counts_here(simulation_.candidates().pairs[pair])) {
      simulation_.history().for_pair(pair, [&](const RegionMemory &) { ++count; });
    }
  }
  return count;
}

void SimulationContacts::append(std::int64_t first, std::int64_t last, std::vector<ContactRow> &rows) const {
  const BlockSystem &blocks = simulation_.blocks();
  rows.reserve(rows.size() + static_cast<std::size_t>(count(first, last)));
  const auto append_pair = [&](std::uint32_t number, std::span<const RegionForce> regions) {
    const CandidatePair &pair = simulation_.candidates().pairs[number];
    if (!simulation_.counts_here(pair)) {
      return;
    }
    std::int32_t position = 0;
    for (const RegionForce &force : regions) {
      const RegionState &memory = simulation_.history().state(number, static_cast<std::size_t>(position));
      const Vec2 tangent = perp(force.normal);
      ContactRow row;
      row.lower = blocks.properties[pair.lower.value].id.value;
      row.higher = blocks.properties[pair.higher.value].id.value;
      row.position = position++;
      row.joint = simulation_.scene().joints.named(memory.law >= 0 ? memory.law : pair.law);
      row.state = static_cast<std::uint8_t>(memory.state);
      row.begin = force.point + force.extent_begin * tangent;
      row.end = force.point + force.extent_end * tangent;
      row.normal_force = force.normal_force;
      row.shear_force = force.shear;
      row.overlap = force.overlap;
      row.slip = memory.slip;
      rows.push_back(row);
    }
  };
  const auto [begin, end] = pairs_from(first, last);
  for_regions(simulation_.state(), begin, end, append_pair);
}

void SimulationContacts::append(std::int64_t first, std::int64_t last,
                                std::vector<RegionRecord> &records) const {
  const auto [begin, end] = pairs_from(first, last);
  for (std::size_t pair = begin; pair < end; ++pair) {
    if (simulation_.counts_here(simulation_.candidates().pairs[pair])) {
      simulation_.history().for_pair(pair, [&](const RegionMemory &region) {
        records.push_back(simulation_.state().neighbours.record_of(simulation_.blocks(), pair, region));
      });
    }
  }
}

/// The row of a block among those of this rank and the fixed ones.
std::optional<std::size_t> row_here(const BlockSystem &blocks, std::int64_t block) {
  const std::size_t owned = first_row_from(blocks, 0, blocks.num_owned, block);
  const std::size_t row = owned < blocks.num_owned && blocks.properties[owned].id.value == block
                              ? owned
                              : first_row_from(blocks, blocks.first_fixed(), blocks.num_rows(), block);
  return row < blocks.num_rows() && blocks.properties[row].id.value == block ? std::optional(row)
                                                                             : std::nullopt;
}

std::vector<BlockHistoryRow> collect_monitors(Simulation &simulation) {
  struct Found {
    std::int64_t monitor;
    BlockHistoryRow row;
  };
  const std::vector<Monitor> &monitors = simulation.scene().monitors;
  std::vector<BlockHistoryRow> rows(monitors.size());
  if (monitors.empty()) {
    return rows;
  }
  std::vector<Found> mine;
  const BlockSystem &blocks = simulation.blocks();
  const SimulationFrame frame(simulation);
  std::vector<FrameRow> found_rows;
  std::int64_t found_block = -1; // whose rows these are
  std::vector<Vec2> vertices;
  for (std::size_t m = 0; m < monitors.size(); ++m) {
    const std::int64_t block = monitors[m].block;
    const std::optional<std::size_t> here = monitors[m].is_point ? row_here(blocks, block) : std::nullopt;
    if (here && !monitors[m].is_on_profile) {
      mine.push_back({static_cast<std::int64_t>(m), point_row(blocks, *here, monitors[m].point)});
    }
    if (block < 0 || (monitors[m].is_point && !monitors[m].is_on_profile)) {
      continue;
    }
    if (block != found_block) { // neighbours on a profile often share a block
      found_block = block;
      found_rows.clear();
      vertices.clear();
      frame.append(block, block + 1, found_rows, vertices);
    }
    for (const FrameRow &row : found_rows) {
      BlockHistoryRow found{row.centroid,
                            row.rotation,
                            row.velocity,
                            row.stress,
                            Vec2{row.contact_force[0], row.contact_force[1]},
                            row.displacement,
                            block};
      if (monitors[m].is_on_profile) {
        found = point_row(blocks, here.value(), monitors[m].point);
        found.stress = row.stress;
        found.block = block;
      }
      mine.push_back({static_cast<std::int64_t>(m), found});
    }
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
                    bolt.shear, bolt.extension, bolt.slide, bolt.links, bolt.yielded, bolt.broken,
                    bolt.largest_axial, bolt.largest_shear});
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

std::vector<LinerHistoryRow> collect_liners(const Simulation &simulation) {
  std::vector<LinerHistoryRow> rows;
  const auto note = [](LinerPeak &peak, double value, Vec2 where) {
    peak = value > peak.value ? LinerPeak{value, where} : peak;
  };
  const Scene &scene = simulation.scene();
  std::int32_t last = -1;
  for (const LinerLine &line :
       simulation.bolts().liner_lines(simulation.communicator(), simulation.blocks())) {
    const std::int32_t number = simulation.bolts().links()[line.link].liner;
    const Vec2 middle = 0.5 * (line.points[0] + line.points[1]);
    if (number != last) {
      last = number;
      const LinerPeak none{0.0, middle};
      rows.push_back({scene.liners[static_cast<std::size_t>(number)].name, 0, none, none, none, none});
    }
    LinerHistoryRow &row = rows.back();
    ++row.elements;
    note(row.compression, -line.memory.axial, middle);
    note(row.tension, line.memory.axial, middle);
    note(row.moment, std::max(std::abs(line.moments[0]), std::abs(line.moments[1])), middle);
    note(row.shear, std::abs(line.memory.shear), middle);
    row.strength_used = std::max(row.strength_used, line.strength_used);
    row.cracked += line.memory.cracked ? 1 : 0;
    row.yielded += line.memory.yielded || line.memory.broken ? 1 : 0;
    row.broken += line.memory.broken ? 1 : 0;
    const LinkPeaks &largest = line.memory.largest;
    row.largest_compression = std::max(row.largest_compression, largest.compression);
    row.largest_tension = std::max(row.largest_tension, largest.tension);
    row.largest_moment = std::max(row.largest_moment, largest.moment);
    row.largest_shear = std::max(row.largest_shear, largest.shear);
    row.largest_strength_used = std::max(row.largest_strength_used, largest.strength_used);
  }
  return rows;
}

std::vector<LinerRow> collect_liner_rows(const Simulation &simulation) {
  const Scene &scene = simulation.scene();
  std::vector<LinerRow> rows;
  for (const LinerLine &line :
       simulation.bolts().liner_lines(simulation.communicator(), simulation.blocks())) {
    const BoltLink &link = simulation.bolts().links()[line.link];
    const LinkMemory &memory = line.memory;
    LinerRow row;
    row.liner = link.liner;
    row.support = scene.liners[static_cast<std::size_t>(link.liner)].support;
    row.state = memory.broken ? 2 : memory.yielded ? 1 : 0;
    row.cracked = memory.cracked ? 1 : 0;
    row.axial_force = memory.axial;
    row.shear_force = memory.shear;
    row.moment_begin = line.moments[0];
    row.moment_end = line.moments[1];
    row.extension = memory.extension;
    row.slide = memory.slide;
    row.turn = link.head_first ? memory.turn : -memory.turn;
    row.thickness = scene.supports[static_cast<std::size_t>(row.support)].thickness;
    row.strength_used = line.strength_used;
    row.nodes = line.points;
    rows.push_back(row);
  }
  return rows;
}

namespace {

/// When support of a scene was put in last: when it became active, at the end of the stage before.
/// @param list  Scene::bolts or Scene::liners
template <class List>
double installed_at(const Simulation &simulation, List list, bool is_active, std::size_t number) {
  const StageState &stage = simulation.stage();
  double installed = 0.0;
  for (std::size_t k = 1; k <= static_cast<std::size_t>(stage.index); ++k) {
    if (const auto &after = simulation.stages()[k].after) {
      const bool becomes = ((*after).*list)[number].active;
      installed = becomes && !is_active ? stage.results[k - 1].time : installed;
      is_active = becomes;
    }
  }
  return installed;
}

template <class Load, class T, class List, class Owner>
std::vector<Load> with_stages(std::vector<Load> loads, const std::vector<T> &at_start,
                              const Simulation &simulation, List list, Owner owner) {
  const std::vector<BoltLink> &links = simulation.bolts().links();
  for (Load &load : loads) {
    const auto found = std::find_if(at_start.begin(), at_start.end(),
                                    [&](const T &support) { return support.name == load.last.name; });
    if (found == at_start.end()) {
      continue;
    }
    const auto number = static_cast<std::size_t>(found - at_start.begin());
    load.installed = installed_at(simulation, list, found->active, number);
    load.in_place = std::any_of(links.begin(), links.end(), [&](const BoltLink &link) {
      return link.*owner == static_cast<std::int32_t>(number);
    });
    load.support = simulation.scene().supports[static_cast<std::size_t>(found->support)].name;
  }
  return loads;
}

} // namespace

std::vector<BoltLoad> with_installation(std::vector<BoltLoad> loads, const std::vector<Bolt> &at_start,
                                        const Simulation &simulation) {
  return with_stages(std::move(loads), at_start, simulation, &Scene::bolts, &BoltLink::bolt);
}

std::vector<LinerLoad> with_installation(std::vector<LinerLoad> loads, const std::vector<Liner> &at_start,
                                         const Simulation &simulation) {
  return with_stages(std::move(loads), at_start, simulation, &Scene::liners, &BoltLink::liner);
}

} // namespace gcpdda
