// Calls that fail before the first step: they say why, create nothing, lose nothing, and the same call works
// once its fault is mended.

#include "child_process.hpp"
#include "support/run_facts.hpp"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <ostream>
#include <sys/file.h>
#include <unistd.h>

namespace gcpdda::early_failures_test {
namespace {

namespace fs = std::filesystem;
using testing::count_of;
using testing::file_text;
using testing::listing;
using testing::Outcome;
using testing::run_gcpdda;
using testing::WorkFolder;

/// A block on a floor that settles at once; a cohesion that keeps it there, or not, is drawn for members.
const std::string scene = R"([run]
[material.rock]
density = 2500.0
[joint.default]
normal_stiffness = 1e8
friction_angle_deg = 30.0
[[block]]
name = "floor"
material = "rock"
vertices = [[-5, -1], [5, -1], [5, 0], [-5, 0]]
fixed = true
[[block]]
name = "a"
material = "rock"
vertices = [[0, 0], [1, 0], [1, 1], [0, 1]]
[[stage]]
kind = "settle"
limit = 2.0
[fos]
limit = 0.02
tolerance = 0.5
[ensemble]
count = 2
[[ensemble.vary]]
key = "joint.default.friction_angle_deg"
distribution = "uniform"
min = 29.0
max = 31.0
)";

/// The block sinks half of its height into the floor: only building the blocks finds it.
const std::string sunk = "block.a.vertices=[[0,-0.5],[1,-0.5],[1,0.5],[0,0.5]]";

struct Failure {
  const char *name;
  std::vector<std::string> arguments;
  int exit_code;
  const char *said; ///< once
};
std::ostream &operator<<(std::ostream &stream, const Failure &failure) {
  return stream << failure.name;
}

// clang-format off
const std::vector<Failure> failures{
    {"RunOfSunkenBlock", {"run", "s.toml", "--out", "o", "--set", sunk}, 3, "'a'"},
    {"FosOfSunkenBlock", {"fos", "s.toml", "--out", "o", "--set", sunk}, 3, "'a'"},
    {"EnsembleOfSunkenBlock", {"ensemble", "s.toml", "--out", "o", "--set", sunk}, 3, "'a'"},
    {"EnsembleOfFactorsOfSunkenBlock", {"ensemble", "s.toml", "--out", "o", "--set", "ensemble.measure=factor", "--set", sunk}, 3, "'a'"},
    {"FosOfNoScene", {"fos", "none.toml", "--out", "o"}, 4, "none.toml: error: cannot open the scene"},
    {"EnsembleOfNoScene", {"ensemble", "none.toml", "--out", "o"}, 4, "none.toml: error: cannot open the scene"},
    {"FosWithUnknownOption", {"fos", "s.toml", "--out", "o", "--bogus"}, 2, "--bogus"},
    {"EnsembleWithUnknownOption", {"ensemble", "s.toml", "--out", "o", "--bogus"}, 2, "--bogus"},
    {"FosWithBadSet", {"fos", "s.toml", "--out", "o", "--set", "fos.tolerance=-1"}, 3, "'tolerance' in [fos] is -1"},
    {"EnsembleWithBadSet", {"ensemble", "s.toml", "--out", "o", "--set", "ensemble.count=0"}, 3, "'count'"},
    {"RunIntoAFile", {"run", "s.toml", "--out", "s.toml"}, 4, "cannot"},
    {"FosBelowAFile", {"fos", "s.toml", "--out", "s.toml/o"}, 4, "cannot make the folder"},
    {"EnsembleBelowAFile", {"ensemble", "s.toml", "--out", "s.toml/o"}, 4, "cannot make the folder"},
    {"FosFromNoState", {"fos", "s.toml", "--out", "o", "--settled", "none"}, 4, "none/scene.toml: error: cannot open"},
    {"FosOfARun", {"fos", "s.toml", "--out", "run"}, 4, "holds a run already"},
    {"EnsembleOfARun", {"ensemble", "s.toml", "--out", "run"}, 4, "holds a run or a search already"},
    {"RunIntoASearch", {"run", "s.toml", "--out", "search"}, 4, "search holds a search for the factor of safety, choose another folder with --out\n"},
    {"RunIntoAnEnsemble", {"run", "s.toml", "--out", "members"}, 4, "members holds an ensemble, choose another folder with --out\n"},
    {"RunOverASearch", {"run", "s.toml", "--out", "search", "--overwrite"}, 4, "search holds a search for the factor of safety, choose another folder with --out\n"},
    {"FosIntoAnEnsemble", {"fos", "s.toml", "--out", "members", "--overwrite"}, 4, "members holds an ensemble already, choose another folder with --out\n"},
    {"EnsembleIntoASearch", {"ensemble", "s.toml", "--out", "search", "--overwrite"}, 4, "holds a run or a search already, choose another folder with --out\n"},
    {"FosOfARunAndASearch", {"fos", "s.toml", "--out", "both"}, 4, "both holds a run already, choose another folder with --out\n"},
    {"RestartOfNoFolder", {"restart", "none"}, 4, "none/scene.toml: error: cannot open the scene"},
    {"RestartOfAFile", {"restart", "s.toml"}, 4, "s.toml/scene.toml: error: cannot open the scene"},
    {"RestartOfASearch", {"restart", "search"}, 4, "search holds a search for the factor of safety, and a restart goes on with a run: repeat gcpdda fos with --out search --overwrite\n"},
    {"RestartOfAnEnsemble", {"restart", "members"}, 4, "members holds an ensemble, and a restart goes on with a run: repeat the call of gcpdda ensemble, which computes the members that are missing\n"},
};
// clang-format on

class EarlyFailure : public ::testing::TestWithParam<Failure> {};

TEST_P(EarlyFailure, LeavesNothing) {
  const WorkFolder folder;
  folder.write("s.toml", scene);
  fs::create_directory(folder / "run");
  folder.write("run/scene.toml", scene);
  for (const char *other : {"search/settled", "members/members", "both/settled"}) {
    fs::create_directories(folder / other);
  }
  folder.write("members/ensemble.toml", scene);
  folder.write("both/scene.toml", scene);
  const std::vector<std::string> before = listing(folder.path());
  const Outcome outcome = run_gcpdda(0, GetParam().arguments, folder);
  EXPECT_EQ(outcome.exit_code, GetParam().exit_code) << outcome.err;
  EXPECT_GE(count_of(outcome.err, GetParam().said), 1) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(listing(folder.path()), before) << "something was created or removed";
  EXPECT_EQ(file_text(folder / "s.toml"), scene);
}

INSTANTIATE_TEST_SUITE_P(Table, EarlyFailure, ::testing::ValuesIn(failures),
                         [](const auto &row) { return std::string(row.param.name); });

// On several ranks, which must all turn back.
TEST(EarlyFailures, AreMendedByTheCorrectedCall) {
  for (const char *command : {"fos", "ensemble"}) {
    const WorkFolder folder;
    folder.write("s.toml", scene);
    const std::vector<std::string> before = listing(folder.path());
    const Outcome refused = run_gcpdda(2, {command, "s.toml", "--set", sunk}, folder);
    EXPECT_EQ(refused.exit_code, 3) << refused.err;
    EXPECT_EQ(listing(folder.path()), before) << "something was created";
    const Outcome corrected = run_gcpdda(2, {command, "s.toml"}, folder);
    EXPECT_TRUE(corrected.exit_code == 0 || corrected.exit_code == 7) << corrected.err;
    const fs::path report =
        folder / "results" / (std::string("s_") + command) / (std::string(command) + ".txt");
    EXPECT_EQ(file_text(report), corrected.out);
    const std::vector<std::string> results = listing(folder.path());
    const Outcome again = run_gcpdda(2, {command, "s.toml", "--overwrite", "--set", sunk}, folder);
    EXPECT_EQ(again.exit_code, 3) << again.err;
    EXPECT_EQ(listing(folder.path()), results) << "results were removed for a scene that is refused";
    EXPECT_EQ(file_text(report), corrected.out);
  }
}

/// Holds the lock of a result folder as a run does.
class HeldFolder {
public:
  explicit HeldFolder(const fs::path &directory) {
    fs::create_directories(directory);
    descriptor_ = ::open((directory / "run.log").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    EXPECT_EQ(::flock(descriptor_, LOCK_EX | LOCK_NB), 0);
  }
  ~HeldFolder() { ::close(descriptor_); }
  HeldFolder(const HeldFolder &) = delete;
  HeldFolder &operator=(const HeldFolder &) = delete;

private:
  int descriptor_ = -1;
};

TEST(EarlyFailures, OfAFolderInUseChangeNothing) {
  const WorkFolder folder;
  folder.write("s.toml", scene);
  fs::create_directories(folder / "search/trials/F2");
  folder.write("search/trials/F2/scene.toml", scene);
  const HeldFolder run(folder / "run");
  const HeldFolder settled(folder / "search/settled");
  const std::vector<std::string> before = listing(folder.path());
  for (const auto &[command, out] : {std::pair("run", "run"), std::pair("fos", "search")}) {
    const Outcome outcome = run_gcpdda(0, {command, "s.toml", "--out", out, "--overwrite"}, folder);
    EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
    EXPECT_EQ(count_of(outcome.err, "is in use: another gcpdda runs in it"), 1) << outcome.err;
    EXPECT_EQ(listing(folder.path()), before) << command;
  }
}

} // namespace
} // namespace gcpdda::early_failures_test
