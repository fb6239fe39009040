#include "base/check.hpp"
#include "blockgen/joint_map.hpp"
#include "blockgen/region_cutter.hpp"

#include <gtest/gtest.h>

namespace gcpdda::joint_map_test {
namespace {

std::vector<std::string> texts(const Diagnostics &diagnostics) {
  std::vector<std::string> result;
  for (const Diagnostic &d : diagnostics) {
    result.push_back(to_string(d));
  }
  return result;
}

using Lines = std::vector<std::vector<Vec2>>;

TEST(JointMap, CsvHoldsTracesOneAfterTheOther) {
  const JointMapReading reading = read_joint_map(
      "trace,x,y\n# mapped on foot\na, 0, 1.5\r\na,2,3e0\n\nb,1,1\nb,2,2\nb,3,1\na,9,9\na,8,8\n", "m.csv");
  EXPECT_EQ(texts(reading.faults), std::vector<std::string>());
  EXPECT_EQ(
      reading.lines,
      (Lines{{{0.0, 1.5}, {2.0, 3.0}}, {{1.0, 1.0}, {2.0, 2.0}, {3.0, 1.0}}, {{9.0, 9.0}, {8.0, 8.0}}}));
}

TEST(JointMap, EveryFaultOfACsvHasItsPlace) {
  const JointMapReading reading = read_joint_map("a,0,0\na,1,one\nb,5,5\nc,1\nd,nan,1\nd,2,2\n", "m.csv");
  EXPECT_EQ(texts(reading.faults),
            (std::vector<std::string>{
                "m.csv:2:5: error: 'one' is no coordinate, y is a number of at most 1e+09 m, mend the file",
                "m.csv:4:1: error: a row with 2 fields, a row is trace,x,y, mend the file",
                "m.csv:5:3: error: 'nan' is no coordinate, x is a number of at most 1e+09 m, mend the file",
                "m.csv:3:1: error: trace 'b' has one row, a trace has at least two rows, one after the "
                "other, mend the file"}));
}

TEST(JointMap, AnEmptyCsvIsAFault) {
  EXPECT_EQ(texts(read_joint_map("trace,x,y\n", "m.csv").faults),
            (std::vector<std::string>{"m.csv:1:1: error: no trace in the file, a trace has at least two rows "
                                      "trace,x,y, mend the file"}));
}

TEST(JointMap, GeoJsonHoldsLinesInFeatures) {
  const JointMapReading reading = read_joint_map(R"({"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {"set": 1}, "geometry": {"type": "LineString", "coordinates": [[0, 1], [2, 3.5]]}},
    {"type": "Feature", "properties": {}, "geometry":
      {"type": "MultiLineString", "coordinates": [[[1, 1], [2, 2], [3, 1]], [[9, 9], [8, 8]]]}}]})",
                                                 "m.geojson");
  EXPECT_EQ(texts(reading.faults), std::vector<std::string>());
  EXPECT_EQ(
      reading.lines,
      (Lines{{{0.0, 1.0}, {2.0, 3.5}}, {{1.0, 1.0}, {2.0, 2.0}, {3.0, 1.0}}, {{9.0, 9.0}, {8.0, 8.0}}}));
}

// RFC 7946 allows both; sections are plane.
TEST(JointMap, HeightsAndFeaturesWithoutGeometryAreLeftOut) {
  const JointMapReading reading = read_joint_map(R"({"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {"no \"geometry\"": null, "list": [1, 2, 3]}, "geometry" : null},
    {"type": "Feature", "properties": null, "geometry":
      {"type": "LineString", "coordinates": [[0, 1, 105.5], [2, 3.5, -1e2], [4, 4.5]]}},
    {"type": "Feature", "properties": null, "geometry":
      {"type": "MultiLineString", "coordinates": [[[1, 1, 7, 8], [2, 2, 7,
        8]], [[9, 9, 0], [8, 8, 0]]]}}]})",
                                                 "m.geojson");
  EXPECT_EQ(texts(reading.faults), std::vector<std::string>());
  EXPECT_EQ(
      reading.lines,
      (Lines{{{0.0, 1.0}, {2.0, 3.5}, {4.0, 4.5}}, {{1.0, 1.0}, {2.0, 2.0}}, {{9.0, 9.0}, {8.0, 8.0}}}));
}

TEST(JointMap, ExtensionsMayHaveCapitals) {
  const char *text = R"({"type": "LineString", "coordinates": [[0, 1], [2, 3.5]]})";
  for (const char *path : {"m.GEOJSON", "m.GeoJSON", "m.JSON"}) {
    EXPECT_EQ(read_joint_map(text, path).lines, (Lines{{{0.0, 1.0}, {2.0, 3.5}}})) << path;
  }
}

TEST(JointMap, BrokenGeoJsonHasAPlace) {
  const JointMapReading reading =
      read_joint_map("{\"type\": \"LineString\",\n  \"coordinates\": [[0, 1], [2 3]]}", "m.geojson");
  ASSERT_EQ(reading.faults.size(), 1U);
  EXPECT_EQ(reading.faults[0].where.line, 2);
  EXPECT_NEAR(reading.faults[0].where.column, 31, 2); // the parser names the end of what it could not use
  EXPECT_EQ(reading.faults[0].what, "not valid GeoJSON");
  // A height moves nothing.
  const JointMapReading high =
      read_joint_map("{\"type\": \"LineString\",\n  \"coordinates\": [[0, 1, 5], [2 3]]}", "m.geojson");
  ASSERT_EQ(high.faults.size(), 1U);
  EXPECT_EQ(high.faults[0].where.line, 2);
  EXPECT_EQ(high.faults[0].where.column, reading.faults[0].where.column + 3);
}

TEST(JointMap, GeoJsonWithoutLinesIsAFault) {
  EXPECT_EQ(read_joint_map(R"({"type": "Point", "coordinates": [0, 1]})", "m.geojson").faults.size(), 1U);
}

TEST(JointMap, OfOneColumnIsAFault) {
  EXPECT_EQ(texts(read_joint_map("x\n1.5\n2.5\n", "m.csv").faults).at(0),
            "m.csv:1:1: error: a row with 1 field, a row is trace,x,y, mend the file");
}

// What cuts nothing because nobody has read it must not pass for rock without joints.
TEST(JointMap, IsReadBeforeItCuts) {
  Scene scene;
  scene.region.outline = {{0.0, 0.0}, {4.0, 0.0}, {4.0, 4.0}};
  scene.region.maps.resize(1);
  EXPECT_THROW(RegionCutter{scene}, InternalError);
  scene.region.maps[0].lines = {{{0.0, 1.0}, {4.0, 1.0}}};
  EXPECT_NO_THROW(RegionCutter{scene});
}

} // namespace
} // namespace gcpdda::joint_map_test
