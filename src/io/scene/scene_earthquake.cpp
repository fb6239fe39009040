#include "io/scene/scene_earthquake.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace gcpdda::scene_text {

namespace {

void read_begin(const SceneSource &source, const Section &section, const Scene &scene,
                Earthquake &earthquake) {
  section.read("start", earthquake.start);
  const toml::node *stage = section.sound("stage");
  if (stage == nullptr) {
    return;
  }
  if (const toml::node *start = section.given("start")) {
    source.faults.add(start->source(), section.label() + " has both start and stage",
                      "it begins at a time or with a stage", "leave one of them out");
  }
  const std::string name = stage->as_string()->get();
  const auto found = std::find_if(scene.stages.begin(), scene.stages.end(),
                                  [&](const Stage &other) { return other.name == name; });
  if (found == scene.stages.end()) {
    source.faults.add(stage->source(), fmt::format("no stage is named '{}'", shown(name)), "",
                      scene.stages.empty() ? "the scene has no [[stage]]: leave 'stage' out"
                                           : fmt::format("did you mean '{}'?", scene.stages.back().name));
    return;
  }
  if (!found->takes_steps()) {
    source.faults.add(stage->source(), fmt::format("stage '{}' takes no time", shown(name)),
                      "nothing can shake in it", "name a stage of kind run");
  }
  earthquake.stage = found - scene.stages.begin();
}

void expect_motion(const SceneSource &source, const Section &section) {
  const toml::node *viscous = section.given("viscous");
  if (section.given("record") == nullptr && viscous == nullptr) {
    source.faults.add(section.source(), fmt::format("{} has neither record nor viscous", section.label()),
                      "then nothing shakes", "for example record = \"record.csv\"");
  }
  if (viscous != nullptr && !source.root.contains("region")) {
    source.faults.add(viscous->source(), section.subject("viscous") + " names sides of nothing",
                      "they are those of [region], which is missing", "leave it out");
  }
  for (const char *key : {"p_wave_speed", "s_wave_speed"}) {
    if (const toml::node *speed = section.given(key); speed != nullptr && viscous == nullptr) {
      source.faults.add(speed->source(), section.subject(key) + " has no meaning",
                        "it is that of the rock beyond viscous sides", "leave it out, or name the sides");
    }
  }
}

} // namespace

Earthquake read_earthquake(const SceneSource &source, const Scene &scene, const std::string &scene_file) {
  Earthquake earthquake;
  if (!source.root.contains("earthquake")) {
    return earthquake;
  }
  const Section section = scene_text::section(source.root, "earthquake", source.faulty);
  earthquake.where = source.faults.origins().position(section.source());
  if (const toml::node *record = section.sound("record")) {
    const std::string &path = record->as_string()->get();
    earthquake.file = (std::filesystem::path(scene_file).parent_path() / path).string();
    earthquake.where = source.faults.origins().position(record->source());
  }
  section.read_choice("earthquake", "quantity", earthquake.quantity);
  section.read_choice("earthquake", "baseline", earthquake.baseline);
  section.read("scale", earthquake.scale);
  if (const toml::node *baseline = section.sound("baseline");
      baseline != nullptr && section.known("quantity") && earthquake.baseline != Baseline::none &&
      earthquake.quantity != RecordQuantity::acceleration) {
    source.faults.add(baseline->source(), section.subject("baseline") + " has no meaning",
                      "it is taken from accelerations, and the record is one of velocities",
                      "leave it out, or write quantity = \"acceleration\"");
  }
  section.read("p_wave_speed", earthquake.p_wave_speed);
  section.read("s_wave_speed", earthquake.s_wave_speed);
  expect_motion(source, section);
  read_begin(source, section, scene, earthquake);
  return earthquake;
}

} // namespace gcpdda::scene_text
