#include "base/check.hpp"
#include "gcpdda/io/frame_rows.hpp"
#include "gcpdda/io/frame_writer.hpp"
#include "gcpdda/io/run_summary.hpp"
#include "io/results/frame_reader.hpp"
#include "io/results/history_writer.hpp"
#include "io/results/result_directory.hpp"
#include "io/results/run_comparison.hpp"
#include "io/results/summary.hpp"
#include "support/frame_data.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

namespace gcpdda::result_files_test {
namespace {

const Monitor slider{"slider", 0, false, {}, {}};

namespace fs = std::filesystem;
using testing::FrameData;
using testing::GivenContacts;
using testing::GivenFrame;
using testing::TemporaryFolder;

std::string read_text(const fs::path &path) {
  std::ifstream stream(path, std::ios::binary);
  EXPECT_TRUE(stream.is_open()) << path;
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write_text(const fs::path &path, const std::string &text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

class ResultFiles : public ::testing::Test {
protected:
  TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

TEST_F(ResultFiles, HistoryHasUnitsAndSeventeenDigits) {
  HistoryWriter writer(folder_, {slider});
  EXPECT_EQ(std::count_if(fs::directory_iterator(folder_ / "history"), {}, [](const auto &) { return true; }),
            2);
  writer.write_monitor(0, 0.1, {{1.0, -2.0}, 1.0 / 3.0, {4, 5, 6}, {7, 8, 9}, {1e-300, 1e10}, {12, -13}});
  writer.flush();
  writer.write_monitor(0, 0.25, {});
  writer.write_energy(0.5, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
  writer.flush();
  writer.flush();
  EXPECT_EQ(read_text(folder_ / "history/slider.csv"),
            "time[s],x[m],y[m],rotation[rad],vx[m/s],vy[m/s],omega[rad/s],sxx[Pa],syy[Pa],sxy[Pa],fx[N/m],"
            "fy[N/m],ux[m],uy[m]\n"
            "0.10000000000000001,1,-2,0.33333333333333331,4,5,6,7,8,9,1e-300,10000000000,12,-13\n"
            "0.25,0,0,0,0,0,0,0,0,0,0,0,0,0\n");
  EXPECT_EQ(read_text(folder_ / "history/energy.csv"),
            "time[s],kinetic[J/m],strain[J/m],contact_normal[J/m],contact_stick[J/m],gravity[J/m],"
            "friction_loss[J/m],damping_loss[J/m],boundary_work[J/m],residual[J/m],unbalanced_ratio[-],"
            "max_speed[m/s]\n"
            "0.5,1,2,3,4,5,6,7,8,9,10,11\n");
}

TEST_F(ResultFiles, HistoryOnAFullDiskIsAFileError) {
  HistoryWriter writer(folder_, {slider});
  fs::remove(folder_ / "history/slider.csv");
  fs::create_symlink("/dev/full", folder_ / "history/slider.csv");
  writer.write_monitor(0, 0.0, {});
  EXPECT_THROW(writer.flush(), FileError);
}

TEST_F(ResultFiles, SummaryIsJson) {
  RunSummary summary;
  summary.version = "1.0.0+4f63e1a";
  summary.command = "gcpdda run 'a \\ b.toml'";
  summary.ranks = 3;
  summary.time_step = 1e-5;
  summary.max_overlap = std::nan("");
  summary.evaluations_per_rank = {10, 20, 30};
  summary.phases = {{"forces", {1.0, 2.0, 4.5}}};
  summary.counters = {{"migrations", 7}};
  summary.verdict = "failed";
  summary.message = "block \"a\\b\"\nis lost";
  write_summary(folder_, summary);
  const std::string text = read_text(folder_ / "summary.json");
  for (const char *part :
       {R"({"version": "1.0.0+4f63e1a",)", R"("command": "gcpdda run 'a \\ b.toml'",)", "\"ranks\": 3,",
        "\"time_step\": 1e-05,", "\"max_overlap\": null,", "\"evaluations_per_rank\": [10, 20, 30],",
        "\"energy\": {\"kinetic\": 0", "\"max_speed\": 0}",
        "\"phases\": {\"forces\": {\"min\": 1, \"mean\": 2, \"max\": 4.5}}",
        "\"counters\": {\"migrations\": 7}", "\"verdict\": \"failed\"",
        R"("message": "block \"a\\b\"\u000ais lost"})"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
  }
  EXPECT_FALSE(fs::exists(folder_ / "summary.json.tmp"));
}

TEST_F(ResultFiles, OwnersAreInBlockOrder) {
  write_owners(folder_, 120, {2, 0, 1});
  EXPECT_EQ(read_text(folder_ / "decomposition/owners_120.csv"), "block,rank\n0,2\n1,0\n2,1\n");
}

TEST_F(ResultFiles, FolderWithARunIsRefused) {
  prepare_result_directory(folder_ / "deep/run", false, "[run]\n");
  EXPECT_EQ(read_text(folder_ / "deep/run/scene.toml"), "[run]\n");
  EXPECT_THROW(prepare_result_directory(folder_ / "deep/run", false, "new"), FileError);
  EXPECT_EQ(read_text(folder_ / "deep/run/scene.toml"), "[run]\n");
  EXPECT_NO_THROW(prepare_result_directory(folder_ / "deep/run", true, "new"));
  EXPECT_EQ(read_text(folder_ / "deep/run/scene.toml"), "new");
}

TEST_F(ResultFiles, OverwriteRemovesOnlyWhatARunWrites) {
  const std::vector<std::string> own = {"run.log",
                                        "run.xdmf",
                                        "run.hdf.series",
                                        "summary.json",
                                        "run.xdmf.tmp",
                                        "frames/frame_000000.hdf",
                                        "frames/frame_000001.hdf.tmp",
                                        "frames/contacts_000000.hdf",
                                        "frames/bolts_000000.hdf",
                                        "frames/topology_000000.h5",
                                        "contacts.hdf.series",
                                        "bolts.hdf.series",
                                        "history/a.csv",
                                        "decomposition/owners_0.csv"};
  const std::vector<std::string> foreign = {"notes.txt", "frames/movie.gif", "frames/frame_of_mine.hdf",
                                            "history/measured.csv", "history/sub/a.csv"};
  prepare_result_directory(folder_, false, "[run]\n");
  for (const std::string &name : own) {
    write_text(folder_ / name, "time[s],x[m]\n");
  }
  for (const std::string &name : foreign) {
    write_text(folder_ / name, "mine");
  }
  prepare_result_directory(folder_, true, "new");
  for (const std::string &name : own) {
    EXPECT_FALSE(fs::exists(folder_ / name)) << name;
  }
  for (const std::string &name : foreign) {
    EXPECT_TRUE(fs::exists(folder_ / name)) << name;
  }
}

TEST_F(ResultFiles, ASceneThatIsNotOfARunSurvivesOverwrite) {
  write_text(folder_ / "scene.toml", "a person's input");
  EXPECT_THROW(prepare_result_directory(folder_, true, "new"), FileError);
  EXPECT_EQ(read_text(folder_ / "scene.toml"), "a person's input");
}

TEST_F(ResultFiles, FolderThatCannotBeMadeIsAFileError) {
  write_text(folder_ / "file", "");
  EXPECT_THROW(prepare_result_directory(folder_ / "file", false, ""), FileError);
  EXPECT_THROW(prepare_result_directory(folder_ / "file/below", false, ""), FileError);
}

constexpr double rotation_of_1 = 0.123456789;
constexpr double time_of_1 = 0.987654321;

// Two frames of two triangles, a contact frame of `num_contacts`, a history.
void write_small_run(const fs::path &directory, int num_contacts = 2) {
  FrameWriter writer(Communicator::self(), directory, 2);
  FrameData data{{FrameRow{}, FrameRow{}}, {{0, 0}, {1, 0}, {0, 1}, {0, 0}, {1, 0}, {0, 1}}};
  data.rows[0].num_vertices = 3;
  data.rows[1].num_vertices = 3;
  data.rows[1].block = 1;
  data.rows[1].rotation = rotation_of_1;
  writer.write(0, 0.0, GivenFrame(data));
  writer.write(1, time_of_1, GivenFrame(data));
  std::vector<ContactRow> contacts;
  for (int i = 0; i < num_contacts; ++i) {
    contacts.push_back({0, 1, i, 0, 1, {}, {}, 0, 0, 0, 0});
  }
  writer.write_contacts(1, 1.0, GivenContacts(contacts));
  HistoryWriter history(directory, {slider});
  history.write_monitor(0, 0.0, {});
  history.flush();
}

// Flips the lowest bit of the only place in the file that holds this number.
void flip_bit(const fs::path &path, double number) {
  std::string bytes = read_text(path);
  char pattern[sizeof(number)];
  std::memcpy(pattern, &number, sizeof(number));
  const std::size_t where = bytes.find(pattern, 0, sizeof(pattern));
  expect(where != std::string::npos && bytes.find(pattern, where + 1, sizeof(pattern)) == std::string::npos,
         "the number once in the file");
  bytes[where] = static_cast<char>(bytes[where] ^ 1);
  write_text(path, bytes);
}

class Comparison : public ResultFiles {
protected:
  Comparison() : a_(folder_ / "a"), b_(folder_ / "b") {
    write_small_run(a_);
    write_small_run(b_);
  }
  // That there is one difference, and that it names what differs.
  void expect_difference(const std::string &what) const {
    for (const auto &differences : {compare_runs(a_, b_), compare_runs(b_, a_)}) {
      EXPECT_EQ(differences.size(), 1U);
      EXPECT_NE(differences.empty() ? -1 : static_cast<int>(differences[0].find(what)), -1)
          << (differences.empty() ? "nothing" : differences[0]);
    }
  }
  fs::path a_;
  fs::path b_;
};

TEST_F(Comparison, FindsNothingInEqualRuns) {
  EXPECT_EQ(compare_runs(a_, b_), std::vector<std::string>{});
  write_text(b_ / "summary.json", "{}");
  write_text(b_ / "run.log", "log");
  write_text(b_ / "decomposition/owners_0.csv", "block,rank\n");
  EXPECT_EQ(compare_runs(a_, b_), std::vector<std::string>{});
}

TEST_F(Comparison, FindsOneBitOfADataset) {
  flip_bit(b_ / "frames/frame_000001.hdf", rotation_of_1);
  expect_difference("frame_000001.hdf: /VTKHDF/CellData/rotation: differs from byte 8");
}

TEST_F(Comparison, FindsAnAttribute) {
  flip_bit(b_ / "frames/frame_000001.hdf", time_of_1);
  expect_difference("frame_000001.hdf: /VTKHDF@time");
}

// HDF5 leaves gaps between what it holds; the longest run of zeros lies in one.
TEST_F(Comparison, FindsAByteThatIsNoContent) {
  std::string bytes = read_text(b_ / "frames/contacts_000001.hdf");
  std::string zeros(64, '\0');
  while (bytes.find(zeros + zeros) != std::string::npos) {
    zeros += zeros;
  }
  ASSERT_GE(zeros.size(), 512U);
  const std::size_t where = bytes.find(zeros) + zeros.size() / 2;
  bytes[where] = '\1';
  write_text(b_ / "frames/contacts_000001.hdf", bytes);
  expect_difference(
      fmt::format("contacts_000001.hdf: the contents are equal, the file differs from byte {} on", where));
}

TEST_F(Comparison, FindsAShape) {
  write_small_run(b_, 1);
  const std::vector<std::string> differences = compare_runs(a_, b_);
  EXPECT_TRUE(std::any_of(differences.begin(), differences.end(), [](const std::string &text) {
    return text == "frames/contacts_000001.hdf: /VTKHDF/CellData/blocks: shape (2, 2) and (1, 2)";
  }));
}

TEST_F(Comparison, FindsAMissingDataset) {
  fs::copy_file(b_ / "frames/contacts_000001.hdf", b_ / "frames/frame_000001.hdf",
                fs::copy_options::overwrite_existing);
  const std::vector<std::string> differences = compare_runs(a_, b_);
  EXPECT_TRUE(std::any_of(differences.begin(), differences.end(), [this](const std::string &text) {
    return text == "frames/frame_000001.hdf: /VTKHDF/CellData/rotation is only in " + a_.string();
  }));
}

TEST_F(Comparison, FindsAMissingFrame) {
  fs::remove(b_ / "frames/frame_000001.hdf");
  expect_difference("frames/frame_000001.hdf is only in " + a_.string());
}

TEST_F(Comparison, FindsAMissingTopologyThroughItsLinks) {
  fs::remove(b_ / "frames/topology_000000.h5");
  EXPECT_EQ(compare_runs(a_, b_).size(), 3U);
}

TEST_F(Comparison, FindsABrokenFile) {
  fs::resize_file(b_ / "frames/frame_000001.hdf", 1000);
  expect_difference("frame_000001.hdf: cannot open");
}

TEST_F(Comparison, FindsAHistoryByte) {
  std::string text = read_text(b_ / "history/slider.csv");
  text[text.size() - 2] = '1';
  write_text(b_ / "history/slider.csv", text);
  expect_difference("history/slider.csv: differs from line 2 on");
  text.resize(text.size() - 1);
  write_text(b_ / "history/slider.csv", text);
  expect_difference("history/slider.csv: differs from line 2 on");
}

TEST_F(Comparison, FindsATimeInTheIndex) {
  write_text(b_ / "run.hdf.series", "{}");
  expect_difference("run.hdf.series");
}

TEST_F(Comparison, OfFoldersWithoutFramesIsADifference) {
  EXPECT_FALSE(compare_runs(folder_ / "none", folder_ / "nowhere").empty());
  for (const fs::path &directory : {a_, b_}) {
    fs::remove_all(directory / "frames");
  }
  EXPECT_FALSE(compare_runs(a_, b_).empty());
}

TEST_F(Comparison, ReaderRefusesWhatIsNotAFrame) {
  EXPECT_THROW(read_frame(a_ / "frames/contacts_000001.hdf"), FileError);
  EXPECT_THROW(read_frame(a_ / "frames/none.hdf"), FileError);
}

} // namespace
} // namespace gcpdda::result_files_test
