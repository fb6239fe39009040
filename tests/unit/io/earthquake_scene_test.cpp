// What is said of [earthquake], its record, and the ground motion that is made of it.

#include "dynamics/ground_motion.hpp"
#include "io/scene/record_file.hpp"
#include "unit/scene_texts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace gcpdda::earthquake_scene_test {
namespace {

using namespace testing;

std::vector<std::string> faults_of(const std::string &csv) {
  std::vector<std::string> texts;
  for (const Diagnostic &fault : read_record(csv, "r.csv").faults) {
    texts.push_back(to_string(fault));
  }
  return texts;
}

TEST(EarthquakeScene, ReadsItsKeys) {
  const Scene scene = good(small_scene + "[earthquake]\nrecord = \"r.csv\"\nquantity = \"acceleration\"\n"
                                         "baseline = \"velocity\"\nscale = 9.81\nstart = 0.5\n");
  EXPECT_EQ(scene.earthquake.file, "folder/r.csv");
  EXPECT_EQ(scene.earthquake.quantity, RecordQuantity::acceleration);
  EXPECT_EQ(scene.earthquake.baseline, Baseline::velocity);
  EXPECT_EQ(scene.earthquake.scale, 9.81);
  EXPECT_EQ(scene.earthquake.start, 0.5);
  EXPECT_EQ(scene.earthquake.stage, -1);
}

TEST(EarthquakeScene, FaultsAreToldAllAtOnce) {
  const std::string text = small_scene + R"([earthquake]
record = "r.csv"
baseline = "displacement"
start = 1.0
stage = "shaking"
)";
  const std::vector<std::string> expected{
      "s.toml:13:12: error: 'baseline' in [earthquake] has no meaning, it is taken from accelerations, and "
      "the "
      "record is one of velocities, leave it out, or write quantity = \"acceleration\"",
      "s.toml:14:9: error: [earthquake] has both start and stage, it begins at a time or with a stage, leave "
      "one of them out",
      "s.toml:15:9: error: no stage is named 'shaking', the scene has no [[stage]]: leave 'stage' out"};
  EXPECT_EQ(messages(read_scene(text, "s.toml", {})), expected);
}

TEST(EarthquakeScene, SidesAndSpeedsBelongTogether) {
  const std::string text = small_scene + R"([earthquake]
p_wave_speed = 3000
)";
  const std::vector<std::string> expected{
      "s.toml:11:1: error: [earthquake] has neither record nor viscous, then nothing shakes, for example "
      "record = \"record.csv\"",
      "s.toml:12:16: error: 'p_wave_speed' in [earthquake] has no meaning, it is that of the rock beyond "
      "viscous sides, leave it out, or name the sides"};
  EXPECT_EQ(messages(read_scene(text, "s.toml", {})), expected);
  EXPECT_EQ(messages(read_scene(small_scene + "[earthquake]\nviscous = [\"left\"]\n", "s.toml", {})),
            std::vector<std::string>{"s.toml:12:11: error: 'viscous' in [earthquake] names sides of nothing, "
                                     "they are those of [region], which is missing, leave it out"});
}

TEST(EarthquakeScene, ShakesInAStageThatTakesSteps) {
  const std::string staged = "[earthquake]\nrecord = \"r.csv\"\nstage = \"out\"\n"
                             "[[stage]]\nkind = \"settle\"\nlimit = 1.0\n"
                             "[[stage]]\nname = \"out\"\nkind = \"excavate\"\nblocks = [\"slider\"]\n";
  std::string text = small_scene + staged;
  text.erase(text.find("duration"), text.find('\n', text.find("duration")) - text.find("duration"));
  EXPECT_EQ(
      messages(read_scene(text, "s.toml", {})),
      std::vector<std::string>{"s.toml:13:9: error: stage 'out' takes no time, nothing can shake in it, "
                               "name a stage of kind run"});
  const std::size_t at = text.find("\"excavate\"");
  text.replace(at, text.find("\"slider\"") + 9 - at, "\"run\"\nduration = 1.0");
  EXPECT_EQ(good(text).earthquake.stage, 1);
}

const std::string boxed = small_scene + R"([region]
material = "granite"
polygon = [[10, 0], [20, 0], [20, 5], [10, 5]]
fixed = ["bottom"]
roller = ["left"]
)";

TEST(EarthquakeScene, SidesThatAreHeldNeedAStage) {
  const SceneReading reading =
      read_scene(boxed + "[earthquake]\nviscous = [\"left\", \"right\", \"bottom\"]\n", "s.toml", {});
  const std::string why =
      "what holds it lets no wave out, and 'stage' names no stage that would take it away, "
      "name a later stage as 'stage' of [earthquake]";
  EXPECT_EQ(
      messages(reading),
      (std::vector<std::string>{
          "s.toml:17:12: error: the left side of [region] is a roller and viscous from the start, " + why,
          "s.toml:17:29: error: the bottom side of [region] is fixed and viscous from the start, " + why}));
  // The bottom, where the wave comes in, is the first one.
  ASSERT_EQ(reading.scene.earthquake.viscous.size(), 3U);
  EXPECT_TRUE(reading.scene.earthquake.is_compliant);
  EXPECT_EQ(reading.scene.earthquake.viscous[0].normal, (Vec2{0.0, -1.0}));
}

TEST(RayleighScene, HasItsLeastRatioAtTheFrequency) {
  const Scene scene = good(small_scene, {"run.rayleigh={ratio=0.05, frequency=2}"});
  const double omega = 4.0 * std::numbers::pi;
  EXPECT_DOUBLE_EQ(scene.run.rayleigh.mass_damping, 0.05 * omega);
  EXPECT_DOUBLE_EQ(scene.run.rayleigh.stiffness_damping, 0.05 / omega);
  EXPECT_EQ(scene.run.contact_damping, 0.0);
  EXPECT_FALSE(good(small_scene).run.rayleigh.present());
  const SceneReading both = read_scene(small_scene, "s.toml",
                                       {"run.rayleigh={ratio=0.05, frequency=2}", "run.contact_damping=0.1"});
  ASSERT_EQ(both.diagnostics.size(), 1U);
  EXPECT_NE(to_string(both.diagnostics[0]).find("'contact_damping' in [run] has no meaning beside rayleigh"),
            std::string::npos);
}

TEST(Record, ReadsOneOrTwoColumnsWithOrWithoutHeading) {
  const RecordReading one = read_record("# a remark\n time [s], v \r\n0.0, 1.0\r\n\n0.5, +2e0\n", "r.csv");
  ASSERT_TRUE(one.faults.empty());
  ASSERT_EQ(one.rows.size(), 2U);
  EXPECT_EQ(one.rows[1].time, 0.5);
  EXPECT_EQ(one.rows[1].value, (Vec2{2.0, 0.0}));
  const RecordReading two = read_record("1,2,3\n2,4,5", "r.csv");
  ASSERT_TRUE(two.faults.empty());
  ASSERT_EQ(two.rows.size(), 2U);
  EXPECT_EQ(two.rows[0].value, (Vec2{2.0, 3.0}));
}

TEST(Record, FaultsHaveLineAndColumn) {
  const std::vector<std::string> expected{
      "r.csv:3:6: error: 'nan' is no motion, x is a number of at most 1e+09, mend the file",
      "r.csv:4:2: error: the time 0.5 is not above that of the row before, 1, the rows of a record go on in "
      "time, mend the file",
      "r.csv:5:1: error: a row with 3 fields, the rows before have 2, mend the file",
      "r.csv:6:1: error: 'late' is no time, time is a number of at most 1e+09, mend the file"};
  EXPECT_EQ(faults_of("t,v\n0,0\n1.0, nan\n 0.5,1\n2,3,4\nlate,1\n"), expected);
  EXPECT_EQ(
      faults_of("0.1\n0.2\n").front(),
      "r.csv:1:1: error: a row with 1 field, a row is time,x or time,x,y, separated by commas, mend the "
      "file");
  EXPECT_EQ(faults_of(""),
            std::vector<std::string>{"r.csv:1:1: error: a record of 0 rows, it has at least two, time,x or "
                                     "time,x,y, mend the file"});
  EXPECT_EQ(faults_of("0,0\n1,1e999\n").size(), 1U);
}

TEST(Record, MayBeginWithAByteOrderMark) {
  for (const std::string heading : {"", "# a remark\n", "t,v\n"}) {
    const RecordReading reading = read_record("\xEF\xBB\xBF" + heading + "0.5,1\n0.75,2\n", "r.csv");
    EXPECT_TRUE(reading.faults.empty()) << to_string(reading.faults.front());
    ASSERT_EQ(reading.rows.size(), 2U);
    EXPECT_EQ(reading.rows[0].time, 0.5);
  }
}

TEST(Record, IsSeparatedByCommas) {
  for (const std::string separator : {";", "\t", " "}) {
    const std::string fault = faults_of("0.0" + separator + "1.0\n0.1" + separator + "2.0\n").front();
    EXPECT_NE(fault.find("r.csv:1:1: error: a row with 1 field"), std::string::npos) << fault;
    EXPECT_NE(fault.find("separated by commas"), std::string::npos) << fault;
  }
}

TEST(Record, ThatIsMissingIsAFaultOfTheScene) {
  Scene scene = good(small_scene + "[earthquake]\nrecord = \"no such.csv\"\n");
  const Diagnostics faults = open_record(Communicator::self(), scene);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(to_string(faults[0]), "folder/small.scene.toml:12:10: error: cannot open the record 'folder/no "
                                  "such.csv', no such file or no right to read it, "
                                  "its path starts from the folder of the scene");
}

Earthquake of(RecordQuantity quantity, std::vector<RecordRow> rows, Baseline baseline = Baseline::none) {
  Earthquake earthquake;
  earthquake.file = "r.csv";
  earthquake.quantity = quantity;
  earthquake.baseline = baseline;
  earthquake.record = std::move(rows);
  return earthquake;
}

TEST(GroundMotion, OfVelocitiesHasTheirMeanSlope) {
  const GroundMotion motion(
      of(RecordQuantity::velocity, {{1.0, {0.5, 0}}, {2.0, {2.5, 0}}, {4.0, {0.5, 2}}}));
  EXPECT_EQ(motion.duration(), 3.0);
  EXPECT_EQ(motion.velocity(0.5), (Vec2{1.5, 0.0}));
  EXPECT_EQ(motion.displacement(1.0), (Vec2{1.5, 0.0}));
  EXPECT_EQ(motion.displacement(3.0), (Vec2{4.5, 2.0}));
  EXPECT_EQ(motion.mean_acceleration(0.5, 0.25), (Vec2{2.0, 0.0}));
  EXPECT_EQ(motion.mean_acceleration(1.0, 0.5), (Vec2{0.5, 0.5})); // half of each slope
  EXPECT_EQ(motion.mean_acceleration(0.0, 0.5), (Vec2{2.0, 0.0})); // what comes, not what was
  EXPECT_EQ(motion.mean_acceleration(-0.5, 0.5), Vec2{});
  EXPECT_EQ(motion.mean_acceleration(4.0, 0.5), Vec2{});
  EXPECT_EQ(motion.peak_acceleration(), 2.0);
}

// a = 6 t on [0, 1], then down to 0 at 2: v = 3 t^2, d = t^3.
TEST(GroundMotion, OfAccelerationsIsTheirIntegral) {
  const GroundMotion motion(of(RecordQuantity::acceleration, {{0.0, {0, 0}}, {1.0, {6, 0}}, {2.0, {0, 0}}}));
  EXPECT_DOUBLE_EQ(motion.velocity(0.5).x, 0.75);
  EXPECT_DOUBLE_EQ(motion.displacement(0.5).x, 0.125);
  EXPECT_DOUBLE_EQ(motion.velocity(2.0).x, 6.0);
  EXPECT_DOUBLE_EQ(motion.displacement(2.0).x, 6.0);
  EXPECT_DOUBLE_EQ(motion.velocity(5.0).x, 6.0);
  EXPECT_EQ(motion.peak_acceleration(), 6.0);
}

TEST(GroundMotion, BaselineBringsTheEndToRest) {
  const std::vector<RecordRow> rows{{0.0, {0, 1}}, {1.0, {6, -2}}, {1.5, {-1, 0}}, {2.5, {0.5, 0.3}}};
  const GroundMotion velocity(of(RecordQuantity::acceleration, rows, Baseline::velocity));
  EXPECT_NEAR(norm(velocity.velocity(2.5)), 0.0, 1e-14);
  EXPECT_GT(norm(velocity.displacement(2.5)), 1.0);
  const GroundMotion both(of(RecordQuantity::acceleration, rows, Baseline::displacement));
  EXPECT_NEAR(norm(both.velocity(2.5)), 0.0, 1e-14);
  EXPECT_NEAR(norm(both.displacement(2.5)), 0.0, 1e-14);
}

} // namespace
} // namespace gcpdda::earthquake_scene_test
