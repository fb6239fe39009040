#include "simulation/shaking_doubts.hpp"

#include "simulation/ground.hpp"
#include "simulation/plausible_ranges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

namespace gcpdda {

namespace {

constexpr double time_rounding = 1.0 + 1e-9;

/// Where the scene gives a key; else the place of the record.
SourcePosition place_of_key(const Scene &scene, const std::string &key) {
  const auto found = scene.places.find(key);
  return found == scene.places.end() ? scene.earthquake.where : found->second;
}

bool has_normalised_units(const Scene &scene) {
  const bool has_unit_density = !scene.materials.empty() &&
                                std::all_of(scene.materials.begin(), scene.materials.end(),
                                            [](const Material &material) { return material.density == 1.0; });
  return norm(scene.run.gravity) == 1.0 || has_unit_density;
}

double peak_of(const Earthquake &earthquake) {
  double peak = 0.0;
  for (const RecordRow &row : earthquake.record) {
    peak = std::max(peak, std::abs(earthquake.scale) * norm(row.value));
  }
  return peak;
}

/// Largest acceleration between two rows of a record of velocities, m/s2.
double steepest_of(const Earthquake &earthquake) {
  double steepest = 0.0;
  for (std::size_t k = 1; k < earthquake.record.size(); ++k) {
    const RecordRow &before = earthquake.record[k - 1];
    const RecordRow &row = earthquake.record[k];
    steepest = std::max(steepest, std::abs(earthquake.scale) * norm(row.value - before.value) /
                                      (row.time - before.time));
  }
  return steepest;
}

// A small record of accelerations is one in g where the scene does not say by `scale` that it is not.
void doubt_strength(const Scene &scene, Diagnostics &doubts) {
  const Earthquake &earthquake = scene.earthquake;
  const PlausibleRange &acceleration = plausible_range("earthquake.record.acceleration");
  const PlausibleRange &velocity = plausible_range("earthquake.record.velocity");
  const bool holds_accelerations = earthquake.quantity == RecordQuantity::acceleration;
  const PlausibleRange &range = holds_accelerations ? acceleration : velocity;
  const bool is_scaled = scene.places.contains("earthquake.scale") || earthquake.scale != 1.0;
  const double peak = peak_of(earthquake);
  const auto warn = [&](const std::string &what, const PlausibleRange &row, const std::string &hint) {
    doubts.push_back({Severity::warning, earthquake.where, what,
                      fmt::format("{} {:g} to {:g} {}", row.what, row.low, row.high, row.unit), hint});
  };
  const std::string measured = fmt::format("the peak of the record is {:.3g} {}", peak, range.unit);
  const bool could_be_acceleration = peak >= acceleration.low && peak <= acceleration.high;
  const char *other_quantity = "if the record holds accelerations, write earthquake.quantity = "
                               "\"acceleration\"";
  if (holds_accelerations && !is_scaled && peak > 0.0 && peak < range.low) {
    warn(measured, range,
         "if the record is in g, set earthquake.scale = 9.81; if it is in m/s2, write scale = 1.0");
  } else if (peak > range.high) {
    const std::string units = fmt::format("if the record is in cm, set earthquake.scale = {:g}; in mm, {:g}",
                                          1e-2 * earthquake.scale, 1e-3 * earthquake.scale);
    warn(measured, range,
         holds_accelerations || !could_be_acceleration ? units
                                                       : fmt::format("{}; {}", other_quantity, units));
  } else if (!holds_accelerations && could_be_acceleration && !scene.places.contains("earthquake.quantity")) {
    if (const double steepest = steepest_of(earthquake); steepest > acceleration.high) {
      warn(fmt::format("the record, read as velocities, has a peak acceleration of {:.3g} m/s2", steepest),
           acceleration, fmt::format("{}; if it holds velocities, write \"velocity\"", other_quantity));
    }
  }
}

/// How to give the record a stage of kind run from `first` on, or before where none follows.
std::string hint_at_run_stage(const Scene &scene, std::int64_t first) {
  const auto shakes = [](const Stage &stage) { return stage.kind == StageKind::run; };
  auto found = std::find_if(scene.stages.begin() + first, scene.stages.end(), shakes);
  if (found == scene.stages.end()) {
    found = std::find_if(scene.stages.begin(), scene.stages.end(), shakes);
  }
  return found == scene.stages.end()
             ? "add a [[stage]] of kind \"run\" with the duration of the record, and name it in "
               "earthquake.stage"
             : fmt::format("write earthquake.stage = \"{}\"", found->name);
}

/// Stages from the beginning of the record to its end. Where stages that may end early come before the
/// record, the time at which a stage begins is known to lie between two bounds alone.
class ShakenStages {
public:
  explicit ShakenStages(const Scene &scene)
      : scene_(&scene), begin_(scene.earthquake.stage < 0 ? scene.earthquake.start : 0.0),
        length_(end_of_shaking(scene.earthquake)) {}

  void doubt(Diagnostics &doubts) const {
    const auto first = std::max<std::int64_t>(scene_->earthquake.stage, 0);
    double earliest = 0.0;
    double latest = 0.0;
    const Stage *last_run = nullptr;
    for (std::int64_t number = first; number < std::ssize(scene_->stages); ++number) {
      const Stage &stage = scene_->stages[static_cast<std::size_t>(number)];
      if (!stage.takes_steps()) {
        continue;
      }
      latest += stage.duration;
      const bool overlaps = ends_after(earliest) && begin_ * time_rounding < latest;
      if (stage.kind == StageKind::settle && overlaps) {
        const bool was_cut = last_run != nullptr && begin_ * time_rounding < earliest;
        doubts.push_back(was_cut ? cut_by(*last_run, earliest,
                                          fmt::format("settle stage '{}' follows, whose damping takes the "
                                                      "motion that the record causes",
                                                      stage.name))
                                 : damped_in(stage, number, latest));
        return;
      }
      if (stage.kind == StageKind::run) {
        earliest += stage.duration;
        last_run = &stage;
      }
    }
    if (last_run != nullptr && begin_ < latest && ends_after(latest)) {
      doubts.push_back(cut_by(*last_run, latest, "the run ends before the ground has ceased to move"));
    }
  }

private:
  [[nodiscard]] bool ends_after(double time) const { return begin_ + length_ > time * time_rounding; }

  [[nodiscard]] Diagnostic damped_in(const Stage &stage, std::int64_t number, double latest) const {
    const bool is_named = scene_->earthquake.stage >= 0;
    const bool is_certain = is_named || begin_ == 0.0;
    return {
        Severity::warning, place_of_key(*scene_, is_named ? "earthquake.stage" : "earthquake.start"),
        is_certain
            ? fmt::format("the record plays in stage '{}', which is a settle stage", stage.name)
            : fmt::format("the record begins at t = {:g} s and may play in settle stage '{}', which may last "
                          "until t = {:g} s",
                          begin_, stage.name, latest),
        "a settle stage looks for equilibrium, and its damping takes the motion that the record causes",
        hint_at_run_stage(*scene_, number)};
  }

  [[nodiscard]] Diagnostic cut_by(const Stage &stage, double end, const std::string &why) const {
    return {Severity::warning, scene_->earthquake.where,
            fmt::format("stage '{}' ends after {:g} s of the record, which moves the ground for {:g} s",
                        stage.name, end - begin_, length_),
            why,
            fmt::format("use stage.{}.{} = {:g} or more", stage.name,
                        stage.until_verdict ? "limit" : "duration", stage.duration + begin_ + length_ - end)};
  }

  const Scene *scene_;
  double begin_;  ///< of the record, from the beginning of the first stage looked at, s
  double length_; ///< s
};

void doubt_duration_of_run(const Scene &scene, Diagnostics &doubts) {
  const double begin = scene.earthquake.start;
  const double length = end_of_shaking(scene.earthquake);
  const double duration = scene.run.duration;
  if (begin < duration && begin + length > duration * time_rounding) {
    doubts.push_back(
        {Severity::warning, scene.earthquake.where,
         fmt::format("the run ends after {:g} s of the record, which moves the ground for {:g} s",
                     duration - begin, length),
         "what comes after the end of the run moves nothing",
         fmt::format("use run.duration = {:g} or more", begin + length)});
  }
}

// A block that slides and is so high that friction takes the pressure off a part of its base bounces and
// rocks by itself, because friction does work on both. Dashpots of a ratio of 0.05 take less than that.
void doubt_damping(const Scene &scene, Diagnostics &doubts) {
  const auto chooses = [&](const RunSettings &run) {
    return run.rayleigh.present() || run.contact_damping != RunSettings{}.contact_damping;
  };
  const bool is_chosen = scene.places.contains("run.contact_damping") || chooses(scene.run) ||
                         std::any_of(scene.stages.begin(), scene.stages.end(), [&](const Stage &stage) {
                           return stage.after && chooses(stage.after->run);
                         });
  const bool has_friction = std::any_of(scene.joints.laws.begin(), scene.joints.laws.end(),
                                        [](const JointLaw &law) { return law.has_friction(); });
  if (!is_chosen && has_friction) {
    doubts.push_back(
        {Severity::warning, scene.earthquake.where,
         fmt::format("the ground shakes with the default contact_damping of {:g}", scene.run.contact_damping),
         "blocks that slide may bounce and rock by themselves, and go too far",
         "use run.contact_damping = 0.3, or set = { \"run.contact_damping\" = 0.3 } in the stage "
         "that shakes; run.contact_damping = 0.05 keeps it"});
  }
}

// That of the run is told when it begins.
void doubt_drag(const Scene &scene, Diagnostics &doubts) {
  for (std::int64_t number = std::max<std::int64_t>(scene.earthquake.stage, 0);
       number < std::ssize(scene.stages); ++number) {
    const Stage &stage = scene.stages[static_cast<std::size_t>(number)];
    if (stage.kind == StageKind::run && stage.local_damping > 0.0) {
      doubts.push_back({Severity::warning, stage.where,
                        fmt::format("stage '{}', in which the ground may shake, has a local damping of {:g}",
                                    stage.name, stage.local_damping),
                        "it holds back whatever moves: blocks slide less far, and waves fade",
                        fmt::format("leave stage.{}.local_damping out; run.contact_damping and run.rayleigh "
                                    "damp as joints and rock do",
                                    stage.name)});
      return;
    }
  }
}

} // namespace

Diagnostics doubts_of_shaking(const Scene &scene) {
  Diagnostics doubts;
  if (!scene.earthquake.shakes() || scene.earthquake.record.empty()) {
    return doubts;
  }
  if (!has_normalised_units(scene)) {
    doubt_strength(scene, doubts);
  }
  doubt_damping(scene, doubts);
  doubt_drag(scene, doubts);
  if (scene.stages.empty()) {
    doubt_duration_of_run(scene, doubts);
  } else {
    ShakenStages(scene).doubt(doubts);
  }
  return doubts;
}

} // namespace gcpdda
