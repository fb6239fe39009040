// A checkpoint has the same bytes on any number of ranks, and any number goes on from it to the same files.

#include "gcpdda/io/run_comparison.hpp"
#include "gcpdda/simulation/restart.hpp"
#include "gcpdda/simulation/run.hpp"
#include "gcpdda/simulation/stop_signal.hpp"
#include "shared_folder.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>

namespace gcpdda {
namespace {

namespace fs = std::filesystem;
using testing::file_text;
using testing::summary_number;
using testing::summary_text;

std::vector<fs::path> checkpoints(const fs::path &run) {
  std::vector<fs::path> found;
  for (const fs::directory_entry &entry : fs::directory_iterator(run / "checkpoints")) {
    found.push_back(entry.path().filename());
  }
  std::sort(found.begin(), found.end());
  return found;
}

class Checkpoints : public ::testing::Test {
protected:
  /// Every block of it remembers something: contacts that stick and slide, strains, loads, fixed points, a
  /// velocity table; checkpoints in the middle and at the end.
  Checkpoints()
      : folder_(world_),
        scene_(testing::scene_of(testing::mixed_wall_toml(12, 8, 0.012),
                                 {"output.checkpoint_interval=0.006", "run.gravity_ramp=0.02",
                                  "block.l3_3.load=[{point=[7, 3.2], force=[1e5, -1e5]}]",
                                  "block.l5_1.fixed_points=[[2.6, 5.2]]",
                                  "block.b2_2.fixed_points=[[5.6, 2.8]]", "run.local_damping=0.1"})) {}

  int run(const Communicator &ranks, const std::string &name) const {
    return run_scene(ranks, scene_, {folder_.path(name), false, false});
  }
  int restart(const Communicator &ranks, const std::string &name) const {
    return restart_scene(ranks, scene_, scene_, folder_.path(name));
  }
  /// Back to the checkpoint in the middle, in a copy. Root only.
  void undo_half(const std::string &name, const std::string &copy) const {
    fs::copy(folder_.path(name), folder_.path(copy), fs::copy_options::recursive);
    fs::remove(folder_.path(copy) / "checkpoints" / checkpoints(folder_.path(copy)).back());
  }
  void expect_same(const std::string &a, const std::string &b) const {
    EXPECT_EQ(compare_runs(folder_.path(a), folder_.path(b)), std::vector<std::string>())
        << a << " and " << b;
    ASSERT_EQ(checkpoints(folder_.path(a)), checkpoints(folder_.path(b)));
    for (const fs::path &name : checkpoints(folder_.path(a))) {
      EXPECT_EQ(file_text(folder_.path(a) / "checkpoints" / name) ==
                    file_text(folder_.path(b) / "checkpoints" / name),
                true)
          << name << " of " << a << " and " << b;
    }
  }

  Communicator world_ = Communicator::world();
  testing::SharedFolder folder_;
  testing::CapturedLog log_;
  Scene scene_;
};

TEST_F(Checkpoints, AreTheSameAndGoOnToTheSameOnAnyNumberOfRanks) {
  EXPECT_EQ(run(world_, "together"), 0);
  if (world_.is_root()) {
    EXPECT_EQ(run(Communicator::self(), "alone"), 0);
    expect_same("together", "alone");
    undo_half("alone", "one_to_many");
    undo_half("together", "many_to_one");
  }
  world_.barrier();
  EXPECT_EQ(restart(world_, "one_to_many"), 0);
  world_.barrier();
  if (world_.is_root()) {
    expect_same("alone", "one_to_many");
    EXPECT_EQ(restart(Communicator::self(), "many_to_one"), 0);
    expect_same("alone", "many_to_one");
    for (const char *name : {"one_to_many", "many_to_one"}) {
      for (const char *fact : {"steps", "time", "contacts", "contact_steps", "max_overlap", "energy"}) {
        EXPECT_EQ(summary_text(folder_.path(name), fact), summary_text(folder_.path("alone"), fact)) << fact;
      }
    }
    EXPECT_GE(summary_number(folder_.path("alone"), "contacts"), 100);
    EXPECT_GE(summary_number(folder_.path("together"), "refreshes"), 1);
    if (world_.size() > 1) {
      EXPECT_GE(summary_number(folder_.path("one_to_many"), "cross_rank_contacts"), 20);
    }
  }
  world_.barrier();
}

// One rank hears the signal, all stop after the same step; nobody writes what a run to the end would not.
TEST_F(Checkpoints, OfASignalToOneRank) {
  catch_stop_signal();
  if (world_.rank() == world_.size() - 1) {
    std::raise(SIGUSR1);
  }
  EXPECT_EQ(run(world_, "stopped"), 6);
  world_.barrier();
  EXPECT_EQ(summary_text(folder_.path("stopped"), "verdict"), "\"stopped\"");
  EXPECT_EQ(summary_number(folder_.path("stopped"), "steps"), 1);
  EXPECT_EQ(checkpoints(folder_.path("stopped")), std::vector<fs::path>{"checkpoint_000000001.h5"});
  world_.barrier();
  EXPECT_EQ(restart(world_, "stopped"), 0);
  world_.barrier();
  if (world_.is_root()) {
    EXPECT_EQ(run(Communicator::self(), "whole"), 0);
    expect_same("stopped", "whole");
  }
  world_.barrier();
}

} // namespace
} // namespace gcpdda
