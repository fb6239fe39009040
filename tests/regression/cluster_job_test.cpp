// run/cluster/job.sh without SLURM: srun and scontrol are stubs on the PATH, the test is the scheduler.

#include "io/results/run_comparison.hpp"

#include "child_process.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <fmt/format.h>

namespace gcpdda::cluster_job_test {
namespace {

namespace fs = std::filesystem;
using testing::file_text;
using testing::Outcome;
using testing::Process;

class ClusterJob : public ::testing::Test {
protected:
  ClusterJob() {
    folder_.write("wall.toml", testing::mixed_wall_toml(12, 10, 0.02));
    fs::create_directory(folder_ / "bin");
    stub("srun",
         fmt::format("[ \"$1\" = --mpi=pmix ] && shift; exec {} -n 2 --oversubscribe --bind-to none \"$@\"",
                     GCPDDA_MPIEXEC));
    stub("scontrol", "echo \"$@\" >> requeued");
  }
  void stub(const std::string &name, const std::string &command) const {
    folder_.write("bin/" + name, "#!/bin/sh\n" + command + "\n");
    fs::permissions(folder_ / "bin" / name, fs::perms::owner_all);
  }
  [[nodiscard]] std::unique_ptr<Process> start(int restarts, const std::string &scene = "wall.toml",
                                               const std::string &out = "out") const {
    const std::vector<std::string> words{
        "bash", GCPDDA_SOURCE_DIR "/run/cluster/job.sh", scene, out, "--set", "output.interval=0.01"};
    std::vector<std::string> environment;
    environment.push_back(fmt::format("PATH={}:{}", (folder_ / "bin").string(), std::getenv("PATH")));
    environment.push_back(fmt::format("GCPDDA={}", GCPDDA_EXECUTABLE));
    environment.emplace_back("SLURM_JOB_ID=42");
    environment.push_back(fmt::format("SLURM_RESTART_COUNT={}", restarts));
    return std::make_unique<Process>(words, folder_.path(), environment);
  }
  [[nodiscard]] std::string requeued() const {
    return fs::exists(folder_ / "requeued") ? file_text(folder_ / "requeued") : "";
  }

  testing::WorkFolder folder_;
};

TEST_F(ClusterJob, StopsRequeuesAndGoesOn) {
  const auto first = start(0);
  first->wait_until([&] { return fs::exists(folder_ / "out/frames/frame_000000.hdf"); });
  kill(first->id(), SIGUSR1); // as --signal=B:USR1@300
  const Outcome stopped = first->wait();
  EXPECT_EQ(stopped.exit_code, 6) << stopped.err;
  EXPECT_EQ(requeued(), "requeue 42\n");

  const Outcome rest = start(1)->wait();
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_EQ(testing::count_of(rest.err, "restart from out/checkpoints/"), 1) << rest.err;
  EXPECT_EQ(requeued(), "requeue 42\n") << "a finished run is not requeued";
  const Outcome whole = testing::run_gcpdda(
      1, {"run", "wall.toml", "--out", "whole", "--set", "output.interval=0.01"}, folder_);
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_EQ(compare_runs(folder_ / "whole", folder_ / "out"), std::vector<std::string>());
}

// Requeued after a node was lost before the first checkpoint: from the beginning. On a first start what is
// there is kept.
TEST_F(ClusterJob, WithoutACheckpointBeginsAnewOnlyWhenRequeued) {
  folder_.write("wall.toml", testing::mixed_wall_toml(5, 5, 0.001));
  EXPECT_EQ(start(0)->wait().exit_code, 0);
  const std::string summary = file_text(folder_ / "out/summary.json");
  EXPECT_EQ(start(0)->wait().exit_code, 4);
  EXPECT_EQ(file_text(folder_ / "out/summary.json"), summary);
  EXPECT_EQ(start(1)->wait().exit_code, 0);
  EXPECT_EQ(requeued(), "");
}

// What the program is called with: pattern characters, blanks and dashes of a path mean themselves.
TEST_F(ClusterJob, TakesPathsLiterally) {
  stub("srun", "shift 2; printf '%s|' \"$@\" > called");
  const auto call = [&](const std::string &scene, const std::string &out) {
    EXPECT_EQ(start(1, scene, out)->wait().exit_code, 0);
    return file_text(folder_ / "called");
  };
  const std::string sets = "|--overwrite|--set|output.interval=0.01|";
  fs::create_directories(folder_ / "res1/checkpoints");
  folder_.write("res1/checkpoints/checkpoint_000000004.h5", "");
  EXPECT_EQ(call("a b.toml", "res1"), "restart|res1|");
  EXPECT_EQ(call("a b.toml", "res[1]"), "run|a b.toml|--out|res[1]" + sets) << "res1 is another folder";
  for (const std::string name : {"res[1]", "two words", "*", "-x", "line\nline"}) {
    fs::create_directories(folder_ / name / "checkpoints");
    folder_.write(name + "/checkpoints/checkpoint_000000004.h5", "");
    EXPECT_EQ(call("a b.toml", name), "restart|" + std::string(name[0] == '-' ? "./" : "") + name + "|");
  }
  EXPECT_EQ(call("-s.toml", "--"), "run|./-s.toml|--out|./--" + sets);
}

TEST_F(ClusterJob, DoesNotRepeatAFailure) {
  folder_.write("wall.toml", "[run]\n");
  EXPECT_EQ(start(0)->wait().exit_code, 3);
  EXPECT_EQ(requeued(), "");
  EXPECT_EQ(testing::run_program({"bash", GCPDDA_SOURCE_DIR "/run/cluster/job.sh"}, folder_.path()).exit_code,
            2);
}

} // namespace
} // namespace gcpdda::cluster_job_test
