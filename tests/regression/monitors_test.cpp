// Histories of monitored blocks and points, and the order of a pair's contact regions, from the files of
// runs.

#include "child_process.hpp"
#include "io/results/frame_reader.hpp"
#include "sample_scenes.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <sstream>

namespace gcpdda::monitors_test {
namespace {

namespace fs = std::filesystem;
using testing::block_toml;
using testing::count_of;
using testing::file_text;
using testing::lines_of;
using testing::Outcome;
using testing::rectangle;
using testing::run_gcpdda;
using testing::WorkFolder;

const std::string block_header = "time[s],x[m],y[m],rotation[rad],vx[m/s],vy[m/s],omega[rad/s],"
                                 "sxx[Pa],syy[Pa],sxy[Pa],fx[N/m],fy[N/m],ux[m],uy[m]";
const std::string point_header = "time[s],x[m],y[m],vx[m/s],vy[m/s],ux[m],uy[m]";
const std::string profile_header =
    "time[s],distance[m],x[m],y[m],ux[m],uy[m],vx[m/s],vy[m/s],sxx[Pa],syy[Pa],"
    "sxy[Pa],block";

/// Rows of a history below its header line, which is checked.
std::vector<std::vector<double>> rows_of(const fs::path &history, const std::string &header) {
  std::vector<std::string> lines = lines_of(file_text(history));
  EXPECT_EQ(lines.at(0), header) << history;
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    std::istringstream stream(lines[i]);
    rows.emplace_back();
    for (std::string cell; std::getline(stream, cell, ',');) {
      rows.back().push_back(std::stod(cell));
    }
  }
  return rows;
}

constexpr double spin = 2.5;      // rad/s
constexpr Vec2 drift{0.75, -0.5}; // m/s
constexpr Vec2 rotor_centre{6.5, 4.5};
constexpr Vec2 on_rotor{7.25, 4.75};
constexpr Vec2 on_wall{-3.7, 0.95};
constexpr Vec2 on_soft{3.25, 0.75};
constexpr Vec2 line_begin{3.25, 0.75}; // in the soft block, then nothing, then the rotor
constexpr Vec2 line_end{7.25, 4.75};

/// A wall on the floor, a deformable square, and a driven rotor that nothing touches.
std::string scene() {
  const auto monitor = [](const std::string &name, Vec2 point) {
    return fmt::format("[[monitor]]\nname = \"{}\"\npoint = [{}, {}]\n", name, point.x, point.y);
  };
  return "[run]\nduration = 0.4\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2600\n"
         "youngs_modulus = 1e8\npoissons_ratio = 0.2\n[joint.default]\nnormal_stiffness = 1e8\n"
         "friction_angle_deg = 30\n[output]\ninterval = 0.1\nhistory_interval = 0.05\n"
         "[[wall]]\nname = \"wall0\"\nmaterial = \"rock\"\norigin = [-5, 0]\nrows = 3\ncolumns = 3\n"
         "block_size = [1.0, 0.5]\n[[monitor]]\nblock = \"wall0.1.2\"\n[[monitor]]\nblock = \"soft\"\n" +
         monitor("on_rotor", on_rotor) + monitor("on_wall", on_wall) + monitor("on_soft", on_soft) +
         monitor("on_floor", {0.5, -1.0}) +
         fmt::format("[[monitor]]\nname = \"line\"\nalong = [[{}, {}], [{}, {}]]\npoints = 9\n", line_begin.x,
                     line_begin.y, line_end.x, line_end.y) +
         block_toml("floor", rectangle({-8.0, -2.0}, {8.0, 0.0}), "fixed = true") +
         block_toml("soft", rectangle({3.0, 0.0}, {4.0, 1.0}), "fidelity = \"deformable\"") +
         block_toml("rotor", rectangle(rotor_centre - Vec2{1.0, 0.5}, rotor_centre + Vec2{1.0, 0.5}),
                    fmt::format("prescribed_velocity = [{}, {}, {}]", drift.x, drift.y, spin));
}

/// One run on one rank and one on three, shared by the tests.
class Monitors : public ::testing::Test {
protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<WorkFolder>();
    folder_->write("scene.toml", scene());
    plain_ = run_gcpdda(0, {"run", "scene.toml", "--out", "out"}, *folder_);
    three_ = run_gcpdda(3, {"run", "scene.toml", "--out", "three"}, *folder_);
  }
  static void TearDownTestSuite() { folder_.reset(); }
  void SetUp() override {
    ASSERT_EQ(plain_.exit_code, 0) << plain_.err;
    ASSERT_EQ(three_.exit_code, 0) << three_.err;
  }
  [[nodiscard]] static fs::path history(const std::string &name) {
    return *folder_ / "out/history" / (name + ".csv");
  }

  static std::unique_ptr<WorkFolder> folder_;
  static Outcome plain_;
  static Outcome three_;
};

std::unique_ptr<WorkFolder> Monitors::folder_;
Outcome Monitors::plain_;
Outcome Monitors::three_;

TEST_F(Monitors, AreTheSameOnThreeRanks) {
  const std::vector<std::string> files = testing::listing(*folder_ / "out/history");
  EXPECT_EQ(files, (std::vector<std::string>{"energy.csv", "line.csv", "on_floor.csv", "on_rotor.csv",
                                             "on_soft.csv", "on_wall.csv", "soft.csv", "wall0.1.2.csv"}));
  for (const std::string &file : files) {
    EXPECT_EQ(file_text(*folder_ / "out/history" / file), file_text(*folder_ / "three/history" / file))
        << file;
  }
}

TEST_F(Monitors, BeginWhereTheSceneSays) {
  for (const auto &[name, point] : {std::pair("on_rotor", on_rotor), std::pair("on_wall", on_wall),
                                    std::pair("on_soft", on_soft), std::pair("on_floor", Vec2{0.5, -1.0})}) {
    const auto rows = rows_of(history(name), point_header);
    ASSERT_EQ(rows.size(), 9U) << name;
    EXPECT_EQ(rows[0].at(0), 0.0);
    EXPECT_NEAR(rows[0].at(1), point.x, 2e-15) << name << ": centroid and arm, added";
    EXPECT_NEAR(rows[0].at(2), point.y, 2e-15) << name;
  }
  // Row 1 begins with half a brick: brick 2 of it covers x from -3.5 to -2.5, y from 0.5 to 1.
  const auto brick = rows_of(history("wall0.1.2"), block_header);
  ASSERT_EQ(brick.size(), 9U);
  EXPECT_NEAR(brick[0].at(1), -3.0, 1e-15);
  EXPECT_NEAR(brick[0].at(2), 0.75, 1e-15);
}

// x(t) = x_c + v t + R(w t) X; sums of some thousand rounded steps of size 1.
TEST_F(Monitors, FollowAPointOfADrivenRotor) {
  const Vec2 arm = on_rotor - rotor_centre;
  for (const std::vector<double> &row : rows_of(history("on_rotor"), point_header)) {
    const double angle = spin * row[0];
    const Vec2 turned{std::cos(angle) * arm.x - std::sin(angle) * arm.y,
                      std::sin(angle) * arm.x + std::cos(angle) * arm.y};
    EXPECT_NEAR(row[1], rotor_centre.x + drift.x * row[0] + turned.x, 1e-13) << row[0];
    EXPECT_NEAR(row[2], rotor_centre.y + drift.y * row[0] + turned.y, 1e-13) << row[0];
    EXPECT_NEAR(row[3], drift.x - spin * turned.y, 1e-13) << row[0];
    EXPECT_NEAR(row[4], drift.y + spin * turned.x, 1e-13) << row[0];
    EXPECT_NEAR(row[5], drift.x * row[0] + turned.x - arm.x, 1e-13) << row[0];
    EXPECT_NEAR(row[6], drift.y * row[0] + turned.y - arm.y, 1e-13) << row[0];
  }
}

// A point of a deformable block moves with centroid and strain: points of the same height as the centroid's
// differ from it, and the fixed floor's does not move at all.
TEST_F(Monitors, FollowPointsOfOtherBlocks) {
  const auto soft = rows_of(history("soft"), block_header);
  const auto point = rows_of(history("on_soft"), point_header);
  ASSERT_EQ(soft.size(), point.size());
  const double sunk = point.back()[2] - on_soft.y;
  EXPECT_LT(sunk, 0.0);
  // Squeezed from below a point above the centroid sinks further than it: by a quarter of the strain, which
  // is at most twice rho g L/E with k_n L = E.
  const double further = sunk - (soft.back()[2] - 0.5);
  EXPECT_LT(further, 0.0);
  EXPECT_GT(further, -0.25 * 2.0 * 2600.0 * 9.81 / 1e8);
  for (const std::vector<double> &row : rows_of(history("on_floor"), point_header)) {
    EXPECT_EQ(std::vector<double>(row.begin() + 1, row.end()),
              (std::vector<double>{0.5, -1.0, 0.0, 0.0, 0.0, 0.0}));
  }
  for (const std::vector<double> &row : soft) { // of the centroid
    EXPECT_NEAR(row[12], row[1] - soft[0][1], 1e-15);
    EXPECT_NEAR(row[13], row[2] - soft[0][2], 1e-15);
  }
  EXPECT_EQ(soft[0][13], 0.0);
  EXPECT_LT(soft.back()[13], 0.0);
}

// Points 0 and 1, at (3.75, 1.25) no longer in the soft square, of nine on a line that ends in the rotor,
// which covers x from 5.5 to 7.5 and y from 4 to 5: points 0, 7 and 8 have rows, the same as points of their
// own.
TEST_F(Monitors, FollowPointsAlongALine) {
  const auto line = rows_of(history("line"), profile_header);
  const auto soft_point = rows_of(history("on_soft"), point_header);
  const auto soft = rows_of(history("soft"), block_header);
  const auto rotor_point = rows_of(history("on_rotor"), point_header);
  ASSERT_EQ(line.size(), 3U * soft_point.size());
  for (std::size_t k = 0; k < soft_point.size(); ++k) {
    for (const auto &[row, point, distance] :
         {std::tuple(line[3 * k], soft_point[k], 0.0),
          std::tuple(line[3 * k + 2], rotor_point[k], 4.0 * std::sqrt(2.0))}) {
      EXPECT_EQ(row[0], point[0]);
      EXPECT_NEAR(row[1], distance, 1e-14);
      EXPECT_EQ(std::vector<double>(row.begin() + 2, row.begin() + 8),
                (std::vector<double>{point[1], point[2], point[5], point[6], point[3], point[4]}));
    }
    EXPECT_EQ(std::vector<double>(line[3 * k].begin() + 8, line[3 * k].begin() + 11),
              std::vector<double>(soft[k].begin() + 7, soft[k].begin() + 10))
        << "the stress of its block";
    EXPECT_NEAR(line[3 * k + 1][1], 3.5 * std::sqrt(2.0), 1e-14);
    EXPECT_EQ(line[3 * k + 1][11], line[3 * k + 2][11]) << "both on the rotor";
  }
  EXPECT_EQ(count_of(plain_.err, "6 of the 9 points of profile 'line' lie in no block, they have no rows"), 1)
      << plain_.err;
}

TEST_F(Monitors, ALineInNoBlockIsAFault) {
  for (const int ranks : {0, 2}) {
    const Outcome outcome = run_gcpdda(
        ranks, {"run", "scene.toml", "--out", "bad", "--set", "monitor=[{name='l',along=[[0,90],[1,91]]}]"},
        *folder_);
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_EQ(count_of(outcome.err, "error: all of the 21 points of profile 'l' lie in no block"), 1)
        << outcome.err;
  }
}

/// A fixed floor, which comes first, and two squares side by side on it that drift away from each other. The
/// vertex at the origin belongs to all three, (1, 0) to the floor and the right square, (3, 0) to the floor.
std::string scene_of_shared_points(const std::string &block_of_corner) {
  return "[run]\nduration = 0.1\ngravity = [0, 0]\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2600\n"
         "[joint.default]\nnormal_stiffness = 1e8\nfriction_angle_deg = 0\n[output]\ninterval = 0.1\n" +
         block_toml("floor", rectangle({-8.0, -2.0}, {8.0, 0.0}), "fixed = true") +
         block_toml("left", rectangle({-1.0, 0.0}, {0.0, 1.0}), "velocity = [-1, 0, 0]") +
         block_toml("right", rectangle({0.0, 0.0}, {1.0, 1.0}), "velocity = [1, 0, 0]") +
         fmt::format("[[monitor]]\nname = \"corner\"\npoint = [0, 0]\n{}"
                     "[[monitor]]\nname = \"edge\"\npoint = [1, 0]\n"
                     "[[monitor]]\nname = \"bare\"\npoint = [3, 0]\n",
                     block_of_corner.empty() ? "" : fmt::format("block = \"{}\"\n", block_of_corner));
}

// A fixed block does not take a point from a mobile one; of several mobile ones the first has it.
TEST(SharedPoints, GoToAMobileBlockOrTheOneNamed) {
  const WorkFolder folder;
  const std::string corner =
      "monitor 'corner' follows the mobile block 'left', 3 blocks share its point (0, 0), "
      "set monitor.block to follow another one";
  const std::string edge = "monitor 'edge' follows the mobile block 'right', 2 blocks share its point (1, 0)";
  const auto moved = [&](const std::string &name) {
    const auto rows = rows_of(folder / ("out/history/" + name + ".csv"), point_header);
    return rows.back().at(1) - rows.front().at(1);
  };
  constexpr double rounding = 1e-12; // of some hundred steps of v dt
  for (const int ranks : {0, 2, 3}) {
    for (const auto &[block, way] : {std::pair("", -0.1), std::pair("right", 0.1), std::pair("floor", 0.0)}) {
      folder.write("scene.toml", scene_of_shared_points(block));
      const Outcome outcome = run_gcpdda(ranks, {"run", "scene.toml", "--out", "out", "--overwrite"}, folder);
      ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
      EXPECT_EQ(count_of(outcome.err, corner), *block == '\0' ? 1 : 0) << outcome.err;
      EXPECT_EQ(count_of(outcome.err, edge), 1) << outcome.err;
      EXPECT_EQ(count_of(outcome.err, "'bare' follows"), 0) << "one block holds it: " << outcome.err;
      EXPECT_NEAR(moved("corner"), way, rounding) << "named: " << block;
      EXPECT_NEAR(moved("edge"), 0.1, rounding);
      EXPECT_EQ(moved("bare"), 0.0);
    }
  }
  EXPECT_EQ(count_of(file_text(folder / "out/scene.toml"), "block = \"floor\""), 1) << "restarts need it";
}

TEST(SharedPoints, ABlockThatDoesNotHoldThePointIsAFault) {
  const WorkFolder folder;
  std::string text = scene_of_shared_points("right");
  text.replace(text.find("point = [0, 0]"), 14, "point = [-3, 4]");
  folder.write("scene.toml", text);
  for (const int ranks : {0, 3}) {
    const Outcome outcome = run_gcpdda(ranks, {"run", "scene.toml", "--out", "out"}, folder);
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_EQ(count_of(outcome.err, "error: block 'right' does not hold the point (-3, 4) of monitor "
                                    "'corner', the point lies 4.24 m outside it"),
              1)
        << outcome.err; // 3 to the left and 3 above
    EXPECT_FALSE(fs::exists(folder / "out/history"));
  }
}

// A wedge touches both faces of a notch, twice: below the notch block stands on the floor on two legs.
TEST(ContactFrames, AreOrderedByPairAndPosition) {
  for (const int ranks : {0, 3}) {
    const WorkFolder folder;
    folder.write("notch.toml",
                 "[run]\nduration = 0.2\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2600\n"
                 "[joint.default]\nnormal_stiffness = 1e8\nfriction_angle_deg = 30\n"
                 "[output]\ninterval = 0.1\n" +
                     block_toml("wedge", {{0.0, 1.0}, {1.0, 2.0}, {-1.0, 2.0}}) +
                     block_toml("notch", {{-2.0, 0.0},
                                          {-1.0, 0.0},
                                          {-1.0, 0.5},
                                          {1.0, 0.5},
                                          {1.0, 0.0},
                                          {2.0, 0.0},
                                          {2.0, 3.0},
                                          {0.0, 1.0},
                                          {-2.0, 3.0}}) +
                     block_toml("floor", rectangle({-8.0, -2.0}, {8.0, 0.0}), "fixed = true"));
    const Outcome outcome = run_gcpdda(ranks, {"run", "notch.toml", "--out", "out"}, folder);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    for (const int frame : {1, 2}) {
      const ContactFrameContent contacts =
          read_contact_frame(folder / fmt::format("out/frames/contacts_{:06}.hdf", frame));
      const std::vector<std::array<std::int64_t, 2>> pairs{{0, 1}, {0, 1}, {1, 2}, {1, 2}};
      ASSERT_EQ(contacts.blocks, pairs) << "two regions each, pairs ascending";
      ASSERT_EQ(contacts.points.size(), 8U);
      const auto middle = [&](std::size_t region) {
        return 0.5 * (contacts.points[2 * region][0] + contacts.points[2 * region + 1][0]);
      };
      // One on each side, whichever comes first; the order stays from frame to frame and for any ranks.
      for (const std::size_t first : {0U, 2U}) {
        EXPECT_LT(middle(first) * middle(first + 1), 0.0) << "regions " << first << " and " << first + 1;
        EXPECT_NEAR(contacts.normal_force[first], contacts.normal_force[first + 1],
                    1e-6 * contacts.normal_force[first])
            << "by symmetry";
      }
    }
  }
}

} // namespace
} // namespace gcpdda::monitors_test
