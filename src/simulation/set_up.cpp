// Construction of a Simulation: distribution of the blocks and the step.
//
// No rank holds all blocks. Each takes one slab of BlockIds from the scene, its generators and its file, and
// what is said of all of them (region, smallest, median) is agreed on by reductions. From the slabs blocks
// migrate to the owners of their cells; fixed ones go to everybody.

#include "simulation/simulation.hpp"

#include "base/free_memory.hpp"
#include "contact/stiffness_bound.hpp"
#include "dynamics/deformable.hpp"
#include "dynamics/frequency_bound.hpp"
#include "gcpdda/io/result_files.hpp"
#include "geometry/polygon.hpp"
#include "io/blocks/block_file.hpp"
#include "model/fidelity.hpp"
#include "model/stiffness.hpp"
#include "parallel/migration.hpp"
#include "parallel/packing.hpp"
#include "simulation/driven_paths.hpp"
#include "simulation/plausibility.hpp"
#include "simulation/rank_facts.hpp"
#include "simulation/region_slabs.hpp"
#include "simulation/scene_size.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <limits>
#include <numeric>

namespace gcpdda {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

void stop_on_errors(const Diagnostics &diagnostics) {
  if (has_errors(diagnostics)) {
    throw SceneError(diagnostics);
  }
}

double agreed_max(const Communicator &communicator, double value) {
  communicator.max(std::span(&value, 1));
  return value;
}

std::int64_t agreed_sum(const Communicator &communicator, std::int64_t value) {
  communicator.sum(std::span(&value, 1));
  return value;
}

Diagnostic on_viscous_sides(const Scene &scene, std::int64_t count) {
  return {count > 0 ? Severity::info : Severity::error, scene.earthquake.where,
          fmt::format("{} blocks have edges on viscous sides", count),
          "edges that lie on a side at the start let waves out", ""};
}

} // namespace

Simulation::Simulation(const Communicator &communicator, Scene scene, const Beginning &beginning)
    : communicator_(communicator), scene_(std::move(scene)), balance_(communicator), ghosts_(communicator),
      contacts_(contact_parameters(scene_)),
      scheme_(make_scheme(scene_.run.scheme, scene_.run.spectral_radius, scene_.run.contact_time)) {
  for (std::size_t i = 0; i < scene_.blocks.size(); ++i) {
    if (!scene_.blocks[i].velocity_table.empty()) {
      prescribed_.emplace_back(BlockId{static_cast<std::int64_t>(i)},
                               PrescribedMotion(scene_.blocks[i].velocity_table));
    }
  }
  is_staged_ = !scene_.stages.empty();
  notes_ = implausible_values(scene_);
  stages_ = std::move(scene_.stages);
  if (!is_staged_) {
    stages_.resize(1);
    stages_.front().duration = scene_.run.duration;
  }
  list_courses();
  plan_all_stages();
  open_earthquake();
  stop_on_errors(notes_);
  distribute(beginning);
  restored_ ? bolts_.take_laws(scene_) : change_bolts({});
  scale_masses();
  find_bound();
  plan_stage();
  warn_of_lively_impacts();
  prepare_matrices();
  refresh(restored_ ? ContactMemory{{}, std::move(restored_->memory)} : ContactMemory{});
  warn_of_driven_paths(scene_, blocks_, notes_);
  if (restored_) {
    go_on();
  } else {
    find_initial_state();
    doubt_gaps();
    doubt_monitors();
  }
  stop_on_errors(notes_);
  std::stable_sort(notes_.begin(), notes_.end(), // warnings in one block
                   [](const Diagnostic &a, const Diagnostic &b) { return a.severity < b.severity; });
  give_back_free_memory();
}

// Cells are weighted first by blocks, then, once the neighbourhoods are known, by counted contact work.
void Simulation::distribute(const Beginning &beginning) {
  stop_on_errors(open_block_file(communicator_, scene_));
  stop_on_errors(judge_size(communicator_, scene_));
  take_prints(beginning); // of the scene as it was read
  std::vector<SceneBlock> slab = load_slab(cut_region());
  load_sides(slab);
  note_groups(slab);
  find_model_sizes(slab);
  place_monitors(slab);
  survey(slab);
  doubt_blocks(slab);
  std::vector<Vec2> centroids;
  for (const SceneBlock &block : slab) {
    if (!block.fixed) {
      centroids.push_back(polygon_moments(block.vertices).centroid);
    }
  }
  map_.grid = lay_grid(communicator_, centroids);
  const std::vector<std::int64_t> equal(centroids.size(), 1);
  map_ = partition_cells(map_.grid, weights_by_cell(communicator_, map_.grid, centroids, equal),
                         communicator_.size(), &partition_);
  identify(slab);
  take_blocks(std::exchange(slab, {}));
  give_back_free_memory();
  if (scene_.in_situ.present) {
    apply_in_situ_stress();
  }
  ContactMemory memory;
  if (!beginning.folder.empty()) { // rows are those of the slab still
    restore(beginning, memory);
  }
  migrate(communicator_, map_, blocks_, memory);
  if (restored_) {
    restored_->memory = std::move(memory.others);
  }
  map_ = partition_cells(map_.grid, count_contact_work(), communicator_.size(), &partition_);
}

/// @param cut  what this rank has cut out of the region
std::vector<SceneBlock> Simulation::load_slab(std::vector<SceneBlock> cut) {
  const std::int64_t num_before_region = num_blocks() - scene_.num_region_blocks;
  const std::int64_t num_listed = num_before_region - scene_.block_file.num_blocks;
  const std::int64_t first = slab_begin(num_blocks(), communicator_.size(), communicator_.rank());
  const std::int64_t last = slab_begin(num_blocks(), communicator_.size(), communicator_.rank() + 1);
  std::vector<SceneBlock> slab;
  slab.reserve(static_cast<std::size_t>(last - first));
  for (std::int64_t id = first; id < std::min(last, num_listed); ++id) {
    slab.push_back(block_of(scene_, id));
  }
  if (!scene_.block_file.path.empty()) {
    const auto in_file = [&](std::int64_t id) {
      return std::clamp(id, num_listed, num_before_region) - num_listed;
    };
    stop_on_errors(read_block_file(communicator_, scene_, in_file(first), in_file(last), slab));
  }
  if (scene_.region_blocks) {
    send_to_slabs(communicator_, num_blocks(), num_before_region, std::move(cut), slab);
  }
  return slab;
}

// What only the blocks together say: the stiffness of an allowed overlap, and how far a pile may sag.
void Simulation::find_model_sizes(std::span<const SceneBlock> slab) {
  const auto by_overlap = [](const JointLaw &law) { return law.allowed_overlap > 0.0; };
  const bool any_by_overlap = std::any_of(scene_.joints.laws.begin(), scene_.joints.laws.end(), by_overlap);
  if (!any_by_overlap && !is_staged_) {
    return;
  }
  const auto is_mobile = [](const SceneBlock &block) { return !block.fixed; };
  const bool any_mobile = agreed_sum(communicator_, std::count_if(slab.begin(), slab.end(), is_mobile)) > 0;
  SizeSurvey survey = survey_sizes(scene_, slab, !any_mobile);
  survey.densest = agreed_max(communicator_, survey.densest);
  survey.high = agreed_max(communicator_, survey.high);
  survey.low = -agreed_max(communicator_, -survey.low);
  if (any_by_overlap) {
    resolve_stiffness(scene_, survey, agreed_median(communicator_, survey.sizes));
    contacts_ = ContactForces(contact_parameters(scene_));
  }
  sag_ = largest_sag(scene_, survey, agreed_median(communicator_, survey.widths));
}

// What is thinnest, what is smallest, how far the model reaches.
void Simulation::survey(std::span<const SceneBlock> slab) {
  Aabb region;
  double smallest_mobile = infinite;
  thinnest_ = infinite;
  std::int64_t num_mobile = 0;
  for (const SceneBlock &block : slab) {
    region.include(bounding_box(block.vertices));
    thinnest_ = std::min(thinnest_, narrowest_width(block.vertices));
    if (!block.fixed) {
      smallest_mobile = std::min(smallest_mobile, signed_area(block.vertices));
      ++num_mobile;
    }
  }
  std::array<double, 6> largest{-region.low.x, -region.low.y,    region.high.x,
                                region.high.y, -smallest_mobile, -thinnest_};
  communicator_.max(largest);
  find_laws_on_edges(slab);
  smallest_mobile = -largest[4];
  thinnest_ = -largest[5];
  num_mobile = agreed_sum(communicator_, num_mobile);
  constexpr double skin_per_size = 0.1;
  base_skin_ = num_mobile > 0 ? skin_per_size * std::sqrt(smallest_mobile) : 0.0;
  if (num_mobile > 0) {
    const double farthest = *std::max_element(largest.begin(), largest.begin() + 4,
                                              [](double a, double b) { return std::abs(a) < std::abs(b); });
    warn_of_rounding(std::sqrt(smallest_mobile), std::abs(farthest));
  }
}

void Simulation::find_laws_on_edges(std::span<const SceneBlock> slab) {
  std::vector<JointLaw> &laws = scene_.joints.laws;
  std::vector<std::int64_t> named(laws.size(), 0);
  for (const SceneBlock &block : slab) {
    for (const std::int32_t law : block.edge_joint) {
      if (law >= 0) {
        named[static_cast<std::size_t>(law)] = 1;
      }
    }
  }
  communicator_.max(named);
  for (std::size_t i = 0; i < laws.size(); ++i) {
    laws[i].is_on_edges = named[i] > 0;
  }
}

// An impact keeps its energy to about (omega dt)^2; dashpots take more than that, but without them it may
// grow.
void Simulation::warn_of_lively_impacts() {
  const double per_step = plan_.time_step * bound_.omega_max;
  if (!contacts_.parameters().has_dashpots() && per_step > 0.5 * (1.0 + 1e-9)) {
    notes_.push_back(
        {Severity::warning,
         {},
         fmt::format(
             "without contact damping a step of {:.2g}/omega_max lets one impact gain or lose up to a "
             "tenth of its energy",
             per_step),
         "the error falls with the square of the step",
         "use run.safety = 0.25 or less, or run.contact_damping"});
  }
}

// A block rests by its overlap; where that is no more than the last digits of its coordinates, it is noise.
void Simulation::warn_of_rounding(double size, double farthest) {
  double density = infinite;
  for (const Material &material : scene_.materials) {
    density = std::min(density, material.density);
  }
  const double depth = density * norm(scene_.run.gravity) * size / stiffest_joint(scene_.joints);
  const double rounding = std::numeric_limits<double>::epsilon() * farthest;
  if (depth > 0.0 && depth < 10.0 * rounding) {
    notes_.push_back(
        {Severity::warning,
         {},
         fmt::format("the smallest block rests by an overlap of {:.2g} m, and coordinates of {:g} m are "
                     "rounded by {:.2g} m",
                     depth, farthest, rounding),
         "forces at rest will be rounding errors",
         "lower joint.normal_stiffness or move the model to the origin"});
  }
}

// Mobile blocks of the slab become owned rows, to be migrated; everybody gets all fixed ones.
void Simulation::take_blocks(std::vector<SceneBlock> slab) {
  const std::int64_t first = slab_begin(num_blocks(), communicator_.size(), communicator_.rank());
  reserve_rows(blocks_, slab.size(),
               std::transform_reduce(slab.begin(), slab.end(), std::size_t{0}, std::plus<>(),
                                     [](const SceneBlock &block) { return block.vertices.size(); }));
  BlockSystem fixed;
  for (std::size_t k = 0; k < slab.size(); ++k) {
    const SceneBlock &block = slab[k];
    const Material &material = scene_.materials[static_cast<std::size_t>(block.material)];
    const FidelityChoice choice =
        choose_fidelity(block, signed_area(block.vertices), material,
                        stiffness_bound(scene_.joints, block.material, block.edge_joint).normal, scene_.run);
    const bool asked = block.fidelity != Fidelity::automatic || scene_.run.fidelity != Fidelity::automatic;
    fidelity_.num_asked += asked && !block.fixed ? 1 : 0;
    fidelity_.num_rigid += choice.kind == BlockKind::rigid ? 1 : 0;
    fidelity_.num_deformable += choice.kind == BlockKind::deformable ? 1 : 0;
    double &worst = choice.kind == BlockKind::deformable ? fidelity_.worst_deformable : fidelity_.worst_rigid;
    if (!block.fixed && !block.driven) {
      worst = std::max(worst, choice.rigid_error);
    }
    append_block(block.fixed ? fixed : blocks_, BlockId{first + static_cast<std::int64_t>(k)}, block,
                 material, choice.kind, scene_.run.plane_strain);
    if (!block.fixed && !scene_.earthquake.viscous.empty()) {
      add_dashpot(block, material);
    }
  }
  fidelity_.num_asked = agreed_sum(communicator_, fidelity_.num_asked);
  fidelity_.num_rigid = agreed_sum(communicator_, fidelity_.num_rigid);
  fidelity_.num_deformable = agreed_sum(communicator_, fidelity_.num_deformable);
  fidelity_.worst_rigid = agreed_max(communicator_, fidelity_.worst_rigid);
  fidelity_.worst_deformable = agreed_max(communicator_, fidelity_.worst_deformable);
  if (!scene_.earthquake.viscous.empty()) {
    notes_.push_back(on_viscous_sides(scene_, agreed_sum(communicator_, std::ssize(blocks_.dashpot))));
    stop_on_errors(notes_);
  }
  blocks_.num_owned = blocks_.num_rows();
  Bytes mine;
  for (std::size_t row = 0; row < fixed.num_rows(); ++row) {
    pack_row(fixed, row, mine);
  }
  for (const Bytes &message : communicator_.all_gather(mine)) { // slabs ascend with the ranks, and so do ids
    unpack_rows(message, blocks_);
  }
  blocks_.num_fixed = blocks_.num_rows() - blocks_.num_owned;
}

// By cell, of the initial configuration. Faces that touch count as contacts whatever their rounding.
std::vector<std::int64_t> Simulation::count_contact_work() {
  ghosts_.rebuild(blocks_, reach_boxes(blocks_, base_skin_));
  WorkOfBlocks work(blocks_.num_owned);
  for (const auto &[lower, higher] : find_pairs(blocks_, reach_boxes(blocks_, 0.1 * base_skin_))) {
    work.add_pair(lower, higher);
  }
  std::vector<Vec2> centroids;
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    centroids.push_back(blocks_.centroid(row));
  }
  return weights_by_cell(communicator_, map_.grid, centroids, work.counted());
}

double Simulation::frequency_bound_of(std::size_t row, std::span<const PointSpring> springs) const {
  const StiffnessBound stiffness =
      stiffness_bound(scene_.joints, blocks_.properties[row].material, blocks_.edge_joints(row));
  return contact_frequency_bound(blocks_, row, stiffness.normal, stiffness.tangential,
                                 elasticity_of(scheme_, scene_.run.elasticity), springs);
}

void Simulation::find_bound() {
  double omega_squared = 0.0;
  double without_bolts = 0.0;
  std::int64_t limiting = std::numeric_limits<std::int64_t>::max();
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    const std::span<const PointSpring> springs = bolts_.springs_at(blocks_.properties[row].id.value);
    const double own = frequency_bound_of(row, springs);
    without_bolts = std::max(without_bolts, springs.empty() ? own : frequency_bound_of(row, {}));
    if (own > omega_squared) {
      omega_squared = own;
      limiting = blocks_.properties[row].id.value;
    }
  }
  const double mine = omega_squared;
  communicator_.max(std::span(&omega_squared, 1));
  std::int64_t minus_id = mine == omega_squared && omega_squared > 0.0 ? -limiting : -num_blocks();
  communicator_.max(std::span(&minus_id, 1));
  bound_.block = minus_id == -num_blocks() ? -1 : -minus_id;
  // A block that is alone can never touch.
  bound_.omega_max = num_blocks() > 1 ? std::sqrt(omega_squared) : 0.0;
  bound_.without_bolts =
      bolts_.empty() ? bound_.omega_max : std::sqrt(agreed_max(communicator_, without_bolts));

  // In a system of blocks the fastest mode is damped more than one joint.
  const double modal_damping_factor = fidelity_.num_deformable > 0 ? 2.4 : 1.4;
  const double joint_ratio = modal_damping_factor * scene_.run.contact_damping;
  const double undamped_limit = stability_limit(scheme_, joint_ratio);
  bound_.damping_ratio = joint_ratio + 0.5 * scene_.run.rayleigh.stiffness_damping * bound_.omega_max;
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
  // On the way to rest nothing needs to be accurate, only stable. Under scaled masses every block swings at
  // the bound, and a step as long keeps the pile awake. A safety below the default asks for a short step.
  constexpr double safety_to_settle = 0.9;
  const Stage &stage = stages_[static_cast<std::size_t>(stage_.index)];
  const bool settles =
      stage.kind == StageKind::settle && !stage.mass_scaling && scene_.run.safety >= RunSettings{}.safety;
  bound_.safety = settles ? std::max(scene_.run.safety, safety_to_settle) : scene_.run.safety;
  const double locally_damped =
      stability_limit(scheme_, bound_.damping_ratio, stage.local_damping_or(scene_.run.local_damping));
  const double undamped_share = undamped_limit / bound_.limit;
  if (locally_damped > 0.0 && bound_.safety * bound_.limit > safety_to_settle * locally_damped) {
    bound_.safety = safety_to_settle;
    bound_.limit = locally_damped;
  }
  bound_.time_step = bound_.omega_max > 0.0 ? bound_.safety * bound_.limit / bound_.omega_max
                                            : std::numeric_limits<double>::infinity();
  bound_.undamped_step = bound_.time_step * undamped_share;
}

} // namespace gcpdda
