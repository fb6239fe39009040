// Bad calls of the program as a table: command lines, scenes and block files, with the exact words a person
// reads and the exit code; a few of them on several ranks. What a block file may not hold is in
// parallel/block_file_test.cpp.

#include "bad_input.hpp"
#include "child_process.hpp"
#include "support/block_file_writer.hpp"
#include "support/run_facts.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

namespace gcpdda::bad_call_test {
namespace {

using testing::BlockFileWriter;
using testing::listing;
using testing::Outcome;
using testing::run_gcpdda;
using testing::scene_text;
using testing::WorkFolder;

/// Three squares far above the other blocks.
BlockFileWriter good_block_file() {
  std::vector<SceneBlock> blocks(3);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const double x = 2.0 * static_cast<double>(i);
    blocks[i].vertices = {{x, 100}, {x + 1, 100}, {x + 1, 101}, {x, 101}};
  }
  return BlockFileWriter(blocks);
}

/// A call of the program in a folder that holds s.toml, blocks.h5 and what the row adds.
struct BadCall {
  const char *name;
  std::vector<std::string> arguments;
  int exit_code;
  std::vector<std::string> expected; ///< all lines of standard error
  std::function<void(const WorkFolder &)> prepare = [](const WorkFolder &) {};
};

std::ostream &operator<<(std::ostream &stream, const BadCall &call) {
  return stream << call.name;
}

void spoil(const WorkFolder &folder, const std::function<void(BlockFileWriter &)> &change) {
  BlockFileWriter writer = good_block_file();
  change(writer);
  writer.write(folder / "blocks.h5");
}

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
const std::string help = "Run with --help for more information.";
const std::string no_scene =
    ": error: cannot open the scene, no such file or no right to read it, check the path";

const std::string many_faults = R"([run]
duration = 2.0
local_damping = 2
[material.granite]
density = 2600.0
[joint.default]
normal_stiffness = 1e9
[[block]]
name = "floor"
material = "granit"
vertices = [[0, 0], [1, 1], [1, 0], [0, 1]]
fixed = true
fixed_points = [[0, 0]]
[[wall]]
material = "granite"
origin = [0, 0]
rows = 2.5
columns = 4
block_size = [1, -1]
[blocks]
flie = "blocks.h5"
[[monitor]]
point = [0, 0]
)";

// clang-format off
const std::vector<std::string> words_of_many_faults{
    "s.toml:3:17: error: 'local_damping' in [run] is 2, it must be at least 0 and below 1, for example local_damping = 0.0",
    "s.toml:10:12: error: no material is named 'granit', did you mean 'granite'?",
    "s.toml:11:12: error: block 'floor' crosses itself, two of its edges meet away from a common vertex, list the vertices in order around the block",
    "s.toml:13:16: error: block 'floor' is fixed but has fixed_points, all of it is held, leave one of fixed and fixed_points out",
    "s.toml:17:8: error: 'rows' in wall 'wall0' is 2.5, it must be an integer, for example rows = 10",
    "s.toml:19:18: error: entry 1 of 'block_size' in wall 'wall0' is -1, it must be above 0 and at most 1e+09, for example block_size = [0.4, 0.2]",
    "s.toml:20:1: error: 'file' in [blocks] is missing, it is required, for example file = \"blocks.h5\"",
    "s.toml:21:1: error: unknown key 'flie' in [blocks], did you mean 'file'?",
    "s.toml:22:1: error: 'name' in [[monitor]] is missing, a monitored point has name and point, for example name = \"roof\""};

const BadCall call_with_many_faults{"ManyFaults", {"run", "s.toml"}, 3, words_of_many_faults,
    [](const WorkFolder &folder) { folder.write("s.toml", many_faults); }};
const BadCall call_with_bad_blocks{"BadBlocks", {"run", "s.toml"}, 3,
     {"blocks.h5: error: block 0: material is 2, the scene has materials 0 to 1, in the order of its file, give one of these numbers",
      "blocks.h5: error: block 1: fixed is 7, it must be 0 or 1, write 1 for a block that never moves",
      "blocks.h5: error: block 1: x of vertex 2 is nan, it must be finite, check where the file is written",
      "blocks.h5: error: block 2: the outline crosses itself, two of its edges meet away from a common vertex, list the vertices in order around the block"},
     [](const WorkFolder &folder) {
       spoil(folder, [](BlockFileWriter &f) {
         f.put("material", 0, std::int32_t{2});
         f.put("fixed", 1, std::uint8_t{7});
         f.put("points", 2 * 6, nan);
         f.put("points", 2 * 10, 4.0);
         f.put("points", 2 * 11, 5.0);
       });
     }};
const BadCall call_without_scene{"NoScene", {"run", "nowhere.toml"}, 4, {"nowhere.toml" + no_scene}};
const BadCall call_with_unknown_option{"UnknownOption", {"run", "s.toml", "--bogus"}, 2, {"The following argument was not expected: --bogus", help}};

const std::vector<BadCall> bad_calls{
    call_with_many_faults,
    call_with_bad_blocks,
    call_without_scene,
    call_with_unknown_option,
    {"NoSubcommand", {}, 2, {"A subcommand is required", help}},
    {"UnknownSubcommand", {"walk", "s.toml"}, 2, {"A subcommand is required", help}},
    {"RunWithoutScene", {"run"}, 2, {"SCENE is required", help}},
    {"InspectWithoutScene", {"inspect"}, 2, {"SCENE is required", help}},
    {"TwoScenes", {"run", "s.toml", "t.toml"}, 2, {"The following argument was not expected: t.toml", help}},
    {"SetWithoutValue", {"run", "s.toml", "--set"}, 2, {"--set: 1 required TEXT missing", help}},
    {"OutWithoutValue", {"run", "s.toml", "--out"}, 2, {"--out: 1 required TEXT missing", help}},
    {"InspectNoScene", {"inspect", "nowhere.toml"}, 4, {"nowhere.toml" + no_scene}},
    {"FolderAsScene", {"run", "folder"}, 4, {"folder: error: cannot open the scene, it is a folder and no file, check the path"}, [](const WorkFolder &folder) { std::filesystem::create_directory(folder / "folder"); }},
    {"SetOutOfRange", {"run", "s.toml", "--set", "run.duration=-1"}, 3,
     {"--set run.duration=-1: error: 'duration' in [run] is -1, it must be above 0 and at most 1e+12, for example duration = 2.0"}},
    {"SetOfWall", {"inspect", "s.toml", "--set", "wall.v.rows=5", "--set", "wall.w.rows=0.5"}, 3,
     {"--set wall.v.rows=5: error: no wall is named 'v', unnamed walls are wall<n>, from 0 in file order",
      "--set wall.w.rows=0.5: error: 'rows' in wall 'w' is 0.5, it must be at least 1 and at most 1e+06, for example rows = 10"}},
    {"EmptyScene", {"run", "empty.toml"}, 3,
     {"empty.toml:1:1: error: 'run' is missing, it is required, write [run]",
      "empty.toml:1:1: error: 'material' is missing, it is required, write [material.granite]",
      "empty.toml:1:1: error: 'joint' is missing, it is required, write [joint.default]",
      "empty.toml:1:1: error: the scene has no blocks, at least one block, wall, pyramid, block file or region is required, write [[block]], [[wall]], [[pyramid]], [blocks] or [region]"},
     [](const WorkFolder &folder) { folder.write("empty.toml", ""); }},
    {"NoBlockFile", {"run", "s.toml", "--set", "blocks.file=sub/nowhere.h5"}, 3,
     {"--set blocks.file=sub/nowhere.h5: error: cannot open the block file 'sub/nowhere.h5', no such file or no right to read it, check the path, which starts from the folder of the scene"}},
    {"TextAsBlockFile", {"run", "s.toml", "--set", "blocks.file=s.toml"}, 3,
     {"s.toml: error: this is no HDF5 file, [blocks] file names one, check the path or write the blocks as HDF5"}},
    {"BlockFileOfTheFolderOfTheScene", {"run", "sub/t.toml"}, 3,
     {"sub/t.toml:33:8: error: cannot open the block file 'sub/blocks.h5', no such file or no right to read it, check the path, which starts from the folder of the scene"},
     [](const WorkFolder &folder) { std::filesystem::create_directory(folder / "sub"); folder.write("sub/t.toml", scene_text()); }},
    {"BlockFileWithoutDatasets", {"inspect", "s.toml"}, 3,
     {"blocks.h5: error: '/points' is missing, it must hold 64-bit reals (n, 2), did you mean it by '/point'?",
      "blocks.h5: error: '/fixed' is missing, it must hold unsigned 8-bit integers (nb), write it"},
     [](const WorkFolder &folder) { spoil(folder, [](BlockFileWriter &f) { f.rename("points", "point"); f.remove("fixed"); }); }},
    {"BlockFileTooShortForAMonitor", {"run", "s.toml", "--set", "monitor=[{block = 'b46'}]"}, 3,
     {"--set monitor=[{block = 'b46'}]: error: no block is named 'b46', those of blocks.h5 are b43 to b45, name one of these"}},
};
// clang-format on

/// Exit code, words, and nothing created.
void expect_refusal(const BadCall &call, int ranks) {
  const WorkFolder folder;
  folder.write("s.toml", scene_text());
  good_block_file().write(folder / "blocks.h5");
  call.prepare(folder);
  const std::vector<std::string> before = listing(folder.path());
  const Outcome outcome = run_gcpdda(ranks, call.arguments, folder);
  EXPECT_EQ(outcome.exit_code, call.exit_code) << outcome.err;
  std::string expected;
  for (const std::string &line : call.expected) {
    expected += line + "\n";
  }
  EXPECT_EQ(outcome.err, expected);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(listing(folder.path()), before) << "something was created";
}

class BadInputCall : public ::testing::TestWithParam<BadCall> {};

TEST_P(BadInputCall, EndsWithTheseWordsAndThisExitCode) {
  expect_refusal(GetParam(), 0);
}

INSTANTIATE_TEST_SUITE_P(Table, BadInputCall, ::testing::ValuesIn(bad_calls),
                         [](const auto &call) { return std::string(call.param.name); });

class BadInputOnRanks : public ::testing::TestWithParam<int> {};

TEST_P(BadInputOnRanks, IsRefusedWithOneVoice) {
  for (const BadCall &call :
       {call_with_many_faults, call_with_bad_blocks, call_without_scene, call_with_unknown_option}) {
    SCOPED_TRACE(call.name);
    expect_refusal(call, GetParam());
  }
}

INSTANTIATE_TEST_SUITE_P(Table, BadInputOnRanks, ::testing::Values(1, 4),
                         [](const auto &ranks) { return "ranks" + std::to_string(ranks.param); });

} // namespace
} // namespace gcpdda::bad_call_test
