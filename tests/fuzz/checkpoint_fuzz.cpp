// A checkpoint is the one that was written, or the one before is taken: whatever happens to its bytes. The
// input says how the newer of two is damaged, or which odd numbers are written into a whole one.

#include "require.hpp"

#include "base/check.hpp"
#include "io/checkpoint/checkpoint.hpp"
#include "io/checkpoint/checkpoint_reader.hpp"
#include "io/checkpoint/checkpoint_writer.hpp"
#include "io/hdf5/passing_files.hpp"
#include "simulation/bolts.hpp"
#include "simulation/stages.hpp"
#include "simulation/static_state.hpp"

#include <fuzzer/FuzzedDataProvider.h>
#include <hdf5.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace gcpdda::fuzz {
namespace {

namespace fs = std::filesystem;
using Input = FuzzedDataProvider;

constexpr std::int64_t num_blocks = 6;
constexpr std::size_t seal_size = 512;

BlockSystem squares(double speed) {
  const Material rock{"rock", 2600.0, 1e9, 0.2};
  BlockSystem blocks;
  for (std::int64_t id = 0; id < num_blocks; ++id) {
    SceneBlock block;
    const auto x = static_cast<double>(id);
    block.vertices = {{x, 0}, {x + 1, 0}, {x + 1, 1}, {x, 1}};
    append_block(blocks, BlockId{id}, block, rock, id % 3 == 0 ? BlockKind::deformable : BlockKind::rigid);
    blocks.velocity.back() = {{speed, x}, 0.0};
    ++blocks.num_owned;
  }
  return blocks;
}

/// One between each block and the next.
class Chain : public RegionSource {
public:
  [[nodiscard]] std::int64_t count(std::int64_t first, std::int64_t last) const override {
    return std::max<std::int64_t>(0, std::min(last, num_blocks - 1) - first);
  }
  void append(std::int64_t first, std::int64_t last, std::vector<RegionRecord> &records) const override {
    for (std::int64_t id = first; id < std::min(last, num_blocks - 1); ++id) {
      records.push_back({BlockId{id}, BlockId{id + 1}, {}});
    }
  }
};

RunFacts facts_at(std::int64_t step) {
  StageState stage;
  stage.index = 1;
  stage.results.resize(1);
  stage.removed = {2, 4};
  const StageNumbers numbers = to_numbers(stage);
  RunFacts facts;
  facts.scene = {num_blocks, num_blocks, 1, 1, {}};
  facts.step = step;
  facts.time = 0.01 * static_cast<double>(step);
  facts.stage_counts = numbers.counts;
  facts.stage_numbers = numbers.reals;
  facts.bolt_counts.resize(Bolts::counts_per_link);
  facts.bolt_numbers.resize(Bolts::numbers_per_link);
  facts.frame_times = {0.0, 0.1};
  facts.results = {{"history/energy.csv", 100, 3}, {"frames/frame_000000.hdf", 1000, -1}};
  return facts;
}

std::string text_of(const fs::path &path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write_text(const fs::path &path, const std::string &text) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << text;
}

fs::path path_of(const fs::path &folder, std::int64_t step) {
  return folder / "checkpoints" / ("checkpoint_00000000" + std::to_string(step) + ".h5");
}

/// Folders with good checkpoints.
class Runs {
public:
  Runs() {
    for (const char *name : {"run", "odd", "other"}) {
      fs::remove_all(folder_ / name);
      fs::create_directories(folder_ / name);
    }
    write("run", facts_at(7), 0.0);
    write("run", facts_at(8), 1.0);
    RunFacts other = facts_at(8);
    other.scene.materials = 2;
    write("other", other, 2.0);
    older = text_of(path_of(folder_ / "run", 7));
    newer = text_of(path_of(folder_ / "run", 8));
    foreign = text_of(path_of(folder_ / "other", 8));
  }
  void write(const std::string &name, const RunFacts &facts, double speed) const {
    CheckpointWriter(self, folder_ / name, path_of(folder_ / name, 7)).write(facts, squares(speed), Chain());
  }
  [[nodiscard]] fs::path operator/(const std::string &name) const { return folder_ / name; }

  const Communicator self = Communicator::self();
  std::string older;
  std::string newer;
  std::string foreign;

private:
  PassingFiles passing_;
  fs::path folder_ = fs::temp_directory_path() / ("gcpdda_fuzz_" + std::to_string(getpid()));
};

std::string any_change(Input &input, const Runs &runs, std::string bytes) {
  const auto place = [&](std::size_t end) {
    return input.ConsumeIntegralInRange<std::size_t>(0, std::max<std::size_t>(end, 1) - 1);
  };
  switch (input.ConsumeIntegralInRange<int>(0, 9)) {
  case 0:
    return bytes.substr(0, place(bytes.size() + 1));
  case 1:
    return bytes + input.ConsumeRandomLengthString(64);
  case 2: { // a page that was never written
    const std::size_t first = place(bytes.size());
    bytes.replace(first, std::min<std::size_t>(4096, bytes.size() - first),
                  std::min<std::size_t>(4096, bytes.size() - first), '\0');
    return bytes;
  }
  case 3:
    return input.ConsumeBool() ? runs.older : runs.foreign;
  case 4:
    return input.ConsumeRandomLengthString(1024);
  case 5: { // half of another file
    const std::size_t cut = place(bytes.size());
    const std::string &end = input.ConsumeBool() ? runs.older : runs.foreign;
    return bytes.substr(0, cut) + end.substr(std::min(cut, end.size()));
  }
  case 6: // the seal
    if (bytes.size() > seal_size) {
      const std::string text = input.ConsumeRandomLengthString(100);
      bytes.replace(place(seal_size - text.size()), text.size(), text);
    }
    return bytes;
  case 7: // without its seal: an HDF5 file
    return bytes.substr(std::min(seal_size, bytes.size()));
  default:
    for (int k = input.ConsumeIntegralInRange<int>(1, 4); k > 0 && !bytes.empty(); --k) {
      char &byte = bytes[place(bytes.size())];
      byte = input.ConsumeBool() ? static_cast<char>(byte ^ (1 << input.ConsumeIntegralInRange(0, 7)))
                                 : input.ConsumeIntegral<char>();
    }
    return bytes;
  }
}

Restored restore(const Runs &runs, const fs::path &folder,
                 const std::function<void(const RunFacts &)> &prepare) {
  BlockSystem blocks = squares(0.0);
  return restore_newest_checkpoint(runs.self, folder, facts_at(0).scene, blocks, prepare,
                                   EarlierResults::may_have_gaps);
}

void damage(Input &input, const Runs &runs) {
  std::string bytes = runs.newer;
  for (int k = input.ConsumeIntegralInRange<int>(1, 3); k > 0; --k) {
    bytes = any_change(input, runs, std::move(bytes));
  }
  write_text(path_of(runs / "run", 8), bytes);
  const bool is_good = bytes == runs.newer;
  const Restored restored = restore(runs, runs / "run", {});
  require(restored.facts.step == (is_good ? 8 : 7), "a damaged checkpoint is not taken, the one before is");
  require(restored.rejected.size() == (is_good ? 0 : 1), "a damaged checkpoint is named");
  require(restored.gaps.size() == 2, "results that are not there are told");
}

std::int64_t any_count(Input &input) {
  return input.ConsumeBool()
             ? input.ConsumeIntegralInRange<std::int64_t>(-2, 8)
             : input.PickValueInArray({std::int64_t{1} << 32, std::int64_t{1} << 62,
                                       std::numeric_limits<std::int64_t>::min(),
                                       std::numeric_limits<std::int64_t>::max(), std::int64_t{-1} << 40});
}

/// Whole, but no state: whoever uses the numbers refuses them.
void write_oddly(Input &input, const Runs &runs) {
  RunFacts facts = facts_at(8);
  for (std::vector<std::int64_t> RunFacts::*counts :
       {&RunFacts::stage_counts, &RunFacts::bolt_counts, &RunFacts::static_counts}) {
    (facts.*counts).resize(input.ConsumeIntegralInRange<std::size_t>(0, 40));
    for (int k = input.ConsumeIntegralInRange<int>(0, 5); k > 0 && !(facts.*counts).empty(); --k) {
      (facts.*counts)[input.ConsumeIntegralInRange<std::size_t>(0, (facts.*counts).size() - 1)] =
          any_count(input);
    }
  }
  for (std::vector<double> RunFacts::*numbers :
       {&RunFacts::stage_numbers, &RunFacts::bolt_numbers, &RunFacts::static_numbers, &RunFacts::frame_times,
        &RunFacts::ledger}) {
    (facts.*numbers)
        .resize(input.ConsumeIntegralInRange<std::size_t>(0, 40), input.ConsumeFloatingPoint<double>());
  }
  facts.results.resize(input.ConsumeIntegralInRange<std::size_t>(0, 3));
  for (ResultFile &file : facts.results) {
    file = {"frames/" + std::to_string(any_count(input)), any_count(input), any_count(input)};
  }
  runs.write("odd", facts, 0.0);
  const Restored restored = restore(runs, runs / "odd", [&](const RunFacts &read) {
    require(read.stage_counts == facts.stage_counts && read.bolt_counts == facts.bolt_counts &&
                read.results == facts.results && read.frame_times.size() == facts.frame_times.size(),
            "what has been written is read");
    try {
      const StageState state = to_state({read.stage_counts, read.stage_numbers});
      require(to_numbers(state).counts.size() == read.stage_counts.size(), "a state is that of its numbers");
    } catch (const FileError &) {
    }
    try {
      const StaticState state = to_static_state(read.static_counts, read.static_numbers);
      require(state.blocks.empty() || to_numbers(state).counts == read.static_counts,
              "a static solver is that of its numbers");
    } catch (const FileError &) {
    }
    try {
      require(Bolts::from_numbers(read.bolt_counts, read.bolt_numbers).links().size() ==
                  read.bolt_counts.size() / Bolts::counts_per_link,
              "bolts are those of their numbers");
    } catch (const FileError &) {
    }
  });
  require(restored.facts.step == 8, "a whole checkpoint is taken");
}

void run(Input input) {
  static const Runs runs;
  if (input.ConsumeIntegralInRange<int>(0, 7) == 0) {
    write_oddly(input, runs);
  } else {
    damage(input, runs);
  }
  require(H5Fget_obj_count(H5F_OBJ_ALL, H5F_OBJ_FILE | H5F_OBJ_DATASET | H5F_OBJ_GROUP | H5F_OBJ_ATTR) == 0,
          "nothing stays open");
}

} // namespace
} // namespace gcpdda::fuzz

/// The leak checker stumbles over the threads of MPI. Nobody asks for much memory, HDF5 neither: it never
/// sees a damaged file.
extern "C" const char *__asan_default_options() {
  return "detect_leaks=0:max_allocation_size_mb=256";
}

extern "C" int LLVMFuzzerInitialize(int *argc, char ***argv) {
  setenv("OMPI_MCA_opal_signal", "", 1); // else Open MPI takes the crashes that libFuzzer keeps inputs of
  static const gcpdda::MpiScope scope(*argc, *argv);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  gcpdda::fuzz::run(FuzzedDataProvider(data, size));
  return 0;
}
