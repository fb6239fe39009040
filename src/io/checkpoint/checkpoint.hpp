#pragma once

// DIR/checkpoints/checkpoint_<step>.h5: everything of a run that its scene does not say and that cannot be
// computed again. Rows are in BlockId order, so the bytes do not depend on the number of ranks, and neither
// does the number that reads them. The file appears under its name only when it is complete and on the disk;
// the two newest are kept. A sum over all bytes is compared before anything else of a file is believed; one
// that is damaged, or of another scene, or whose results are not whole, is named and the one before is taken.

#include "gcpdda/io/result_manifest.hpp"
#include "gcpdda/parallel/communicator.hpp"
#include "model/block_system.hpp"
#include "model/contact_history.hpp"
#include "model/fingerprint.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

namespace gcpdda {

/// What a state fits (model/fingerprint.hpp).
struct SceneIdentity {
  std::int64_t num_blocks = 0; ///< fixed ones included
  std::int64_t num_mobile = 0;
  std::uint64_t blocks = 0; ///< sum of the fingerprints of all
  std::uint64_t materials = 0;
  ScenePrints parts{}; ///< of the scene with the stages up to that of the state

  friend bool operator==(const SceneIdentity &, const SceneIdentity &) = default;
};

/// What a checkpoint holds besides blocks and contacts; the same on all ranks.
struct RunFacts {
  SceneIdentity scene;
  std::int64_t step = 0;
  double time = 0.0;              ///< s
  double time_step = 0.0;         ///< s
  double total_at_start = 0.0;    ///< of the energies, J/m
  double stick_at_start = 0.0;    ///< energy of the stick springs, J/m
  std::int64_t contact_steps = 0; ///< and what follows: of the run so far, for its summary
  double max_overlap = 0.0;
  double max_overlap_share = 0.0;
  double fastest_turn = 0.0;
  double gravity_x = 0.0; ///< and what follows: BlockSystem::body, m/s2
  double gravity_y = 0.0;
  double shaking_x = 0.0;
  double shaking_y = 0.0;
  std::vector<double> ledger; ///< of the energies, what stages changed at once (simulation/energy_ledger.hpp)
  std::int64_t more_mobile = 0;           ///< mobile blocks now, beyond those of the scene; not written
  std::vector<std::int64_t> stage_counts; ///< where the run stands in its stages (simulation/stages.hpp)
  std::vector<double> stage_numbers;
  std::vector<std::int64_t> bolt_counts; ///< links of the bolts in place (simulation/bolts.hpp)
  std::vector<double> bolt_numbers;
  std::vector<std::int64_t> static_counts; ///< of a static solver at work (simulation/static_state.hpp)
  std::vector<double> static_numbers;
  std::vector<double> frame_times; ///< of the frames written, s
  std::vector<ResultFile> results; ///< files written so far; known to the root alone
};

/// Where the memory of contacts comes from: each rank hands over what it has, strip by strip, so that nobody
/// holds a copy of all.
class RegionSource {
public:
  RegionSource() = default;
  virtual ~RegionSource() = default;
  RegionSource(const RegionSource &) = delete;
  RegionSource &operator=(const RegionSource &) = delete;
  /// This rank's regions with first <= lower < last. Not collective.
  [[nodiscard]] virtual std::int64_t count(std::int64_t first, std::int64_t last) const = 0;
  /// The same regions behind `records`, those of a pair in their order.
  virtual void append(std::int64_t first, std::int64_t last, std::vector<RegionRecord> &records) const = 0;
};

} // namespace gcpdda
