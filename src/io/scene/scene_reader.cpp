#include "gcpdda/io/scene_reader.hpp"

#include "io/scene/scene_blocks.hpp"
#include "io/scene/scene_check.hpp"
#include "io/scene/scene_earthquake.hpp"
#include "io/scene/scene_ensemble.hpp"
#include "io/scene/scene_generators.hpp"
#include "io/scene/scene_in_situ.hpp"
#include "io/scene/scene_joints.hpp"
#include "io/scene/scene_keys.hpp"
#include "io/scene/scene_materials.hpp"
#include "io/scene/scene_monitors.hpp"
#include "io/scene/scene_places.hpp"
#include "io/scene/scene_region.hpp"
#include "io/scene/scene_sets.hpp"
#include "io/scene/scene_settings.hpp"
#include "io/scene/scene_sides.hpp"
#include "io/scene/scene_stages.hpp"
#include "io/scene/scene_support.hpp"
#include "io/scene/scene_water.hpp"
#include "io/scene/scene_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>

namespace gcpdda {

namespace scene_text {

namespace {

void expect_blocks(const SceneSource &source) {
  for (const char *key : {"block", "wall", "pyramid"}) {
    const toml::node *node = source.root.get(key);
    const bool is_empty = node != nullptr && node->is_array() && node->as_array()->empty();
    if (node != nullptr && !is_empty) {
      return;
    }
  }
  if (!source.root.contains("blocks") && !source.root.contains("region")) {
    source.faults.add(source.root.source(), "the scene has no blocks",
                      "at least one block, wall, pyramid, block file or region is required",
                      "write [[block]], [[wall]], [[pyramid]], [blocks] or [region]");
  }
}

void read_parts(const SceneSource &source, const std::string &file, Scene &scene) {
  scene.run = read_run(source);
  const Fidelity fidelity = scene.run.fidelity;
  scene.places = places_of(source);
  Materials materials(source);
  Names names(source.faults);
  scene.materials = materials.all();
  scene.joints = read_joint_laws(source, materials.index());
  scene.water = read_water(source, scene.joints);
  expect_blocks(source);
  scene.blocks = read_blocks(source, materials, names, fidelity, scene.joints);
  scene.generators = read_generators(source, materials, names, fidelity, scene.blocks);
  scene.block_file = read_block_file_table(source, materials, fidelity, file);
  scene.region = read_region(source, materials, fidelity, scene.joints, file);
  scene.supports = read_supports(source);
  scene.bolts = read_bolts(source, scene);
  scene.liners = read_liners(source, scene);
  add_rollers(source, scene);
  if (has_stages(source.root)) {
    scene.run.duration = duration_of_stages(source);
  }
  scene.output = read_output(source, scene.run.duration);
  scene.monitors = read_monitors(source, scene);
  scene.reduction = read_reduction(source, scene.joints);
}

// A block that could move keeps its state when a stage fixes it: it is held where it is then.
void hold_where_they_are(Scene &scene, std::vector<bool> &could_move) {
  could_move.resize(scene.blocks.size());
  for (std::size_t i = 0; i < scene.blocks.size(); ++i) {
    SceneBlock &block = scene.blocks[i];
    if (block.fixed && could_move[i]) {
      block.fixed = false;
      block.driven = true;
      block.velocity = {};
      block.velocity_table.clear();
    }
    could_move[i] = could_move[i] || !block.fixed;
  }
}

/// What a reading starts from.
struct Text {
  std::string_view toml;
  const std::string &file;
  const std::vector<std::string> &sets;
};

/// The tree of a stage: that of the file with all that is set up to it.
struct TreeOfStage {
  std::optional<toml::table> root;
  bool changes = false;                          ///< this stage sets something
  std::optional<toml::source_region> stress_set; ///< where it sets the in-situ stress
  std::optional<toml::source_region> water_set;  ///< where it sets gravity, or water
};

TreeOfStage tree_of_stage(const Text &text, std::size_t last, Faults &faults) {
  TreeOfStage tree{parse_scene(text.toml, faults), false, {}, {}};
  for (std::size_t i = 0; i < text.sets.size(); ++i) {
    apply_set(*tree.root, text.sets[i], i, faults);
  }
  toml::array *stages = (*tree.root)["stage"].as_array();
  for (std::size_t k = 0; k <= last; ++k) {
    toml::table *stage = (*stages)[k].as_table();
    toml::table *set = stage == nullptr ? nullptr : stage->get_as<toml::table>("set");
    tree.changes = set != nullptr;
    for (auto entry = set == nullptr ? toml::table::iterator() : set->begin();
         tree.changes && entry != set->end(); ++entry) {
      if (k == last && sets_stress(entry->first.str())) {
        tree.stress_set = entry->first.source();
      }
      if (k == last && sets_gravity_or_water(entry->first.str())) {
        tree.water_set = entry->first.source();
      }
      apply_change(*tree.root, entry->first, entry->second, faults);
    }
  }
  return tree;
}

/// The key of a table that gives its law bonds.
const toml::node *key_of_bonds(const toml::table &root, const std::string &law) {
  for (const char *key : {"tension", "residual_cohesion", "residual_friction_angle_deg"}) {
    if (const toml::node *node = root["joint"][law][key].node()) {
      return node;
    }
  }
  return nullptr;
}

// Bonds form at the start alone. Contacts that have none take the residual values, as if theirs were broken.
void expect_no_new_bonds(const toml::table &root, const JointLaws &start, const JointLaws &after,
                         Faults &faults) {
  for (std::size_t i = 0; i < start.laws.size() && i < after.laws.size(); ++i) {
    const std::string &name = start.laws[i].name;
    if (start.laws[i].has_bonds || !after.laws[i].has_bonds) {
      continue;
    }
    const toml::node *own = key_of_bonds(root, name);
    const toml::node *key = own != nullptr ? own : key_of_bonds(root, "default");
    faults.add(key != nullptr ? key->source() : root.source(),
               fmt::format("a stage cannot give [joint.{}] bonds", name),
               "tension and residual values belong to bonds, which form at t = 0 only, under laws that have "
               "one of these keys then; contacts without bonds would have the residual values alone",
               fmt::format("write tension into [joint.{}] itself and let the stage change its value, or set "
                           "cohesion and friction_angle_deg alone",
                           name));
  }
}

/// The scene of a stage is that of the file with all that is set up to it; its faults are told where they are
/// set. Moved values leave a copy of the tree that is no longer good: each stage takes a new one.
void read_changes(const Text &text, Faults &faults, Scene &scene) {
  std::vector<bool> could_move;
  InSituStress stress = scene.in_situ;
  Scene start = scene;
  hold_where_they_are(start, could_move);
  for (std::size_t last = 0; last < scene.stages.size(); ++last) {
    Faults own(faults.origins());
    TreeOfStage tree = tree_of_stage(text, last, own);
    if (!tree.changes) {
      continue;
    }
    auto after = std::make_shared<Scene>();
    const FaultyNodes faulty = check_keys(*tree.root, own);
    const SceneSource source{*tree.root, faulty, own};
    read_parts(source, text.file, *after);
    expect_no_new_bonds(*tree.root, scene.joints, after->joints, own);
    if (tree.water_set) { // else it has been told
      expect_gravity_of_water(source, after->water, tree.water_set);
    }
    if (tree.stress_set) {
      after->in_situ = read_in_situ(source, *after);
      read_stressed_sides(source, *after);
      if (after->in_situ.present) { // else it has been told
        check_changed_stress(source, *tree.stress_set, *after, stress);
      }
      stress = after->in_situ;
      scene.stages[last].changes_stress = true;
    }
    faults.add_new(own);
    hold_where_they_are(*after, could_move);
    scene.stages[last].after = std::move(after);
  }
}

SceneReading read_alone(std::string_view text, const std::string &file, const std::vector<std::string> &sets);

/// A member of the ensemble is the scene with other values: what is wrong with the median of each is told
/// where it is said to vary.
void check_variations(const Text &text, SceneReading &reading) {
  for (const Variation &variation : reading.scene.ensemble.variations) {
    std::vector<std::string> sets = text.sets;
    sets.push_back(assignment(variation, variation.quantile(0.5)));
    for (Diagnostic &fault : read_alone(text.toml, text.file, sets).diagnostics) {
      if (fault.severity == Severity::error) {
        fault.where = variation.where;
        fault.what = fmt::format("'{}' cannot vary: {}", variation.key, fault.what);
        reading.diagnostics.push_back(fault);
      }
    }
  }
}

/// The resolved scene will lie in another folder, and may be read from a third one.
void name_from_everywhere(const Scene &scene, toml::table &root) {
  const auto name = [](const std::string &path, toml::node *node) {
    const std::string whole = path.empty() ? "" : std::filesystem::absolute(path).string();
    if (!whole.empty() && whole.size() <= longest_text) {
      *node->as_string() = whole;
    }
  };
  name(scene.block_file.path, root["blocks"]["file"].node());
  name(scene.earthquake.file, root["earthquake"]["record"].node());
  for (std::size_t i = 0; i < scene.region.maps.size(); ++i) {
    name(scene.region.maps[i].path, root["joint_map"][i]["file"].node());
  }
}

SceneReading read_alone(std::string_view text, const std::string &file,
                        const std::vector<std::string> &sets) {
  const Origins origins(file, sets);
  Faults faults(origins);
  SceneReading reading;
  reading.scene.stem = std::filesystem::path(file).stem().string();
  if (auto root = parse_scene(text, faults)) {
    for (std::size_t i = 0; i < sets.size(); ++i) {
      apply_set(*root, sets[i], i, faults);
    }
    const FaultyNodes faulty = check_keys(*root, faults);
    read_parts({*root, faulty, faults}, file, reading.scene);
    expect_gravity_of_water({*root, faulty, faults}, reading.scene.water, std::nullopt);
    reading.scene.in_situ = read_in_situ({*root, faulty, faults}, reading.scene);
    read_stressed_sides({*root, faulty, faults}, reading.scene);
    reading.scene.stages = read_stages({*root, faulty, faults}, reading.scene);
    reading.scene.earthquake = read_earthquake({*root, faulty, faults}, reading.scene, file);
    read_viscous_sides({*root, faulty, faults}, reading.scene);
    reading.scene.ensemble = read_ensemble({*root, faulty, faults}, reading.scene);
    read_changes({text, file, sets}, faults, reading.scene);
    reading.diagnostics = faults.sorted();
    if (!has_errors(reading.diagnostics)) {
      name_from_everywhere(reading.scene, *root);
      reading.scene.resolved = to_toml(*root, origins);
    }
  } else {
    reading.diagnostics = faults.sorted();
  }
  return reading;
}

} // namespace

} // namespace scene_text

std::string assignment(const Variation &variation, double value) {
  return fmt::format("{}={}", variation.key, value);
}

SceneReading read_scene(std::string_view text, const std::string &file,
                        const std::vector<std::string> &sets) {
  SceneReading reading = scene_text::read_alone(text, file, sets);
  if (!has_errors(reading.diagnostics)) {
    scene_text::check_variations({text, file, sets}, reading);
  }
  return reading;
}

// No string of a resolved scene holds a line end, so that a line which begins with a bracket is a header.
std::string settling_part(std::string_view resolved) {
  constexpr std::array<std::string_view, 4> left_out{"fos", "output", "ensemble", "monitor"};
  std::string part;
  bool counts = true;
  while (!resolved.empty()) {
    const std::string_view line = resolved.substr(0, resolved.find('\n'));
    resolved.remove_prefix(std::min(line.size() + 1, resolved.size()));
    if (line.starts_with('[')) {
      const std::string_view path = line.substr(line.find_first_not_of('['));
      const std::string_view table = path.substr(0, path.find_first_of(".]"));
      counts = std::find(left_out.begin(), left_out.end(), table) == left_out.end();
    }
    if (counts && !line.empty() && !line.starts_with('#')) {
      part.append(line).push_back('\n');
    }
  }
  return part;
}

} // namespace gcpdda
