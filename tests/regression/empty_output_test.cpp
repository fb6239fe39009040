// Files that would be empty are not written: the next program could not know that they should not be.

#include "child_process.hpp"
#include "sample_scenes.hpp"
#include "support/run_facts.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fmt/format.h>

namespace gcpdda::empty_output_test {
namespace {

namespace fs = std::filesystem;
using testing::count_of;
using testing::file_text;
using testing::Outcome;
using testing::run_gcpdda;
using testing::run_program;
using testing::WorkFolder;

TEST(BlockFile, WithoutBlocksIsNotWritten) {
  const WorkFolder folder;
  folder.write("scene.toml",
               testing::head_scene(1e8, 1e-3, 0.1) +
                   "[region]\nmaterial = \"rock\"\npolygon = [[0,0],[4,0],[4,4],[0,4]]\n[[opening]]\n"
                   "name = \"all\"\nshape = \"polygon\"\npolygon = [[-1,-1],[5,-1],[5,5],[-1,5]]\n"
                   "excavated = true\n");
  for (const int ranks : {0, 2}) {
    const Outcome outcome = run_gcpdda(ranks, {"blocks", "scene.toml", "--out", "none.h5"}, folder);
    EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
    EXPECT_EQ(count_of(outcome.err, "none.h5: error: there are no blocks to write"), 1) << outcome.err;
    EXPECT_FALSE(fs::exists(folder / "none.h5"));
  }
}

/// The converter with a stub of ogr2ogr that writes this.
Outcome converted(const WorkFolder &folder, const std::string &geojson,
                  const std::vector<std::string> &layer = {}) {
  folder.write("written", geojson);
  folder.write("ogr2ogr", "#!/bin/sh\necho \"$@\" > " + (folder / "call").string() + "\ncp " +
                              (folder / "written").string() + " \"$3\"\n");
  fs::permissions(folder / "ogr2ogr", fs::perms::owner_all);
  std::vector<std::string> words{"sh", GCPDDA_SOURCE_DIR "/run/dxf_to_geojson.sh", "in.dxf", "out.geojson"};
  words.insert(words.end(), layer.begin(), layer.end());
  return run_program(words, folder.path(),
                     {fmt::format("PATH={}:{}", folder.path().string(), std::getenv("PATH"))});
}

TEST(DxfConverter, RefusesALayerWithoutLines) {
  const WorkFolder folder;
  folder.write("out.geojson", "of yesterday");
  const Outcome empty =
      converted(folder, "{\"type\": \"FeatureCollection\", \"features\": [\n]}\n", {"miner's joints"});
  EXPECT_EQ(empty.exit_code, 4);
  EXPECT_EQ(count_of(empty.err, "in.dxf: error: no line in the layer miner's joints of the drawing"), 1)
      << empty.err;
  EXPECT_EQ(file_text(folder / "out.geojson"), "of yesterday");
  EXPECT_EQ(count_of(file_text(folder / "call"), "Layer = 'miner''s joints'"), 1)
      << file_text(folder / "call");
  const std::string lines =
      "{\"features\": [{\"geometry\": {\"type\": \"LineString\", \"coordinates\": [[0, 0], [1, 1]]}}]}\n";
  const Outcome sound = converted(folder, lines);
  EXPECT_EQ(sound.exit_code, 0) << sound.err;
  EXPECT_EQ(file_text(folder / "out.geojson"), lines);
}

TEST(Converters, RefuseWhatWouldBeEmpty) {
  const WorkFolder folder;
  const std::vector<std::vector<std::string>> calls{
      {"make_record.py", "--out", "out", "--duration", "0"},
      {"make_record.py", "--out", "out", "--interval", "9"},
      {"make_record.py", "--out", "out", "--peak", "nan"},
      {"make_blocks.py", "out", "--rows", "0"},
      {"make_blocks.py", "out", "--size", "0", "1"},
      {"make_blocks.py", "out", "--overlap", "7"},
  };
  for (const std::vector<std::string> &call : calls) {
    std::vector<std::string> words{"/usr/bin/python3", std::string(GCPDDA_SOURCE_DIR "/run/") + call[0]};
    words.insert(words.end(), call.begin() + 1, call.end());
    const Outcome outcome = run_program(words, folder.path());
    EXPECT_EQ(outcome.exit_code, 2) << fmt::format("{} {}: {}", call[0], call.back(), outcome.err);
    EXPECT_EQ(count_of(outcome.err, ": error: "), 1) << outcome.err;
    EXPECT_FALSE(fs::exists(folder / "out"));
  }
}

} // namespace
} // namespace gcpdda::empty_output_test
