#include "io/scene/scene_water.hpp"

#include "io/scene/scene_joints.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace gcpdda::scene_text {

namespace {

void expect_line(const SceneSource &source, const Section &section, const std::vector<Vec2> &line) {
  const toml::node *node = section.sound("phreatic");
  if (node == nullptr) {
    return;
  }
  if (line.size() < 2) {
    source.faults.add(node->source(), fmt::format("{} has one point", section.subject("phreatic")),
                      "a line has at least two", "add its other end");
  }
  for (std::size_t k = 1; k < line.size(); ++k) {
    if (!(line[k - 1].x < line[k].x)) {
      source.faults.add((*node->as_array())[k].source(),
                        fmt::format("point {} of {} does not lie to the right of the one before", k,
                                    section.subject("phreatic")),
                        "the line gives one height for each x", "write its points from left to right");
      return;
    }
  }
}

} // namespace

void expect_gravity_of_water(const SceneSource &source, const std::vector<Water> &water,
                             const std::optional<toml::source_region> &where) {
  Vec2 gravity = RunSettings{}.gravity;
  const Section run = section(source.root, "run", source.faulty);
  run.read("gravity", gravity);
  if (!run.known("gravity") || (gravity.x == 0.0 && gravity.y < 0.0)) {
    return;
  }
  for (const NamedSection &named :
       named_sections(source.root, "water", source.faulty, source.faults.origins())) {
    const bool is_there = std::any_of(water.begin(), water.end(),
                                      [&](const Water &one) { return one.name == named.name && one.active; });
    if (is_there) {
      source.faults.add(
          where.value_or(named.section.source()),
          fmt::format("{} needs gravity along -y", named.section.label()),
          "its pressure grows downwards from a line of heights",
          where ? fmt::format("set run.gravity = [0.0, -9.81], or water.{}.active = false", named.name)
                : "write gravity = [0.0, -9.81], or leave the water out");
    }
  }
}

std::vector<Water> read_water(const SceneSource &source, const JointLaws &joints) {
  std::vector<Water> all;
  for (const NamedSection &named :
       named_sections(source.root, "water", source.faulty, source.faults.origins())) {
    const Section &section = named.section;
    Water water;
    water.name = named.name;
    section.read("phreatic", water.phreatic);
    section.read("density", water.density);
    section.read("active", water.active);
    expect_line(source, section, water.phreatic);
    water.joints = find_joints(source, section, "joints", joints);
    if (section.sound("phreatic") != nullptr) {
      all.push_back(std::move(water));
    }
  }
  return all;
}

} // namespace gcpdda::scene_text
