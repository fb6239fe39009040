#pragma once

// Rows of frames, histories and checkpoints from the state of a run.

#include "contact/contact_sums.hpp"
#include "gcpdda/io/frame_rows.hpp"
#include "gcpdda/io/frame_writer.hpp"
#include "gcpdda/io/run_summary.hpp"
#include "io/results/history_writer.hpp"
#include "simulation/simulation.hpp"

#include <vector>

namespace gcpdda {

/// What one mobile block puts on a fixed one.
struct Reaction {
  std::int64_t fixed = 0;
  std::int64_t mobile = 0;
  ContactPart part;
};

/// Rows of all blocks this rank hands over: its owned ones, and the fixed ones of its id slab, whose
/// reactions are summed in the order of the other blocks' ids. Construction is collective. Forces and
/// stresses belong to the last evaluation.
class SimulationFrame : public FrameSource {
public:
  explicit SimulationFrame(Simulation &simulation);
  [[nodiscard]] std::int64_t num_rows() const override;
  void append(std::int64_t first, std::int64_t last, std::vector<FrameRow> &rows,
              std::vector<Vec2> &vertices) const override;

private:
  Simulation &simulation_;
  std::vector<Reaction> reactions_; ///< by fixed id, then by mobile id
};

/// Regions this rank hands over: for frames where they touch, for checkpoints what is remembered of them.
class SimulationContacts : public ContactSource, public RegionSource {
public:
  explicit SimulationContacts(Simulation &simulation) : simulation_(simulation) {}
  [[nodiscard]] std::int64_t count(std::int64_t first, std::int64_t last) const override;
  void append(std::int64_t first, std::int64_t last, std::vector<ContactRow> &rows) const override;
  void append(std::int64_t first, std::int64_t last, std::vector<RegionRecord> &records) const override;

private:
  struct Pairs {
    std::size_t begin = 0;
    std::size_t end = 0;
  };
  /// Those with a lower id in [first, last).
  [[nodiscard]] Pairs pairs_from(std::int64_t first, std::int64_t last) const;

  Simulation &simulation_;
};

/// Rows of the bolts that are in place; complete on every rank. Collective.
std::vector<BoltHistoryRow> collect_bolts(const Simulation &simulation);

/// Lines of the bolts that are in place; complete on every rank. Collective.
BoltFrame collect_bolt_lines(const Simulation &simulation);

/// The same of liners.
std::vector<LinerHistoryRow> collect_liners(const Simulation &simulation);
std::vector<LinerRow> collect_liner_rows(const Simulation &simulation);

/// The loads of a history with what the stages know of their bolts and liners.
/// @param at_start  Scene::bolts or Scene::liners as the scene states them
std::vector<BoltLoad> with_installation(std::vector<BoltLoad> loads, const std::vector<Bolt> &at_start,
                                        const Simulation &simulation);
std::vector<LinerLoad> with_installation(std::vector<LinerLoad> loads, const std::vector<Liner> &at_start,
                                         const Simulation &simulation);

/// Rows of the scene's monitors, in their order; complete on every rank. Collective.
std::vector<BlockHistoryRow> collect_monitors(Simulation &simulation);

} // namespace gcpdda
