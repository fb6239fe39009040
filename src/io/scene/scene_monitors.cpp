#include "io/scene/scene_monitors.hpp"

#include "base/edit_distance.hpp"
#include "model/generators.hpp"

#include <fmt/format.h>

#include <optional>
#include <unordered_map>
#include <utility>

namespace gcpdda::scene_text {

namespace {

class MonitorReader {
public:
  MonitorReader(const SceneSource &source, const Scene &scene) : source_(source), scene_(&scene) {
    for (std::size_t i = 0; i < scene.blocks.size(); ++i) {
      id_of_name_.emplace(scene.blocks[i].name, static_cast<std::int64_t>(i));
      names_.push_back(scene.blocks[i].name);
    }
    for (const char *list : {"wall", "pyramid"}) {
      const toml::array *elements = source.root[list].as_array();
      for (std::size_t i = 0; elements != nullptr && i < elements->size(); ++i) {
        generators_.push_back(name_of_element(list, (*elements)[i], i));
      }
    }
  }

  /// One for a block or a point, those of all points for a profile; none where there is no history to write.
  std::vector<Monitor> read(const Section &section) {
    if (section.given("along") != nullptr) {
      return read_profile(section);
    }
    if (const toml::node *points = section.given("points")) {
      fault(points->source(), "'points' in [[monitor]] has no meaning without along",
            "it is the number of points of a profile",
            "add along = [[0.0, 2.0], [8.0, 2.0]], or write point = [0.0, 2.0]");
      return {};
    }
    const std::optional<Monitor> one = read_one(section);
    return one ? std::vector<Monitor>{*one} : std::vector<Monitor>();
  }

private:
  std::optional<Monitor> read_one(const Section &section) {
    const toml::node *block = section.given("block");
    const toml::node *name = section.given("name");
    const toml::node *point = section.given("point");
    if (block != nullptr && (name == nullptr) != (point == nullptr)) {
      const char *given = point != nullptr ? "point" : "name";
      const char *missing = point != nullptr ? "name" : "point";
      fault(block->source(), fmt::format("[[monitor]] gives block and {} without {}", given, missing),
            "it is a block alone, or a named point with or without the block it follows",
            fmt::format("add {}, or leave {} out", missing, given));
      return std::nullopt;
    }
    if (block != nullptr && name == nullptr) {
      return section.sound("block") != nullptr ? read_block(section) : std::nullopt;
    }
    if (name == nullptr && point == nullptr) {
      if (section.is_table()) {
        fault(section.source(), "[[monitor]] gives neither block nor name and point",
              "it is either a block or a named point", "for example block = \"slider\"");
      }
      return std::nullopt;
    }
    if (name == nullptr || point == nullptr) {
      fault(section.source(),
            fmt::format("'{}' in [[monitor]] is missing", name == nullptr ? "name" : "point"),
            "a monitored point has name and point",
            name == nullptr ? "for example name = \"roof\"" : "for example point = [0.0, 1.0]");
      return std::nullopt;
    }
    const bool is_sound = section.sound("name") != nullptr && section.sound("point") != nullptr &&
                          (block == nullptr || section.sound("block") != nullptr);
    return is_sound ? read_point(section) : std::nullopt;
  }

  void fault(const toml::source_region &where, std::string what, std::string why, std::string hint) {
    source_.faults.add(where, std::move(what), std::move(why), std::move(hint));
  }

  /// The name of another history.
  bool is_taken(const std::string &name) const {
    return name == "energy" || (name == "bolts" && !scene_->bolts.empty()) ||
           (name == "liners" && !scene_->liners.empty());
  }
  static std::string why_taken(const std::string &name) {
    return fmt::format("history/{}.csv holds the {} of the scene", name,
                       name == "energy" ? "energies" : name);
  }

  std::optional<Monitor> read_block(const Section &section) {
    const std::string name = *section.text("block");
    const toml::source_region &where = section.given("block")->source();
    Monitor monitor;
    monitor.name = name;
    monitor.where = source_.faults.origins().position(where);
    if (!find_block(name, where, monitor.block)) {
      return std::nullopt;
    }
    if (is_taken(name)) {
      fault(where, fmt::format("a block named '{}' cannot be monitored", name), why_taken(name),
            "choose another name for the block");
      return std::nullopt;
    }
    if (const auto [first, is_new] = first_of_name_.emplace(name, First{where, false}); !is_new) {
      if (first->second.is_point) {
        report_shared_file(where, name, first->second.where);
      } else {
        fault(where, fmt::format("block '{}' is monitored twice", name), "", "keep one of them");
      }
      return std::nullopt;
    }
    return monitor;
  }

  /// False, and reported, where no block has that name.
  bool find_block(const std::string &name, const toml::source_region &where, std::int64_t &block) {
    const auto found = id_of_name_.find(name);
    block = found != id_of_name_.end() ? found->second : find_generated_block(*scene_, name);
    if (block < 0 && !rests_on_a_fault(name)) {
      fault(where, fmt::format("no block is named '{}'", name), "", hint_for(name));
    }
    return block >= 0;
  }

  // A brick of a wall that cannot be built, or a block of a file without a path: reported there.
  bool rests_on_a_fault(const std::string &name) {
    const bool all_built = generators_.size() == scene_->generators.size();
    for (const std::string &generator : generators_) {
      if (!all_built && name.starts_with(generator + ".")) {
        return true;
      }
    }
    const bool no_file = scene_->block_file.path.empty() && source_.root.contains("blocks");
    const bool no_region = !scene_->region.present() && source_.root.contains("region");
    return (no_file || no_region) && name.starts_with('b');
  }

  std::optional<Monitor> read_point(const Section &section) {
    Monitor monitor;
    monitor.name = *section.text("name");
    monitor.is_point = true;
    section.read("point", monitor.point);
    monitor.where = source_.faults.origins().position(section.given("point")->source());
    if (!takes_name(section, monitor.name, "point")) {
      return std::nullopt;
    }
    if (const toml::node *block = section.given("block")) {
      monitor.block_name = *section.text("block");
      if (!find_block(monitor.block_name, block->source(), monitor.block)) {
        return std::nullopt;
      }
    }
    return monitor;
  }

  std::vector<Monitor> read_profile(const Section &section) {
    for (const char *other : {"block", "point"}) {
      if (const toml::node *node = section.given(other)) {
        fault(node->source(), fmt::format("[[monitor]] gives both along and {}", other),
              "a profile is a line of points, each of which follows the block that holds it",
              fmt::format("leave {} out, or write another [[monitor]] for it", other));
        return {};
      }
    }
    if (section.given("name") == nullptr) {
      fault(section.source(), "'name' in [[monitor]] is missing", "a profile has name and along",
            "for example name = \"wall\"");
      return {};
    }
    std::vector<Vec2> ends;
    section.read("along", ends);
    if (section.sound("along") != nullptr && (ends.size() != 2 || ends[0] == ends[1])) {
      fault(section.given("along")->source(),
            fmt::format("'along' in [[monitor]] has {}",
                        ends.size() != 2 ? fmt::format("{} points", ends.size()) : "the same point twice"),
            "a profile is a straight line between two points",
            "for example along = [[0.0, 2.0], [8.0, 2.0]]");
      return {};
    }
    if (section.sound("along") == nullptr || section.sound("name") == nullptr || !section.known("points")) {
      return {};
    }
    std::int64_t num_points = 21;
    section.read("points", num_points);
    num_profile_points_ += num_points;
    if (num_profile_points_ > most_profile_points) {
      fault(section.source(), fmt::format("the profiles up to this one have {} points", num_profile_points_),
            fmt::format("all together have at most {}", most_profile_points), "use fewer points");
      return {};
    }
    Monitor monitor;
    monitor.name = *section.text("name");
    monitor.is_point = true;
    monitor.is_on_profile = true;
    monitor.where = source_.faults.origins().position(section.given("along")->source());
    if (!takes_name(section, monitor.name, "profile")) {
      return {};
    }
    std::vector<Monitor> profile(static_cast<std::size_t>(num_points), monitor);
    for (std::size_t k = 0; k < profile.size(); ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(num_points - 1);
      profile[k].distance = share * norm(ends[1] - ends[0]);
      profile[k].point = k + 1 == profile.size() ? ends[1] : ends[0] + share * (ends[1] - ends[0]);
    }
    return profile;
  }

  /// False, and reported, where another history has the name.
  bool takes_name(const Section &section, const std::string &name, const char *what) {
    const toml::source_region &where = section.given("name")->source();
    if (is_taken(name)) {
      fault(where, fmt::format("a {} named '{}' cannot be monitored", what, name), why_taken(name),
            "choose another name");
      return false;
    }
    const auto [first, is_new] = first_of_name_.emplace(name, First{where, true});
    if (!is_new) {
      report_shared_file(where, name, first->second.where);
    }
    return is_new;
  }

  void report_shared_file(const toml::source_region &where, const std::string &name,
                          const toml::source_region &first) {
    fault(where, fmt::format("two monitors are named '{}'", name),
          fmt::format("the one at {} writes history/{}.csv too", source_.faults.origins().place(first), name),
          "choose another name for the point");
  }

  std::string hint_for(const std::string &name) {
    for (const BrickGenerator &generator : scene_->generators) {
      if (name.starts_with(generator.name + ".")) {
        return fmt::format("blocks of '{0}' are {0}.<row>.<column>, from {1} to {2}", generator.name,
                           make_block(generator, 0).name,
                           make_block(generator, num_blocks(generator) - 1).name);
      }
    }
    const bool is_number = name.find_first_not_of("0123456789", 1) == std::string::npos;
    const bool has_file = !scene_->block_file.path.empty();
    if ((has_file || scene_->region.present()) && name.starts_with('b') && name.size() > 1 && is_number) {
      return fmt::format("the blocks of the {} begin with b{}", has_file ? "file" : "region",
                         num_blocks(*scene_));
    }
    const std::string near = nearest_word(name, names_);
    return near.empty() ? "unnamed blocks are b<n>, from 0 in file order"
                        : fmt::format("did you mean '{}'?", near);
  }

  static constexpr std::int64_t most_profile_points = 100'000;

  struct First {
    toml::source_region where;
    bool is_point;
  };
  SceneSource source_;
  const Scene *scene_;
  std::unordered_map<std::string, std::int64_t> id_of_name_;
  std::vector<std::string> names_;
  std::vector<std::string> generators_; ///< also those that cannot be built
  std::unordered_map<std::string, First> first_of_name_;
  std::int64_t num_profile_points_ = 0;
};

} // namespace

std::vector<Monitor> read_monitors(const SceneSource &source, const Scene &scene) {
  MonitorReader reader(source, scene);
  std::vector<Monitor> monitors;
  for (const Section &section : listed_sections(source.root, "monitor", source.faulty)) {
    const std::vector<Monitor> read = reader.read(section);
    monitors.insert(monitors.end(), read.begin(), read.end());
  }
  return monitors;
}

} // namespace gcpdda::scene_text
