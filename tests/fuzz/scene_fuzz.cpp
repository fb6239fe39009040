// Any text is a scene or gets faults with places in it. What follows a line "--set" are --set arguments, one
// a line.

#include "scene_checks.hpp"

#include "gcpdda/io/scene_reader.hpp"
#include "model/generators.hpp"

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace gcpdda::fuzz {
namespace {

constexpr const char *file_name = "folder/scene.toml";

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

struct Input {
  std::string text;
  std::vector<std::string> sets;
};

Input split(std::string_view bytes) {
  constexpr std::string_view separator = "\n--set\n";
  const std::size_t at = bytes.find(separator);
  Input input{std::string(bytes.substr(0, at)), {}};
  if (at != std::string_view::npos) {
    std::string_view sets = bytes.substr(at + separator.size());
    sets.remove_suffix(sets.ends_with('\n') ? 1 : 0);
    for (const std::string_view line : lines_of(sets)) {
      input.sets.emplace_back(line);
    }
  }
  return input;
}

void check_place(const Diagnostic &d, const std::string &text) {
  if (d.where.file != file_name) {
    require(d.where.file.starts_with("--set ") && d.where.line == 0, "a fault is in the file or in a --set",
            to_string(d));
    return;
  }
  const std::vector<std::string_view> lines = lines_of(text);
  const auto line = static_cast<std::size_t>(d.where.line);
  require(d.where.line >= 1 && line <= lines.size(), "a line of the text", to_string(d));
  // One behind the last character, and one more for the end of the line.
  require(d.where.column >= 1 && static_cast<std::size_t>(d.where.column) <= lines[line - 1].size() + 2,
          "a column of the line", to_string(d));
}

void check_settings(const Scene &scene) {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  require(positive(scene.run.duration), "duration");
  require(std::isfinite(scene.run.time_step) && scene.run.time_step >= 0.0, "time step");
  require(positive(scene.output.interval), "interval");
  require(positive(scene.output.history_interval), "history interval");
  const double ratio = scene.output.interval / scene.output.history_interval;
  require(positive(ratio), "histories that divide interval or are a multiple of it");
  require(!scene.materials.empty(), "a scene has materials");
  for (const Material &material : scene.materials) {
    require(positive(material.density), "density", material.name);
  }
  const std::size_t n = scene.materials.size();
  require(scene.joints.num_materials == static_cast<std::int32_t>(n), "materials of the joints");
  require(scene.joints.of_material.size() == n * n, "a law for each pair");
  for (const std::int32_t law : scene.joints.of_material) {
    require(law >= 0 && static_cast<std::size_t>(law) < scene.joints.laws.size(), "laws exist");
  }
  for (const JointLaw &law : scene.joints.laws) {
    require(positive(law.normal_stiffness) != positive(law.allowed_overlap), "stiffness or overlap",
            law.name);
    require(positive(law.tangential_ratio) && std::isfinite(law.tan_friction) && law.tan_friction >= 0.0,
            "friction", law.name);
  }
}

void check_generator(const Scene &scene, const BrickGenerator &generator, std::int64_t first) {
  const std::int64_t count = num_blocks(generator);
  require(count >= 1, "a generator makes blocks", generator.name);
  for (const std::int64_t index : {std::int64_t{0}, count / 2, count - 1}) {
    const SceneBlock block = make_block(generator, index);
    check_block(block, scene.materials.size());
    require(block.vertices.size() == 4, "bricks have four corners", block.name);
    require(block_name(scene, first + index) == block.name, "the name of a brick", block.name);
    require(find_generated_block(scene, block.name) == first + index, "the brick of a name", block.name);
  }
}

void check_scene(const Scene &scene) {
  check_settings(scene);
  std::set<std::string> names;
  for (const SceneBlock &block : scene.blocks) {
    check_block(block, scene.materials.size());
    require(names.insert(block.name).second, "names are unique", block.name);
    require(find_generated_block(scene, block.name) < 0, "no block has the name of a brick", block.name);
  }
  auto first = static_cast<std::int64_t>(scene.blocks.size());
  for (const BrickGenerator &generator : scene.generators) {
    check_generator(scene, generator, first);
    require(names.insert(generator.name).second, "names are unique", generator.name);
    first += num_blocks(generator);
  }
  require(first <= 2'147'483'647, "ids fit 32 bits");
  const bool has_file = !scene.block_file.path.empty() || scene.region.present();
  require(first >= 1 || has_file, "a scene has blocks");
  for (const Monitor &monitor : scene.monitors) {
    require(monitor.is_point || (monitor.block >= 0 && (monitor.block < first || has_file)),
            "monitored blocks exist", monitor.name);
  }
}

void check_same(const Scene &again, const Scene &scene) {
  require(again.resolved == scene.resolved, "the resolved text reads to itself", scene.resolved);
  require(num_blocks(again) == num_blocks(scene), "the resolved text has all blocks");
  require(again.joints.of_material == scene.joints.of_material, "the resolved text has the same joints");
  require(again.monitors.size() == scene.monitors.size(), "the resolved text has all monitors");
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    require(again.materials.at(i).name == scene.materials[i].name, "materials keep their order");
  }
  for (std::size_t i = 0; i < scene.blocks.size(); ++i) {
    require(again.blocks.at(i).vertices == scene.blocks[i].vertices, "blocks keep their order and vertices");
  }
}

void run(std::string_view bytes) {
  const Input input = split(bytes);
  const SceneReading reading = read_scene(input.text, file_name, input.sets);
  for (const Diagnostic &d : reading.diagnostics) {
    check_message(d);
    check_place(d, input.text);
  }
  if (has_errors(reading.diagnostics)) {
    return;
  }
  check_scene(reading.scene);
  const SceneReading again = read_scene(reading.scene.resolved, file_name, {});
  require(again.diagnostics.size() == reading.diagnostics.size(), "the resolved text is a scene",
          again.diagnostics.empty() ? "" : to_string(again.diagnostics.front()));
  check_same(again.scene, reading.scene);
}

} // namespace
} // namespace gcpdda::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  gcpdda::fuzz::run({reinterpret_cast<const char *>(data), size});
  return 0;
}
