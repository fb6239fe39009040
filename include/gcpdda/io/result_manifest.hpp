#pragma once

// What a checkpoint remembers of the results before it: a restart adds to them, and a run whose histories or
// frames have a hole is none that a person can rely on.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace gcpdda {

/// A file of a run as it was when a checkpoint was written.
struct ResultFile {
  std::string name;       ///< in the result folder, with its sub-folder
  std::int64_t bytes = 0; ///< a history has at least these by now, every other file just these
  std::int64_t rows = -1; ///< of a history, without its header; -1: it is none

  /// Equal in name, bytes and rows.
  friend bool operator==(const ResultFile &, const ResultFile &) = default;
};

/// What results in the folder of a checkpoint have to do with going on from it.
enum class EarlierResults {
  are_not_looked_at, ///< the run writes its own
  must_be_whole,     ///< else an older checkpoint is taken, after which they are written again
  may_have_gaps
};

/// What is wrong with a file of this folder: it is missing, cut short or otherwise not as it was. Empty:
/// nothing. By one process alone.
std::string damage_of(const std::filesystem::path &directory, const ResultFile &file);

/// What is wrong with any of these, none that is left out. By one process alone.
std::vector<std::string> gaps_in(const std::filesystem::path &directory,
                                 const std::vector<ResultFile> &files);
/// The first of them, for a message.
std::string words_on_gaps(const std::vector<std::string> &gaps);

} // namespace gcpdda
