#pragma once

// One scene run by all ranks and by one alone, which are to write the same bytes.

#include "driver/restart.hpp"
#include "gcpdda/driver/run.hpp"
#include "io/checkpoint/checkpoint_reader.hpp"
#include "io/results/run_comparison.hpp"
#include "shared_folder.hpp"
#include "support/run_facts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace gcpdda::testing {

/// Folders of one scene run by all ranks and by one alone, and whether they are the same.
class TwoRuns {
public:
  explicit TwoRuns(const Scene &scene, ExitCode expected = exit_code::done) : folder_(world_) {
    const CapturedLog log;
    EXPECT_EQ(run_scene(world_, scene, {together(), false}), expected) << "together";
    world_.barrier();
    if (world_.is_root()) {
      EXPECT_EQ(run_scene(Communicator::self(), scene, {alone(), false}), expected) << "alone";
      compare();
    }
    world_.barrier();
  }

  [[nodiscard]] const Communicator &world() const { return world_; }
  [[nodiscard]] std::filesystem::path together() const { return folder_.path("together"); }
  [[nodiscard]] std::filesystem::path alone() const { return folder_.path("alone"); }
  /// A counter of the run together, on every rank.
  [[nodiscard]] double counted(const std::string &key) const { return summary_number(together(), key); }

private:
  void compare() const {
    for (const std::string &difference : compare_runs(together(), alone())) {
      ADD_FAILURE() << difference;
    }
    for (const std::filesystem::path &checkpoint : checkpoint_files(alone())) {
      const std::filesystem::path other = together() / checkpoint.lexically_relative(alone());
      EXPECT_TRUE(file_text(checkpoint) == file_text(other)) << checkpoint.filename();
    }
    // These facts of the summary do not depend on the ranks either.
    for (const char *fact :
         {"blocks", "fixed_blocks", "steps", "time", "time_step", "contacts", "contact_steps", "max_overlap",
          "energy", "normals_undefined", "verdict", "message"}) {
      EXPECT_EQ(summary_text(together(), fact), summary_text(alone(), fact)) << fact;
    }
    EXPECT_EQ(summary_number(together(), "ranks"), world_.size());
    EXPECT_EQ(summary_number(alone(), "ranks"), 1);
    for (const char *crossing : {"cross_rank_contacts", "migrations", "messages_per_step"}) {
      EXPECT_EQ(summary_number(alone(), crossing), 0) << crossing;
    }
  }

  Communicator world_ = Communicator::world();
  SharedFolder folder_;
};

/// A restart from the last checkpoint but one, of the middle of the last stage, comes to the same results.
inline void expect_same_after_restart(const TwoRuns &runs, const Scene &scene,
                                      ExitCode expected = exit_code::done) {
  const SharedFolder folder(runs.world());
  if (runs.world().is_root()) {
    std::filesystem::copy(runs.alone(), folder.path("run"), std::filesystem::copy_options::recursive);
    const std::vector<std::filesystem::path> checkpoints = checkpoint_files(folder.path("run"));
    EXPECT_EQ(checkpoints.size(), 2U);
    std::filesystem::remove(std::max(checkpoints.front(), checkpoints.back()));
  }
  runs.world().barrier();
  const CapturedLog log;
  EXPECT_EQ(restart_scene(runs.world(), scene, scene, folder.path("run")), expected);
  runs.world().barrier();
  if (runs.world().is_root()) {
    for (const std::string &difference : compare_runs(folder.path("run"), runs.alone())) {
      ADD_FAILURE() << "restarted: " << difference;
    }
  }
}

} // namespace gcpdda::testing
