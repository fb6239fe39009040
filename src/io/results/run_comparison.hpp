#pragma once

// Whether two runs have the same results, to the byte.

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace gcpdda {

/// Are two runs identical? Every file of frames/ and history/, run.hdf.series, contacts.hdf.series,
/// bolts.hdf.series, liners.hdf.series and run.xdmf is compared byte for byte, HDF5 files by their datasets
/// and attributes before (path, type, shape, bytes; links into other files are followed), which name what
/// differs. summary.json, run.log, scene.toml, checkpoints/ and decomposition/ are exempt.
///
/// @return the first differences, a line each; empty means identical. Folders without frames differ: there is
///         nothing to compare.
std::vector<std::string> compare_runs(const std::filesystem::path &a, const std::filesystem::path &b);

} // namespace gcpdda
