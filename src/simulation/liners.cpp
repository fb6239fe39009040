#include "simulation/liners.hpp"

#include "simulation/liner_face.hpp"
#include "simulation/outline_box.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace gcpdda {

namespace {

/// A liner that is put in, with the rock on either side of its path.
struct Lining {
  const Liner *liner = nullptr;
  std::array<LinerPath, 2> path; ///< the second only where the side is not known
  std::array<std::vector<FaceHit>, 2> hits;

  [[nodiscard]] std::size_t num_sides() const { return liner->has_rock_on_right ? 1 : 2; }
  [[nodiscard]] std::int64_t count(std::size_t side, bool is_face) const {
    return std::count_if(hits[side].begin(), hits[side].end(), [&](const FaceHit &hit) {
      return is_face ? hit.block >= 0 : hit.block == FaceHit::inside;
    });
  }
};

Lining lining_of(const Scene &scene, std::int64_t index) {
  Lining lining;
  lining.liner = &scene.liners[static_cast<std::size_t>(index)];
  const SupportType &support = scene.supports[static_cast<std::size_t>(lining.liner->support)];
  for (std::size_t side = 0; side < lining.num_sides(); ++side) {
    lining.path[side] = path_of(*lining.liner, support.thickness, side == 0);
    lining.hits[side].resize(lining.path[side].stations.size());
  }
  return lining;
}

struct HitRecord {
  std::uint32_t lining = 0;
  std::uint32_t side = 0;
  std::uint64_t station = 0;
  FaceHit hit;
};

/// Every rank has the hits of all. Collective.
void find_faces(const Communicator &communicator, const BlockSystem &system, std::vector<Lining> &linings) {
  for (std::size_t row = 0; row < system.num_rows(); ++row) {
    if (row >= system.num_owned && !(system.is_fixed(row) && communicator.is_root())) {
      continue;
    }
    const Aabb around = box_around(system, row);
    std::vector<Vec2> polygon; // of the few blocks that are near
    for (Lining &lining : linings) {
      for (std::size_t side = 0; side < lining.num_sides(); ++side) {
        if (!around.inflated(lining.path[side].reach).meets(lining.path[side].box)) {
          continue;
        }
        if (polygon.empty()) {
          polygon = current_vertices(system, row);
        }
        meet(lining.path[side], polygon, system.properties[row].id.value, lining.hits[side]);
      }
    }
  }
  std::vector<HitRecord> mine;
  for (std::size_t k = 0; k < linings.size(); ++k) {
    for (std::size_t side = 0; side < linings[k].num_sides(); ++side) {
      for (std::size_t i = 0; i < linings[k].hits[side].size(); ++i) {
        if (linings[k].hits[side][i].block != FaceHit::nothing) {
          mine.push_back(
              {static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(side), i, linings[k].hits[side][i]});
        }
      }
    }
  }
  for (const auto &theirs : communicator.all_gather(mine)) {
    for (const HitRecord &record : theirs) {
      FaceHit &hit = linings[record.lining].hits[record.side][record.station];
      hit = record.hit.is_before(hit) ? record.hit : hit;
    }
  }
}

Diagnostic remark(const Liner &liner, Severity severity, std::string what, const char *why,
                  const char *hint) {
  return {severity, liner.where, fmt::format("liner '{}' {}", liner.name, what), why, hint};
}

/// What is odd about a liner that has been put in.
void note_liner(const Lining &lining, std::size_t side, const LinerElements &elements, Diagnostics &notes) {
  const Liner &liner = *lining.liner;
  const std::int64_t faces = lining.count(side, true);
  if (faces == 0 && lining.count(side, false) > 0) {
    notes.push_back(remark(liner, Severity::warning, "lies inside the rock", "a liner covers a free face",
                           "excavate first, then set \"liner.NAME.active\" = true in a later stage"));
  } else if (faces == 0) {
    notes.push_back(remark(liner, Severity::warning, "touches no block", "it holds nothing",
                           liner.is_closed ? "check 'opening'" : "check where its path lies"));
  } else if (elements.links.empty()) {
    notes.push_back(remark(liner, Severity::warning, "touches only one block",
                           "it acts only between two neighbouring blocks",
                           "make it longer, or leave it out"));
  } else if (elements.num_gaps > 0) {
    notes.push_back(remark(
        liner, Severity::info,
        fmt::format("is interrupted at {} place{}", elements.num_gaps, elements.num_gaps == 1 ? "" : "s"),
        "there is no face of a block within its reach over more than its thickness", ""));
  }
}

} // namespace

std::vector<BoltLink> lay_liners(const Communicator &communicator, const Scene &scene,
                                 const BlockSystem &system, std::span<const std::int64_t> which,
                                 Diagnostics &notes) {
  std::vector<BoltLink> links;
  std::vector<Lining> linings;
  for (const std::int64_t index : which) {
    linings.push_back(lining_of(scene, index));
  }
  find_faces(communicator, system, linings);
  for (std::size_t k = 0; k < linings.size(); ++k) {
    const Lining &lining = linings[k];
    const std::array<std::int64_t, 2> faces{lining.count(0, true), lining.count(1, true)};
    const std::size_t side = faces[1] > faces[0] ? 1 : 0;
    if (lining.num_sides() == 2 && 10 * faces[1 - side] > faces[side]) { // a few meet the end of the path
      notes.push_back(remark(*lining.liner, Severity::warning, "has blocks on both sides",
                             "a liner covers the face of the rock on one side; it is not put in",
                             "let 'points' follow one face, or give its opening"));
      continue;
    }
    const SupportType &support = scene.supports[static_cast<std::size_t>(lining.liner->support)];
    const LinerElements elements =
        elements_of(which[k], lining.path[side], support.thickness, lining.hits[side]);
    note_liner(lining, side, elements, notes);
    links.insert(links.end(), elements.links.begin(), elements.links.end());
  }
  return links;
}

// The normal of the spring is across the element: its `bending` is then the angle between the two convected
// directions of the element, also of blocks that shear.
LinerLine line_of(const BlockSystem &system, const BoltLink &link, const std::array<std::size_t, 2> &rows,
                  const LinkLaw &law) {
  const std::size_t head = link.head_first ? 0 : 1;
  const LinkMemory &memory = link.memory;
  LinerLine line;
  line.memory = memory;
  line.points = {trial_position(system, rows[head], link.end[head].point),
                 trial_position(system, rows[1 - head], link.end[1 - head].point)};
  const double constant = link.head_first ? memory.moment : -memory.moment;
  const double linear = 0.5 * law.length * memory.shear;
  line.moments = {constant + linear, constant - linear};
  line.strength_used = strength_used(law, memory);
  line.memory.largest = with_last(law, memory);
  return line;
}

} // namespace gcpdda
