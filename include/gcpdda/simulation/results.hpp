#pragma once

#include "gcpdda/io/result_files.hpp"
#include "gcpdda/simulation/simulation.hpp"

#include <vector>

namespace gcpdda {

/// Rows of all blocks this rank writes: its owned ones, and the fixed ones of its id slab, whose reactions
/// are summed in the order of the other blocks' ids. Collective. Forces and stresses belong to the last
/// evaluation.
FrameData collect_frame(const Simulation &simulation);

/// Touching regions this rank writes.
std::vector<ContactRow> collect_contacts(const Simulation &simulation);

/// Rows of the bolts that are in place; complete on every rank. Collective.
std::vector<BoltHistoryRow> collect_bolts(const Simulation &simulation);

/// Lines of the bolts that are in place; complete on every rank. Collective.
BoltFrame collect_bolt_lines(const Simulation &simulation);

/// The loads of a history with what the stages know of their bolts.
/// @param at_start  Scene::bolts as the scene states them
std::vector<BoltLoad> with_installation(std::vector<BoltLoad> loads, const std::vector<Bolt> &at_start,
                                        const Simulation &simulation);

/// Rows of the scene's monitors, in their order; complete on every rank. Collective.
std::vector<BlockHistoryRow> collect_monitors(const Simulation &simulation);

} // namespace gcpdda
