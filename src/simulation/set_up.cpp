// Construction of a Simulation: distribution of the blocks, the step, the consistent initial state.

#include "gcpdda/simulation/simulation.hpp"

#include "gcpdda/contact/initial_friction.hpp"
#include "gcpdda/dynamics/frequency_bound.hpp"
#include "gcpdda/dynamics/integrate.hpp"
#include "gcpdda/geometry/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace gcpdda {

Simulation::Simulation(const Communicator &communicator, Scene scene)
    : communicator_(communicator), scene_(std::move(scene)), ghosts_(communicator),
      contacts_({scene_.joints, scene_.run.contact_damping, scene_.run.potential}),
      scheme_(make_scheme(scene_.run.scheme, scene_.run.spectral_radius, scene_.run.contact_time)) {
  distribute();
  find_bound();
  plan_ = plan_time(scene_.run, scene_.output, bound_.time_step, notes_);
  if (has_errors(notes_)) {
    throw SceneError(notes_);
  }
  refresh();
  find_initial_state();
}

// Everybody knows the whole list of blocks and keeps its own; cells are weighted first by blocks, then, once
// the neighbourhoods are known, by counted contact work.
void Simulation::distribute() {
  lay_grid();
  std::vector<std::int64_t> weights(static_cast<std::size_t>(map_.grid.num_cells()), 0);
  for (const SceneBlock &block : scene_.blocks) {
    if (!block.fixed) {
      ++weights[static_cast<std::size_t>(map_.grid.cell_of(polygon_moments(block.vertices).centroid))];
    }
  }
  map_ = partition_cells(map_.grid, weights, communicator_.size(), &partition_);
  take_blocks();
  map_ = partition_cells(map_.grid, count_contact_work(), communicator_.size(), &partition_);
}

// About two cells a mobile block: fine enough to balance, coarse enough that most blocks stay in theirs.
void Simulation::lay_grid() {
  Aabb region;
  double smallest_mobile = std::numeric_limits<double>::infinity();
  thinnest_ = std::numeric_limits<double>::infinity();
  std::int64_t num_mobile = 0;
  for (const SceneBlock &block : scene_.blocks) {
    region.include(bounding_box(block.vertices));
    thinnest_ = std::min(thinnest_, narrowest_width(block.vertices));
    if (!block.fixed) {
      smallest_mobile = std::min(smallest_mobile, signed_area(block.vertices));
      ++num_mobile;
    }
  }
  constexpr double skin_per_size = 0.1;
  base_skin_ = num_mobile > 0 ? skin_per_size * std::sqrt(smallest_mobile) : 0.0;
  map_.grid = CellGrid::over(region, std::max(std::int64_t{64} * communicator_.size(), 2 * num_mobile));
}

void Simulation::take_blocks() {
  for (const bool fixed : {false, true}) {
    for (std::size_t k = 0; k < scene_.blocks.size(); ++k) {
      const SceneBlock &block = scene_.blocks[k];
      const bool here =
          fixed || map_.rank_of(polygon_moments(block.vertices).centroid) == communicator_.rank();
      if (block.fixed == fixed && here) {
        append_block(blocks_, BlockId{static_cast<std::int64_t>(k)}, block,
                     scene_.materials[static_cast<std::size_t>(block.material)]);
        ++(fixed ? blocks_.num_fixed : blocks_.num_owned);
      }
    }
  }
}

// By cell: one for each block and two for each of its candidate pairs in the initial configuration.
std::vector<std::int64_t> Simulation::count_contact_work() {
  std::vector<std::int64_t> weights(static_cast<std::size_t>(map_.grid.num_cells()), 0);
  const auto add = [&](std::size_t row, std::int64_t weight) {
    weights[static_cast<std::size_t>(map_.grid.cell_of(blocks_.centroid(row)))] += weight;
  };
  ghosts_.rebuild(map_, blocks_, reach_boxes(blocks_, base_skin_));
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    add(row, 1);
  }
  for (const auto &[lower, higher] : find_pairs(blocks_, reach_boxes(blocks_, base_skin_))) {
    for (const BlockIndex end : {lower, higher}) {
      if (end.value < blocks_.num_owned) {
        add(end.value, 2);
      }
    }
  }
  communicator_.sum(weights);
  return weights;
}

void Simulation::find_bound() {
  double omega_squared = 0.0;
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    const StiffnessBound stiffness = stiffness_bound(scene_.joints, blocks_.properties[row].material);
    omega_squared = std::max(omega_squared,
                             contact_frequency_bound(blocks_, row, stiffness.normal, stiffness.tangential));
  }
  communicator_.max(std::span(&omega_squared, 1));
  // A block that is alone can never touch.
  bound_.omega_max = num_blocks() > 1 ? std::sqrt(omega_squared) : 0.0;

  // In a system of rigid blocks the fastest mode is damped more than one joint.
  constexpr double modal_damping_factor = 1.4;
  bound_.damping_ratio = modal_damping_factor * scene_.run.contact_damping;
  bound_.limit = stability_limit(scheme_, bound_.damping_ratio);
  if (bound_.limit <= 0.0) {
    bound_.always_unstable = true;
    bound_.limit = 2.0;
    notes_.push_back({Severity::warning,
                      {},
                      "contact forces taken where this scene takes them are unstable for every time step",
                      fmt::format("the amplitude of a contact oscillation at W = 0.1 grows by {:.2g} a step",
                                  amplification(scheme_, 0.1, bound_.damping_ratio) - 1.0),
                      "use run.contact_time = \"leapfrog\" for results"});
  }
  bound_.time_step = bound_.omega_max > 0.0 ? scene_.run.safety * bound_.limit / bound_.omega_max
                                            : std::numeric_limits<double>::infinity();
}

void Simulation::accelerate_owned() {
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    RigidDof force = sum_contacts(blocks_, candidates_, contacts_.pairs(), row).force;
    force.u += blocks_.properties[row].mass * gravity();
    blocks_.acceleration[row] = accelerate(blocks_.properties[row], force);
  }
}

// a_0 = M^-1 F(0): constant acceleration is then exact from the first step.
void Simulation::find_initial_state() {
  evaluate_contacts();
  if (scene_.run.initial_friction == InitialFriction::consistent) {
    find_initial_friction();
  }
  gather_forces();
  accelerate_owned();
  report();
  counters_.evaluations = 0; // these two are of steps
  counters_.contact_steps = 0;
}

void Simulation::find_initial_friction() {
  InitialStick stick(blocks_, candidates_, contacts_, history_);
  ghosts_.copy(stick.contact_counts());
  const auto agreed_residual = [&] {
    accelerate_owned();
    ghosts_.copy(blocks_.acceleration);
    double residual = stick.residual(blocks_);
    communicator_.max(std::span(&residual, 1));
    return residual;
  };
  constexpr int num_sweeps = 50;
  const double before = agreed_residual();
  double after = before;
  for (int sweep = 0; sweep < num_sweeps && after > 0.0; ++sweep) {
    stick.sweep(blocks_);
    after = agreed_residual();
  }
  if (before > 0.0 && !(after < before)) {
    stick.reset();
    notes_.push_back(
        {Severity::info,
         {},
         "friction starts at zero",
         fmt::format("{} sweeps did not bring the initial stick forces nearer to equilibrium", num_sweeps),
         ""});
  }
}

} // namespace gcpdda
