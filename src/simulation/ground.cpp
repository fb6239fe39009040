#include "simulation/ground.hpp"

#include "contact/stiffness_bound.hpp"
#include "dynamics/deformable.hpp"
#include "dynamics/viscous_sides.hpp"
#include "io/scene/record_file.hpp"
#include "model/stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>

namespace gcpdda {

namespace {

// The time of the record's first row; never for a stage that has not begun.
double shaking_since(const RunState &run) {
  const std::int64_t stage = run.scene.earthquake.stage;
  if (stage < 0) {
    return run.scene.earthquake.start;
  }
  if (run.clock.state.index == stage) {
    return run.clock.state.start_time;
  }
  return run.clock.state.index < stage ? std::numeric_limits<double>::infinity()
         : stage == 0                  ? 0.0
                                       : run.clock.state.results[static_cast<std::size_t>(stage - 1)].time;
}

/// Whether the ground has begun to shake in a stage that is over or at hand, by its number.
bool has_shaken_in(const RunState &run, std::int64_t stage) {
  const StageState &state = run.clock.state;
  if (run.scene.earthquake.stage >= 0) {
    return stage == run.scene.earthquake.stage;
  }
  const auto end_of = [&](std::int64_t number) {
    return number < 0 ? 0.0 : state.results[static_cast<std::size_t>(number)].time;
  };
  const double start = run.scene.earthquake.start;
  return stage >= 0 && start >= end_of(stage - 1) && (stage == state.index || start < end_of(stage));
}

// They sleep until the shaking begins: no stage before it lets waves out.
void wake_dashpots(RunState &run) {
  for (Dashpot &dashpot : run.blocks.dashpot) {
    dashpot.is_awake = run.clock.state.index >= run.scene.earthquake.stage ? 1.0 : 0.0;
  }
}

/// Which baseline would bring the ground to rest, or to rest where it began; empty where it does so already.
std::string hint_at_baseline(const Earthquake &earthquake, const GroundMotion &ground) {
  constexpr double negligible = 1e-9;
  const double end = ground.duration();
  const double speed = ground.peak_acceleration() * end;
  const bool goes_on = norm(ground.velocity(end)) > negligible * speed;
  const bool is_displaced = norm(ground.displacement(end)) > negligible * speed * end;
  if (earthquake.quantity != RecordQuantity::acceleration || !(goes_on || is_displaced)) {
    return "";
  }
  return goes_on ? "earthquake.baseline = \"displacement\" brings both to zero"
                 : "earthquake.baseline = \"displacement\" brings the displacement to zero, too";
}

} // namespace

double end_of_shaking(const Earthquake &earthquake) {
  const std::vector<RecordRow> &rows = earthquake.record;
  const bool holds_accelerations = earthquake.quantity == RecordQuantity::acceleration;
  std::size_t last = rows.size() - 1;
  const auto is_even = [&](std::size_t k) { // from the row before to this one
    return holds_accelerations ? norm(rows[k].value) == 0.0 && norm(rows[k - 1].value) == 0.0
                               : norm(rows[k].value - rows[k - 1].value) == 0.0;
  };
  while (last > 0 && is_even(last)) {
    --last;
  }
  return rows[last].time - rows[0].time;
}

void open_earthquake(RunState &run) {
  const Diagnostics faults = open_record(run.communicator, run.scene);
  run.notes.insert(run.notes.end(), faults.begin(), faults.end());
  if (!run.scene.earthquake.shakes() || has_errors(run.notes)) {
    return;
  }
  run.loads.ground = GroundMotion(run.scene.earthquake);
  const double end = run.loads.ground.duration();
  run.notes.push_back(
      {Severity::info, run.scene.earthquake.where,
       fmt::format("the record has {} rows in {:g} s and a peak acceleration of {:.3g} m/s2",
                   run.scene.earthquake.record.size(), end, run.loads.ground.peak_acceleration()),
       fmt::format("at its end the ground moves with {:.2g} m/s and has moved by {:.2g} m",
                   norm(run.loads.ground.velocity(end)), norm(run.loads.ground.displacement(end))),
       hint_at_baseline(run.scene.earthquake, run.loads.ground)});
}

Vec2 ground_acceleration(const RunState &run) {
  return run.scene.earthquake.shakes() && !run.scene.earthquake.is_compliant
             ? run.loads.ground.mean_acceleration(run.loads.time - shaking_since(run),
                                                  run.clock.plan.time_step)
             : Vec2{};
}

Vec2 incoming_wave(const RunState &run) {
  const double since = run.loads.time - shaking_since(run);
  return run.scene.earthquake.shakes() && run.scene.earthquake.is_compliant && since > 0.0
             ? run.loads.ground.velocity(since)
             : Vec2{};
}

// Of the row that was appended last, as the scene draws it.
void add_dashpot(RunState &run, const SceneBlock &block, const SideRock &rock) {
  const Earthquake &earthquake = run.scene.earthquake;
  const std::size_t row = run.blocks.num_rows() - 1;
  const Vec2 centroid = run.blocks.properties[row].centroid;
  std::vector<ViscousEdge> edges;
  for (std::size_t k = 0; k < block.vertices.size(); ++k) {
    const Vec2 a = block.vertices[k];
    const Vec2 b = block.vertices[(k + 1) % block.vertices.size()];
    for (std::size_t side = 0; side < earthquake.viscous.size(); ++side) {
      if (earthquake.viscous[side].holds(a) && earthquake.viscous[side].holds(b)) {
        edges.push_back({a - centroid, b - centroid, rock.beyond(run.blocks, row, block, k),
                         earthquake.is_compliant && side == 0});
      }
    }
  }
  if (!edges.empty()) {
    run.blocks.dashpot.push_back(dashpot_of(edges));
    run.blocks.dashpot_begin.lengthen(row, 1);
  }
}

void prepare_matrices(RunState &run) {
  wake_dashpots(run);
  list_applied(run.blocks, !run.scene.water.empty() || !run.clock.state.unloading.empty());
  make_block_matrices(run.blocks, run.scheme, run.clock.plan.time_step, run.scene.run.elasticity,
                      stiffest_joint(run.scene.joints), run.scene.run.rayleigh.stiffness_damping);
}

bool opens_viscous_sides(const RunState &run) {
  return !run.scene.earthquake.viscous.empty() && run.clock.state.index == run.scene.earthquake.stage;
}

// Fixed blocks beyond a viscous side held it so far; what they held with stays (Unloading).
std::vector<std::int64_t> held_beyond_viscous_sides(const RunState &run) {
  std::vector<std::int64_t> held;
  for (std::size_t row = run.blocks.first_fixed(); row < run.blocks.num_rows(); ++row) {
    const std::vector<Vec2> corners = current_vertices(run.blocks, row);
    const auto is_beyond = [&](const Boundary &side) {
      return std::all_of(corners.begin(), corners.end(),
                         [&](Vec2 x) { return dot(side.normal, x) >= side.reach - side.rounding; });
    };
    if (std::any_of(run.scene.earthquake.viscous.begin(), run.scene.earthquake.viscous.end(), is_beyond)) {
      held.push_back(run.blocks.properties[row].id.value);
    }
  }
  return held; // fixed rows ascend by id, and all ranks have them all
}

void keep_unshaken(RunState &run) {
  if (!run.scene.earthquake.shakes() || !has_shaken_in(run, run.clock.state.index - 1)) {
    return;
  }
  const std::span<Vec2> unshaken = unshaken_rows(run.blocks);
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    unshaken[row] = run.blocks.mark_of(row).stage.u;
  }
}

bool has_begun_to_shake(const RunState &run) {
  return run.scene.earthquake.shakes() && run.clock.time() >= shaking_since(run);
}

bool is_to_shake(const RunState &run) {
  const Stage &stage = run.clock.stage();
  if (!run.scene.earthquake.shakes() || stage.kind != StageKind::run || stage.is_trial()) {
    return false;
  }
  const double begin = shaking_since(run);
  return begin <= run.clock.state.start_time + stage.duration &&
         run.clock.time() < begin + end_of_shaking(run.scene.earthquake);
}

std::optional<Diagnostic> warning_of_cut_record(const RunState &run) {
  const Earthquake &earthquake = run.scene.earthquake;
  if (!earthquake.shakes() || !run.clock.is_staged || earthquake.stage >= 0) {
    return std::nullopt; // known before the run
  }
  const double length = end_of_shaking(earthquake);
  const double seen = std::max(0.0, run.clock.time() - earthquake.start);
  constexpr double rounding = 1e-9;
  if (seen >= length * (1.0 - rounding)) {
    return std::nullopt;
  }
  return Diagnostic{Severity::warning, earthquake.where,
                    fmt::format("the run has ended at t = {:g} s after {:g} s of the record, which moves the "
                                "ground for {:g} s from t = {:g} s on",
                                run.clock.time(), seen, length, earthquake.start),
                    "stages before it may have ended earlier than expected",
                    "name the stage that is to shake in earthquake.stage instead of earthquake.start"};
}

std::optional<FarthestBlock> permanent_displacement(const RunState &run) {
  if (!has_begun_to_shake(run)) {
    return std::nullopt;
  }
  const bool is_remembered = run.communicator.max(run.blocks.unshaken.empty() ? 0.0 : 1.0) > 0.0;
  if (!is_remembered && !has_shaken_in(run, run.clock.state.index)) { // in a checkpoint that lacks it
    return std::nullopt;
  }
  FarthestBlock mine;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    const Vec2 before =
        is_remembered ? run.blocks.unshaken[run.blocks.unshaken_begin[row]] : run.blocks.mark_of(row).stage.u;
    const double distance = norm(run.blocks.displacement[row].u - before);
    if (!run.blocks.properties[row].keeps_its_velocity() && distance > mine.distance) {
      mine = {distance, run.blocks.properties[row].id.value};
    }
  }
  FarthestBlock farthest;
  for (const auto &theirs : run.communicator.all_gather(std::vector<FarthestBlock>{mine})) {
    const FarthestBlock &other = theirs.front();
    if (other.distance > farthest.distance ||
        (other.distance == farthest.distance && other.block < farthest.block)) {
      farthest = other;
    }
  }
  return farthest;
}

} // namespace gcpdda
