// summary.json.

#include "io/results/summary.hpp"

#include "io/hdf5/durable_file.hpp"
#include "io/results/json.hpp"

#include <fmt/format.h>

#include <numbers>

namespace gcpdda {

namespace {

JsonObject energy_object(const EnergyRow &row) {
  return JsonObject()
      .add("kinetic", row.kinetic)
      .add("strain", row.strain)
      .add("contact_normal", row.contact_normal)
      .add("contact_stick", row.contact_stick)
      .add("gravity", row.gravity)
      .add("friction_loss", row.friction_loss)
      .add("damping_loss", row.damping_loss)
      .add("boundary_work", row.boundary_work)
      .add("residual", row.residual)
      .add("unbalanced_ratio", row.unbalanced_ratio)
      .add("max_speed", row.max_speed);
}

std::vector<JsonObject> stage_objects(const RunSummary &summary) {
  std::vector<JsonObject> objects;
  for (const auto &[name, verdict, result, slid_block] : summary.stages) {
    objects.push_back(JsonObject()
                          .add("name", name)
                          .add("verdict", verdict)
                          .add("time", result.time)
                          .add("steps", result.steps)
                          .add("contact_steps", result.contact_steps)
                          .add("unbalanced_ratio", result.unbalanced_ratio)
                          .add("kinetic", result.kinetic)
                          .add("moved", result.moved)
                          .add("removed", result.removed)
                          .add("loose", result.loose)
                          .add("slide", result.slide)
                          .add("slid_block", slid_block)
                          .add("slid_blocks", result.slid_blocks));
  }
  return objects;
}

std::vector<JsonObject> bolt_objects(const std::vector<BoltLoad> &loads) {
  std::vector<JsonObject> objects;
  for (const BoltLoad &load : loads) {
    objects.push_back(JsonObject()
                          .add("name", load.last.name)
                          .add("support", load.support)
                          .add("installed", load.installed)
                          .add("in_place", load.in_place)
                          .add("axial", load.last.axial)
                          .add("shear", load.last.shear)
                          .add("largest_axial", load.axial)
                          .add("largest_shear", load.shear)
                          .add("extension", load.last.extension)
                          .add("slide", load.last.slide)
                          .add("joints", load.last.links)
                          .add("yielded", load.last.yielded)
                          .add("broken", load.last.broken));
  }
  return objects;
}

std::vector<JsonObject> liner_objects(const std::vector<LinerLoad> &loads) {
  std::vector<JsonObject> objects;
  for (const LinerLoad &load : loads) {
    objects.push_back(JsonObject()
                          .add("name", load.last.name)
                          .add("support", load.support)
                          .add("installed", load.installed)
                          .add("in_place", load.in_place)
                          .add("elements", load.last.elements)
                          .add("compression", load.last.compression.value)
                          .add("tension", load.last.tension.value)
                          .add("moment", load.last.moment.value)
                          .add("shear", load.last.shear.value)
                          .add("strength_used", load.last.strength_used)
                          .add("largest_compression", load.compression)
                          .add("largest_tension", load.tension)
                          .add("largest_moment", load.moment)
                          .add("largest_shear", load.shear)
                          .add("largest_strength_used", load.strength_used)
                          .add("cracked", load.last.cracked)
                          .add("yielded", load.last.yielded)
                          .add("broken", load.last.broken));
  }
  return objects;
}

JsonObject measures_object(const JointSetMeasures &measures) {
  constexpr double degrees = 180.0 / std::numbers::pi;
  return JsonObject()
      .add("spacing", measures.spacing)
      .add("p21", measures.intensity)
      .add("trace_length", measures.trace_length)
      .add("trace_angle_deg", measures.angle * degrees)
      .add("scatter_deg", measures.scatter * degrees);
}

std::vector<JsonObject> joint_set_objects(const std::vector<JointSetSummary> &sets) {
  std::vector<JsonObject> objects;
  for (const JointSetSummary &set : sets) {
    JsonObject &object = objects.emplace_back();
    object.add("name", set.name).add("asked", measures_object(set.asked));
    if (set.drawn) {
      object.add("drawn", measures_object(*set.drawn)).add("joints", set.joints).add("lines", set.lines);
    }
  }
  return objects;
}

} // namespace

void write_summary(const std::filesystem::path &directory, const RunSummary &summary) {
  JsonObject phases;
  for (const auto &[name, seconds] : summary.phases) {
    phases.add(name, JsonObject().add("min", seconds[0]).add("mean", seconds[1]).add("max", seconds[2]));
  }
  JsonObject counters;
  for (const auto &[name, count] : summary.counters) {
    counters.add(name, count);
  }
  JsonObject object(",\n ");
  object.add("version", summary.version).add("command", summary.command);
  if (summary.restarted_at >= 0.0) {
    object.add("restarted_at", summary.restarted_at);
  }
  object.add("ranks", summary.ranks)
      .add("blocks", summary.blocks)
      .add("fixed_blocks", summary.fixed_blocks)
      .add("steps", summary.steps)
      .add("time", summary.time)
      .add("time_step", summary.time_step)
      .add("time_step_min", summary.time_step_min)
      .add("contacts", summary.contacts)
      .add("contact_steps", summary.contact_steps)
      .add("evaluations_per_rank", summary.evaluations_per_rank)
      .add("work_per_rank", summary.work_per_rank)
      .add("ghosts_per_rank", summary.ghosts_per_rank)
      .add("wall_s", summary.wall_s)
      .add("cpu_s", summary.cpu_s)
      .add("setup_wall_s", summary.setup_wall_s)
      .add("output_wall_s", summary.output_wall_s)
      .add("total_wall_s", summary.total_wall_s)
      .add("max_overlap", summary.max_overlap);
  if (summary.permanent_displacement >= 0.0) {
    object.add("permanent_displacement", summary.permanent_displacement)
        .add("permanent_block", summary.permanent_block);
  }
  object.add("energy", energy_object(summary.energy))
      .add("imbalance", summary.imbalance)
      .add("bytes_sent_per_step", summary.bytes_sent_per_step)
      .add("messages_per_step", summary.messages_per_step)
      .add("phases", phases)
      .add("counters", counters)
      .add("verdict", summary.verdict)
      .add("message", summary.message);
  if (!summary.joint_sets.empty()) {
    object.add("joint_sets", joint_set_objects(summary.joint_sets));
  }
  if (!summary.bolts.empty()) {
    object.add("bolts", bolt_objects(summary.bolts));
  }
  if (!summary.liners.empty()) {
    object.add("liners", liner_objects(summary.liners));
  }
  if (!summary.stages.empty()) {
    object.add("stages", stage_objects(summary));
  }
  write_file(directory / "summary.json", object.text() + "\n");
}

} // namespace gcpdda
