#include "driver/trial_frames.hpp"

#include "base/check.hpp"
#include "geometry/holds_point.hpp"
#include "geometry/polygon.hpp"
#include "io/results/frame_reader.hpp"
#include "model/generators.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string>

namespace gcpdda {

namespace {

namespace fs = std::filesystem;

constexpr std::uint8_t slipping = 2; // ContactRow::state

/// The last file frames/<kind>_<n>.hdf of a run; empty where it wrote none.
fs::path last_file(const fs::path &directory, const std::string &kind) {
  fs::path last;
  for (const fs::directory_entry &entry : fs::directory_iterator(directory / "frames")) {
    const fs::path &path = entry.path();
    if (path.filename().string().starts_with(kind + "_") && path.extension() == ".hdf" && path > last) {
      last = path;
    }
  }
  return last;
}

/// The settled state and the end of a trial, block by block.
class TwoFrames {
public:
  TwoFrames(const fs::path &settled, const fs::path &trial)
      : before_(read_frame(last_file(settled, "frame"))), after_(read_frame(last_file(trial, "frame"))) {}

  /// What a block that is left at the end has done since the settled state.
  struct Motion {
    Vec2 displacement; ///< of the centroid, m
    double rotation = 0.0;
    Vec2 centroid; ///< at the end
  };

  [[nodiscard]] std::size_t num_blocks() const { return after_.block.size(); }
  [[nodiscard]] std::int64_t block(std::size_t row) const { return after_.block[row]; }
  [[nodiscard]] bool is_fixed(std::size_t row) const { return after_.kind[row] == 0; }

  [[nodiscard]] std::vector<Vec2> vertices(std::size_t row) const {
    std::vector<Vec2> vertices;
    for (std::int64_t k = after_.offsets[row]; k < after_.offsets[row + 1]; ++k) {
      const std::array<double, 3> &point = after_.points[static_cast<std::size_t>(k)];
      vertices.push_back({point[0], point[1]});
    }
    return vertices;
  }

  [[nodiscard]] Motion motion(std::size_t row) const {
    const std::size_t then = row_of(before_, after_.block[row]).value();
    Motion motion;
    motion.displacement = {after_.displacement[row][0] - before_.displacement[then][0],
                           after_.displacement[row][1] - before_.displacement[then][1]};
    motion.rotation = after_.rotation[row] - before_.rotation[then];
    motion.centroid = polygon_moments(vertices(row)).centroid;
    return motion;
  }

  /// What a motion does to any point of the block at most, m.
  [[nodiscard]] double farthest(std::size_t row, const Motion &moved) const {
    double radius = 0.0;
    for (const Vec2 vertex : vertices(row)) {
      radius = std::max(radius, norm(vertex - moved.centroid));
    }
    return norm(moved.displacement) + radius * std::abs(moved.rotation);
  }

  /// Where the motion of a block has carried points of the settled state; none for a block that is gone. The
  /// strain of the trial is too small to be seen in a picture.
  [[nodiscard]] std::optional<std::array<Vec2, 2>> carried(std::int64_t block,
                                                           const std::array<Vec2, 2> &points) const {
    const std::optional<std::size_t> row = row_of(after_, block);
    if (!row) {
      return std::nullopt;
    }
    const Motion moved = motion(*row);
    const double c = std::cos(moved.rotation);
    const double s = std::sin(moved.rotation);
    std::array<Vec2, 2> carried;
    std::transform(points.begin(), points.end(), carried.begin(), [&](Vec2 point) {
      const Vec2 arm = point - (moved.centroid - moved.displacement);
      return moved.centroid + Vec2{c * arm.x - s * arm.y, s * arm.x + c * arm.y};
    });
    return carried;
  }

private:
  static std::optional<std::size_t> row_of(const FrameContent &frame, std::int64_t block) {
    const auto found = std::lower_bound(frame.block.begin(), frame.block.end(), block);
    return found != frame.block.end() && *found == block
               ? std::optional(static_cast<std::size_t>(found - frame.block.begin()))
               : std::nullopt;
  }

  FrameContent before_;
  FrameContent after_;
};

std::vector<FailingBlock> failing_blocks(const Scene &scene, const TwoFrames &frames) {
  std::vector<FailingBlock> blocks;
  for (std::size_t row = 0; row < frames.num_blocks(); ++row) {
    const TwoFrames::Motion moved = frames.motion(row);
    FailingBlock block;
    block.block = frames.block(row);
    block.name = block_name(scene, block.block);
    block.fixed = frames.is_fixed(row);
    block.vertices = frames.vertices(row);
    block.displacement = moved.displacement;
    block.rotation = moved.rotation;
    block.area = polygon_moments(block.vertices).area;
    block.motion = block.fixed ? 0.0 : frames.farthest(row, moved);
    blocks.push_back(std::move(block));
  }
  return blocks;
}

/// Marks the blocks that have moved at least a tenth as far as the block with which the area of the ones that
/// have moved farthest reaches `area`.
void mark_moving(double area, std::vector<FailingBlock> &blocks) {
  std::vector<FailingBlock *> by_motion;
  for (FailingBlock &block : blocks) {
    by_motion.push_back(&block);
  }
  std::stable_sort(by_motion.begin(), by_motion.end(),
                   [](const FailingBlock *a, const FailingBlock *b) { return a->motion > b->motion; });
  double sum = 0.0;
  const auto reaches = [&](const FailingBlock *block) { return (sum += block->area) >= area; };
  const auto first = std::find_if(by_motion.begin(), by_motion.end(), reaches);
  std::for_each(by_motion.begin(), first, [](FailingBlock *block) { block->left_out = true; });
  const double least = first == by_motion.end() ? 0.0 : 0.1 * (*first)->motion;
  for (FailingBlock &block : blocks) {
    block.moves = !block.fixed && block.motion >= least && block.motion > 0.0;
  }
}

std::array<Vec2, 2> line_of(const ContactFrameContent &contacts, std::size_t k) {
  const auto &begin = contacts.points[2 * k];
  const auto &end = contacts.points[2 * k + 1];
  return {Vec2{begin[0], begin[1]}, Vec2{end[0], end[1]}};
}

Vec2 middle_of(const std::array<Vec2, 2> &line) {
  return 0.5 * (line[0] + line[1]);
}

/// A joint slips where a contact does at the end of the trial. It has opened where two blocks that touched in
/// the settled state touch nowhere at the end and its sides are at least `least_gap` apart: elsewhere joints
/// without load open and close by less than anybody sees. It is drawn on both of its sides.
FailingJoints failing_joints(const TwoFrames &frames, const fs::path &settled, const fs::path &trial,
                             double least_gap) {
  FailingJoints joints;
  const ContactFrameContent now = read_contact_frame(last_file(trial, "contacts"));
  std::set<std::array<std::int64_t, 2>> touching;
  for (std::size_t k = 0; k < now.blocks.size(); ++k) {
    touching.insert(now.blocks[k]);
    if (now.state[k] == slipping) {
      joints.slipping.push_back(line_of(now, k));
    }
  }
  const fs::path file = last_file(settled, "contacts");
  if (file.empty()) { // output.contacts = false
    return joints;
  }
  joints.knows_opened = true;
  const ContactFrameContent then = read_contact_frame(file);
  for (std::size_t k = 0; k < then.blocks.size(); ++k) {
    if (touching.contains(then.blocks[k])) {
      continue;
    }
    const auto lower = frames.carried(then.blocks[k][0], line_of(then, k));
    const auto higher = frames.carried(then.blocks[k][1], line_of(then, k));
    if (lower && higher && norm(middle_of(*higher) - middle_of(*lower)) >= least_gap) {
      joints.opened.insert(joints.opened.end(), {*lower, *higher});
    }
  }
  return joints;
}

} // namespace

double area_moved_by(double share, const std::vector<Vec2> &region, const fs::path &settled,
                     const fs::path &trial) {
  const TwoFrames frames(settled, trial);
  double area = 0.0;
  for (std::size_t row = 0; row < frames.num_blocks(); ++row) {
    const TwoFrames::Motion moved = frames.motion(row);
    const double of_block = polygon_moments(frames.vertices(row)).area;
    const bool is_far = !frames.is_fixed(row) && frames.farthest(row, moved) >= share * std::sqrt(of_block);
    if (is_far && (region.empty() || holds_point(region, moved.centroid - moved.displacement))) {
      area += of_block;
    }
  }
  return area;
}

DrawnTrial drawn_trial_of(const Scene &scene, const fs::path &settled, const fs::path &trial,
                          double ignored_area) {
  const TwoFrames frames(settled, trial);
  DrawnTrial drawn{failing_blocks(scene, frames), {}};
  mark_moving(ignored_area, drawn.blocks);
  constexpr double seen = 0.01; // share of the farthest motion
  drawn.joints = failing_joints(frames, settled, trial, seen * farthest_motion(drawn.blocks));
  return drawn;
}

} // namespace gcpdda
