// What a restart rests on: which changes of a scene a state survives, where histories and frames are cut, on
// which step a run goes on.

#include "driver/restart.hpp"

#include "base/check.hpp"
#include "driver/restart_changes.hpp"
#include "gcpdda/base/scene_error.hpp"
#include "gcpdda/io/frame_rows.hpp"
#include "gcpdda/io/frame_writer.hpp"
#include "gcpdda/io/run_summary.hpp"
#include "io/results/folder_lock.hpp"
#include "io/results/history_writer.hpp"
#include "io/results/run_comparison.hpp"
#include "simulation/time_plan.hpp"
#include "support/frame_data.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"
#include "unit/scene_texts.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

namespace gcpdda::restart_test {
namespace {

namespace fs = std::filesystem;
using testing::file_text;
using testing::FrameData;
using testing::GivenContacts;
using testing::GivenFrame;
using testing::scene_of;
using testing::TemporaryFolder;

const std::string scene_text = R"([run]
duration = 1.0
[material.rock]
density = 2600.0
youngs_modulus = 1e9
poissons_ratio = 0.2
[joint.default]
normal_stiffness = 1e9
[output]
interval = 0.1
[[block]]
name = "floor"
material = "rock"
vertices = [[-5, -1], [5, -1], [5, 0], [-5, 0]]
fixed = true
[[block]]
name = "slider"
material = "rock"
vertices = [[0, 0], [1, 0], [1, 1], [0, 1]]
velocity = [1, 0, 0]
[[wall]]
name = "w"
material = "rock"
origin = [2, 0]
rows = 2
columns = 2
block_size = [0.5, 0.25]
[support.layer]
kind = "liner"
thickness = 0.1
youngs_modulus = 2e10
[[liner]]
name = "face"
support = "layer"
points = [[-1, 0], [2, 0]]
[[monitor]]
block = "slider"
)";

TEST(UnfitChanges, AreNoneWhereAStateGoesOn) {
  const Scene before = scene_of(scene_text);
  EXPECT_TRUE(unfit_changes(before, before).empty());
  for (const char *set :
       {"run.duration=3", "run.gravity=[1, -2]", "run.gravity_ramp=0.5", "run.time_step=1e-4",
        "run.safety=0.1", "run.contact_damping=0.2", "run.local_damping=0.5", "run.potential=linear",
        "run.elasticity=explicit", "joint.default.friction_angle_deg=20", "joint.default.cohesion=1e3",
        "joint.default.normal_stiffness=2e9", "output.interval=0.2", "output.checkpoint_interval=0.2",
        "output.contacts=false", "support.layer.compressive_strength=3e7",
        "block.slider.load=[{point=[0.5, 1], force=[0, -1e4]}]"}) {
    EXPECT_TRUE(unfit_changes(before, scene_of(scene_text, {set})).empty()) << set;
  }
}

TEST(UnfitChanges, AreNamedEachWithReasonAndHint) {
  const Scene before = scene_of(scene_text);
  for (const auto &[set, named] : std::vector<std::pair<std::string, std::string>>{
           {"run.scheme=newmark-dda", "run.scheme"},
           {"run.spectral_radius=0.8", "run.spectral_radius"},
           {"run.contact_time=start", "run.contact_time"},
           {"run.plane=stress", "run.plane"},
           {"run.initial_friction=zero", "run.initial_friction"},
           {"material.rock.density=2601", "material.rock.density"},
           {"material.rock.youngs_modulus=2e9", "material.rock.youngs_modulus"},
           {"material.rock.poissons_ratio=0.21", "material.rock.poissons_ratio"},
           {"material.clay.density=2000", "the list of materials"},
           {"block.slider.vertices=[[0, 0], [1, 0], [1, 1], [0, 1.5]]", "block 'slider'"},
           {"block.slider.velocity=[2, 0, 0]", "block 'slider'"},
           {"block.slider.fixed=true", "block 'slider'"},
           {"block.slider.fixed_points=[[0.5, 0.5]]", "block 'slider'"},
           {"block.slider.fidelity=rigid", "block 'slider'"},
           {"liner.face.points=[[0, 0], [2, 0]]", "liners that are there, or put in others at the start"},
           {"liner.face.active=false", "liners that are there, or put in others at the start"},
           {"wall.w.gap=0.1", "'w'"},
           {"wall.w.rows=3", "'w'"},
           {"pyramid=[{material=\"rock\", origin=[9, 9], rows=1, block_size=[1, 1]}]",
            "the number of blocks"}}) {
    std::vector<std::string> sets{set};
    if (set.starts_with("block.slider.fixed=")) {
      sets.emplace_back("block.slider.velocity=[0, 0, 0]");
    }
    const Diagnostics faults = unfit_changes(before, scene_of(scene_text, sets));
    ASSERT_EQ(faults.size(), 1U) << set;
    EXPECT_EQ(faults[0].severity, Severity::error);
    EXPECT_EQ(faults[0].what, "a restart cannot change " + named);
    EXPECT_FALSE(faults[0].why.empty() || faults[0].hint.empty()) << set;
  }
}

TEST(UnfitChanges, AreThoseByWhichBlocksAreCutAndContactsHaveTheirLaws) {
  const std::string text = R"([run]
duration = 1.0
[material.rock]
density = 2600.0
[joint.default]
allowed_overlap = 1e-3
[joint.bedding]
friction_angle_deg = 30
[region]
polygon = [[0, 0], [4, 0], [4, 4], [0, 4]]
material = "rock"
fixed = ["bottom"]
[[joint_set]]
name = "beds"
dip_deg = 0
spacing = 1.0
)";
  const Scene before = scene_of(text);
  for (const auto &[set, named] : std::vector<std::pair<std::string, std::string>>{
           {"region.min_width=0.3", "region.min_width"},
           {"joint_set.beds.spacing=2", "joint_set.beds.spacing"},
           {"voronoi=[{size = 0.5}]", "voronoi"},
           {"joint.bedding.materials=[\"rock\", \"rock\"]", "joint.bedding.materials"},
           {"joint.default.allowed_overlap=2e-3", "joint.default.allowed_overlap"},
           {"run.fidelity=rigid", "run.fidelity"},
           {"run.accepted_error=0.5", "run.accepted_error"}}) {
    const Diagnostics faults = unfit_changes(before, scene_of(text, {set}));
    ASSERT_EQ(faults.size(), 1U) << set;
    EXPECT_EQ(faults[0].what, "a restart cannot change " + named);
  }
  EXPECT_TRUE(unfit_changes(before, scene_of(text, {"joint.bedding.tangential_ratio=0.7"})).empty());
  EXPECT_TRUE(unfit_changes(before, scene_of(text, {"water.w.phreatic=[[0, 1], [4, 1]]"})).empty());
}

const std::string staged_text =
    scene_text.substr(0, 6) + scene_text.substr(scene_text.find("[material")) + R"([[stage]]
name = "weight"
kind = "settle"
limit = 2
[[stage]]
name = "weak"
kind = "settle"
limit = 2
set = { "joint.default.friction_angle_deg" = 20.0 }
)";

TEST(StagesThatAreOver, KeepTheirKeys) {
  const Scene before = scene_of(staged_text);
  const Scene after = scene_of(staged_text, {"stage.weak.limit=3"});
  EXPECT_NO_THROW(expect_same_past(before, before, 2));
  EXPECT_NO_THROW(expect_same_past(before, after, 1));
  EXPECT_NO_THROW(
      expect_same_past(before, scene_of(staged_text + "[[stage]]\nkind = \"run\"\nduration = 1\n"), 2));
  try {
    expect_same_past(before, after, 2);
    ADD_FAILURE() << "the limit of a stage that is over has changed";
  } catch (const SceneError &error) {
    ASSERT_EQ(error.diagnostics().size(), 1U);
    EXPECT_EQ(
        to_string(error.diagnostics()[0]),
        "test.toml:41:1: error: a restart cannot change stage.weak.limit from 2 to 3, this stage is over in "
        "the "
        "checkpoint, add a further [[stage]], leave the change out, or start a new run with gcpdda run");
  }
}

TEST(ChangesOfARestart, AreReportedEach) {
  const Scene before = scene_of(staged_text);
  std::vector<std::string> sets{"joint.default.normal_stiffness=9e9", "joint.default.friction_angle_deg=10",
                                "run.potential=linear"};
  keep_intervals(before.output, sets);
  const Scene after = scene_of(staged_text, sets);
  const auto texts = [&](std::int64_t stage) {
    std::vector<std::string> all;
    for (const Diagnostic &report : reports_of_changes(before, after, 0.5, stage)) {
      all.push_back(to_string(report));
    }
    return all;
  };
  const std::string behind = ", the run has the new value from t = 0.5 s on";
  const std::string friction = "joint.default.friction_angle_deg changes from its default 0 to 10";
  const std::vector<std::string> others{
      "info: joint.default.normal_stiffness changes from 1e+09 to 9e+09" + behind,
      "info: run.potential changes from its default \"exact\" to \"linear\"" + behind};
  EXPECT_EQ(texts(0), (std::vector<std::string>{others[0], "info: " + friction + behind, others[1]}));
  EXPECT_EQ(texts(1),
            (std::vector<std::string>{others[0],
                                      "warning: " + friction +
                                          ", the change is without effect because stage 'weak' sets "
                                          "the value, set the value in a further stage",
                                      others[1]}));
}

TimePlan plan_of(double time_step, double checkpoint_interval, Diagnostics &notes) {
  RunSettings run;
  run.duration = 2.0;
  run.time_step = time_step;
  OutputSettings output;
  output.interval = 0.1;
  output.history_interval = 0.1;
  output.checkpoint_interval = checkpoint_interval;
  return plan_time(run, output, 1.0, notes);
}

TEST(CheckpointTimes, AreWholeStepsAndTheEnd) {
  Diagnostics notes;
  const TimePlan plan = plan_of(0.01, 0.3, notes);
  EXPECT_TRUE(notes.empty());
  std::vector<std::int64_t> due;
  for (std::int64_t step = 0; step <= plan.num_steps; ++step) {
    if (plan.checkpoint_due(step)) {
      due.push_back(step);
    }
  }
  EXPECT_EQ(due, (std::vector<std::int64_t>{30, 60, 90, 120, 150, 180, 200}));
  EXPECT_FALSE(plan_of(0.01, 0.0, notes).checkpoint_due(200));
  EXPECT_TRUE(notes.empty());
  EXPECT_EQ(plan_of(0.01, 1e-6, notes).steps_per_checkpoint, 1) << "at least one step";
  EXPECT_EQ(plan_of(0.01, 0.0449, notes).steps_per_checkpoint, 4);
  EXPECT_EQ(plan_of(0.01, 1e12, notes).steps_per_checkpoint, 100'000'000'000'000);
  ASSERT_EQ(notes.size(), 2U);
  EXPECT_EQ(notes[1].severity, Severity::info);
  EXPECT_EQ(notes[1].what, "checkpoints are written every 0.04 s, not every 0.0449 s");
}

TEST(StepToGoOnFrom, IsThatOfTheTime) {
  Diagnostics notes;
  const TimePlan plan = plan_of(0.1 / 3.0, 0.0, notes);
  for (std::int64_t step = 0; step <= plan.num_steps; ++step) {
    EXPECT_EQ(step_to_go_on_from(plan, plan.time(step), plan.time_step, notes), step);
  }
  EXPECT_TRUE(notes.empty());
  EXPECT_EQ(step_to_go_on_from(plan, 0.2, 0.05, notes), 6);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].severity, Severity::warning) << "one step of another length";
  step_to_go_on_from(plan, 0.25, 0.05, notes);
  ASSERT_EQ(notes.size(), 2U);
  EXPECT_EQ(notes[1].severity, Severity::error) << "0.25 s are 7.5 steps";
  // Where the times themselves have no common step there is nothing to say about the checkpoint's.
  notes.clear();
  EXPECT_EQ(step_to_go_on_from(TimePlan{}, 0.2, 0.05, notes), 0);
  EXPECT_TRUE(notes.empty());
}

class CutResults : public ::testing::Test {
protected:
  void write(const std::string &name, const std::string &text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

TEST_F(CutResults, HistoriesKeepWholeRowsUpToTheTime) {
  Monitor point;
  point.name = "roof";
  point.is_point = true;
  Monitor fresh;
  fresh.name = "fresh";
  fresh.is_point = true;
  const std::string header = "time[s],x[m],y[m],vx[m/s],vy[m/s],ux[m],uy[m]\n";
  const std::string kept = "0,1,2,3,4,0,0\n0.1,1,2,3,4,0,0\n0.20000000000000001,5,6,7,8,4,4\n";
  for (const std::string rest :
       {"", "0.3", "0.30000000000000004,1,2,3,4,0,0\n0.4,1,2,3,4,0,0\n", "0.2", "0.2,5"}) {
    write("history/roof.csv", header + kept + rest);
    HistoryWriter writer(folder_, {point, fresh}, 0.2 + 0.5e-3, {});
    EXPECT_EQ(file_text(folder_ / "history/roof.csv"), header + kept) << rest;
    EXPECT_EQ(file_text(folder_ / "history/fresh.csv"), header) << "a monitor that was not there before";
    writer.write_monitor(0, 0.5, {});
    writer.flush();
    EXPECT_EQ(file_text(folder_ / "history/roof.csv"), header + kept + "0.5,0,0,0,0,0,0\n");
    EXPECT_NO_THROW(writer.sync());
  }
}

// One from a version whose histories had no displacements: its columns stay those of its header, or the file
// that a checkpoint knows would have changed.
TEST_F(CutResults, HistoriesKeepTheirColumns) {
  Monitor point;
  point.name = "roof";
  point.is_point = true;
  Monitor block;
  block.name = "b0";
  const std::string roof = "time[s],x[m],y[m],vx[m/s],vy[m/s]\n0,1,2,3,4\n";
  const std::string b0 =
      "time[s],x[m],y[m],rotation[rad],vx[m/s],vy[m/s],omega[rad/s],sxx[Pa],syy[Pa],sxy[Pa],"
      "fx[N/m],fy[N/m]\n0,1,2,3,4,5,6,7,8,9,10,11\n";
  write("history/roof.csv", roof + "0.3,1,2,3,4\n");
  write("history/b0.csv", b0);
  HistoryWriter writer(folder_, {point, block}, 0.25, {});
  writer.write_monitor(0, 0.5, {});
  writer.write_monitor(1, 0.5, {});
  writer.flush();
  EXPECT_EQ(file_text(folder_ / "history/roof.csv"), roof + "0.5,0,0,0,0\n");
  EXPECT_EQ(file_text(folder_ / "history/b0.csv"), b0 + "0.5,0,0,0,0,0,0,0,0,0,0,0\n");
}

TEST_F(CutResults, AreToldByTheirSizesAndRows) {
  Monitor point;
  point.name = "roof";
  point.is_point = true;
  HistoryWriter writer(folder_, {point});
  for (int k = 0; k < 3; ++k) {
    writer.write_monitor(0, 0.1 * k, {});
    writer.write_energy(0.1 * k, {});
  }
  writer.flush();
  const ResultFile roof = writer.files().front();
  EXPECT_EQ(roof.name, "history/roof.csv");
  EXPECT_EQ(roof.rows, 3);
  const std::string text = file_text(folder_ / roof.name);
  EXPECT_EQ(roof.bytes, std::ssize(text));
  const HistoryWriter resumed(folder_, {point}, 0.15, {});
  EXPECT_EQ(resumed.files().front().rows, 2);
  const ResultFile at_checkpoint{roof.name, 0, 1};
  const HistoryWriter behind(folder_, {point}, 0.15, {at_checkpoint});
  EXPECT_EQ(behind.files().front().rows, 1) << "a row at the same time came after the checkpoint";
  const auto damage = [&](const std::string &now) {
    write(roof.name, now);
    return damage_of(folder_, roof);
  };
  EXPECT_EQ(damage(text), "");
  EXPECT_EQ(damage(text + "0.3,1,2,3,4\n0.4,"), "") << "rows that came later";
  EXPECT_EQ(damage(text.substr(0, text.size() - 3)), "history/roof.csv is cut short, it has 2 of 3 rows");
  EXPECT_EQ(damage(""), "history/roof.csv is cut short, it has 0 of 3 rows");
  std::string joined = text;
  joined[joined.find("\n0.1")] = ' ';
  EXPECT_TRUE(damage(joined).starts_with("history/roof.csv has changed"));
  fs::remove(folder_ / roof.name);
  EXPECT_EQ(damage_of(folder_, roof), "history/roof.csv is missing");
  write("frames/frame_000000.hdf", "12345");
  EXPECT_EQ(damage_of(folder_, {"frames/frame_000000.hdf", 5, -1}), "");
  EXPECT_EQ(damage_of(folder_, {"frames/frame_000000.hdf", 6, -1}),
            "frames/frame_000000.hdf is damaged, it has 5 of 6 bytes");
}

FrameData two_triangles(double rotation) {
  FrameData data{{FrameRow{}, FrameRow{}}, {{0, 0}, {1, 0}, {0, 1}, {0, 0}, {1, 0}, {0, 1}}};
  data.rows[0].num_vertices = 3;
  data.rows[1].num_vertices = 3;
  data.rows[1].block = 1;
  data.rows[1].rotation = rotation;
  return data;
}

/// It comes with frame 1.
BoltFrame one_bolt(int frame) {
  BoltRow row;
  row.num_points = 2;
  row.axial_force = 0.1 * frame;
  return frame == 0 ? BoltFrame{} : BoltFrame{{row}, {{0, 0}, {1, 1}}};
}

// Largest forces of all rows, the last of them, in the order of the bolts' first rows.
TEST_F(CutResults, LoadsOfBoltsGoOnAsIfNeverStopped) {
  const auto row = [](const char *name, double axial, double shear, std::int64_t yielded) {
    return BoltHistoryRow{name, {0.1, 0.2}, {0.3, 0.4}, axial, shear, 1e-3, 2e-3, 5, yielded, 0};
  };
  const auto expect_loads = [&](const std::vector<BoltLoad> &loads) {
    ASSERT_EQ(loads.size(), 3U);
    EXPECT_EQ(loads[0].last.name, "pulled");
    EXPECT_EQ(loads[0].axial, 1e5 / 3.0);
    EXPECT_EQ(loads[0].shear, 7.0);
    EXPECT_EQ(loads[0].last.axial, 2e4);
    EXPECT_EQ(loads[0].last.yielded, 1);
    EXPECT_EQ(loads[0].time, 0.3);
    EXPECT_EQ(loads[1].last.name, "pressed");
    EXPECT_EQ(loads[1].axial, -1.0);
    EXPECT_EQ(loads[1].time, 0.1);
    EXPECT_EQ(loads[2].last.name, "late");
  };
  const auto write_last = [&](HistoryWriter &writer) {
    writer.write_bolts(0.3, {row("pulled", 2e4, 6.0, 1), row("late", 1.0, 0.0, 0)});
    writer.flush();
  };
  HistoryWriter whole(folder_, {}, SupportHistories{true, false});
  whole.write_bolts(0.1, {row("pulled", 1e4, 7.0, 0), row("pressed", -1.0, 0.0, 0)});
  whole.write_bolts(0.2, {row("pulled", 1e5 / 3.0, 5.0, 0)});
  whole.flush();
  write_last(whole);
  expect_loads(whole.bolt_loads());
  HistoryWriter resumed(folder_, {}, 0.2 + 0.5e-3, {}, {true, false});
  EXPECT_EQ(resumed.bolt_loads().size(), 2U);
  write_last(resumed);
  expect_loads(resumed.bolt_loads());
}

TEST_F(CutResults, FramesGoOnAsIfNeverStopped) {
  std::vector<ResultFile> files;
  for (const char *run : {"whole", "cut"}) {
    FrameWriter writer(Communicator::self(), folder_ / run, 2);
    HistoryWriter history(folder_ / run, {});
    for (int k = 0; k < 4; ++k) {
      writer.write(k, 0.1 * k, GivenFrame(two_triangles(k)));
      writer.write_contacts(k, 0.1 * k, GivenContacts({}));
      writer.write_bolts(k, 0.1 * k, one_bolt(k));
    }
    EXPECT_EQ(writer.times(), (std::vector<double>{0.0, 0.1, 0.2, 0.1 * 3}));
    writer.finish();
    files = writer.files();
    EXPECT_EQ(files.size(), 13U) << "a topology, and frame, contacts and bolts of four times";
  }
  write("cut/frames/frame_000123.hdf", "of a failure");
  write("cut/frames/frame_000002.txt", "a person's");
  FrameWriter writer(Communicator::self(), folder_ / "cut", 2);
  writer.continue_behind({0.0, 0.1}, {files.begin(), files.begin() + 7});
  EXPECT_EQ(testing::count_of(file_text(folder_ / "cut/run.hdf.series"), "\"name\""), 2);
  EXPECT_EQ(testing::count_of(file_text(folder_ / "cut/contacts.hdf.series"), "\"name\""), 2);
  EXPECT_EQ(testing::count_of(file_text(folder_ / "cut/bolts.hdf.series"), "\"name\""), 2);
  EXPECT_EQ(testing::count_of(file_text(folder_ / "cut/run.xdmf"), "<Time "), 2);
  EXPECT_EQ(testing::listing(folder_ / "cut/frames"),
            (std::vector<std::string>{"bolts_000000.hdf", "bolts_000001.hdf", "contacts_000000.hdf",
                                      "contacts_000001.hdf", "frame_000000.hdf", "frame_000001.hdf",
                                      "frame_000002.txt", "topology_000000.h5"}));
  fs::remove(folder_ / "cut/frames/frame_000002.txt");
  for (int k = 2; k < 4; ++k) {
    writer.write(k, 0.1 * k, GivenFrame(two_triangles(k)));
    writer.write_contacts(k, 0.1 * k, GivenContacts({}));
    writer.write_bolts(k, 0.1 * k, one_bolt(k));
  }
  writer.finish();
  EXPECT_EQ(writer.files(), files);
  EXPECT_EQ(compare_runs(folder_ / "whole", folder_ / "cut"), std::vector<std::string>());
}

TEST_F(CutResults, WithoutItsTopologyFileIsAFileError) {
  fs::create_directories(folder_ / "frames");
  FrameWriter writer(Communicator::self(), folder_, 2);
  EXPECT_THROW(writer.continue_behind({0.0}), FileError);
}

TEST_F(CutResults, ALockIsHeldByOneAndGivenBack) {
  FolderLock first;
  first.acquire(folder_); // no run yet: nothing to lock
  write("run.log", "");
  FolderLock second;
  {
    FolderLock third;
    third.acquire(folder_);
    EXPECT_THROW(second.acquire(folder_), FileError);
    third.acquire(folder_); // again, as after --overwrite
    EXPECT_THROW(second.acquire(folder_), FileError);
  }
  EXPECT_NO_THROW(second.acquire(folder_));
}

} // namespace
} // namespace gcpdda::restart_test
