#pragma once

// What became of the members of an ensemble, and the files that tell of it.

#include "gcpdda/model/ensemble.hpp"
#include "io/results/folder_lock.hpp"
#include "model/statistics.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace gcpdda {

/// What became of a member. With factors the bracket decides: `undecided` where it holds 1.
enum class MemberOutcome {
  holds,
  fails,
  undecided,
  cannot_run ///< a scene that is refused, or a numerical failure; no trial of anything
};
inline const char *word_of(MemberOutcome outcome) {
  constexpr std::array words{"holds", "fails", "undecided", "cannot_run"};
  return words.at(static_cast<std::size_t>(outcome));
}

struct EnsembleMember {
  std::int64_t number = 0;
  MemberOutcome outcome = MemberOutcome::undecided;
  std::optional<double> holds; ///< bracket of the factor of safety, where it has been searched and found
  std::optional<double> fails;
  std::optional<double> displacement; ///< m, permanent since the ground began to shake; of blocks at rest
  std::int64_t steps = 0;             ///< of the runs that the outcome rests on
  double cpu_s = 0.0;                 ///< of all runs and ranks
  std::vector<double> values;         ///< drawn, in the order of the variations
  std::string
      message; ///< why it cannot run, or has no outcome; of one that holds, which blocks have slid before

  /// It holds where its blocks have slid to while they settled.
  [[nodiscard]] bool holds_after_slide() const { return outcome == MemberOutcome::holds && !message.empty(); }
  [[nodiscard]] std::optional<double> factor() const {
    return holds && fails ? std::optional(0.5 * (*holds + *fails)) : std::nullopt;
  }
};

/// What gcpdda ensemble has found.
struct EnsembleReport {
  std::vector<std::string> keys; ///< what varies
  Measure measure = Measure::factor;
  std::int64_t count = 0; ///< members asked for
  bool shakes = false;    ///< members have permanent displacements
  double largest_displacement = std::numeric_limits<double>::infinity(); ///< m; farther is failure
  std::vector<EnsembleMember> members;                                   ///< those that are done, by number
};

/// What all members together say.
struct EnsembleStatistics {
  std::int64_t holds = 0;
  std::int64_t fails = 0;
  std::int64_t undecided = 0;
  std::int64_t cannot_run = 0;
  std::int64_t below = 0; ///< fail at the smallest factor tried
  std::int64_t above = 0; ///< hold at the largest one
  std::int64_t slid = 0;  ///< hold where their blocks have slid to
  /// Share of the members that fail; NaN where none has a verdict.
  double probability = 0.0;
  /// 95 % interval of the probability of failure (probability_interval()). Its low end takes the undecided
  /// members as ones that hold, its high end as ones that fail.
  Interval interval{0.0, 1.0};
  SampleMoments factor;       ///< of the members that have one
  SampleMoments displacement; ///< permanent, m, of the members that have come to rest
  double median_displacement = 0.0;
  std::int64_t beyond = 0; ///< fail where they have come to rest: farther than the largest displacement

  [[nodiscard]] std::int64_t trials() const { return holds + fails + undecided; }
};
EnsembleStatistics statistics_of(const EnsembleReport &report);

/// One line without its end, as in ensemble_members.csv.
/// @param shakes  it has a cell for the permanent displacement
std::string row_of(const EnsembleMember &member, bool shakes);
/// The member of such a line; nothing where it is not whole.
std::optional<EnsembleMember> member_of(const std::string &row, std::size_t num_values, bool shakes);

/// What people read.
std::string to_text(const EnsembleReport &report);

/// ensemble.txt, ensemble.json, ensemble_members.csv and, with factors, ensemble.svg, the picture. Root only;
/// throws FileError.
void write_ensemble_report(const std::filesystem::path &directory, const EnsembleReport &report,
                           const std::string &picture);

/// Makes the folder of an ensemble, or takes the members that are there. A folder that holds anything else of
/// gcpdda, an ensemble of another scene and not `overwrite`, or one in which another process works, is
/// refused with FileError. Root only.
/// @param identity  text that is the same for ensembles whose members are
/// @param lock  keeps other processes out of the folder as long as it lives
/// @return rows of the members that are done
std::vector<std::string> prepare_ensemble_directory(const std::filesystem::path &directory, bool overwrite,
                                                    const std::string &identity, FolderLock &lock);

/// A member's row goes to the disk at once. Root of the ranks of that member only; throws FileError.
void write_member(const std::filesystem::path &directory, const EnsembleMember &member, bool shakes);

/// Where a member runs.
std::filesystem::path member_directory(const std::filesystem::path &directory, std::int64_t number);

} // namespace gcpdda
