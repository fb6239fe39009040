#include "io/checkpoint/checkpoint_reader.hpp"

#include "io/checkpoint/checkpoint_facts.hpp"
#include "io/checkpoint/checkpoint_layout.hpp"
#include "io/checkpoint/checkpoint_seal.hpp"
#include "io/hdf5/hdf5_collective_file.hpp"
#include "io/hdf5/hdf5_input.hpp"
#include "io/hdf5/numbered_name.hpp"
#include "io/results/frame_strips.hpp"
#include "io/results/id_slabs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <tuple>
#include <utility>

namespace gcpdda {

namespace {

namespace fs = std::filesystem;

/// Throws where the scene is another one.
void expect_same_scene(const SceneIdentity &saved, const SceneIdentity &scene) {
  if (saved.num_blocks != scene.num_blocks || saved.num_mobile != scene.num_mobile) {
    throw FileError(
        fmt::format("it is of another scene: {} blocks of which {} can move, this one has {} and {}",
                    saved.num_blocks, saved.num_mobile, scene.num_blocks, scene.num_mobile));
  }
  if (saved.materials != scene.materials) {
    throw FileError("it is of another scene: a material has another density or elasticity");
  }
  if (saved.blocks != scene.blocks) {
    throw FileError("it is of another scene, or its block file has changed: a block has another outline, "
                    "material or initial velocity, or is held or driven differently");
  }
}

/// Reads rows and sums up what it has read.
class SummedInput {
public:
  SummedInput(const Communicator &communicator, const FoundCheckpoint &found)
      : communicator_(communicator), input_(communicator, found.path), checksum_(found.checksum) {
    if (communicator.is_root()) {
      sum_facts(found.facts);
    }
  }

  /// Dataset of exactly that many rows in all.
  template <class T> std::vector<T> rows(const char *name, RowRange range, hsize_t columns = 1) {
    if (const std::int64_t there = input_.num_rows(name); there != range.total) {
      throw FileError(fmt::format("{} has {} rows and not {}", name, there, range.total));
    }
    if (range.total == 0) {
      return {};
    }
    std::vector<T> values = input_.rows<T>(name, range.first, range.count, columns);
    sum_.add(name, range.first * static_cast<std::int64_t>(columns), std::span<const T>(values));
    return values;
  }

  /// Every row of such a dataset on some rank, for the sum alone: piece by piece, and none is kept.
  template <class T> void pass(const char *name, std::int64_t num_rows, hsize_t columns = 1) {
    const Strips pieces{num_rows, communicator_.size(), usual_ids_per_strip};
    for (int number = 0; number < std::max(1, pieces.size()); ++number) {
      const IdRange piece = pieces.of(communicator_.rank(), number);
      rows<T>(name, {piece.first, piece.last - piece.first, num_rows}, columns);
    }
  }

  std::int64_t num_rows(const char *name) { return input_.num_rows(name); }

  /// An equal share of all rows of a dataset.
  RowRange share_of(const char *name) {
    RowRange range{0, 0, input_.num_rows(name)};
    range.first = slab_begin(range.total, communicator_.size(), communicator_.rank());
    range.count = slab_begin(range.total, communicator_.size(), communicator_.rank() + 1) - range.first;
    return range;
  }

  /// Once all has been read.
  void expect_whole() const {
    if (static_cast<std::int64_t>(sum_.total(communicator_)) != checksum_) {
      throw FileError("it is damaged: its checksum is wrong");
    }
  }

private:
  void sum_facts(const RunFacts &facts) {
    for (const auto &[name, value] : checkpoint::whole_facts(facts)) {
      sum_.add(name, 0, std::span<const std::int64_t>(&value, 1));
    }
    for (const auto &[name, member] : checkpoint::real_facts) {
      sum_.add(name, 0, std::span<const double>(&(facts.*member), 1));
    }
    const checkpoint::ResultLists results = checkpoint::to_lists(facts.results);
    sum_.add(checkpoint::result_names, 0, std::span<const std::uint8_t>(results.names));
    sum_.add(checkpoint::result_bytes, 0, std::span<const std::int64_t>(results.bytes));
    sum_.add(checkpoint::result_rows, 0, std::span<const std::int64_t>(results.rows));
    const ScenePrints &parts = facts.scene.parts;
    sum_.add(checkpoint::scene_parts, 0, std::span<const std::uint64_t>(parts));
    for (const auto &[name, member] : checkpoint::real_lists) {
      sum_.add(name, 0, std::span<const double>(facts.*member));
    }
    for (const auto &[name, member] : checkpoint::whole_lists) {
      sum_.add(name, 0, std::span<const std::int64_t>(facts.*member));
    }
  }

  Communicator communicator_;
  hdf5::CollectiveInput input_;
  std::int64_t checksum_;
  checkpoint::ContentSum sum_;
};

/// Reads the rows of this rank.
class StateReader {
public:
  StateReader(const Communicator &communicator, const FoundCheckpoint &found)
      : communicator_(communicator), found_(found), input_(communicator, found) {}

  std::vector<RegionRecord> restore(BlockSystem &blocks) {
    read_blocks(blocks);
    read_deformations(blocks);
    const std::vector<RegionRecord> records = read_regions();
    input_.expect_whole();
    apply(blocks);
    return send_to_slabs(records);
  }

private:
  void expect_here(bool condition, const char *what) {
    on_all_ranks(communicator_, [&] {
      if (!condition) {
        throw FileError(what);
      }
    });
  }

  void read_blocks(const BlockSystem &blocks) {
    const RowRange range = rows_in_rank_order(communicator_, static_cast<std::int64_t>(blocks.num_owned));
    const auto ids = input_.rows<std::int64_t>(checkpoint::block_ids, range);
    const auto kinds = input_.rows<std::uint8_t>(checkpoint::block_kinds, range);
    bool same_ids = true;
    bool same_kinds = true;
    for (std::size_t row = 0; row < ids.size(); ++row) {
      same_ids = same_ids && ids[row] == blocks.properties[row].id.value;
      same_kinds = same_kinds && kinds[row] == static_cast<std::uint8_t>(blocks.properties[row].kind);
    }
    expect_here(same_ids, "it is damaged: its blocks are not those of its scene");
    expect_here(same_kinds, "a block that was rigid would now be deformable or the other way round: its "
                            "stiffness or that of its joints has changed, or the fidelity");
    for (const auto &field : checkpoint::block_fields) {
      block_values_.push_back(input_.rows<double>(field.name, range, field.columns));
    }
    for (const auto &field : checkpoint::unshaken_fields) {
      has_shaken_ = input_.num_rows(field.name) > 0;
      if (has_shaken_) {
        unshaken_values_ = input_.rows<double>(field.name, range, field.columns);
      }
    }
  }

  void read_deformations(const BlockSystem &blocks) {
    const RowRange range = rows_in_rank_order(
        communicator_, static_cast<std::int64_t>(blocks.deformation_begin[blocks.num_owned]));
    const auto ids = input_.rows<std::int64_t>(checkpoint::deformation_ids, range);
    std::size_t next = 0;
    bool same_ids = true;
    for (std::size_t row = 0; row < blocks.num_owned && !ids.empty(); ++row) {
      if (blocks.is_deformable(row)) {
        same_ids = same_ids && ids[next++] == blocks.properties[row].id.value;
      }
    }
    expect_here(same_ids, "it is damaged: its deformable blocks are not those of its scene");
    for (const auto &field : checkpoint::deformation_fields) {
      deformation_values_.push_back(input_.rows<double>(field.name, range, field.columns));
    }
  }

  /// An equal share of them all, in the order of the file.
  std::vector<RegionRecord> read_regions() {
    const RowRange range = input_.share_of(checkpoint::region_blocks);
    const auto blocks = input_.rows<std::int64_t>(checkpoint::region_blocks, range, 2);
    const auto stretches = input_.rows<std::int32_t>(checkpoint::region_stretches, range, 2);
    const auto states = input_.rows<std::uint8_t>(checkpoint::region_states, range);
    const auto laws = input_.rows<std::int32_t>(checkpoint::region_laws, range);
    const auto seen_at = input_.rows<std::int32_t>(checkpoint::region_seen_at, range);
    std::vector<RegionRecord> records(states.size());
    bool sound = true;
    for (std::size_t k = 0; k < records.size(); ++k) {
      RegionRecord &record = records[k];
      record.lower = BlockId{blocks[2 * k]};
      record.higher = BlockId{blocks[2 * k + 1]};
      record.memory.lower_stretch = stretches[2 * k];
      record.memory.higher_stretch = stretches[2 * k + 1];
      record.memory.state = static_cast<ContactState>(states[k]);
      record.memory.law = laws[k];
      record.memory.seen_at = static_cast<std::uint16_t>(seen_at[k]);
      sound = sound && 0 <= record.lower.value && record.lower < record.higher &&
              record.higher.value < found_.facts.scene.num_blocks;
    }
    for (const auto &field : checkpoint::region_fields) {
      const std::vector<double> values = input_.rows<double>(field.name, range, field.columns);
      for (std::size_t k = 0; k < records.size(); ++k) {
        field.set(records, k, values.data() + k * field.columns);
      }
    }
    expect_here(sound, "it is damaged: its contacts are not those of its scene");
    return records;
  }

  void apply(BlockSystem &blocks) const {
    for (std::size_t f = 0; f < checkpoint::block_fields.size(); ++f) {
      const auto &field = checkpoint::block_fields[f];
      for (std::size_t row = 0; row < blocks.num_owned; ++row) {
        field.set(blocks, row, block_values_[f].data() + row * field.columns);
      }
    }
    for (const auto &field : checkpoint::unshaken_fields) {
      for (std::size_t row = 0; row < blocks.num_owned && has_shaken_; ++row) {
        field.set(blocks, row, unshaken_values_.data() + row * field.columns);
      }
    }
    for (std::size_t f = 0; f < checkpoint::deformation_fields.size(); ++f) {
      const auto &field = checkpoint::deformation_fields[f];
      for (std::size_t row = 0; row < blocks.deformation_begin[blocks.num_owned]; ++row) {
        field.set(blocks.deformation, row, deformation_values_[f].data() + row * field.columns);
      }
    }
  }

  /// To the slabs of both blocks: each rank knows all contacts of its rows.
  std::vector<RegionRecord> send_to_slabs(const std::vector<RegionRecord> &records) const {
    const int num_ranks = communicator_.size();
    std::vector<std::vector<RegionRecord>> leaving(static_cast<std::size_t>(num_ranks));
    for (const RegionRecord &record : records) {
      const int lower = slab_owner(found_.facts.scene.num_blocks, num_ranks, record.lower.value);
      const int higher = slab_owner(found_.facts.scene.num_blocks, num_ranks, record.higher.value);
      leaving[static_cast<std::size_t>(lower)].push_back(record);
      if (higher != lower) {
        leaving[static_cast<std::size_t>(higher)].push_back(record);
      }
    }
    std::vector<RegionRecord> memory;
    for (const std::vector<RegionRecord> &message : communicator_.all_to_all(leaving)) {
      memory.insert(memory.end(), message.begin(), message.end());
    }
    return memory;
  }

  Communicator communicator_;
  const FoundCheckpoint &found_;
  SummedInput input_;
  std::vector<std::vector<double>> block_values_;
  bool has_shaken_ = false;
  std::vector<double> unshaken_values_;
  std::vector<std::vector<double>> deformation_values_;
};

template <class T> void share(const Communicator &communicator, std::vector<T> &values) {
  Bytes bytes(values.size() * sizeof(T));
  if (!bytes.empty()) {
    std::memcpy(bytes.data(), values.data(), bytes.size());
  }
  communicator.broadcast(bytes);
  values.resize(bytes.size() / sizeof(T));
  if (!bytes.empty()) {
    std::memcpy(values.data(), bytes.data(), bytes.size());
  }
}

/// The root's finding for all.
void share(const Communicator &communicator, FoundCheckpoint &found) {
  std::string path = found.path.string();
  communicator.broadcast(path);
  found.path = path;
  RunFacts &facts = found.facts;
  Bytes bytes;
  const auto each = [&](auto &&visit) {
    visit(facts.scene), visit(facts.step), visit(facts.contact_steps), visit(found.checksum);
    for (const auto &[name, member] : checkpoint::real_facts) {
      visit(facts.*member);
    }
  };
  each([&](auto &value) {
    const auto *first = reinterpret_cast<const std::byte *>(&value);
    bytes.insert(bytes.end(), first, first + sizeof(value));
  });
  communicator.broadcast(bytes);
  std::size_t at = 0;
  each([&](auto &value) {
    std::memcpy(&value, bytes.data() + at, sizeof(value));
    at += sizeof(value);
  });
  for (const auto &[name, member] : checkpoint::real_lists) {
    share(communicator, facts.*member);
  }
  for (const auto &[name, member] : checkpoint::whole_lists) {
    share(communicator, facts.*member);
  }
}

std::string reason(const fs::path &path, const std::string &why) {
  return fmt::format("{}: {}", path.string(), why);
}

/// A file that has the seal of a checkpoint.
struct Sealed {
  fs::path path;
  checkpoint::Seal seal;
};

/// Root only: newest first; those without a seal into `rejected`.
std::vector<Sealed> sealed_files(const fs::path &directory, std::vector<std::string> &rejected) {
  std::vector<Sealed> found;
  for (const fs::path &path : checkpoint_files(directory)) {
    try {
      found.push_back({path, checkpoint::read_seal(path)});
    } catch (const std::exception &error) {
      rejected.push_back(reason(path, error.what()));
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Sealed &a, const Sealed &b) { return a.seal.step > b.seal.step; });
  return found;
}

/// The root's file for all, and what it holds once all its bytes have been compared. Collective.
FoundCheckpoint look_at_sealed(const Communicator &communicator, Sealed file) {
  std::string path = file.path.string();
  communicator.broadcast(path);
  file.path = path;
  std::vector<checkpoint::Seal> seal{file.seal};
  share(communicator, seal);
  checkpoint::expect_unchanged(communicator, file.path, seal.front());
  FoundCheckpoint found;
  on_root(communicator, [&] { found = look_at(file.path); });
  share(communicator, found);
  return found;
}

/// What is wrong with the results in a folder, for the root.
/// @throws FileError on all ranks where they have to be whole and are not
void find_gaps(const Communicator &communicator, const fs::path &directory,
               const std::vector<ResultFile> &results, EarlierResults demand,
               std::vector<std::string> &gaps) {
  on_root(communicator, [&] {
    gaps = demand == EarlierResults::are_not_looked_at ? std::vector<std::string>()
                                                       : gaps_in(directory, results);
    if (demand == EarlierResults::must_be_whole && !gaps.empty()) {
      throw FileError("results before it are not whole: " + words_on_gaps(gaps));
    }
  });
}

} // namespace

std::vector<fs::path> checkpoint_files(const fs::path &directory) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const fs::directory_entry &entry : fs::directory_iterator(checkpoint::folder(directory), none)) {
    if (is_numbered(entry.path().filename().string(), "checkpoint", ".h5")) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

void expect_readable_checkpoint(const Communicator &communicator, const fs::path &path) {
  Sealed file{path, {}};
  on_root(communicator, [&] { file.seal = checkpoint::read_seal(path); });
  const FoundCheckpoint found = look_at_sealed(communicator, file);
  SummedInput input(communicator, found);
  const auto fields = [&](const auto &table, std::int64_t num_rows) {
    for (const auto &field : table) {
      input.pass<double>(field.name, num_rows, field.columns);
    }
  };
  const std::int64_t num_blocks = input.num_rows(checkpoint::block_ids);
  input.pass<std::int64_t>(checkpoint::block_ids, num_blocks);
  input.pass<std::uint8_t>(checkpoint::block_kinds, num_blocks);
  fields(checkpoint::block_fields, num_blocks);
  fields(checkpoint::unshaken_fields, input.num_rows(checkpoint::unshaken_fields[0].name));
  const std::int64_t num_deformations = input.num_rows(checkpoint::deformation_ids);
  input.pass<std::int64_t>(checkpoint::deformation_ids, num_deformations);
  fields(checkpoint::deformation_fields, num_deformations);
  const std::int64_t num_regions = input.num_rows(checkpoint::region_blocks);
  input.pass<std::int64_t>(checkpoint::region_blocks, num_regions, 2);
  input.pass<std::int32_t>(checkpoint::region_stretches, num_regions, 2);
  input.pass<std::uint8_t>(checkpoint::region_states, num_regions);
  input.pass<std::int32_t>(checkpoint::region_laws, num_regions);
  input.pass<std::int32_t>(checkpoint::region_seen_at, num_regions);
  fields(checkpoint::region_fields, num_regions);
  input.expect_whole();
}

Restored restore_newest_checkpoint(const Communicator &communicator, const fs::path &directory,
                                   const SceneIdentity &scene, BlockSystem &blocks,
                                   const std::function<void(const RunFacts &)> &prepare,
                                   EarlierResults results) {
  Restored restored;
  std::vector<Sealed> files;
  on_root(communicator, [&] { files = sealed_files(directory, restored.rejected); });
  std::int64_t count = std::ssize(files);
  communicator.max(std::span(&count, 1));
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    const Sealed file = communicator.is_root() ? files[k] : Sealed{};
    try {
      const FoundCheckpoint candidate = look_at_sealed(communicator, file);
      expect_same_scene(candidate.facts.scene, scene);
      if (prepare) {
        prepare(candidate.facts);
      }
      find_gaps(communicator, directory, candidate.facts.results, results, restored.gaps);
      restored.memory = StateReader(communicator, candidate).restore(blocks);
      restored.path = candidate.path;
      restored.facts = candidate.facts;
      return restored;
    } catch (const FileError &error) { // on all ranks
      restored.rejected.push_back(reason(file.path, error.what()));
    }
  }
  std::string text = fmt::format("cannot restart {}: ", directory.string());
  if (restored.rejected.empty()) {
    text += fmt::format("there is no checkpoint in {}, try gcpdda run with output.checkpoint_interval",
                        checkpoint::folder(directory).string());
  } else {
    text += "no checkpoint can be used";
    for (const std::string &why : restored.rejected) {
      text += "\n  " + why;
    }
    text += restored.gaps.empty() ? ""
                                  : "\nbring the files back that are missing, or go on without them: gcpdda "
                                    "restart --accept-gaps";
  }
  communicator.broadcast(text);
  throw FileError(text);
}

} // namespace gcpdda
