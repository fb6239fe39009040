#include "simulation/loads.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace gcpdda {

namespace {

bool same_load(const PointLoad &a, const PointLoad &b) {
  return a.point == b.point && a.force == b.force && a.ramp == b.ramp && a.table == b.table;
}

/// The factor of a table rises and falls on the way from a value before a time (s) to what it stays.
bool turns_back(const LoadCourse &course, double before, double now) {
  constexpr int parts = 8; // of a row, in which ramps bend what is straight in the table
  constexpr double rounding = 1e-9;
  double last = before;
  double up = 0.0;
  double down = 0.0;
  double largest = std::abs(before);
  const auto go_to = [&](double time) {
    const double next = course.factor(time);
    up = std::max(up, next - last);
    down = std::max(down, last - next);
    largest = std::max(largest, std::abs(next));
    last = next;
  };
  go_to(now);
  double from = now;
  const auto go_on_to = [&](double time) {
    for (int k = 1; k <= parts && time > from; ++k) {
      go_to(k == parts ? time : from + k * (time - from) / parts);
    }
    from = std::max(from, time);
  };
  for (const LoadRow &row : course.table) {
    go_on_to(std::min(course.begin + row.time, course.end()));
  }
  go_on_to(course.end());
  return std::min(up, down) > rounding * largest;
}

bool is_constant(const PointLoad &load) {
  return load.ramp == 0.0 && load.table.empty();
}

void replace_loads(BlockSystem &system, std::size_t row, std::size_t num_before,
                   const std::vector<PointLoad> &loads) {
  std::vector<MaterialLoad> own;
  for (const PointLoad &load : loads) {
    own.push_back({load.point - system.properties[row].centroid, load.force, load.course});
  }
  const auto begin = system.load.begin() + system.load_begin[row];
  const auto place = system.load.erase(begin, begin + static_cast<std::ptrdiff_t>(num_before));
  system.load.insert(place, own.begin(), own.end());
  system.load_begin.lengthen(row, std::ssize(own) - static_cast<std::ptrdiff_t>(num_before));
}

} // namespace

Loads::Loads(const Scene &scene) {
  for (std::size_t i = 0; i < scene.blocks.size(); ++i) {
    if (!scene.blocks[i].velocity_table.empty()) {
      prescribed.emplace_back(BlockId{static_cast<std::int64_t>(i)},
                              PrescribedMotion(scene.blocks[i].velocity_table));
    }
  }
}

Vec2 Loads::gravity(const RunSettings &run) const {
  return Rise{0.0, run.gravity_ramp}.at(time) * run.gravity;
}

void Loads::list_courses(Scene &scene, std::span<const Stage> stages) {
  courses_.assign(1, LoadCourse{});
  side_stresses_.assign(1, scene.in_situ);
  for (const Stage &stage : stages) {
    if (stage.changes_stress) {
      side_stresses_.push_back(stage.after->in_situ);
    }
  }
  if (side_stresses_.size() > 1) {
    courses_.resize(1 + side_stresses_.size());
    for (std::size_t k = 2; k < courses_.size(); ++k) {
      courses_[k].in.begin = std::numeric_limits<double>::infinity();
    }
  }
  for (SceneBlock &block : scene.blocks) {
    for (PointLoad &load : block.loads) {
      load.course = is_constant(load) ? 0 : new_course({0.0, load.ramp, load.table});
    }
  }
}

std::int64_t Loads::new_course(LoadCourse course) {
  courses_.push_back(std::move(course));
  return std::ssize(courses_) - 1;
}

Vec2 Loads::force_of(const MaterialLoad &load) const {
  return load.course == 0 ? load.force
                          : courses_[static_cast<std::size_t>(load.course)].factor(time) * load.force;
}

// Linear along an edge, and so at its ends: what does the same work on any motion that is linear there.
void Loads::load_sides(std::span<SceneBlock> slab) const {
  for (std::size_t number = 0; number < side_stresses_.size(); ++number) {
    const InSituStress &stress = side_stresses_[number];
    const std::int64_t course = side_stresses_.size() > 1 ? static_cast<std::int64_t>(1 + number) : 0;
    for (SceneBlock &block : slab) {
      const std::size_t count = block.vertices.size();
      for (std::size_t k = 0; k < count && !block.fixed && !stress.boundaries.empty(); ++k) {
        const Vec2 a = block.vertices[k];
        const Vec2 b = block.vertices[(k + 1) % count];
        if (!stress.acts_on(a, b)) {
          continue;
        }
        const Vec2 along = b - a;
        const Vec2 outwards{along.y, -along.x}; // times the length
        const Vec2 at_a = -1.0 / 6.0 * stress.compression_at(a)(outwards);
        const Vec2 at_b = -1.0 / 6.0 * stress.compression_at(b)(outwards);
        block.loads.push_back({.point = a, .force = 2.0 * at_a + at_b, .course = course});
        block.loads.push_back({.point = b, .force = at_a + 2.0 * at_b, .course = course});
      }
    }
  }
}

void Loads::change_side_stress(const Rise &change) {
  std::size_t next = 2;
  while (std::isfinite(courses_[next].in.begin)) {
    ++next;
  }
  courses_[next].in = change;
  for (std::size_t k = 1; k < next; ++k) {
    courses_[k].out.push_back(change);
  }
}

std::vector<PointLoad> Loads::after(std::vector<PointLoad> acting, std::vector<PointLoad> listed,
                                    const Rise &change) {
  const auto is_going = [&](const PointLoad &load) {
    return !courses_[static_cast<std::size_t>(load.course)].out.empty();
  };
  const auto first_going = std::stable_partition(acting.begin(), acting.end(), std::not_fn(is_going));
  if (std::equal(acting.begin(), first_going, listed.begin(), listed.end(), same_load)) {
    return acting;
  }
  for (PointLoad &load : listed) {
    const bool is_plain = is_constant(load) && change.duration == 0.0;
    load.course = is_plain ? 0 : new_course({change.begin, load.ramp, load.table, change});
  }
  for (PointLoad &load : acting) {
    if (change.duration == 0.0 ||
        (is_going(load) && courses_[static_cast<std::size_t>(load.course)].end() <= change.begin)) {
      continue;
    }
    if (load.course == 0) {
      load.course = new_course({});
    }
    courses_[static_cast<std::size_t>(load.course)].out.push_back(change);
    listed.push_back(load);
  }
  return listed;
}

bool same_loads(const std::vector<PointLoad> &a, const std::vector<PointLoad> &b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_load);
}

void adopt_loads(BlockSystem &blocks, std::size_t row, const std::vector<PointLoad> &before,
                 const std::vector<PointLoad> &after) {
  const auto same = [](const PointLoad &a, const PointLoad &b) {
    return same_load(a, b) && a.course == b.course;
  };
  if (!std::equal(before.begin(), before.end(), after.begin(), after.end(), same)) {
    replace_loads(blocks, row, before.size(), after);
  }
}

std::int64_t Loads::find_pulse(const Scene &scene, const StageState &stage, double now) const {
  for (std::size_t i = 0; i < scene.blocks.size(); ++i) {
    const auto id = static_cast<std::int64_t>(i);
    if (scene.blocks[i].loads.empty() || is_removed(stage, id)) {
      continue;
    }
    for (const PointLoad &load : scene.blocks[i].loads) {
      const LoadCourse &course = courses_[static_cast<std::size_t>(load.course)];
      const double before = course.begin >= stage.start_time ? 0.0 : course.factor(now);
      if (!course.table.empty() && turns_back(course, before, now)) {
        return id;
      }
    }
  }
  return -1;
}

double Loads::end_of_changes(const Scene &scene, const StageState &stage, double now) const {
  double end = now;
  for (std::size_t k = 1; side_stresses_.size() > 1 && k <= side_stresses_.size(); ++k) {
    if (courses_[k].in.begin <= now) { // else the stress comes in with a later stage
      end = std::max(end, courses_[k].end());
    }
  }
  for (std::size_t i = 0; i < scene.blocks.size(); ++i) {
    const std::vector<PointLoad> &loads = scene.blocks[i].loads;
    if (!loads.empty() && !is_removed(stage, static_cast<std::int64_t>(i))) {
      for (const PointLoad &load : loads) {
        end = std::max(end, courses_[static_cast<std::size_t>(load.course)].end());
      }
    }
  }
  return end;
}

} // namespace gcpdda
