#include "io/blocks/block_file.hpp"

#include "io/blocks/block_file_layout.hpp"
#include "io/hdf5/hdf5_collective_file.hpp"
#include "io/hdf5/hdf5_input.hpp"
#include "io/scene/scene_keys.hpp"
#include "io/scene/scene_outline.hpp"
#include "model/generators.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace gcpdda {

namespace {

using scene_text::largest_coordinate;
using scene_text::most_blocks_in_all;

constexpr std::size_t most_faults = 20; ///< written out

/// A fault with the block it belongs to, by which the faults of all ranks are put in order.
struct BlockFault {
  std::int64_t block = 0;
  Diagnostic diagnostic;
};

// Diagnostics as they travel: the parts of each, ended by a character that none of them holds.
constexpr char end_of_part = '\0';

void append(std::string &text, const std::string &part) {
  text += part + end_of_part;
}

std::string pack(const std::vector<BlockFault> &faults) {
  std::string text;
  for (const BlockFault &fault : faults) {
    const Diagnostic &d = fault.diagnostic;
    for (const std::string &part : {std::to_string(fault.block), d.where.file, std::to_string(d.where.line),
                                    std::to_string(d.where.column), d.what, d.why, d.hint}) {
      append(text, part);
    }
  }
  return text;
}

std::vector<BlockFault> unpack(const std::string &text) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find(end_of_part, at);
    parts.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  std::vector<BlockFault> faults;
  constexpr std::size_t num_parts = 7;
  for (std::size_t i = 0; i + num_parts <= parts.size(); i += num_parts) {
    faults.push_back({std::stoll(parts[i]),
                      {Severity::error,
                       {parts[i + 1], std::stoi(parts[i + 2]), std::stoi(parts[i + 3])},
                       parts[i + 4],
                       parts[i + 5],
                       parts[i + 6]}});
  }
  return faults;
}

/// Collects the faults of this rank's blocks; keeps no more of them than are written out.
class Collector {
public:
  explicit Collector(std::string path) : path_(std::move(path)) {}

  void add(std::int64_t block, const std::string &what, std::string why, std::string hint) {
    add_plain(block, fmt::format("block {}: {}", block, what), std::move(why), std::move(hint));
  }
  /// Of no block; stands where those of `block` stand.
  void add_plain(std::int64_t block, std::string what, std::string why, std::string hint) {
    ++num_faults_;
    faults_.push_back(
        {block, {Severity::error, {path_, 0, 0}, std::move(what), std::move(why), std::move(hint)}});
    if (faults_.size() > 2 * most_faults) {
      keep_first();
    }
  }
  [[nodiscard]] bool empty() const { return num_faults_ == 0; }

  /// Of all ranks together.
  Diagnostics gather(const Communicator &communicator) {
    keep_first();
    const std::string mine = pack(faults_);
    faults_.clear();
    for (const std::vector<char> &text :
         communicator.all_gather(std::vector<char>(mine.begin(), mine.end()))) {
      const std::vector<BlockFault> theirs = unpack(std::string(text.begin(), text.end()));
      faults_.insert(faults_.end(), theirs.begin(), theirs.end());
    }
    std::int64_t total = num_faults_;
    communicator.sum(std::span(&total, 1));
    keep_first();
    Diagnostics diagnostics;
    for (BlockFault &fault : faults_) {
      diagnostics.push_back(std::move(fault.diagnostic));
    }
    const std::int64_t rest = total - static_cast<std::int64_t>(diagnostics.size());
    if (rest > 0) {
      diagnostics.push_back({Severity::error,
                             {path_, 0, 0},
                             fmt::format("{} more faults", rest),
                             fmt::format("only the first {} are written out", most_faults),
                             "mend these first"});
    }
    return diagnostics;
  }

private:
  void keep_first() {
    std::stable_sort(faults_.begin(), faults_.end(),
                     [](const BlockFault &a, const BlockFault &b) { return a.block < b.block; });
    faults_.resize(std::min(faults_.size(), most_faults));
  }

  std::string path_;
  std::vector<BlockFault> faults_;
  std::int64_t num_faults_ = 0;
};

/// What a rank has read of its blocks.
struct Rows {
  std::vector<std::int64_t> offsets; ///< one more than blocks, or none
  std::vector<std::int32_t> material;
  std::vector<std::uint8_t> fixed;
  std::vector<double> velocity; ///< three a block, or none
};

/// Makes this rank's blocks from what the file holds.
class BlockMaker {
public:
  BlockMaker(const Scene &scene, std::int64_t first, const Rows &rows, Collector &faults)
      : num_materials_(static_cast<std::int64_t>(scene.materials.size())), joints_(&scene.joints.laws),
        first_(first), rows_(&rows), faults_(&faults) {}

  /// False where no points can be read for them.
  bool check_offsets(std::int64_t num_blocks, std::int64_t num_points) {
    const std::vector<std::int64_t> &offsets = rows_->offsets;
    const bool was_sound = faults_->empty();
    if (offsets.empty()) {
      return true;
    }
    if (first_ == 0 && offsets.front() != 0) {
      faults_->add_plain(0, fmt::format("'/offsets' begins with {}", offsets.front()),
                         "the points of the first block begin with number 0", "write 0 there");
    }
    for (std::size_t i = 0; i + 1 < offsets.size(); ++i) {
      check_offset(first_ + static_cast<std::int64_t>(i), offsets[i], offsets[i + 1], num_points);
    }
    const std::int64_t last = first_ + static_cast<std::int64_t>(offsets.size()) - 1;
    if (last == num_blocks && offsets.back() != num_points && offsets.back() <= num_points) {
      faults_->add_plain(last, fmt::format("'/offsets' ends with {}", offsets.back()),
                         fmt::format("'/points' has {} rows", num_points),
                         "end '/offsets' with the number of points");
    }
    return was_sound && faults_->empty();
  }

  /// All but the outline.
  SceneBlock make(std::size_t i) {
    const std::int64_t number = first_ + static_cast<std::int64_t>(i);
    SceneBlock block;
    block.material = rows_->material[i];
    if (block.material < 0 || block.material >= num_materials_) {
      faults_->add(
          number, fmt::format("material is {}", block.material),
          fmt::format("the scene has materials 0 to {}, in the order of its file", num_materials_ - 1),
          "give one of these numbers");
      block.material = 0;
    }
    if (rows_->fixed[i] > 1) {
      faults_->add(number, fmt::format("fixed is {}", rows_->fixed[i]), "it must be 0 or 1",
                   "write 1 for a block that never moves");
    }
    block.fixed = rows_->fixed[i] == 1;
    if (!rows_->velocity.empty()) {
      read_velocity(number, i, block);
    }
    return block;
  }

  /// @param points      x and y of all points of this rank
  /// @param edge_joint  laws of all edges of this rank, or none
  void add_outline(std::size_t i, const std::vector<double> &points,
                   const std::vector<std::int32_t> &edge_joint, SceneBlock &block) {
    const std::int64_t number = first_ + static_cast<std::int64_t>(i);
    const auto begin = static_cast<std::size_t>(rows_->offsets[i] - rows_->offsets.front());
    const auto end = static_cast<std::size_t>(rows_->offsets[i + 1] - rows_->offsets.front());
    block.vertices.reserve(end - begin);
    for (std::size_t k = begin; k < end; ++k) {
      block.vertices.push_back({points[2 * k], points[2 * k + 1]});
    }
    if (!edge_joint.empty()) {
      read_edge_joints(number, std::span(edge_joint).subspan(begin, end - begin), block);
    }
    bool finite = true;
    for (std::size_t k = 0; k < block.vertices.size(); ++k) {
      const Vec2 p = block.vertices[k];
      if (!is_coordinate(p.x) || !is_coordinate(p.y)) {
        finite = false;
        expect_coordinate(number, p.x, fmt::format("x of vertex {}", k));
        expect_coordinate(number, p.y, fmt::format("y of vertex {}", k));
      }
    }
    if (!finite) {
      return;
    }
    for (const scene_text::OutlineFault &f :
         scene_text::check_outline(block.vertices, block.edge_joint, "the outline")) {
      faults_->add(number, f.what, f.why, f.hint);
    }
  }

private:
  void check_offset(std::int64_t number, std::int64_t begin, std::int64_t end, std::int64_t num_points) {
    if (begin < 0 || end > num_points) {
      faults_->add(number, fmt::format("its points are {} to {}", begin, end),
                   fmt::format("'/points' has {} rows", num_points), "check '/offsets'");
    } else if (end < begin) {
      faults_->add(number, fmt::format("'/offsets' falls from {} to {}", begin, end),
                   "the points of a block follow those of the block before", "check '/offsets'");
    } else if (end - begin < 3) {
      faults_->add(number, fmt::format("it has {} vertices", end - begin), "a block has at least 3",
                   "check '/offsets'");
    } else if (end - begin > static_cast<std::int64_t>(scene_text::most_vertices)) {
      faults_->add(number, fmt::format("it has {} vertices", end - begin),
                   fmt::format("a block has at most {}", scene_text::most_vertices), "simplify the outline");
    }
  }

  static bool is_coordinate(double x) { return std::isfinite(x) && std::abs(x) <= largest_coordinate; }

  void expect_coordinate(std::int64_t number, double x, const std::string &who) {
    if (!is_coordinate(x)) {
      faults_->add(number, fmt::format("{} is {}", who, x),
                   std::isfinite(x) ? fmt::format("it must be at least {:g} and at most {:g}",
                                                  -largest_coordinate, largest_coordinate)
                                    : "it must be finite",
                   "check where the file is written");
    }
  }

  void read_edge_joints(std::int64_t number, std::span<const std::int32_t> joints, SceneBlock &block) {
    block.edge_joint.assign(joints.begin(), joints.end());
    for (std::size_t k = 0; k < joints.size(); ++k) {
      if (joints[k] < -1 || joints[k] >= std::ssize(*joints_)) {
        faults_->add(number, fmt::format("edge_joint of edge {} is {}", k, joints[k]),
                     fmt::format("the scene has joints 0 to {}, in the order of its file but default first",
                                 joints_->size() - 1),
                     "give one of these numbers, or -1 for the law of the materials");
        block.edge_joint[k] = -1;
      }
    }
  }

  // Velocities have the bounds of coordinates, as in the scene file.
  void read_velocity(std::int64_t number, std::size_t i, SceneBlock &block) {
    for (std::size_t k = 0; k < 3; ++k) {
      block.velocity[k] = rows_->velocity[3 * i + k];
    }
    if (!std::all_of(block.velocity.begin(), block.velocity.end(), is_coordinate)) {
      for (std::size_t k = 0; k < 3; ++k) {
        expect_coordinate(number, block.velocity[k], fmt::format("entry {} of velocity", k));
      }
    } else if (block.fixed && block.velocity != std::array<double, 3>{}) {
      faults_->add(number, "it is fixed but has a velocity", "a fixed block never moves",
                   "write velocity 0 or fixed 0");
    }
  }

  std::int64_t num_materials_;
  const std::vector<JointLaw> *joints_;
  std::int64_t first_;
  const Rows *rows_;
  Collector *faults_;
};

bool is_on_all_ranks(const Communicator &communicator, bool condition) {
  std::int64_t broken = condition ? 0 : 1;
  communicator.max(std::span(&broken, 1));
  return broken == 0;
}

/// What the scene says of blocks whose number was not known when it was read.
void check_against_scene(const Scene &scene, Diagnostics &faults) {
  const std::int64_t total = num_blocks(scene);
  const std::int64_t before = total - scene.block_file.num_blocks;
  if (total > most_blocks_in_all) {
    faults.push_back(
        {Severity::error,
         {scene.block_file.path, 0, 0},
         fmt::format("the file has {} blocks", scene.block_file.num_blocks),
         fmt::format("a scene has at most {} in all, and this one has {} others", most_blocks_in_all, before),
         "use fewer blocks"});
    return;
  }
  for (const SceneBlock &block : scene.blocks) {
    if (find_generated_block(scene, block.name) >= before) {
      faults.push_back(
          {Severity::error, block.where,
           fmt::format("block '{}' has the name of a block of {}", block.name, scene.block_file.path),
           fmt::format("those are b{} to b{}", before, total - 1), "choose another name"});
    }
  }
  for (const Monitor &monitor : scene.monitors) {
    if (monitor.block >= total && !scene.region.present()) {
      const std::string &name = monitor.is_point ? monitor.block_name : monitor.name;
      faults.push_back({Severity::error, monitor.where, fmt::format("no block is named '{}'", name),
                        fmt::format("those of {} are b{} to b{}", scene.block_file.path, before, total - 1),
                        "name one of these"});
    }
  }
}

} // namespace

Diagnostics open_block_file(const Communicator &communicator, Scene &scene) {
  Diagnostics faults;
  if (scene.block_file.path.empty()) {
    return faults;
  }
  std::string packed;
  std::string count;
  on_root(communicator, [&] {
    const block_file::Overview overview = block_file::look_at(scene.block_file);
    std::vector<BlockFault> seen;
    for (const Diagnostic &d : overview.faults) {
      seen.push_back({0, d});
    }
    packed = pack(seen);
    count = std::to_string(overview.num_blocks);
  });
  communicator.broadcast(packed);
  communicator.broadcast(count);
  for (BlockFault &fault : unpack(packed)) {
    faults.push_back(std::move(fault.diagnostic));
  }
  scene.block_file.num_blocks = std::max<std::int64_t>(0, std::stoll(count));
  if (scene.block_file.num_blocks > 0) {
    check_against_scene(scene, faults);
  }
  return faults;
}

Diagnostics read_block_file(const Communicator &communicator, const Scene &scene, std::int64_t first,
                            std::int64_t last, std::vector<SceneBlock> &blocks) {
  const std::string &path = scene.block_file.path;
  if (path.empty()) {
    return {};
  }
  expect_on_all_ranks(communicator, 0 <= first && first <= last && last <= scene.block_file.num_blocks,
                      "block file: a range of its blocks");
  const std::int64_t count = last - first;
  Rows rows;
  std::vector<double> points;
  std::vector<std::int32_t> edge_joint;
  Collector faults(path);
  BlockMaker maker(scene, first, rows, faults);
  {
    hdf5::CollectiveInput input(communicator, path);
    const std::int64_t num_points = input.num_rows("points");
    rows.offsets = input.rows<std::int64_t>("offsets", first, count == 0 ? 0 : count + 1);
    rows.material = input.rows<std::int32_t>("material", first, count);
    rows.fixed = input.rows<std::uint8_t>("fixed", first, count);
    if (input.num_rows("velocity") > 0) {
      rows.velocity = input.rows<double>("velocity", first, count, 3);
    }
    const bool sound = maker.check_offsets(scene.block_file.num_blocks, num_points);
    // Offsets that are at fault say nothing of how much to read.
    if (is_on_all_ranks(communicator, sound)) {
      const std::int64_t begin = count == 0 ? 0 : rows.offsets.front();
      const std::int64_t end = count == 0 ? 0 : rows.offsets.back();
      points = input.rows<double>("points", begin, end - begin, 2);
      if (input.num_rows("edge_joint") > 0) {
        edge_joint = input.rows<std::int32_t>("edge_joint", begin, end - begin);
      }
    }
  }
  blocks.reserve(blocks.size() + static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    blocks.push_back(maker.make(i));
    if (!points.empty()) {
      maker.add_outline(i, points, edge_joint, blocks.back());
    }
  }
  return faults.gather(communicator);
}

} // namespace gcpdda
