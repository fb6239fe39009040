#include "io/scene/scene_settings.hpp"

#include "io/scene/scene_joints.hpp"
#include "io/scene/scene_outline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace gcpdda::scene_text {

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

void check_duration(const SceneSource &source, const Section &run) {
  const toml::node *duration = run.given("duration");
  const bool staged = has_stages(source.root);
  if (duration == nullptr && !staged && run.is_table() && source.root.contains("run")) {
    source.faults.add(run.source(), run.subject("duration") + " is missing", "it is required",
                      "for example duration = 2.0");
  } else if (duration != nullptr && staged) {
    fault(source, *duration, run.subject("duration") + " has no meaning beside [[stage]]",
          "the stages say how long they last", "leave it out");
  }
}

} // namespace

namespace {

void read_rayleigh(const SceneSource &source, const Section &run, RunSettings &settings) {
  const auto rayleigh = run.table("rayleigh");
  if (!rayleigh) {
    return;
  }
  double ratio = 0.0;
  double frequency = 0.0;
  rayleigh->read("ratio", ratio);
  rayleigh->read("frequency", frequency);
  const double omega = 2.0 * std::numbers::pi * frequency;
  settings.rayleigh = omega > 0.0 ? Rayleigh{omega * ratio, ratio / omega} : Rayleigh{};
  if (const toml::node *contact = run.given("contact_damping")) {
    fault(source, *contact, run.subject("contact_damping") + " has no meaning beside rayleigh",
          "the dashpots of joints follow from it", "leave one of them out");
  }
  settings.contact_damping = 0.0;
}

} // namespace

RunSettings read_run(const SceneSource &source) {
  const Section run = section(source.root, "run", source.faulty);
  RunSettings settings;
  run.read("duration", settings.duration);
  check_duration(source, run);
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
  read_rayleigh(source, run, settings);
  run.read("local_damping", settings.local_damping);
  run.read_choice("run", "elasticity", settings.elasticity);
  settings.plane_strain = run.text("plane").value_or("strain") == "strain";
  check_scheme_keys(source, run, settings.scheme);
  return settings;
}

OutputSettings read_output(const SceneSource &source, double duration) {
  const Section output = section(source.root, "output", source.faulty);
  OutputSettings settings;
  settings.interval = duration / 100.0;
  output.read("interval", settings.interval);
  settings.history_interval = settings.interval;
  output.read("history_interval", settings.history_interval);
  output.read("contacts", settings.contacts);
  output.read("checkpoint_interval", settings.checkpoint_interval);

  if (duration > 0.0 && settings.interval == 0.0) { // the smallest numbers have no hundredth
    const Section run = section(source.root, "run", source.faulty);
    fault(source, *run.given("duration"), fmt::format("{} is {}", run.subject("duration"), duration),
          "a hundredth of it, which interval is by default, is 0", "use a longer one");
    return settings;
  }
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
    if (!(std::abs(ratio - std::round(ratio)) <= 1e-9 * ratio)) { // so that an infinite one is at fault
      fault(source, *node,
            fmt::format("{} is {}", output.subject("history_interval"), settings.history_interval),
            fmt::format("it must divide interval ({}) or be a multiple of it", settings.interval),
            fmt::format("for example history_interval = {}", settings.interval));
    }
  }
  return settings;
}

StrengthReduction read_reduction(const SceneSource &source, const JointLaws &joints) {
  const Section fos = section(source.root, "fos", source.faulty);
  StrengthReduction reduction;
  fos.read("from", reduction.from);
  fos.read("to", reduction.to);
  fos.read("tolerance", reduction.tolerance);
  fos.read("limit", reduction.limit);
  fos.read("patience", reduction.patience);
  fos.read("failure_motion", reduction.failure_motion);
  fos.read("largest_motion", reduction.largest_motion);
  fos.read("local_damping", reduction.local_damping);
  fos.read("ignore_area", reduction.ignored_area);
  fos.read("region", reduction.region);
  if (const toml::node *region = fos.sound("region")) {
    for (const OutlineFault &found : check_outline(reduction.region, fos.subject("region"))) {
      fault(source, *region, found.what, found.why, found.hint);
    }
  }
  if (reduction.to <= reduction.from && fos.known("from") && fos.known("to")) {
    const toml::node *to = fos.given("to");
    fault(source, to != nullptr ? *to : *fos.given("from"),
          fmt::format("{} is {} and from is {}", fos.subject("to"), reduction.to, reduction.from),
          "the factor is searched from the one to the other", "exchange them");
  }
  reduction.families = find_joints(source, fos, "families", joints);
  return reduction;
}

} // namespace gcpdda::scene_text
