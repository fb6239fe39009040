// What is said of a search that has no state to begin from.

#include "driver/trial_facts.hpp"
#include "support/incline.hpp"

#include <gtest/gtest.h>

#include <string>

namespace gcpdda::testing::trial_words_test {
namespace {

std::string words(const std::string &motion) {
  const Scene scene = scene_of("[run]\nduration = 1.0\n[material.rock]\ndensity = 2600.0\n[joint.default]\n"
                               "normal_stiffness = 1e9\nfriction_angle_deg = 35.0\n" +
                               block_toml("ram", rectangle({0.0, 0.0}, {1.0, 1.0}), motion));
  return words_on_no_rest({}, scene);
}

// Where a block is driven without end no strength brings rest, and neither does more time.
TEST(TrialWords, NameABlockThatNeverStops) {
  for (const char *motion :
       {"velocity_table = [[0, 0, 0, 0], [0.1, 0.05, 0, 0]]", "prescribed_velocity = [0.05, 0.0, 0.0]"}) {
    EXPECT_NE(words(motion).find("block 'ram' moves by a given velocity that never ends"), std::string::npos)
        << motion;
  }
  for (const char *motion :
       {"velocity_table = [[0, 0.1, 0, 0], [0.1, 0, 0, 0]]", "velocity = [0.1, 0.0, 0.0]"}) {
    EXPECT_EQ(words(motion).find("'ram'"), std::string::npos) << motion;
  }
}

} // namespace
} // namespace gcpdda::testing::trial_words_test
