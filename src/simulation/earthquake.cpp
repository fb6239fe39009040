// The ground motion of a Simulation and the sides through which it comes and goes
// (dynamics/ground_motion.hpp, dynamics/viscous_sides.hpp).

#include "contact/stiffness_bound.hpp"
#include "dynamics/deformable.hpp"
#include "dynamics/viscous_sides.hpp"
#include "io/scene/record_file.hpp"
#include "model/stiffness.hpp"
#include "simulation/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace gcpdda {

namespace {

/// Moduli of confined compression and of shear of the rock as the block has it; zero where it is rigid.
std::array<double, 2> moduli_of(const BlockSystem &blocks, std::size_t row) {
  if (!blocks.is_deformable(row)) {
    return {};
  }
  const Deformation &d = blocks.deformation_of(row);
  const double area = blocks.properties[row].area;
  return {d.stiffness_direct / area, d.stiffness_shear / area};
}

} // namespace

void Simulation::open_earthquake() {
  const Diagnostics faults = open_record(communicator_, scene_);
  notes_.insert(notes_.end(), faults.begin(), faults.end());
  if (!scene_.earthquake.shakes() || has_errors(notes_)) {
    return;
  }
  ground_ = GroundMotion(scene_.earthquake);
  const double end = ground_.duration();
  notes_.push_back({Severity::info, scene_.earthquake.where,
                    fmt::format("the record has {} rows in {:g} s and a peak acceleration of {:.3g} m/s2",
                                scene_.earthquake.record.size(), end, ground_.peak_acceleration()),
                    fmt::format("at its end the ground moves with {:.2g} m/s and has moved by {:.2g} m",
                                norm(ground_.velocity(end)), norm(ground_.displacement(end))),
                    scene_.earthquake.quantity == RecordQuantity::acceleration
                        ? "earthquake.baseline can bring both to zero"
                        : ""});
}

// The time of the record's first row; never for a stage that has not begun.
double Simulation::shaking_since() const {
  const std::int64_t stage = scene_.earthquake.stage;
  if (stage < 0) {
    return scene_.earthquake.start;
  }
  if (stage_.index == stage) {
    return stage_.start_time;
  }
  return stage_.index < stage ? std::numeric_limits<double>::infinity()
         : stage == 0         ? 0.0
                              : stage_.results[static_cast<std::size_t>(stage - 1)].time;
}

Vec2 Simulation::ground_acceleration() const {
  return scene_.earthquake.shakes() && !scene_.earthquake.is_compliant
             ? ground_.mean_acceleration(load_time_ - shaking_since(), plan_.time_step)
             : Vec2{};
}

Vec2 Simulation::incoming_wave() const {
  const double since = load_time_ - shaking_since();
  return scene_.earthquake.shakes() && scene_.earthquake.is_compliant && since > 0.0 ? ground_.velocity(since)
                                                                                     : Vec2{};
}

// Of the row that was appended last, as the scene draws it.
void Simulation::add_dashpot(const SceneBlock &block, const Material &material) {
  const Earthquake &earthquake = scene_.earthquake;
  const std::size_t row = blocks_.num_rows() - 1;
  const JointLaw &law = scene_.joints.laws.front();
  std::vector<ViscousEdge> edges;
  for (std::size_t k = 0; k < block.vertices.size(); ++k) {
    const Vec2 a = block.vertices[k];
    const Vec2 b = block.vertices[(k + 1) % block.vertices.size()];
    for (std::size_t side = 0; side < earthquake.viscous.size(); ++side) {
      if (!earthquake.viscous[side].holds(a) || !earthquake.viscous[side].holds(b)) {
        continue;
      }
      const double height = blocks_.properties[row].area / norm(b - a);
      Impedance impedance =
          impedance_of(material.density, moduli_of(blocks_, row),
                       {law.normal_stiffness, law.tangential_ratio * law.normal_stiffness}, height);
      if (earthquake.p_wave_speed > 0.0) {
        impedance.normal = material.density * earthquake.p_wave_speed;
      }
      if (earthquake.s_wave_speed > 0.0) {
        impedance.tangential = material.density * earthquake.s_wave_speed;
      }
      const Vec2 centroid = blocks_.properties[row].centroid;
      edges.push_back({a - centroid, b - centroid, impedance, earthquake.is_compliant && side == 0});
    }
  }
  if (!edges.empty()) {
    blocks_.dashpot.push_back(dashpot_of(edges));
    blocks_.dashpot_begin.lengthen(row, 1);
  }
}

// They sleep until the shaking begins: no stage before it lets waves out.
void Simulation::wake_dashpots() {
  for (Dashpot &dashpot : blocks_.dashpot) {
    dashpot.is_awake = stage_.index >= scene_.earthquake.stage ? 1.0 : 0.0;
  }
}

void Simulation::prepare_matrices() {
  wake_dashpots();
  list_applied(blocks_, !scene_.water.empty() || !stage_.unloading.empty());
  make_block_matrices(blocks_, scheme_, plan_.time_step, scene_.run.elasticity, stiffest_joint(scene_.joints),
                      scene_.run.rayleigh.stiffness_damping);
}

bool Simulation::opens_viscous_sides() const {
  return !scene_.earthquake.viscous.empty() && stage_.index == scene_.earthquake.stage;
}

// Fixed blocks beyond a viscous side held it so far; what they held with stays (Unloading).
std::vector<std::int64_t> Simulation::held_beyond_viscous_sides() const {
  std::vector<std::int64_t> held;
  for (std::size_t row = blocks_.first_fixed(); row < blocks_.num_rows(); ++row) {
    const std::vector<Vec2> corners = current_vertices(blocks_, row);
    const auto is_beyond = [&](const Boundary &side) {
      return std::all_of(corners.begin(), corners.end(),
                         [&](Vec2 x) { return dot(side.normal, x) >= side.reach - side.rounding; });
    };
    if (std::any_of(scene_.earthquake.viscous.begin(), scene_.earthquake.viscous.end(), is_beyond)) {
      held.push_back(blocks_.properties[row].id.value);
    }
  }
  return held; // fixed rows ascend by id, and all ranks have them all
}

std::optional<FarthestBlock> Simulation::permanent_displacement() const {
  const std::int64_t stage = std::max<std::int64_t>(scene_.earthquake.stage, 0);
  if (!scene_.earthquake.shakes() || stage_.index != stage) {
    return std::nullopt;
  }
  FarthestBlock mine;
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    const double distance = norm(blocks_.displacement[row].u - blocks_.mark_of(row).stage.u);
    if (!blocks_.properties[row].keeps_its_velocity() && distance > mine.distance) {
      mine = {distance, blocks_.properties[row].id.value};
    }
  }
  FarthestBlock farthest;
  for (const auto &theirs : communicator_.all_gather(std::vector<FarthestBlock>{mine})) {
    const FarthestBlock &other = theirs.front();
    if (other.distance > farthest.distance ||
        (other.distance == farthest.distance && other.block < farthest.block)) {
      farthest = other;
    }
  }
  return farthest;
}

} // namespace gcpdda
