#include "io/scene/scene_blocks.hpp"

#include "geometry/holds_point.hpp"
#include "io/scene/scene_joints.hpp"
#include "io/scene/scene_materials.hpp"
#include "io/scene/scene_outline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace gcpdda::scene_text {

namespace {

class BlockReader {
public:
  BlockReader(const SceneSource &source, Materials &materials, Names &names, Fidelity of_run,
              const JointLaws &joints)
      : source_(source), materials_(&materials), names_(&names), of_run_(of_run), joints_(&joints) {}

  SceneBlock read(const Section &section, const std::string &name) {
    SceneBlock block;
    block.name = name;
    block.where = source_.faults.origins().position(section.source());
    names_->add(section, section.label(), name);
    const std::int32_t material = materials_->find(section);
    block.material = std::max(0, material);
    section.read("fixed", block.fixed);
    section.read("velocity", block.velocity);
    section.read("prescribed_velocity", block.velocity);
    read_velocity_table(section, block);
    block.driven = given_motion(section) != nullptr;
    section.read_choice("block[]", "fidelity", block.fidelity);
    check_motion(section, block);
    check_fidelity(section, block, material);

    const bool has_outline = read_outline(section, block);
    section.read("fixed_points", block.fixed_points);
    if (const toml::node *points = section.sound("fixed_points"); points != nullptr && has_outline) {
      for (std::size_t i = 0; i < block.fixed_points.size(); ++i) {
        expect_in_block((*points->as_array())[i], block, block.fixed_points[i],
                        fmt::format("fixed point {} of {}", i, section.label()));
      }
    }
    for (const Section &load : section.list("load")) {
      read_load(load, block, has_outline);
    }
    return block;
  }

private:
  void fault(const toml::node &node, std::string what, std::string why, std::string hint) {
    source_.faults.add(node.source(), std::move(what), std::move(why), std::move(hint));
  }

  void check_motion(const Section &section, const SceneBlock &block) {
    const std::string &who = section.label();
    if (block.driven) {
      check_prescribed(section, block);
    } else if (block.fixed) {
      if (block.velocity != std::array<double, 3>{}) {
        fault(*section.given("velocity"), who + " is fixed but has a velocity", "a fixed block never moves",
              "leave one of fixed and velocity out");
      }
      if (const toml::node *points = section.given("fixed_points")) {
        fault(*points, who + " is fixed but has fixed_points", "all of it is held",
              "leave one of fixed and fixed_points out");
      }
    }
    const toml::node *loads = section.given("load");
    if (loads != nullptr && (block.fixed || block.driven)) {
      const std::vector<Section> list = section.list("load");
      source_.faults.add(
          list.empty() ? loads->source() : list.front().source(),
          fmt::format("{} {} but has a load", who, block.fixed ? "is fixed" : "has a prescribed velocity"),
          "no force changes its motion", "leave the load out");
    }
  }

  /// What prescribes the motion of the block; null if nothing does.
  static const toml::node *given_motion(const Section &section) {
    const toml::node *table = section.given("velocity_table");
    return table != nullptr ? table : section.given("prescribed_velocity");
  }

  void read_velocity_table(const Section &section, SceneBlock &block) {
    section.read("velocity_table", block.velocity_table);
    if (section.sound("velocity_table") != nullptr) {
      expect_rising_times(section, "velocity_table", block.velocity_table);
      block.velocity = block.velocity_table[0].velocity;
    }
  }

  /// @param rows  of that table, which is sound
  template <class Row>
  void expect_rising_times(const Section &section, const char *key, const std::vector<Row> &rows) {
    const toml::array &nodes = *section.sound(key)->as_array();
    const auto time_fault = [&](std::size_t i, const std::string &why, const std::string &hint) {
      fault((*nodes[i].as_array())[0],
            fmt::format("row {} of {} has the time {}", i, section.subject(key), rows[i].time), why, hint);
    };
    if (rows[0].time != 0.0) {
      time_fault(0, "the table must begin at 0", "add a row for the time 0");
    }
    for (std::size_t i = 1; i < rows.size(); ++i) {
      if (!(rows[i].time > rows[i - 1].time)) {
        time_fault(i, fmt::format("it must be above that of the row before, {}", rows[i - 1].time),
                   "order the rows by time");
      }
    }
  }

  void check_prescribed(const Section &section, const SceneBlock &block) {
    const std::string &who = section.label();
    const toml::node &node = *given_motion(section);
    const std::string key =
        section.given("velocity_table") != nullptr ? "velocity_table" : "prescribed_velocity";
    if (block.fixed) {
      fault(node, fmt::format("{} is fixed but has a {}", who, key), "a fixed block never moves",
            fmt::format("leave one of fixed and {} out", key));
    }
    if (section.given("velocity") != nullptr) {
      fault(node, fmt::format("{} has both velocity and {}", who, key),
            "it keeps the prescribed one from the start", "leave velocity out");
    }
    if (key == "velocity_table" && section.given("prescribed_velocity") != nullptr) {
      fault(node, who + " has both prescribed_velocity and velocity_table", "only one can be followed",
            "leave one of them out");
    }
    if (section.given("fixed_points") != nullptr) {
      fault(node, fmt::format("{} has both fixed_points and {}", who, key), "a point cannot be held and move",
            "leave one of them out");
    }
  }

  void check_fidelity(const Section &section, const SceneBlock &block, std::int32_t material) {
    const bool own = block.fidelity != Fidelity::automatic;
    const bool deformable = (own ? block.fidelity : of_run_) == Fidelity::deformable;
    if (!deformable || block.fixed) {
      return;
    }
    const toml::node *where = section.given(own ? "fidelity" : "material");
    if (!block.driven && where != nullptr) {
      materials_->expect_elastic(material, section.label(), *where);
    } else if (block.driven && own) {
      fault(*section.given("fidelity"), section.label() + " has a prescribed velocity but is deformable",
            "its motion is prescribed as that of a rigid body", "leave fidelity out or write \"rigid\"");
    }
  }

  /// True if the outline is sound.
  bool read_outline(const Section &section, SceneBlock &block) {
    section.read("vertices", block.vertices);
    const toml::node *node = section.sound("vertices");
    if (node == nullptr) {
      return false;
    }
    read_edge_joints(section, block);
    const std::vector<OutlineFault> faults = check_outline(block.vertices, block.edge_joint, section.label());
    for (const OutlineFault &f : faults) {
      fault(f.vertex ? (*node->as_array())[*f.vertex] : *node, f.what, f.why, f.hint);
    }
    return faults.empty();
  }

  void read_edge_joints(const Section &section, SceneBlock &block) {
    const toml::node *node = section.sound("edge_joints");
    if (node == nullptr) {
      return;
    }
    const toml::array &names = *node->as_array();
    if (names.size() != block.vertices.size()) {
      fault(*node, fmt::format("{} has {} entries", section.subject("edge_joints"), names.size()),
            fmt::format("the block has {} edges", block.vertices.size()),
            "write one name for each edge, \"\" for the law of the materials");
      return;
    }
    for (const toml::node &name : names) {
      const bool is_blank = name.as_string()->get().empty();
      block.edge_joint.push_back(is_blank ? -1 : find_joint(source_, name, *joints_).value_or(-1));
    }
  }

  void read_load(const Section &section, SceneBlock &block, bool has_outline) {
    PointLoad load;
    section.read("point", load.point);
    section.read("force", load.force);
    section.read("ramp", load.ramp);
    section.read("table", load.table);
    if (section.sound("table") != nullptr) {
      expect_rising_times(section, "table", load.table);
    }
    if (const toml::node *ramp = section.given("ramp");
        ramp != nullptr && section.given("table") != nullptr) {
      fault(*ramp, section.label() + " has both ramp and table", "each says how its force changes with time",
            "leave one of them out");
    }
    if (const toml::node *point = section.sound("point"); point != nullptr && has_outline) {
      expect_in_block(*point, block, load.point, fmt::format("the point of {}", section.label()));
    }
    block.loads.push_back(load);
  }

  void expect_in_block(const toml::node &node, const SceneBlock &block, Vec2 point, const std::string &who) {
    if (!holds_point(block.vertices, point)) {
      fault(node, fmt::format("{} is not in the block", who),
            fmt::format("[{}, {}] lies outside its outline", point.x, point.y),
            "move it to a place in or on the block");
    }
  }

  SceneSource source_;
  Materials *materials_;
  Names *names_;
  Fidelity of_run_;
  const JointLaws *joints_;
};

} // namespace

void Names::add(const Section &section, const std::string &label, const std::string &name) {
  const auto [first, is_new] = first_of_name_.emplace(name, First{label, section.source()});
  if (is_new) {
    return;
  }
  const toml::node *given = section.sound("name");
  const bool same_list = first->second.label == label;
  faults_->add(given == nullptr ? section.source() : given->source(),
               same_list ? fmt::format("two {}s are named '{}'", label.substr(0, label.find(' ')), name)
                         : fmt::format("{} has the name of {}", label, first->second.label),
               fmt::format("the first is at {}", faults_->origins().place(first->second.where)),
               label.starts_with("block")
                   ? "names are unique, and unnamed blocks are b<n> from 0 in file order"
                   : "names of blocks, walls and pyramids are unique: choose another one");
}

std::vector<SceneBlock> read_blocks(const SceneSource &source, Materials &materials, Names &names,
                                    Fidelity of_run, const JointLaws &joints) {
  const std::vector<Section> sections = listed_sections(source.root, "block", source.faulty);
  BlockReader reader(source, materials, names, of_run, joints);
  std::vector<SceneBlock> blocks;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const toml::node &node = (*source.root["block"].as_array())[i];
    blocks.push_back(reader.read(sections[i], name_of_element("block", node, i)));
  }
  return blocks;
}

} // namespace gcpdda::scene_text
