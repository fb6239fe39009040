#include "scene_parts.hpp"
#include "scene_sets.hpp"

#include "gcpdda/geometry/aabb.hpp"
#include "gcpdda/geometry/polygon.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <unordered_map>

namespace gcpdda::scene_text {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

std::vector<Vec2> read_vertices(const toml::node &node) {
  std::vector<Vec2> vertices;
  for (const toml::node &element : *node.as_array()) {
    const toml::array &point = *element.as_array();
    vertices.push_back({as_number(point[0]), as_number(point[1])});
  }
  return vertices;
}

// Rounding of the coordinates as they stand in the file, as a length.
double coordinate_rounding(std::span<const Vec2> vertices) {
  double largest = 0.0;
  for (const Vec2 p : vertices) {
    largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
  }
  return 4.0 * epsilon * largest;
}

// No vertex is further off one straight line than rounding puts it.
bool is_flat(std::span<const Vec2> vertices) {
  const Vec2 origin = vertices[0];
  Vec2 farthest;
  for (const Vec2 p : vertices) {
    if (norm(p - origin) > norm(farthest)) {
      farthest = p - origin;
    }
  }
  const double bound = norm(farthest) * coordinate_rounding(vertices);
  return std::all_of(vertices.begin(), vertices.end(),
                     [&](Vec2 p) { return std::abs(cross(farthest, p - origin)) <= bound; });
}

// Left turns only and once around: such a ring is simple, which spares the O(n^2) test (1 s at 10^4
// vertices).
bool turns_left_once(std::span<const Vec2> vertices) {
  constexpr double three_half_turns = 9.42477796076938;
  const std::size_t n = vertices.size();
  double turned = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 in = vertices[(i + 1) % n] - vertices[i];
    const Vec2 out = vertices[(i + 2) % n] - vertices[(i + 1) % n];
    turned += std::atan2(cross(in, out), dot(in, out));
  }
  return is_convex(vertices) && turned < three_half_turns;
}

class BlockReader {
public:
  BlockReader(const SceneSource &source, const MaterialIndex &materials)
      : source_(source), materials_(&materials) {}

  SceneBlock read(const Section &section, const std::string &name) {
    SceneBlock block;
    block.name = name;
    block.where = source_.faults.origins().position(section.source());
    check_unique(section, name);
    if (const auto material = section.text("material")) {
      block.material = std::max(
          0, find_material(*materials_, *material, section.given("material")->source(), source_.faults));
    }
    section.read("velocity", block.velocity);
    section.read("fixed", block.fixed);
    if (block.fixed && block.velocity != std::array<double, 3>{}) {
      fault(*section.given("velocity"), fmt::format("block '{}' is fixed but has a velocity", name),
            "a fixed block never moves", "leave one of fixed and velocity out");
    }
    if (section.text("fidelity") == "deformable") {
      fault(*section.given("fidelity"), "deformable blocks are not available in this version", "",
            "use \"rigid\"");
    }
    if (const toml::node *vertices = section.sound("vertices")) {
      block.vertices = read_vertices(*vertices);
      check_polygon(*vertices, block);
    }
    return block;
  }

private:
  void fault(const toml::node &node, std::string what, std::string why, std::string hint) {
    source_.faults.add(node.source(), std::move(what), std::move(why), std::move(hint));
  }

  void check_unique(const Section &section, const std::string &name) {
    const auto [first, is_new] = first_of_name_.emplace(name, section.source());
    if (!is_new) {
      const toml::node *given = section.sound("name");
      source_.faults.add(given == nullptr ? section.source() : given->source(),
                         fmt::format("two blocks are named '{}'", name),
                         fmt::format("the first is at {}", source_.faults.origins().place(first->second)),
                         "names are unique, and unnamed blocks are b<n> from 0 in file order");
    }
  }

  // Leaves the vertices counter-clockwise.
  void check_polygon(const toml::node &node, SceneBlock &block) {
    std::vector<Vec2> &vertices = block.vertices;
    const std::string who = fmt::format("block '{}'", block.name);
    if (has_equal_neighbours(node, vertices, who)) {
      return;
    }
    if (is_flat(vertices)) {
      fault(node, who + " has zero area", "all its vertices lie on one line", "check the vertices");
      return;
    }
    if (signed_area(vertices) < 0.0) {
      std::reverse(vertices.begin() + 1, vertices.end());
    }
    if (turns_left_once(vertices)) {
      return;
    }
    if (!is_simple(vertices)) {
      fault(node, who + " crosses itself", "two of its edges meet away from a common vertex",
            "list the vertices in order around the block");
    } else {
      fault(node, who + " is not convex: this version computes convex blocks", "",
            "split it into convex blocks");
    }
  }

  bool has_equal_neighbours(const toml::node &node, std::span<const Vec2> vertices, const std::string &who) {
    const double rounding = coordinate_rounding(vertices);
    bool found = false;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const std::size_t next = (i + 1) % vertices.size();
      if (norm(vertices[next] - vertices[i]) > rounding) {
        continue;
      }
      found = true;
      // Of the last and the first vertex the last is the superfluous one.
      const std::size_t later = std::max(i, next);
      fault((*node.as_array())[later],
            fmt::format("vertex {} of {} equals vertex {}", later, who, later == i ? next : i),
            later == i ? "the outline closes by itself" : "an edge needs a length", "leave one of them out");
    }
    return found;
  }

  SceneSource source_;
  const MaterialIndex *materials_;
  std::unordered_map<std::string, toml::source_region> first_of_name_;
};

} // namespace

std::vector<SceneBlock> read_blocks(const SceneSource &source, const MaterialIndex &materials) {
  const std::vector<Section> sections = listed_sections(source.root, "block", source.faulty);
  BlockReader reader(source, materials);
  std::vector<SceneBlock> blocks;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const toml::node &node = (*source.root["block"].as_array())[i];
    blocks.push_back(reader.read(sections[i], block_name(node, i)));
  }
  return blocks;
}

} // namespace gcpdda::scene_text
