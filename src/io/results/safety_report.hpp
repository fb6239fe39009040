#pragma once

// What a search for the factor of safety has found, and the files that tell of it.

#include "gcpdda/geometry/vec2.hpp"
#include "gcpdda/model/stage.hpp"
#include "io/results/folder_lock.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace gcpdda {

/// A run with all strengths divided by a factor.
struct StrengthTrial {
  double factor = 1.0;
  Verdict verdict = Verdict::undecided;     ///< also where the run has ended in a numerical failure
  Verdict first_block = Verdict::undecided; ///< on any block, where `verdict` is on a mechanism
  bool rests_far = false; ///< has failed because blocks come to rest farther than fos.largest_motion
  std::string decided_by; ///< what has come to the verdict, in words
  bool decisive = false;  ///< the bracket rests on it; others were run because ranks were free
  double time = 0.0;      ///< simulated, s
  double moved = 0.0;     ///< largest motion of a block, in sizes of that block
  double slide = 0.0;     ///< largest slide (simulation/slid_blocks.hpp), in the same way
  double unbalanced_ratio = 0.0;
  std::int64_t steps = 0;
  std::int64_t evaluations = 0; ///< of candidate pairs, all ranks
  double cpu_s = 0.0;           ///< all ranks
  int ranks = 1;
  std::string message;
  std::filesystem::path directory;
};

/// Blocks that have slid to where they hold in a settle stage before the search.
struct EarlierSlide {
  std::string stage;
  std::string block;       ///< the one that slid farthest, by its size
  double share = 0.0;      ///< how far that one slid, in sizes of it ...
  double distance = 0.0;   ///< ... and in m
  std::int64_t blocks = 0; ///< that slid by StageResult::telling_slide or more
  std::string words;       ///< all this in a sentence
};

/// A block in the picture of how the blocks fail.
struct FailingBlock {
  std::int64_t block = 0;
  std::string name;
  std::vector<Vec2> vertices; ///< at failure, m
  bool fixed = false;
  bool moves = false;    ///< at least a tenth as far as the one that moves most, small falls left out
  Vec2 displacement;     ///< of the centroid since the trial began, m
  double rotation = 0.0; ///< since the trial began, rad
  double motion = 0.0;   ///< largest of any of its points, m
  double area = 0.0;     ///< m^2
  bool left_out = false; ///< falls by itself, and is smaller than what counts (fos.ignore_area)
};

/// Bracket of the factor at which the first block fails, however small it is.
struct FirstBlock {
  std::optional<double> holds;
  std::optional<double> fails;
  std::vector<FailingBlock> blocks; ///< of `fails`, by BlockId
};

/// What the static solver has found where the dynamic step came to no verdict on any of it.
struct UnconfirmedBracket {
  std::optional<double> holds;
  std::optional<double> fails;
  std::size_t confirmations = 0; ///< dynamic runs without a verdict
  double limit = 0.0;            ///< of a trial, s
  std::int64_t patience = 0;     ///< fos.patience
};

/// SVG texts; empty where there is nothing to draw.
struct SafetyPictures {
  std::string mechanism;
  std::string first_block;
};

/// A part of a bracket, so wide, is within the tolerance, but for the round-off of factors that are halved.
inline bool is_narrow(double width, double holds, double tolerance) {
  return width <= (1.0 + 1e-9) * tolerance * holds;
}

/// What gcpdda fos has found.
struct SafetyReport {
  std::vector<std::string> families;        ///< laws that were weakened
  bool leaves_earthquake_out = false;       ///< of the scene
  std::vector<std::string> left_out_stages; ///< with what they change: those behind the last settle stage
  double tolerance = 0.0;                   ///< asked for
  std::optional<double> holds;              ///< largest factor at which the blocks settled
  std::optional<double> fails;              ///< smallest one at which they failed
  std::vector<double> undecided;            ///< factors between these two without a verdict
  StrengthTrial settled; ///< the run up to the settled state, or the last one that did not come there
  std::vector<EarlierSlide> earlier_slides;      ///< up to the settled state
  std::vector<StrengthTrial> trials;             ///< by factor
  std::optional<double> bound;                   ///< upper bound by limit analysis, where it was asked for
  std::optional<double> resting_bound;           ///< the same for blocks that hold as they lie; no larger
  bool is_bound_alone = false;                   ///< no trials were to be run
  std::string unsolved_bound;                    ///< why limit analysis has come to none
  std::vector<FailingBlock> mechanism;           ///< of `fails`, by BlockId; empty without it
  std::optional<UnconfirmedBracket> unconfirmed; ///< where the search has ended without confirmed ends
  std::optional<FirstBlock>
      first_block;           ///< where the factor is that of a mechanism (fos.ignore_area, fos.region)
  double ignored_area = 0.0; ///< m^2, fos.ignore_area
  std::optional<StrengthTrial>
      first_slide; ///< that of the least factor at which blocks slide, or move far, until they rest

  /// The bracket is as narrow as asked for.
  [[nodiscard]] bool is_found() const {
    return holds && fails && is_narrow(*fails - *holds, *holds, tolerance);
  }
};

/// What people read.
std::string to_text(const SafetyReport &report);

/// fos.txt, fos.json, fos_trials.csv, and with a mechanism fos_blocks.csv and fos.svg, the picture;
/// fos_first_block.svg where the factor of the first block is another one. Root only; throws FileError.
void write_safety_report(const std::filesystem::path &directory, const SafetyReport &report,
                         const SafetyPictures &pictures);

/// Makes the folder of a search. One that holds a run or an ensemble, or in which another process works, is
/// refused with FileError, one that holds a search unless `overwrite`, which removes what a search writes.
/// Root only.
/// @param lock  keeps other processes out of the folder as long as it lives
void prepare_safety_directory(const std::filesystem::path &directory, bool overwrite, FolderLock &lock);

} // namespace gcpdda
