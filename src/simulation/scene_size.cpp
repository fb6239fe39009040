#include "simulation/scene_size.hpp"

#include "base/free_memory.hpp"
#include "model/block_source.hpp"
#include "model/generators.hpp"

#include <cmath>
#include <fmt/format.h>

namespace gcpdda {

namespace {

// Measured on walls of rigid bricks: whatever has more vertices or deforms takes more.
constexpr double bytes_per_block = 900.0;
constexpr double seconds_per_block = 15e-6;

constexpr double long_time = 120.0; ///< a user should know of it before, s

std::string time_text(double seconds) {
  return seconds < 7200.0     ? fmt::format("{:.0f} min", std::ceil(seconds / 60.0))
         : seconds < 172800.0 ? fmt::format("{:.0f} hours", seconds / 3600.0)
                              : fmt::format("{:.3g} days", seconds / 86400.0);
}

std::string ranks_text(int ranks) {
  return fmt::format("{} rank{}", ranks, ranks == 1 ? "" : "s");
}

} // namespace

SizeEstimate estimate_size(const Scene &scene) {
  SizeEstimate size;
  size.blocks = static_cast<double>(num_blocks(scene));
  if (scene.region_blocks && scene.num_region_blocks == 0) {
    size.blocks += scene.region_blocks->expected_blocks();
    size.seconds = scene.region_blocks->expected_seconds();
  }
  size.bytes = bytes_per_block * size.blocks;
  size.seconds += seconds_per_block * size.blocks;
  return size;
}

Machine survey_machine(const Communicator &communicator) {
  const double share = available_memory() / communicator.ranks_on_node();
  return {communicator.size(), -communicator.max(-share) * communicator.size()};
}

Diagnostics judge_size(const SizeEstimate &size, const Machine &machine, double copies) {
  Diagnostics found;
  constexpr double gigabyte = 1e9;
  constexpr double nearly_full = 0.8;
  const double bytes = copies * size.bytes;
  const std::string who =
      fmt::format("{}about {:.3g} blocks need at least {:.3g} GB of memory",
                  copies > 1.0 ? fmt::format("{:g} times ", copies) : "", size.blocks, bytes / gigabyte);
  const std::string why =
      fmt::format("{} can have {:.3g} GB here", ranks_text(machine.ranks), machine.memory / gigabyte);
  const std::string hint = "use fewer or larger blocks, or more machines";
  if (bytes > machine.memory) {
    found.push_back({Severity::error, {}, who, why, hint});
    return found;
  }
  if (bytes > nearly_full * machine.memory) {
    found.push_back({Severity::warning, {}, who, why, hint});
  }
  const double seconds = size.seconds * copies / machine.ranks;
  if (seconds > long_time) {
    found.push_back({Severity::warning,
                     {},
                     fmt::format("it takes about {} on {} to make the blocks and find their contacts",
                                 time_text(seconds), ranks_text(machine.ranks)),
                     fmt::format("there are about {:.3g} blocks", size.blocks),
                     "wait, use more ranks, or use larger spacings and blocks"});
  }
  return found;
}

Diagnostics judge_size(const Communicator &communicator, const Scene &scene, double copies) {
  constexpr double small = 1e8; // bytes: every machine has them
  const SizeEstimate size = estimate_size(scene);
  const bool is_small = copies * size.bytes < small && copies * size.seconds < long_time;
  return is_small ? Diagnostics() : judge_size(size, survey_machine(communicator), copies);
}

} // namespace gcpdda
