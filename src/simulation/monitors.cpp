#include "simulation/monitors.hpp"

#include "geometry/aabb.hpp"
#include "geometry/holds_point.hpp"
#include "io/results/id_slabs.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <limits>
#include <string>
#include <vector>

namespace gcpdda {

namespace {

void place_point(RunState &run, std::span<const SceneBlock> slab, Monitor &monitor) {
  const std::int64_t first =
      slab_begin(num_blocks(run.scene), run.communicator.size(), run.communicator.rank());
  constexpr std::int64_t none = std::numeric_limits<std::int64_t>::min();
  std::array<std::int64_t, 2> minus_ids{none, none}; // the first mobile and the first fixed block
  std::int64_t holders = 0;
  for (std::size_t k = 0; k < slab.size(); ++k) {
    if (holds_point(slab[k].vertices, monitor.point)) {
      std::int64_t &minus_id = minus_ids[slab[k].fixed ? 1 : 0];
      minus_id = std::max(minus_id, -(first + static_cast<std::int64_t>(k)));
      ++holders;
    }
  }
  run.communicator.max(minus_ids);
  run.communicator.sum(std::span(&holders, 1));
  if (holders == 0) {
    run.notes.push_back({Severity::error, monitor.where,
                         fmt::format("no block holds the point ({}, {}) of monitor '{}'", monitor.point.x,
                                     monitor.point.y, monitor.name),
                         "a monitored point follows the block it lies in", "check 'point'"});
    return;
  }
  const bool is_mobile = minus_ids[0] > none;
  monitor.block = -minus_ids[is_mobile ? 0 : 1];
  if (holders > 1) {
    run.notes.push_back(
        {Severity::info, monitor.where,
         fmt::format("monitor '{}' follows the {} block '{}'", monitor.name, is_mobile ? "mobile" : "fixed",
                     block_name(run.scene, monitor.block)),
         fmt::format("{} blocks share its point ({}, {})", holders, monitor.point.x, monitor.point.y),
         "set monitor.block to follow another one"});
  }
}

void check_named_block(RunState &run, std::span<const SceneBlock> slab, const Monitor &monitor) {
  const std::int64_t first =
      slab_begin(num_blocks(run.scene), run.communicator.size(), run.communicator.rank());
  const std::int64_t place = monitor.block - first;
  double distance = 0.0;
  if (place >= 0 && place < std::ssize(slab)) {
    const std::vector<Vec2> &vertices = slab[static_cast<std::size_t>(place)].vertices;
    distance = holds_point(vertices, monitor.point) ? 0.0 : distance_to_boundary(vertices, monitor.point);
  }
  distance = run.communicator.max(distance);
  if (distance > 0.0) {
    run.notes.push_back({Severity::error, monitor.where,
                         fmt::format("block '{}' does not hold the point ({}, {}) of monitor '{}'",
                                     monitor.block_name, monitor.point.x, monitor.point.y, monitor.name),
                         fmt::format("the point lies {:.3g} m outside it", distance),
                         "move 'point' into the block, or leave monitor.block out"});
  }
}

/// Finds the blocks of all points of a profile, in one pass over the blocks.
void place_profile(RunState &run, std::span<const SceneBlock> slab, std::span<Monitor> points) {
  const std::int64_t first =
      slab_begin(num_blocks(run.scene), run.communicator.size(), run.communicator.rank());
  constexpr std::int64_t none = std::numeric_limits<std::int64_t>::min();
  std::vector<std::int64_t> minus_ids(2 * points.size(), none); // mobile, then fixed ones, by point
  Aabb line;
  line.include(points.front().point);
  line.include(points.back().point);
  for (std::size_t k = 0; k < slab.size(); ++k) {
    const Aabb box = bounding_box(slab[k].vertices);
    for (std::size_t i = 0; box.meets(line) && i < points.size(); ++i) {
      if (box.holds(points[i].point) && holds_point(slab[k].vertices, points[i].point)) {
        std::int64_t &minus_id = minus_ids[2 * i + (slab[k].fixed ? 1 : 0)];
        minus_id = std::max(minus_id, -(first + static_cast<std::int64_t>(k)));
      }
    }
  }
  run.communicator.max(minus_ids);
  std::size_t outside = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::int64_t minus_id = minus_ids[2 * i] > none ? minus_ids[2 * i] : minus_ids[2 * i + 1];
    points[i].block = minus_id > none ? -minus_id : -1;
    outside += minus_id > none ? 0 : 1;
  }
  if (outside > 0) {
    const bool is_empty = outside == points.size();
    run.notes.push_back({is_empty ? Severity::error : Severity::info, points.front().where,
                         fmt::format("{} of the {} points of profile '{}' {} in no block",
                                     is_empty ? "all" : std::to_string(outside), points.size(),
                                     points.front().name, outside == 1 ? "lies" : "lie"),
                         is_empty ? "a point follows the block that holds it" : "they have no rows",
                         is_empty ? "check 'along'" : "move the line, if they should lie in rock"});
  }
}

} // namespace

// A point follows the block that the scene names for it, else the first mobile block that holds it, else the
// first fixed one.
void place_monitors(RunState &run, std::span<const SceneBlock> slab) {
  std::vector<Monitor> &monitors = run.scene.monitors;
  for (std::size_t m = 0; m < monitors.size(); ++m) {
    Monitor &monitor = monitors[m];
    if (monitor.is_on_profile) {
      std::size_t end = m + 1;
      while (end < monitors.size() && monitors[end].is_on_profile && monitors[end].name == monitor.name) {
        ++end;
      }
      place_profile(run, slab, std::span(monitors).subspan(m, end - m));
      m = end - 1;
    } else if (monitor.block >= num_blocks(run.scene)) {
      run.notes.push_back(
          {Severity::error, monitor.where,
           fmt::format("no block is named '{}'", monitor.is_point ? monitor.block_name : monitor.name),
           fmt::format("the scene has {} blocks", num_blocks(run.scene)), "check the name"});
    } else if (monitor.is_point && monitor.block_name.empty()) {
      place_point(run, slab, monitor);
    } else if (monitor.is_point) {
      check_named_block(run, slab, monitor);
    }
  }
  if (has_errors(run.notes)) {
    throw SceneError(run.notes);
  }
}

} // namespace gcpdda
