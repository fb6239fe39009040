#include "gcpdda/io/scene_reader.hpp"

#include "edit_distance.hpp"
#include "scene_parts.hpp"
#include "scene_sets.hpp"
#include "scene_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace gcpdda {

namespace scene_text {

namespace {

void fault(const SceneSource &source, const toml::node &node, std::string what, std::string why,
           std::string hint) {
  source.faults.add(node.source(), std::move(what), std::move(why), std::move(hint));
}

// Keys that only some schemes have.
void check_scheme_keys(const SceneSource &source, const Section &run, SchemeKind scheme) {
  if (!run.known("scheme")) {
    return;
  }
  const bool implicit = scheme == SchemeKind::generalized_alpha;
  if (const toml::node *node = run.given("contact_time"); node != nullptr && !implicit) {
    fault(source, *node, run.subject("contact_time") + " has no meaning for this scheme",
          "it belongs to generalized-alpha", "leave it out");
  }
  const bool has_radius = implicit || scheme == SchemeKind::explicit_generalized_alpha;
  if (const toml::node *node = run.given("spectral_radius"); node != nullptr && !has_radius) {
    fault(source, *node, run.subject("spectral_radius") + " has no meaning for this scheme",
          "it belongs to generalized-alpha and explicit-generalized-alpha", "leave it out");
  }
}

void check_available(const SceneSource &source, const Section &run, Fidelity fidelity) {
  if (fidelity == Fidelity::deformable) {
    fault(source, *run.given("fidelity"), "deformable blocks are not available in this version", "",
          "use \"rigid\"");
  }
  double local_damping = 0.0;
  run.read("local_damping", local_damping);
  if (local_damping != 0.0) {
    fault(source, *run.given("local_damping"),
          run.subject("local_damping") + " is not available in this version", "", "leave it out or write 0");
  }
}

RunSettings read_run(const SceneSource &source) {
  const Section run = section(source.root, "run", source.faulty);
  RunSettings settings;
  run.read("duration", settings.duration);
  run.read("gravity", settings.gravity);
  run.read("gravity_ramp", settings.gravity_ramp);
  const toml::node *time_step = run.sound("time_step");
  if (time_step != nullptr && !time_step->is_string()) {
    settings.time_step = as_number(*time_step);
  }
  run.read("safety", settings.safety);
  run.read_choice("run", "scheme", settings.scheme);
  run.read("spectral_radius", settings.spectral_radius);
  run.read_choice("run", "contact_time", settings.contact_time);
  run.read_choice("run", "potential", settings.potential);
  run.read_choice("run", "fidelity", settings.fidelity);
  run.read("accepted_error", settings.accepted_error);
  run.read_choice("run", "initial_friction", settings.initial_friction);
  run.read("contact_damping", settings.contact_damping);
  settings.plane_strain = run.text("plane").value_or("strain") == "strain";
  check_scheme_keys(source, run, settings.scheme);
  check_available(source, run, settings.fidelity);
  return settings;
}

std::vector<Material> read_materials(const SceneSource &source) {
  std::vector<Material> materials;
  for (const auto &[name, section] :
       named_sections(source.root, "material", source.faulty, source.faults.origins())) {
    Material &material = materials.emplace_back();
    material.name = name;
    section.read("density", material.density);
    section.read("youngs_modulus", material.youngs_modulus);
    section.read("poissons_ratio", material.poissons_ratio);
  }
  return materials;
}

OutputSettings read_output(const SceneSource &source, double duration) {
  const Section output = section(source.root, "output", source.faulty);
  OutputSettings settings;
  settings.interval = duration / 100.0;
  output.read("interval", settings.interval);
  settings.history_interval = settings.interval;
  output.read("history_interval", settings.history_interval);
  output.read("contacts", settings.contacts);

  const bool duration_known = duration > 0.0;
  const bool interval_known =
      output.sound("interval") != nullptr || (output.given("interval") == nullptr && duration_known);
  constexpr double most_frames = 1e6;
  if (duration_known && interval_known && duration / settings.interval >= most_frames) {
    fault(source, *output.given("interval"),
          fmt::format("{} makes {:.0f} frames", output.subject("interval"), duration / settings.interval),
          "frame numbers have six digits", fmt::format("use at least {:g}", duration / most_frames * 2.0));
  }
  if (const toml::node *node = output.sound("history_interval"); node != nullptr && interval_known) {
    const double longer = std::max(settings.interval, settings.history_interval);
    const double ratio = longer / std::min(settings.interval, settings.history_interval);
    if (std::abs(ratio - std::round(ratio)) > 1e-9 * ratio) {
      fault(source, *node,
            fmt::format("{} is {}", output.subject("history_interval"), settings.history_interval),
            fmt::format("it must divide interval ({}) or be a multiple of it", settings.interval),
            fmt::format("for example history_interval = {}", settings.interval));
    }
  }
  return settings;
}

std::vector<Monitor> read_monitors(const SceneSource &source, const std::vector<SceneBlock> &blocks) {
  std::unordered_map<std::string, std::int64_t> id_of_name;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    id_of_name.emplace(blocks[i].name, static_cast<std::int64_t>(i));
    names.push_back(blocks[i].name);
  }
  std::unordered_set<std::string> monitored;
  std::vector<Monitor> monitors;
  for (const Section &section : listed_sections(source.root, "monitor", source.faulty)) {
    const auto name = section.text("block");
    if (!name) {
      continue;
    }
    const toml::node &node = *section.given("block");
    const auto found = id_of_name.find(*name);
    if (found == id_of_name.end()) {
      const std::string near = nearest_word(*name, names);
      fault(source, node, fmt::format("no block is named '{}'", *name), "",
            near.empty() ? "unnamed blocks are b<n>, from 0 in file order"
                         : fmt::format("did you mean '{}'?", near));
    } else if (!monitored.insert(*name).second) {
      fault(source, node, fmt::format("block '{}' is monitored twice", *name), "", "keep one of them");
    } else if (*name == "energy") {
      fault(source, node, "a block named 'energy' cannot be monitored",
            "history/energy.csv holds the energies of the scene", "choose another name for the block");
    } else {
      monitors.push_back({*name, found->second});
    }
  }
  return monitors;
}

void read_parts(const SceneSource &source, Scene &scene) {
  scene.run = read_run(source);
  scene.materials = read_materials(source);
  MaterialIndex index;
  for (const Material &material : scene.materials) {
    index.emplace(material.name, static_cast<std::int32_t>(index.size()));
  }
  scene.joints = read_joint_laws(source, index);
  scene.blocks = read_blocks(source, index);
  scene.output = read_output(source, scene.run.duration);
  scene.monitors = read_monitors(source, scene.blocks);
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
    read_parts({*root, faulty, faults}, reading.scene);
    reading.diagnostics = faults.sorted();
    if (!has_errors(reading.diagnostics)) {
      reading.scene.resolved = to_toml(*root, origins);
    }
  } else {
    reading.diagnostics = faults.sorted();
  }
  return reading;
}

} // namespace gcpdda
