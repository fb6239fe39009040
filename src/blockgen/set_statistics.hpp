#pragma once

// What the joint sets of a region have drawn, beside what the scene asks of them.

#include "gcpdda/model/rock_region.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace gcpdda::blockgen {

struct SetStatistics {
  JointSetMeasures asked;
  JointSetMeasures drawn;
  bool is_drawn = false;    ///< false: so many joints that they have not been counted
  std::int64_t lines = 0;   ///< lines of joints that cross the region
  std::int64_t joints = 0;  ///< joints with a part in the region
  std::int64_t lengths = 0; ///< joints whose middle lies in the region: the mean trace length is theirs
};

/// One element a set. Sets of more than a million joints are not drawn for this.
std::vector<SetStatistics> set_statistics(const RockRegion &region);

/// Name of a set without what labels it in messages.
std::string bare_name(const JointSet &set);

/// The lines of a report, one string a line, empty where the region has no joint sets.
std::vector<std::string> words_on_sets(const RockRegion &region,
                                       const std::vector<SetStatistics> &statistics);

/// The same numbers as a JSON array.
std::string json_of_sets(const RockRegion &region, const std::vector<SetStatistics> &statistics);

} // namespace gcpdda::blockgen
