#include "simulation/cut_bolts.hpp"

#include "simulation/bolt_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <string>
#include <utility>

namespace gcpdda {

namespace {

/// Whether grout of limited strength holds the bolt.
bool slips_in_grout(const Scene &scene, std::int32_t bolt) {
  const std::int32_t support = scene.bolts[static_cast<std::size_t>(bolt)].support;
  return std::isfinite(scene.supports[static_cast<std::size_t>(support)].bond_strength);
}

bool is_cable(const Scene &scene, std::int32_t bolt) {
  const std::int32_t support = scene.bolts[static_cast<std::size_t>(bolt)].support;
  return scene.supports[static_cast<std::size_t>(support)].kind == SupportType::Kind::anchored;
}

/// Cables between their ends, by their numbers.
using Cables = std::map<std::int32_t, Bolt>;

Cables cables_in_place(const RunState &run) {
  Cables cables;
  for (const LinkLine &line : run.bolts.lines(run.communicator, run.blocks)) {
    const std::int32_t number = run.bolts.links()[line.link].bolt;
    if (is_cable(run.scene, number)) {
      Bolt &cable = cables[number] = run.scene.bolts[static_cast<std::size_t>(number)];
      cable.from = line.points.front();
      cable.to = line.points.back();
    }
  }
  return cables;
}

Cables cables_as_drawn(const Scene &scene, const Bolts &bolts) {
  Cables cables;
  for (const BoltLink &link : bolts.links()) {
    if (link.liner < 0 && is_cable(scene, link.bolt)) {
      cables.emplace(link.bolt, scene.bolts[static_cast<std::size_t>(link.bolt)]);
    }
  }
  return cables;
}

/// Cables that cross excavated rock. Collective.
std::set<std::int32_t> crossing(const RunState &run, const Cables &cables,
                                const std::vector<std::int64_t> &ids) {
  std::vector<BoltPiece> pieces;
  for (std::size_t row = 0; row < run.blocks.num_rows() && !cables.empty(); ++row) {
    const std::int64_t id = run.blocks.properties[row].id.value;
    const bool is_here = row < run.blocks.num_owned || run.blocks.is_fixed(row);
    if (is_here && std::binary_search(ids.begin(), ids.end(), id)) {
      const std::vector<Vec2> polygon = current_vertices(run.blocks, row);
      for (const auto &[number, cable] : cables) {
        append_pieces(cable, number, polygon, id, pieces);
      }
    }
  }
  std::set<std::int32_t> crossed;
  for (const auto &from_rank : run.communicator.all_gather(pieces)) {
    for (const BoltPiece &piece : from_rank) {
      crossed.insert(static_cast<std::int32_t>(piece.bolt));
    }
  }
  return crossed;
}

/// @param crossed  cables, also those one end of which goes
CutBolts cut_links(const Scene &scene, const Bolts &bolts, const std::vector<std::int64_t> &ids,
                   std::set<std::int32_t> crossed) {
  const auto goes = [&](std::int64_t id) { return std::binary_search(ids.begin(), ids.end(), id); };
  CutBolts cut;
  cut.crossed = std::move(crossed);
  std::set<std::int32_t> stay;
  std::int32_t last = -1;
  for (const BoltLink &link : bolts.links()) { // along each bolt
    if (link.liner >= 0) {
      continue;
    }
    const bool is_gone = goes(link.end[0].block) || goes(link.end[1].block);
    (is_gone ? cut.taken_away : stay).insert(link.bolt);
    const bool is_plated = !std::isfinite(link.grout[0]) && slips_in_grout(scene, link.bolt);
    if (link.bolt != last && is_plated && goes(link.end[link.head_first ? 0 : 1].block)) {
      cut.without_plate.insert(link.bolt);
    }
    last = link.bolt;
  }
  for (const std::int32_t bolt : stay) {
    cut.taken_away.erase(bolt);
  }
  for (const std::int32_t bolt : cut.taken_away) {
    cut.without_plate.erase(bolt);
    cut.crossed.erase(bolt);
  }
  return cut;
}

/// A warning that has not been given yet.
/// @param one, many  what happens to a single bolt, to several ones
void warn_of(RunState &run, const std::set<std::int32_t> &bolts, const std::string &one,
             const std::string &many, const char *why, const char *hint) {
  if (bolts.empty()) {
    return;
  }
  const Bolt &first = run.scene.bolts[static_cast<std::size_t>(*bolts.begin())];
  const std::string what = bolts.size() == 1
                               ? fmt::format("bolt '{}' {}", first.name, one)
                               : fmt::format("bolt '{}' and {} more {}", first.name, bolts.size() - 1, many);
  if (std::none_of(run.notes.begin(), run.notes.end(),
                   [&](const Diagnostic &note) { return note.what == what; })) {
    run.notes.push_back({Severity::warning, first.where, what, why, hint});
  }
}

} // namespace

void CutBolts::forget(const std::function<bool(std::int32_t)> &is_known) {
  for (std::set<std::int32_t> *bolts : {&taken_away, &without_plate, &crossed}) {
    std::erase_if(*bolts, is_known);
  }
}

CutBolts cut_bolts(const RunState &run, const std::vector<std::int64_t> &ids) {
  return cut_links(run.scene, run.bolts, ids, crossing(run, cables_in_place(run), ids));
}

CutBolts cut_bolts(const RunState &run, const Scene &scene, const Bolts &bolts,
                   const std::vector<std::int64_t> &ids) {
  return cut_links(scene, bolts, ids, crossing(run, cables_as_drawn(scene, bolts), ids));
}

void warn_of_cuts(RunState &run, const Stage &stage, const CutBolts &cut) {
  const char *later =
      "put bolts in after the excavation: active = false, and \"bolt.NAME.active\" = true, or "
      "\"bolt_pattern.NAME.active\", in a later stage";
  const std::string by = fmt::format("taken away by stage '{}'", stage.name);
  warn_of(run, cut.taken_away, "is " + by, "are " + by,
          "it excavates a block at an end of the cable, or at every joint of the bar", later);
  const std::string in = fmt::format("in stage '{}'", stage.name);
  warn_of(run, cut.without_plate, "loses its face plate " + in, "lose their face plates " + in,
          "it excavates the block at the head; the grout on that side then limits the force", later);
  const std::string across =
      fmt::format("rock between head and anchor that stage '{}' excavates", stage.name);
  warn_of(run, cut.crossed, "crosses " + across, "cross " + across,
          "a cable keeps its tension across the opening",
          "let it end before the opening, or set \"bolt.NAME.active\" = false in the stage");
}

} // namespace gcpdda
