#pragma once

// The result folder of a run as a whole.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace gcpdda {

/// Whether the folder holds a search for the factor of safety. Root only.
bool holds_search(const std::filesystem::path &directory);

/// Whether the folder holds an ensemble. Root only.
bool holds_ensemble(const std::filesystem::path &directory);

/// Throws FileError where the folder holds a search or an ensemble in place of a run, and says how these go
/// on. Root only.
void expect_run_to_restart(const std::filesystem::path &directory);

/// Makes the folder of a run, root only. A folder that holds a run is refused with FileError unless
/// `overwrite`, which removes only what a run writes. A folder that holds a search or an ensemble is always
/// refused: with a run in it neither could go on. Writes scene.toml (the resolved text).
void prepare_result_directory(const std::filesystem::path &directory, bool overwrite,
                              const std::string &resolved_scene);

/// Where a run keeps the lines of a drawing, the joint map of this number, for its restarts.
std::filesystem::path kept_joint_map(const std::filesystem::path &directory, std::size_t number);

/// Makes a run's folder fit to go on with: its scene.toml is this one, its summary is gone. Root only.
void reopen_result_directory(const std::filesystem::path &directory, const std::string &resolved_scene);

/// Whether summary.json says that the run has reached its end. Root only.
bool says_completed(const std::filesystem::path &directory);

/// Root only: decomposition/owners_<step>.csv, `block,rank` in BlockId order; anything that depends on ranks
/// lives there.
void write_owners(const std::filesystem::path &directory, std::int64_t step,
                  const std::vector<std::int32_t> &owner_of_block);

} // namespace gcpdda
