#include "io/scene/scene_stages.hpp"

#include "base/edit_distance.hpp"
#include "io/scene/scene_outline.hpp"
#include "io/scene/scene_sets.hpp"
#include "model/generators.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <unordered_map>
#include <utility>

namespace gcpdda::scene_text {

namespace {

/// A key and the kinds of stages it belongs to.
struct Belongs {
  const char *key;
  std::vector<StageKind> kinds;
};

const std::vector<Belongs> &belongings() {
  using enum StageKind;
  static const std::vector<Belongs> table{
      {"duration", {run}},
      {"limit", {run, settle}},
      {"tolerance", {run, settle}},
      {"failure_motion", {run, settle}},
      {"local_damping", {run, settle}},
      {"kinetic_damping", {settle}},
      {"mass_scaling", {settle}},
      {"solver", {settle}},
      {"increments", {settle}},
      {"blocks", {excavate}},
      {"region", {excavate}},
      {"openings", {excavate}},
      {"relax", {excavate}},
  };
  return table;
}

std::string kinds_text(const std::vector<StageKind> &kinds) {
  const std::vector<std::string> words = words_of(find_key("stage[]", "kind")->choices);
  std::string text;
  for (const StageKind kind : kinds) {
    text += (text.empty() ? "" : " and ") + words[static_cast<std::size_t>(kind)];
  }
  return text;
}

class StageReader {
public:
  StageReader(const SceneSource &source, const Scene &scene) : source_(source), scene_(&scene) {
    for (std::size_t i = 0; i < scene.blocks.size(); ++i) {
      id_of_name_.emplace(scene.blocks[i].name, static_cast<std::int64_t>(i));
      names_.push_back(scene.blocks[i].name);
    }
  }

  Stage read(const Section &section, std::size_t index) {
    Stage stage;
    stage.where = source_.faults.origins().position(section.source());
    stage.name = section.text("name").value_or(fmt::format("stage{}", index));
    expect_new_name(section, stage.name);
    section.read_choice("stage[]", "kind", stage.kind);
    if (section.sound("kind") == nullptr) {
      return stage;
    }
    expect_own_keys(section, stage.kind);
    section.read("duration", stage.duration);
    section.read("limit", stage.duration);
    stage.until_verdict = section.given("limit") != nullptr;
    section.read("tolerance", stage.tolerance);
    section.read("failure_motion", stage.failure_motion);
    section.read("kinetic_damping", stage.kinetic_damping);
    stage.local_damping = stage.kind != StageKind::settle ? -1.0 : stage.kinetic_damping ? 0.0 : 0.8;
    section.read("local_damping", stage.local_damping);
    section.read("mass_scaling", stage.mass_scaling);
    const bool is_damped =
        section.given("local_damping") != nullptr || stage.kinetic_damping || stage.mass_scaling;
    stage.solver = stage.kind == StageKind::settle && !is_damped ? Solver::statics : Solver::dynamic;
    section.read_choice("stage[]", "solver", stage.solver);
    section.read("increments", stage.increments);
    section.read("relax", stage.relax);
    section.read("ramp", stage.ramp);
    expect_ramped(section);
    expect_end(section, stage.kind);
    if (index == 0 && (!stage.takes_steps() || section.given("set") != nullptr)) {
      fault(section.source(), section.label() + " changes the scene before anything has happened",
            "the first stage starts from the scene as it is written",
            "write the change into the scene itself, or let a stage of kind settle or run come first");
    }
    if (stage.kind == StageKind::excavate) {
      stage.excavated = read_selection(section);
    }
    if (stage.kind == StageKind::change && section.given("set") == nullptr) {
      fault(section.source(), section.label() + " changes nothing", "a change needs 'set'",
            "for example set = { \"joint.default.friction_angle_deg\" = 25.0 }");
    }
    return stage;
  }

private:
  void fault(const toml::source_region &where, std::string what, std::string why, std::string hint) {
    source_.faults.add(where, std::move(what), std::move(why), std::move(hint));
  }

  void expect_new_name(const Section &section, const std::string &name) {
    const toml::node *given = section.given("name");
    const toml::source_region &where = given != nullptr ? given->source() : section.source();
    if (const auto [first, is_new] = first_of_name_.emplace(name, where); !is_new) {
      fault(where, fmt::format("two stages are named '{}'", name),
            fmt::format("the other one is at {}", source_.faults.origins().place(first->second)),
            "choose another name");
    }
  }

  void expect_own_keys(const Section &section, StageKind kind) {
    for (const Belongs &belongs : belongings()) {
      const toml::node *node = section.given(belongs.key);
      if (node != nullptr && std::count(belongs.kinds.begin(), belongs.kinds.end(), kind) == 0) {
        fault(node->source(), section.subject(belongs.key) + " has no meaning",
              fmt::format("it belongs to stages of kind {}", kinds_text(belongs.kinds)), "leave it out");
      }
    }
  }

  void expect_ramped(const Section &section) {
    const toml::node *ramp = section.given("ramp");
    const toml::node *set = section.given("set");
    const toml::table *changes = set == nullptr ? nullptr : set->as_table();
    if (ramp == nullptr ||
        (changes != nullptr && std::any_of(changes->begin(), changes->end(), [](auto entry) {
           return sets_stress(entry.first.str()) || sets_load(entry.first.str());
         }))) {
      return;
    }
    fault(ramp->source(), section.subject("ramp") + " has no meaning",
          "it belongs to stages that set in_situ.KEY, region.stress or block.NAME.load: everything else "
          "changes "
          "at once",
          "leave it out");
  }

  void expect_end(const Section &section, StageKind kind) {
    const bool duration = section.given("duration") != nullptr;
    const bool limit = section.given("limit") != nullptr;
    if (kind == StageKind::settle && !limit) {
      fault(section.source(), fmt::format("'limit' in {} is missing", section.label()),
            "a stage that waits for a verdict must not wait for ever", "for example limit = 10.0");
    } else if (kind == StageKind::run && duration == limit) {
      fault(section.source(),
            fmt::format("{} gives {} duration {} limit", section.label(), duration ? "both" : "neither",
                        duration ? "and" : "nor"),
            "a run lasts for a duration, or until a verdict and at most for a limit",
            duration ? "leave one of them out" : "for example duration = 2.0");
    }
  }

  BlockSelection read_selection(const Section &section) {
    BlockSelection selection;
    if (section.given("blocks") == nullptr && section.given("region") == nullptr &&
        section.given("openings") == nullptr) {
      fault(section.source(), section.label() + " names no blocks",
            "an excavation needs 'blocks', 'region', 'openings' or several of them",
            "for example region = [[0, 0], [4, 0], [4, 3], [0, 3]]");
    }
    section.read("region", selection.region);
    if (const toml::node *node = section.sound("region")) {
      for (const OutlineFault &found : check_outline(selection.region, section.subject("region"))) {
        fault(node->source(), found.what, found.why, found.hint);
      }
    }
    const toml::node *names = section.sound("blocks");
    for (std::size_t i = 0; names != nullptr && i < names->as_array()->size(); ++i) {
      const toml::node &name = (*names->as_array())[i];
      if (const std::int64_t id = find(name.as_string()->get()); id >= 0) {
        selection.blocks.push_back(id);
      } else {
        const std::string near = nearest_word(name.as_string()->get(), names_);
        fault(name.source(), fmt::format("no block is named '{}'", name.as_string()->get()), "",
              near.empty() ? "unnamed blocks are b<n>, from 0 in file order"
                           : fmt::format("did you mean '{}'?", near));
      }
    }
    std::sort(selection.blocks.begin(), selection.blocks.end());
    if (const toml::node *openings = section.sound("openings")) {
      read_openings(*openings->as_array(), selection);
    }
    return selection;
  }

  void read_openings(const toml::array &names, BlockSelection &selection) {
    const std::vector<Opening> &openings = scene_->region.openings;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::string &name = names[i].as_string()->get();
      const auto found = std::find_if(openings.begin(), openings.end(),
                                      [&](const Opening &opening) { return opening.name == name; });
      if (found == openings.end()) {
        fault(names[i].source(), fmt::format("no opening is named '{}'", name), "",
              openings.empty() ? "the scene has no [[opening]]"
                               : fmt::format("did you mean '{}'?", openings.front().name));
      } else if (found->excavated) {
        fault(names[i].source(), fmt::format("opening '{}' has no blocks", name),
              "with 'excavated' they are not made at all", "leave 'excavated' out of the opening");
      } else {
        selection.openings.push_back(static_cast<std::size_t>(found - openings.begin()));
      }
    }
  }

  std::int64_t find(const std::string &name) const {
    const auto found = id_of_name_.find(name);
    return found != id_of_name_.end() ? found->second : find_generated_block(*scene_, name);
  }

  SceneSource source_;
  const Scene *scene_;
  std::unordered_map<std::string, std::int64_t> id_of_name_;
  std::vector<std::string> names_;
  std::map<std::string, toml::source_region> first_of_name_;
};

} // namespace

std::vector<Stage> read_stages(const SceneSource &source, const Scene &scene) {
  StageReader reader(source, scene);
  std::vector<Stage> stages;
  for (const Section &section : listed_sections(source.root, "stage", source.faulty)) {
    stages.push_back(reader.read(section, stages.size()));
  }
  return stages;
}

double duration_of_stages(const SceneSource &source) {
  double sum = 0.0;
  for (const Section &section : listed_sections(source.root, "stage", source.faulty)) {
    for (const char *key : {"duration", "limit"}) {
      double length = 0.0;
      section.read(key, length);
      sum += length;
    }
  }
  return sum;
}

} // namespace gcpdda::scene_text
