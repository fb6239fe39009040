#pragma once

// Whether two runs have the same results, to the byte.

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace gcpdda {

/// Are two runs identical? Every file of frames/ and history/, run.hdf.series, bolts.hdf.series and run.xdmf
/// is compared byte for byte, HDF5 files by their datasets and attributes before (path, type, shape, bytes;
/// links into other files are followed), which name what differs. summary.json, run.log, scene.toml,
/// checkpoints/ and decomposition/ are exempt.
///
/// @return the first differences, a line each; empty means identical. Folders without frames differ: there is
///         nothing to compare.
std::vector<std::string> compare_runs(const std::filesystem::path &a, const std::filesystem::path &b);

/// What frames/frame_<n>.hdf holds; rows in BlockId order.
struct FrameContent {
  double time = 0.0;
  std::vector<std::array<double, 3>> points;
  std::vector<std::int64_t> offsets; ///< block b has points [offsets[b], offsets[b + 1])
  std::vector<std::int64_t> block;
  std::vector<std::int32_t> material;
  std::vector<std::uint8_t> kind;
  std::vector<std::array<double, 3>> displacement;
  std::vector<double> rotation;
  std::vector<std::array<double, 3>> velocity;
  std::vector<std::array<double, 3>> stress;
  std::vector<std::array<double, 3>> contact_force;
};

/// What frames/contacts_<n>.hdf holds.
struct ContactFrameContent {
  double time = 0.0;
  std::vector<std::array<double, 3>> points; ///< two for each region
  std::vector<std::array<std::int64_t, 2>> blocks;
  std::vector<std::int32_t> joint;
  std::vector<std::uint8_t> state;
  std::vector<double> normal_force;
  std::vector<double> shear_force;
  std::vector<double> overlap;
  std::vector<double> slip;
};

/// Not collective; throws FileError.
FrameContent read_frame(const std::filesystem::path &path);
ContactFrameContent read_contact_frame(const std::filesystem::path &path);

} // namespace gcpdda
