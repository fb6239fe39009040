#pragma once

// Scenes that a run has been computed with before.

#include <cstdint>
#include <filesystem>
#include <vector>

namespace gcpdda {

/// Scenes that a run has left behind: `restart --set` changes a scene under a state, and the state stays one
/// of this run. DIR/checkpoints/past_scenes.txt has a fingerprint a line. By the root alone.
std::vector<std::uint64_t> past_scenes(const std::filesystem::path &directory);
/// Adds these; throws FileError.
void remember_scenes(const std::filesystem::path &directory, const std::vector<std::uint64_t> &prints);

} // namespace gcpdda
