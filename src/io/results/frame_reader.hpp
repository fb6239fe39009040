#pragma once

// Frames read back.

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace gcpdda {

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
