#include "simulation/plausibility.hpp"

#include "io/scene/joint_parameters.hpp"

#include "geometry/aabb.hpp"
#include "geometry/point_text.hpp"
#include "geometry/polygon.hpp"
#include "simulation/fault_doubts.hpp"
#include "simulation/plausible_ranges.hpp"
#include "simulation/shaking_doubts.hpp"
#include "simulation/short_traces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>

namespace gcpdda {

namespace {

double degrees_of(double tangent) {
  return std::atan(tangent) * 180.0 / std::numbers::pi;
}

/// The name in a label of messages such as "joint_set 'bedding'"; a label without one is the name.
std::string name_in(const std::string &label) {
  const std::size_t first = label.find('\'');
  const std::size_t last = label.rfind('\'');
  return first < last ? label.substr(first + 1, last - first - 1) : label;
}

bool is_normalised(const Scene &scene) {
  const bool unit_density = std::all_of(scene.materials.begin(), scene.materials.end(),
                                        [](const Material &material) { return material.density == 1.0; });
  return norm(scene.run.gravity) == 1.0 || unit_density;
}

/// The units that put a value into the range, the likeliest first.
std::vector<UnitSlip> slips_of(const PlausibleRange &row, double value) {
  std::vector<UnitSlip> fitting;
  for (const UnitSlip &slip : row.slips) {
    if (const double meant = slip.factor * value; meant >= row.low && meant <= row.high) {
      fitting.push_back(slip);
    }
  }
  std::stable_sort(fitting.begin(), fitting.end(), [&](const UnitSlip &a, const UnitSlip &b) {
    const auto distance = [&](const UnitSlip &slip) {
      return std::abs(std::log(slip.factor * value / row.typical));
    };
    return distance(a) < distance(b);
  });
  fitting.resize(std::min<std::size_t>(fitting.size(), 2));
  return fitting;
}

std::string hint_for(const PlausibleRange &row, double value, const std::vector<UnitSlip> &slips) {
  std::string hint;
  for (const UnitSlip &slip : slips) {
    hint += fmt::format("{}if it is in {}, write {:.4g}", hint.empty() ? "" : "; ", slip.unit,
                        slip.factor * value);
  }
  if (!slips.empty() && row.key.find("friction") != std::string_view::npos) {
    hint += fmt::format("; if it is the coefficient, write {:.3g}", degrees_of(value));
  }
  return hint.empty() ? "check its unit; gcpdda reference --values has the range and its source" : hint;
}

/// Warnings of one scene, each kind once.
class Doubts {
public:
  explicit Doubts(const Scene &scene) : scene_(&scene), only_ratios_(is_normalised(scene)) {}

  /// A value that the scene gives at `path`, or that stands in a table which knows its place.
  void judge(std::string_view key, const std::string &path, double value,
             const SourcePosition &fallback = {}) {
    const PlausibleRange &row = plausible_range(key);
    const auto place = place_of(path, fallback);
    const double size = std::abs(value);
    const bool judged = !only_ratios_ || row.unit.empty() || row.unit == "degrees";
    if (!place || !judged || size == 0.0 || !std::isfinite(size) || (size >= row.low && size <= row.high)) {
      return;
    }
    const std::vector<UnitSlip> slips = slips_of(row, size);
    const std::string_view slip =
        slips.empty() ? std::string_view(size < row.low ? "low" : "high") : slips[0].unit;
    auto [kind, is_new] = kinds_.try_emplace({std::string(key), std::string(slip)});
    if (is_new) {
      kind->second.warning = {
          Severity::warning, *place,
          fmt::format("{} is {:g}{}{}", path, value, row.unit.empty() ? "" : " ", row.unit),
          fmt::format("{} {:g} to {:g}{}{}", row.what, row.low, row.high, row.unit.empty() ? "" : " ",
                      row.unit),
          hint_for(row, size, slips)};
    }
    ++kind->second.count;
  }

  void add(const Diagnostics &found) { others_.insert(others_.end(), found.begin(), found.end()); }

  void warn(const SourcePosition &where, std::string what, std::string why, std::string hint) {
    others_.push_back({Severity::warning, where, std::move(what), std::move(why), std::move(hint)});
  }

  /// Where it was written; nothing where the scene leaves it to its default.
  [[nodiscard]] std::optional<SourcePosition> place_of(const std::string &path,
                                                       const SourcePosition &fallback = {}) const {
    const auto found = scene_->places.find(path);
    if (found != scene_->places.end()) {
      return found->second;
    }
    const bool is_made_in_code = scene_->places.empty();
    return is_made_in_code || fallback.line > 0 || !fallback.file.empty() ? std::optional(fallback)
                                                                          : std::nullopt;
  }

  [[nodiscard]] Diagnostics take() {
    Diagnostics all;
    for (auto &[key, kind] : kinds_) {
      if (kind.count > 1) {
        kind.warning.what += fmt::format(" (and {} more like it)", kind.count - 1);
      }
      all.push_back(std::move(kind.warning));
    }
    all.insert(all.end(), others_.begin(), others_.end());
    std::stable_sort(all.begin(), all.end(), [](const Diagnostic &a, const Diagnostic &b) {
      return std::tie(a.where.line, a.where.column) < std::tie(b.where.line, b.where.column);
    });
    return all;
  }

  [[nodiscard]] const Scene &scene() const { return *scene_; }

private:
  struct Kind {
    Diagnostic warning;
    std::int64_t count = 0;
  };
  const Scene *scene_;
  bool only_ratios_;
  std::map<std::pair<std::string, std::string>, Kind> kinds_; ///< by key and slip
  Diagnostics others_;
};

void judge_run(Doubts &doubts) {
  const RunSettings &run = doubts.scene().run;
  doubts.judge("run.gravity", "run.gravity", norm(run.gravity));
  doubts.judge("run.contact_damping", "run.contact_damping", run.contact_damping);
  doubts.judge("run.rayleigh.ratio", "run.rayleigh.ratio",
               std::sqrt(run.rayleigh.mass_damping * run.rayleigh.stiffness_damping));
  if (const auto place = doubts.place_of("run.gravity"); place && run.gravity.y > std::abs(run.gravity.x)) {
    doubts.warn(
        *place, fmt::format("run.gravity is [{:g}, {:g}]: it points upwards", run.gravity.x, run.gravity.y),
        "y is up", fmt::format("if the rock is to fall, write [{:g}, {:g}]", run.gravity.x, -run.gravity.y));
  }
}

void judge_materials(Doubts &doubts) {
  for (const Material &material : doubts.scene().materials) {
    const std::string path = "material." + material.name;
    doubts.judge("material.*.density", path + ".density", material.density);
    doubts.judge("material.*.youngs_modulus", path + ".youngs_modulus", material.youngs_modulus);
  }
}

void judge_joints(Doubts &doubts) {
  for (const JointLaw &law : doubts.scene().joints.laws) {
    for (const scene_text::JointParameter &parameter : scene_text::joint_parameters()) {
      if (parameter.value != nullptr) {
        doubts.judge(parameter.key.path,
                     fmt::format("joint.{}.{}", law.name, scene_text::name_of(parameter.key)),
                     parameter.value(law));
      }
    }
  }
}

void judge_blocks(Doubts &doubts) {
  for (std::size_t i = 0; i < doubts.scene().blocks.size(); ++i) {
    const SceneBlock &block = doubts.scene().blocks[i];
    const std::string path = "block." + (block.name.empty() ? fmt::format("b{}", i) : block.name);
    const auto judge = [&](const std::array<double, 3> &velocity) {
      doubts.judge("block.*.velocity", path + ": velocity", std::hypot(velocity[0], velocity[1]),
                   block.where);
      doubts.judge("block.*.spin", path + ": spin", velocity[2], block.where);
    };
    judge(block.velocity);
    for (const VelocityRow &row : block.velocity_table) {
      judge(row.velocity);
    }
  }
  for (const BrickGenerator &generator : doubts.scene().generators) {
    const std::string list = generator.kind == BrickGenerator::Kind::wall ? "wall" : "pyramid";
    for (const double size : {generator.block_size.x, generator.block_size.y}) {
      doubts.judge(list + ".*.block_size", fmt::format("{}.{}.block_size", list, generator.name), size,
                   generator.where);
    }
  }
}

/// What lies outside of the region cuts nothing.
void expect_inside(Doubts &doubts, const std::string &path, std::span<const Vec2> points,
                   const SourcePosition &where) {
  const Aabb region = bounding_box(doubts.scene().region.outline);
  const Aabb box = bounding_box(points);
  if (points.empty() || box.meets(region)) {
    return;
  }
  doubts.warn(
      where,
      fmt::format("{} lies from {} to {}, outside of the region", path, point_text(box.low),
                  point_text(box.high)),
      fmt::format("the region reaches from {} to {}", point_text(region.low), point_text(region.high)),
      "check its coordinates and their unit, m");
}

void judge_cutters(Doubts &doubts) {
  const RockRegion &region = doubts.scene().region;
  for (const JointSet &set : region.joint_sets) {
    const std::string path = "joint_set." + name_in(set.name);
    if (set.intensity > 0.0) {
      doubts.judge("joint_set.*.p21", path + ".p21", set.intensity, set.where);
    } else {
      doubts.judge("joint_set.*.spacing", path + ".spacing",
                   set.plane ? set.plane->spacing : set.spacing.mean, set.where);
    }
    if (!set.through_going) {
      doubts.judge("joint_set.*.trace_length", path + ".trace_length", set.trace.mean, set.where);
      doubts.judge("joint_set.*.gap", path + ".gap", set.gap.mean, set.where);
    }
    expect_inside(doubts, path + ".within", set.within,
                  doubts.place_of(path + ".within", set.where).value_or(set.where));
    const Vec2 extent = bounding_box(region.outline).extent();
    if (set.spacing.mean > norm(extent)) {
      doubts.warn(doubts.place_of(path + ".spacing", set.where).value_or(set.where),
                  fmt::format("{}.spacing is {:g} m, and the region is {:g} m across", path, set.spacing.mean,
                              norm(extent)),
                  "hardly any of its joints meets the region",
                  fmt::format("if it is in mm, write {:.4g}", 1e-3 * set.spacing.mean));
    }
  }
  for (const VoronoiCells &cells : region.voronoi) {
    doubts.judge("voronoi.*.size", "voronoi.size", cells.size, cells.where);
  }
  for (const BrickPattern &bricks : region.bricks) {
    for (const double size : {bricks.size.x, bricks.size.y}) {
      doubts.judge("bricks.*.block_size", "bricks.block_size", size, bricks.where);
    }
  }
}

/// What ends in the rock cuts nothing there.
void warn_of_short_traces(Doubts &doubts) {
  const std::vector<ShortTrace> found = short_traces(doubts.scene().region);
  if (found.empty()) {
    return;
  }
  const auto widest = std::max_element(
      found.begin(), found.end(), [](const ShortTrace &a, const ShortTrace &b) { return a.gap < b.gap; });
  doubts.warn(widest->where,
              fmt::format("{} ends at {}, {:.2g} m short of another line{}", widest->path,
                          point_text(widest->end), widest->gap,
                          found.size() == 1
                              ? ""
                              : fmt::format(" ({} more {} by less)", found.size() - 1,
                                            found.size() == 2 ? "end is short" : "ends are short")),
              "a trace that ends in rock cuts nothing there",
              "where it is to end at the line, let it end a little beyond");
}

/// A roller's law takes what it does not give from [joint.default], as every law does.
void warn_of_rough_rollers(Doubts &doubts) {
  const Scene &scene = doubts.scene();
  const auto law = std::find_if(scene.joints.laws.begin(), scene.joints.laws.end(),
                                [](const JointLaw &l) { return l.name == "roller"; });
  const auto is_given = [&](const char *key) { return scene.places.contains(key); };
  if (!is_given("region.roller") || law == scene.joints.laws.end() || !law->has_friction() ||
      is_given("joint.roller.friction_angle_deg") || is_given("joint.roller.cohesion") ||
      is_given("joint.roller.law")) {
    return;
  }
  const auto place = scene.places.find("region.roller");
  doubts.warn(
      place->second,
      fmt::format("[joint.roller] takes a friction angle of {:.3g} degrees and a cohesion of {:.3g} Pa "
                  "from [joint.default]",
                  degrees_of(law->tan_friction), law->cohesion),
      "a roller is to hold the normal direction only",
      "give joint.roller.friction_angle_deg = 0 and joint.roller.cohesion = 0, or leave [joint.roller] out");
}

void judge_region(Doubts &doubts) {
  const RockRegion &region = doubts.scene().region;
  if (!region.present()) {
    return;
  }
  doubts.judge("region.size", "region: the root of its area", std::sqrt(signed_area(region.outline)),
               region.where);
  judge_cutters(doubts);
  for (const FaultLine &fault : region.faults) {
    expect_inside(doubts, "fault." + name_in(fault.name), fault.points, fault.where);
  }
  for (const JointMap &map : region.maps) {
    std::vector<Vec2> points;
    for (const std::vector<Vec2> &line : map.lines) {
      points.insert(points.end(), line.begin(), line.end());
    }
    expect_inside(doubts, fmt::format("the joint map '{}'", map.path), points, map.where);
  }
  for (const Opening &opening : region.openings) {
    const std::string path = "opening." + opening.name;
    doubts.judge("opening.*.size", path + ": width", bounding_box(opening.outline).extent().x, opening.where);
    expect_inside(doubts, path, opening.outline, opening.where);
  }
  for (const Layer &layer : region.layers) {
    expect_inside(doubts, "a layer", layer.outline, layer.where);
  }
  warn_of_short_traces(doubts);
  warn_of_rough_rollers(doubts);
  if (const auto held = doubt_faults_at_corners(region, doubts.scene().run.gravity)) {
    doubts.warn(held->where, held->what, held->why, held->hint);
  }
}

void judge_stress(Doubts &doubts) {
  const Scene &scene = doubts.scene();
  for (const Water &water : scene.water) {
    doubts.judge("water.*.density", "water." + water.name + ".density", water.density);
  }
  const InSituStress &stress = scene.in_situ;
  if (!stress.present) {
    return;
  }
  const bool by_principals = scene.places.contains("in_situ.principal_stresses");
  const std::string key = by_principals ? "principal_stresses" : "vertical_stress";
  doubts.judge("in_situ.stress", "in_situ." + key, principal_values(stress.at_level).largest);
  const auto along = [](const Mat2 &m, Vec2 d) {
    return dot(d, Vec2{m.xx * d.x + m.xy * d.y, m.xy * d.x + m.yy * d.y});
  };
  const double gravity = norm(scene.run.gravity);
  const bool grows = norm(stress.down) > 0.0 && gravity > 0.0;
  const Mat2 &matrix = grows ? stress.growth : stress.at_level;
  const Vec2 down = grows           ? stress.down
                    : gravity > 0.0 ? (1.0 / gravity) * scene.run.gravity
                                    : Vec2{0.0, -1.0};
  const double vertical = along(matrix, down);
  if (vertical > 0.0 && !by_principals) {
    doubts.judge("in_situ.k0", "in_situ.k0", (matrix.xx + matrix.yy - vertical) / vertical);
  }
  if (grows) {
    doubts.judge("in_situ.density", "in_situ.density", vertical / gravity);
  }
}

void judge_supports(Doubts &doubts) {
  for (const SupportType &support : doubts.scene().supports) {
    const auto judge = [&](const std::string &key, double value) {
      doubts.judge("support.*." + key, "support." + support.name + "." + key, value);
    };
    judge("axial_stiffness", support.axial_stiffness);
    judge("axial_rigidity", support.axial_rigidity);
    judge("axial_yield", support.axial_yield);
    judge("shear_stiffness", support.shear_stiffness);
    judge("shear_yield", support.shear_yield);
    judge("rupture_strain", support.rupture_strain);
    judge("pretension", support.pretension);
    judge("active_length", support.active_length);
    judge("bond_strength", support.bond_strength);
    judge("spacing", support.spacing);
    judge("thickness", support.thickness);
    judge("youngs_modulus", support.youngs_modulus);
    judge("compressive_strength", support.compressive_strength);
    judge("tensile_strength", support.tensile_strength);
    judge("residual_tensile_strength", support.residual_tensile_strength);
    judge("shear_strength", support.shear_strength);
    judge("adhesion", support.adhesion);
    judge("bond_width", support.bond_width);
  }
  for (const Bolt &bolt : doubts.scene().bolts) {
    doubts.judge("bolt.*.length", "bolt." + bolt.name + ": length", norm(bolt.to - bolt.from), bolt.where);
  }
}

void judge_earthquake(Doubts &doubts) {
  const Earthquake &earthquake = doubts.scene().earthquake;
  doubts.judge("earthquake.p_wave_speed", "earthquake.p_wave_speed", earthquake.p_wave_speed);
  doubts.judge("earthquake.s_wave_speed", "earthquake.s_wave_speed", earthquake.s_wave_speed);
  doubts.add(doubts_of_shaking(doubts.scene()));
}

/// Until when the factor of a table is zero from its beginning on, s; 0 where it is at no time another one.
double end_of_zeros(const std::vector<LoadRow> &table) {
  const auto first =
      std::find_if(table.begin(), table.end(), [](const LoadRow &row) { return row.factor != 0.0; });
  return first == table.begin() || first == table.end() ? 0.0 : std::prev(first)->time;
}

/// What begins or comes round after the end of the run never does.
void judge_times(Doubts &doubts) {
  const Scene &scene = doubts.scene();
  double duration = scene.run.duration;
  if (!scene.stages.empty()) {
    duration = 0.0;
    for (const Stage &stage : scene.stages) {
      duration += stage.takes_steps() ? stage.duration : 0.0;
    }
  }
  constexpr double rounding = 1e-9;
  const auto judge = [&](const std::string &path, double time, const char *why,
                         const SourcePosition &fallback = {}) {
    if (const auto place = doubts.place_of(path, fallback);
        place && duration > 0.0 && time > duration * (1.0 + rounding)) {
      doubts.warn(*place, fmt::format("{} is {:g} s, and the run takes {:g} s", path, time, duration), why,
                  fmt::format("use at most {:g}", duration));
    }
  };
  const char *nothing = "nothing is written in between";
  judge("output.interval", scene.output.interval, nothing);
  judge("output.history_interval", scene.output.history_interval, nothing);
  judge("output.checkpoint_interval", scene.output.checkpoint_interval, "no checkpoint is written by time");
  const bool completes_loads = // the time of such a stage begins when its loads are complete
      std::any_of(scene.stages.begin(), scene.stages.end(),
                  [](const Stage &stage) { return stage.solver == Solver::statics; });
  if (!completes_loads) {
    judge("run.gravity_ramp", scene.run.gravity_ramp, "gravity never acts in full");
  }
  if (scene.earthquake.stage < 0 && scene.earthquake.shakes()) {
    judge("earthquake.start", scene.earthquake.start, "the ground never moves");
  }
  for (const SceneBlock &block : scene.blocks) {
    for (const PointLoad &load : block.loads) {
      if (!completes_loads) {
        judge(fmt::format("block.{}: the ramp of a load", block.name), load.ramp,
              "the force never acts in full", block.where);
        judge(fmt::format("block.{}: the last time of a load's table at which its factor is still 0",
                          block.name),
              end_of_zeros(load.table), "the force never acts", block.where);
      }
    }
  }
}

Diagnostics doubts_of(const Scene &scene, bool is_whole) {
  Doubts doubts(scene);
  judge_run(doubts);
  judge_materials(doubts);
  judge_joints(doubts);
  judge_stress(doubts);
  judge_supports(doubts);
  judge_blocks(doubts);
  if (is_whole) {
    judge_region(doubts);
    judge_earthquake(doubts);
    judge_times(doubts);
  }
  return doubts.take();
}

} // namespace

Diagnostics implausible_size(const Scene &scene, double size) {
  Doubts doubts(scene);
  const SourcePosition where = !scene.blocks.empty()      ? scene.blocks.front().where
                               : scene.region.present()   ? scene.region.where
                               : scene.generators.empty() ? scene.block_file.where
                                                          : scene.generators.front().where;
  doubts.judge("block.*.size", "the root of the area of the median block", size, where);
  return doubts.take();
}

Diagnostics implausible_values(const Scene &scene) {
  Diagnostics all = doubts_of(scene, true);
  for (const Stage &stage : scene.stages) {
    for (Diagnostic &doubt : stage.after ? doubts_of(*stage.after, false) : Diagnostics()) {
      const auto is_same = [text = to_string(doubt)](const Diagnostic &told) {
        return to_string(told) == text;
      };
      if (std::none_of(all.begin(), all.end(), is_same)) {
        all.push_back(std::move(doubt));
      }
    }
  }
  return all;
}

} // namespace gcpdda
