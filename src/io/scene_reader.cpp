#include "gcpdda/io/scene_reader.hpp"

#include "scene_keys.hpp"
#include "scene_parts.hpp"
#include "scene_sets.hpp"
#include "scene_writer.hpp"

#include <filesystem>

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
  Materials materials(source);
  Names names(source.faults);
  scene.materials = materials.all();
  scene.joints = read_joint_laws(source, materials.index());
  expect_blocks(source);
  scene.blocks = read_blocks(source, materials, names, fidelity, scene.joints);
  scene.generators = read_generators(source, materials, names, fidelity, scene.blocks);
  scene.block_file = read_block_file_table(source, materials, fidelity, file);
  scene.region = read_region(source, materials, scene.joints, file);
  scene.output = read_output(source, scene.run.duration);
  scene.monitors = read_monitors(source, scene);
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
  for (std::size_t i = 0; i < scene.region.maps.size(); ++i) {
    name(scene.region.maps[i].path, root["joint_map"][i]["file"].node());
  }
}

} // namespace

} // namespace scene_text

SceneReading read_scene(std::string_view text, const std::string &file,
                        const std::vector<std::string> &sets) {
  using namespace scene_text;
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

} // namespace gcpdda
