#include "simulation/wet_joints.hpp"

#include "contact/find_pairs.hpp"
#include "contact/start_contacts.hpp"
#include "io/results/id_slabs.hpp"
#include "model/find_row.hpp"

#include <algorithm>
#include <iterator>

namespace gcpdda {

namespace {

/// By law, whether a water table of the scene or of a stage lists it; empty where none lists any.
std::vector<bool> listed_laws(const RunState &run) {
  std::vector<bool> listed;
  const auto note = [&](const std::vector<Water> &water) {
    for (const Water &table : water) {
      for (const std::int32_t law : table.joints) {
        listed.resize(run.scene.joints.laws.size());
        listed[static_cast<std::size_t>(law)] = true;
      }
    }
  };
  note(run.scene.water);
  for (const Stage &stage : run.clock.stages) {
    if (stage.after) {
      note(stage.after->water);
    }
  }
  return listed;
}

/// What this rank knows of the contacts at the start.
struct KnownContacts {
  std::vector<std::vector<StartContact>> of_mobile; ///< by the owner of the block's slab
  std::vector<StartContact> of_fixed;               ///< each contact on one rank
};

void sort_out(const RunState &run, const BlockSystem &placed, std::span<const StartContact> contacts,
              KnownContacts &known) {
  const auto is_owned = [&](std::int64_t id) { return find_owned_row(placed, id).has_value(); };
  const auto is_fixed = [&](std::int64_t id) { return find_fixed_row(placed, id).has_value(); };
  for (const StartContact &contact : contacts) {
    if (is_owned(contact.block)) {
      const int owner = slab_owner(num_blocks(run.scene), run.communicator.size(), contact.block);
      known.of_mobile[static_cast<std::size_t>(owner)].push_back(contact);
    } else if (is_fixed(contact.block) &&
               (is_owned(contact.other) || (run.communicator.is_root() && is_fixed(contact.other)))) {
      known.of_fixed.push_back(contact);
    }
  }
}

KnownContacts find_contacts(const RunState &run) {
  KnownContacts known;
  known.of_mobile.resize(static_cast<std::size_t>(run.communicator.size()));
  const auto [placed, pairs] = run.neighbours.place(run.blocks);
  sort_out(run, placed, find_start_contacts(placed, pairs, run.scene.joints), known);
  // A stage may set blocks free that keep their place until then.
  const auto kept_pairs = find_kept_pairs(placed, run.neighbours.base_skin);
  sort_out(run, placed, find_start_contacts(placed, kept_pairs, run.scene.joints), known);
  return known;
}

} // namespace

void find_wet_joints(RunState &run) {
  const std::vector<bool> listed = listed_laws(run);
  if (listed.empty()) {
    return;
  }
  KnownContacts known = find_contacts(run);
  std::vector<StartContact> contacts;
  for (const auto &from_rank : run.communicator.all_to_all(std::move(known.of_mobile))) {
    contacts.insert(contacts.end(), from_rank.begin(), from_rank.end());
  }
  for (const auto &from_rank : run.communicator.all_gather(known.of_fixed)) {
    contacts.insert(contacts.end(), from_rank.begin(), from_rank.end());
  }
  sort_start_contacts(contacts);
  BlockSystem &blocks = run.blocks;
  blocks.water_stretch_begin = BlockSystem{}.water_stretch_begin; // of no rows
  for (std::size_t row = 0; row < blocks.num_rows(); ++row) {
    const std::int64_t id = blocks.properties[row].id.value;
    const auto first = std::partition_point(contacts.begin(), contacts.end(),
                                            [&](const StartContact &c) { return c.block < id; });
    const auto last =
        std::find_if(first, contacts.end(), [&](const StartContact &c) { return c.block != id; });
    const std::vector<WaterStretch> own = water_stretches_of(blocks, row, {first, last}, listed);
    blocks.water_stretch.insert(blocks.water_stretch.end(), own.begin(), own.end());
    blocks.water_stretch_begin.push_back(static_cast<std::uint32_t>(blocks.water_stretch.size()));
  }
}

void keep_wet_joints(const BlockSystem &blocks, std::int64_t id, BlockSystem &freed) {
  if (const auto row = find_fixed_row(blocks, id)) {
    const std::span<const WaterStretch> own = blocks.water_stretches(*row);
    freed.water_stretch.insert(freed.water_stretch.end(), own.begin(), own.end());
    freed.water_stretch_begin.lengthen(freed.num_rows() - 1, std::ssize(own));
  }
}

} // namespace gcpdda
