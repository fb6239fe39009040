// What is no file where a file is read: devices, pipes, sockets, folders and files of absurd size are refused
// with exit code 4 and a reason, at once, wherever a path of the user's is opened. A process that hangs is
// killed after two minutes and fails the test.

#include "child_process.hpp"
#include "support/run_facts.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

namespace gcpdda::no_file_test {
namespace {

namespace fs = std::filesystem;
using testing::count_of;
using testing::Outcome;
using testing::run_gcpdda;
using testing::run_program;
using testing::WorkFolder;

const std::string head = R"([run]
duration = 0.01
[material.rock]
density = 2500.0
[joint.default]
normal_stiffness = 1e8
)";

const std::string blocks = R"([[block]]
name = "floor"
material = "rock"
vertices = [[-5, -1], [5, -1], [5, 0], [-5, 0]]
fixed = true
[[block]]
name = "a"
material = "rock"
vertices = [[0, 0], [1, 0], [1, 1], [0, 1]]
)";

const std::string region = R"([region]
material = "rock"
polygon = [[0, 0], [4, 0], [4, 4], [0, 4]]
[[joint_map]]
file = "map.csv"
)";

/// A folder with one of each, and scenes that read a block file, a record and a map.
class NoFile : public ::testing::Test {
protected:
  struct Kind {
    std::string path;
    std::string reason;
  };

  NoFile() {
    folder_.write("plain.toml", head + blocks);
    folder_.write("blocks.toml", head + blocks + "[blocks]\nfile = \"blocks.h5\"\n");
    folder_.write("record.toml", head + blocks + "[earthquake]\nrecord = \"record.csv\"\n");
    folder_.write("map.toml", head + region);
    fs::create_directory(folder_ / "folder");
    EXPECT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    make_socket(folder_ / "socket");
    folder_.write("huge", "[run]\n");
    fs::resize_file(folder_ / "huge", std::uintmax_t{1} << 40U); // sparse
    before_ = testing::listing(folder_.path());
  }

  [[nodiscard]] std::vector<Kind> kinds() const {
    return {{"/dev/zero", "it is a device and no file"},
            {(folder_ / "pipe").string(), "it is a pipe and no file"},
            {(folder_ / "folder").string(), "it is a folder and no file"},
            {(folder_ / "socket").string(), "it is a socket and no file"}};
  }
  [[nodiscard]] Kind huge() const {
    return {(folder_ / "huge").string(), "it has 1099511627776 bytes and at most"};
  }

  void expect_refusal(const std::vector<std::string> &arguments, const Kind &kind, int ranks = 0) const {
    const Outcome outcome = run_gcpdda(ranks, arguments, folder_);
    EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
    EXPECT_EQ(count_of(outcome.err, kind.reason), 1)
        << arguments[0] << " " << kind.path << ": " << outcome.err;
    EXPECT_GE(count_of(outcome.err, kind.path), 1) << "names the path: " << outcome.err;
    EXPECT_EQ(testing::listing(folder_.path()), before_) << "something was created";
  }

  WorkFolder folder_;
  std::vector<std::string> before_;

private:
  static void make_socket(const fs::path &path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path.c_str(), sizeof(address.sun_path) - 1);
    const int descriptor = ::socket(AF_UNIX, SOCK_STREAM, 0);
    EXPECT_EQ(::bind(descriptor, reinterpret_cast<const sockaddr *>(&address), sizeof(address)), 0);
    ::close(descriptor);
  }
};

TEST_F(NoFile, AsAScene) {
  for (const Kind &kind : kinds()) {
    expect_refusal({"run", kind.path, "--out", "o"}, kind);
  }
  expect_refusal({"run", huge().path, "--out", "o"}, huge());
  for (const char *command : {"inspect", "blocks", "fos", "ensemble"}) {
    expect_refusal({command, kinds()[1].path}, kinds()[1]);
  }
}

TEST_F(NoFile, AsAJointMap) {
  for (const Kind &kind : kinds()) {
    expect_refusal({"blocks", "map.toml", "--set", "joint_map=[{file='" + kind.path + "'}]"}, kind);
  }
  expect_refusal({"run", "map.toml", "--out", "o", "--set", "joint_map=[{file='" + huge().path + "'}]"},
                 huge());
}

TEST_F(NoFile, AsARecord) {
  for (const Kind &kind : kinds()) {
    expect_refusal({"run", "record.toml", "--out", "o", "--set", "earthquake.record=" + kind.path}, kind);
  }
  expect_refusal({"inspect", "record.toml", "--set", "earthquake.record=" + huge().path}, huge());
}

TEST_F(NoFile, AsABlockFile) {
  for (const Kind &kind : kinds()) {
    expect_refusal({"run", "blocks.toml", "--out", "o", "--set", "blocks.file=" + kind.path}, kind);
  }
  const Outcome outcome =
      run_gcpdda(0, {"run", "blocks.toml", "--set", "blocks.file=" + huge().path}, folder_);
  EXPECT_EQ(outcome.exit_code, 3) << "HDF5 reads no more than it needs of a file of any size: "
                                  << outcome.err;
  EXPECT_EQ(count_of(outcome.err, "this is no HDF5 file"), 1) << outcome.err;
}

TEST_F(NoFile, OnSeveralRanks) {
  const Kind pipe = kinds()[1];
  expect_refusal({"run", pipe.path, "--out", "o"}, pipe, 3);
  expect_refusal({"run", "record.toml", "--out", "o", "--set", "earthquake.record=" + pipe.path}, pipe, 3);
  expect_refusal({"run", "blocks.toml", "--out", "o", "--set", "blocks.file=" + pipe.path}, pipe, 3);
}

TEST_F(NoFile, AsAResultFolder) {
  const std::string cannot_open = "/scene.toml: error: cannot open";
  for (Kind kind : kinds()) {
    kind.reason = cannot_open;
    expect_refusal({"restart", kind.path}, kind);
    expect_refusal({"fos", "plain.toml", "--out", "o", "--settled", kind.path}, kind);
  }
}

// What a run reads of its own folder may not be a pipe either.
TEST_F(NoFile, InsideAResultFolder) {
  const Outcome whole = run_gcpdda(0,
                                   {"run", "plain.toml", "--out", "o", "--set",
                                    "output.checkpoint_interval=0.005", "--set", "output.interval=0.005"},
                                   folder_);
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  std::vector<fs::path> checkpoints;
  for (const fs::directory_entry &entry : fs::directory_iterator(folder_ / "o/checkpoints")) {
    checkpoints.push_back(entry.path());
  }
  for (const fs::path &path : checkpoints) {
    fs::remove(path);
    ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  }
  const Outcome restarted = run_gcpdda(0, {"restart", "o"}, folder_);
  EXPECT_EQ(restarted.exit_code, 4) << restarted.err;
  EXPECT_EQ(count_of(restarted.err, "it is a pipe and no file"), static_cast<int>(checkpoints.size()))
      << restarted.err;
  ASSERT_EQ(::mkfifo((folder_ / "o/history/mine.csv").c_str(), 0600), 0);
  const Outcome replaced = run_gcpdda(0, {"run", "plain.toml", "--out", "o", "--overwrite"}, folder_);
  EXPECT_EQ(replaced.exit_code, 0) << replaced.err;
  EXPECT_TRUE(fs::exists(folder_ / "o/history/mine.csv")) << "no file of ours";
  fs::remove(folder_ / "o/scene.toml");
  ASSERT_EQ(::mkfifo((folder_ / "o/scene.toml").c_str(), 0600), 0);
  const Outcome unread = run_gcpdda(0, {"restart", "o"}, folder_);
  EXPECT_EQ(unread.exit_code, 4) << unread.err;
  EXPECT_EQ(count_of(unread.err, "o/scene.toml: error: cannot open the scene, it is a pipe and no file"), 1)
      << unread.err;
}

// A block file does not take the place of a device.
TEST_F(NoFile, IsWrittenOver) {
  folder_.write("map.csv", "a,1,-1\na,2,5\n");
  for (const std::string &path : {kinds()[1].path, kinds()[2].path}) {
    const Outcome outcome = run_gcpdda(0, {"blocks", "map.toml", "--out", path}, folder_);
    EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
    EXPECT_EQ(count_of(outcome.err, "there is something of this name that is no file"), 1) << outcome.err;
  }
  EXPECT_TRUE(fs::is_fifo(folder_ / "pipe"));
}

TEST_F(NoFile, AsTheCellsOfAPartition) {
  const fs::path program = fs::path(GCPDDA_EXECUTABLE).parent_path() / "gcpdda-partition";
  std::vector<Kind> all = kinds();
  all.push_back(huge());
  for (const Kind &kind : all) {
    const Outcome outcome = run_program({program.string(), kind.path, "--parts", "2"}, folder_.path());
    EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
    EXPECT_EQ(count_of(outcome.err, kind.reason), 1) << outcome.err;
  }
}

} // namespace
} // namespace gcpdda::no_file_test
