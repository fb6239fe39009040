#include "simulation/start.hpp"

#include "base/free_memory.hpp"
#include "contact/find_pairs.hpp"
#include "contact/stiffness_bound.hpp"
#include "dynamics/deformable.hpp"
#include "dynamics/frequency_bound.hpp"
#include "dynamics/own_springs.hpp"
#include "geometry/polygon.hpp"
#include "io/blocks/block_file.hpp"
#include "io/results/id_slabs.hpp"
#include "model/stiffness.hpp"
#include "parallel/migration.hpp"
#include "parallel/packing.hpp"
#include "partition/partition_cells.hpp"
#include "simulation/doubts.hpp"
#include "simulation/driven_paths.hpp"
#include "simulation/excavation_doubts.hpp"
#include "simulation/ground.hpp"
#include "simulation/in_situ_state.hpp"
#include "simulation/initial_state.hpp"
#include "simulation/monitors.hpp"
#include "simulation/plausibility.hpp"
#include "simulation/rank_facts.hpp"
#include "simulation/region_slabs.hpp"
#include "simulation/scene_size.hpp"
#include "simulation/stage_changes.hpp"
#include "simulation/stage_doubts.hpp"
#include "simulation/stage_plan.hpp"
#include "simulation/water_doubts.hpp"
#include "simulation/wet_joints.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>

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

/// @param cut  what this rank has cut out of the region
std::vector<SceneBlock> load_slab(RunState &run, std::vector<SceneBlock> cut) {
  const std::int64_t num_before_region = num_blocks(run.scene) - run.scene.num_region_blocks;
  const std::int64_t num_listed = num_before_region - run.scene.block_file.num_blocks;
  const std::int64_t first =
      slab_begin(num_blocks(run.scene), run.communicator.size(), run.communicator.rank());
  const std::int64_t last =
      slab_begin(num_blocks(run.scene), run.communicator.size(), run.communicator.rank() + 1);
  std::vector<SceneBlock> slab;
  slab.reserve(static_cast<std::size_t>(last - first));
  for (std::int64_t id = first; id < std::min(last, num_listed); ++id) {
    slab.push_back(block_of(run.scene, id));
  }
  if (!run.scene.block_file.path.empty()) {
    const auto in_file = [&](std::int64_t id) {
      return std::clamp(id, num_listed, num_before_region) - num_listed;
    };
    stop_on_errors(read_block_file(run.communicator, run.scene, in_file(first), in_file(last), slab));
  }
  if (run.scene.region_blocks) {
    send_to_slabs(run.communicator, num_blocks(run.scene), num_before_region, std::move(cut), slab);
  }
  return slab;
}

// What only the blocks together say: the stiffness of an allowed overlap, and how far a pile may sag.
void find_model_sizes(RunState &run, std::span<const SceneBlock> slab) {
  const auto by_overlap = [](const JointLaw &law) { return law.allowed_overlap > 0.0; };
  const bool any_by_overlap =
      std::any_of(run.scene.joints.laws.begin(), run.scene.joints.laws.end(), by_overlap);
  if (!any_by_overlap && !run.clock.is_staged) {
    return;
  }
  const auto is_mobile = [](const SceneBlock &block) { return !block.fixed; };
  const bool any_mobile =
      agreed_sum(run.communicator, std::count_if(slab.begin(), slab.end(), is_mobile)) > 0;
  SizeSurvey survey = survey_sizes(run.scene, slab, !any_mobile);
  survey.densest = agreed_max(run.communicator, survey.densest);
  survey.high = agreed_max(run.communicator, survey.high);
  survey.low = -agreed_max(run.communicator, -survey.low);
  if (any_by_overlap) {
    resolve_stiffness(run.scene, survey, agreed_median(run.communicator, survey.sizes));
    run.contacts = ContactForces(contact_parameters(run.scene));
  }
  run.sag = largest_sag(run.scene, survey, agreed_median(run.communicator, survey.widths));
}

void find_laws_on_edges(RunState &run, std::span<const SceneBlock> slab) {
  std::vector<JointLaw> &laws = run.scene.joints.laws;
  std::vector<std::int64_t> named(laws.size(), 0);
  for (const SceneBlock &block : slab) {
    for (const std::int32_t law : block.edge_joint) {
      if (law >= 0) {
        named[static_cast<std::size_t>(law)] = 1;
      }
    }
  }
  run.communicator.max(named);
  for (std::size_t i = 0; i < laws.size(); ++i) {
    laws[i].is_on_edges = named[i] > 0;
  }
}

// What is thinnest and what is smallest.
void survey_blocks(RunState &run, std::span<const SceneBlock> slab) {
  double smallest_mobile = infinite;
  double smallest = infinite;
  run.thinnest = infinite;
  std::int64_t num_mobile = 0;
  for (const SceneBlock &block : slab) {
    const double area = signed_area(block.vertices);
    run.thinnest = std::min(run.thinnest, narrowest_width(block.vertices));
    smallest = std::min(smallest, area);
    if (!block.fixed) {
      smallest_mobile = std::min(smallest_mobile, area);
      ++num_mobile;
    }
  }
  find_laws_on_edges(run, slab);
  smallest_mobile = -agreed_max(run.communicator, -smallest_mobile);
  smallest = -agreed_max(run.communicator, -smallest);
  run.thinnest = -agreed_max(run.communicator, -run.thinnest);
  num_mobile = agreed_sum(run.communicator, num_mobile);
  constexpr double skin_per_size = 0.1;
  // A stage may set blocks free where none can move at the start.
  const double area = num_mobile > 0 ? smallest_mobile : smallest;
  run.neighbours.base_skin = std::isfinite(area) ? skin_per_size * std::sqrt(area) : 0.0;
}

// An impact keeps its energy to about (omega dt)^2; dashpots take more than that, but without them it may
// grow.
void warn_of_lively_impacts(RunState &run) {
  const double per_step = run.clock.plan.time_step * run.bound.omega_max;
  if (!run.contacts.parameters().has_dashpots() && per_step > 0.5 * (1.0 + 1e-9)) {
    run.notes.push_back(
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

/// Where the scene writes Young's modulus of a material, if it writes it alone: then no block of it can
/// deform. A scene made in code has no places and gives all values.
const SourcePosition *modulus_alone(const Scene &scene, std::int32_t material) {
  const std::string path = "material." + scene.materials[static_cast<std::size_t>(material)].name;
  const auto place = scene.places.find(path + ".youngs_modulus");
  return place != scene.places.end() && !scene.places.contains(path + ".poissons_ratio") ? &place->second
                                                                                         : nullptr;
}

/// @param scene  of the stage in which the block is looked at
bool deforms(const Scene &scene, const JointLaws &joints, const SceneBlock &block) {
  return choose_fidelity(scene, joints, block).kind == BlockKind::deformable;
}

// With fidelity "auto" stiffness and size decide which blocks deform, also those that a stage sets free: the
// reader of the scene does not know them. Collective.
void expect_poissons_ratios(RunState &run, std::span<const SceneBlock> slab) {
  const Scene &scene = run.scene;
  const std::int64_t first = slab_begin(num_blocks(scene), run.communicator.size(), run.communicator.rank());
  constexpr std::int64_t none = std::numeric_limits<std::int64_t>::min();
  std::vector<std::int64_t> minus_ids(scene.materials.size(), none); // of the first block, by material
  std::vector<bool> is_alone;
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    is_alone.push_back(modulus_alone(scene, static_cast<std::int32_t>(m)) != nullptr);
  }
  for (std::size_t k = 0; k < slab.size(); ++k) {
    const std::int64_t id = first + static_cast<std::int64_t>(k);
    const auto deforms_in = [&](const Stage &stage) {
      return slab[k].fixed && stage.after && id < std::ssize(stage.after->blocks) &&
             modulus_alone(*stage.after, slab[k].material) != nullptr &&
             deforms(*stage.after, scene.joints, stage.after->blocks[static_cast<std::size_t>(id)]);
    };
    const auto material = static_cast<std::size_t>(slab[k].material);
    if ((is_alone[material] && deforms(scene, scene.joints, slab[k])) ||
        std::any_of(run.clock.stages.begin(), run.clock.stages.end(), deforms_in)) {
      minus_ids[material] = std::max(minus_ids[material], -id);
    }
  }
  run.communicator.max(minus_ids);
  for (std::size_t m = 0; m < minus_ids.size(); ++m) {
    if (minus_ids[m] != none) {
      const std::string &name = scene.materials[m].name;
      const SourcePosition *place = modulus_alone(scene, static_cast<std::int32_t>(m));
      run.notes.push_back({Severity::error, place == nullptr ? SourcePosition{} : *place,
                           fmt::format("block '{}' is deformable but its material '{}' has no poissons_ratio",
                                       block_name(scene, -minus_ids[m]), name),
                           "a deformable block has its stiffness from both",
                           fmt::format("for example poissons_ratio = 0.25 in [material.{}]", name)});
    }
  }
  stop_on_errors(run.notes);
}

// A block strains uniformly. Where many are held to each other by joints far stiffer than they are, none can
// strain but with its neighbours.
void doubt_stiff_joints(RunState &run) {
  constexpr std::int64_t many = 20;
  constexpr double stiff = 30.0;  // k_n L/E
  constexpr double enough = 10.0; // up to which stresses hardly suffer
  const double share = run.fidelity.worst_deformable;
  const double ratio = share / (1.0 - share);
  if (run.fidelity.num_deformable >= many && ratio > stiff) {
    run.notes.push_back(
        {Severity::warning,
         {},
         fmt::format("joints are up to {:.3g} times as stiff as the deformable blocks between them (k_n L/E)",
                     ratio),
         "each block strains uniformly, so that blocks held together by such joints are too stiff, and their "
         "stresses less accurate",
         fmt::format("a joint.normal_stiffness lower by {:.2g} times makes it {:g}; or cut smaller blocks",
                     ratio / enough, enough)});
  }
}

void count_kind(RunState &run, const SceneBlock &block, const FidelityChoice &choice) {
  const bool asked = block.fidelity != Fidelity::automatic || run.scene.run.fidelity != Fidelity::automatic;
  FidelityReport &report = run.fidelity;
  report.num_asked += asked && !block.fixed ? 1 : 0;
  report.num_rigid += choice.kind == BlockKind::rigid ? 1 : 0;
  report.num_deformable += choice.kind == BlockKind::deformable ? 1 : 0;
  double &worst = choice.kind == BlockKind::deformable ? report.worst_deformable : report.worst_rigid;
  if (!block.fixed && !block.driven) {
    worst = std::max(worst, choice.rigid_error);
  }
}

// Mobile blocks of the slab become owned rows, to be migrated; everybody gets all fixed ones.
void take_blocks(RunState &run, std::vector<SceneBlock> slab) {
  const std::int64_t first =
      slab_begin(num_blocks(run.scene), run.communicator.size(), run.communicator.rank());
  reserve_rows(run.blocks, slab.size(),
               std::transform_reduce(slab.begin(), slab.end(), std::size_t{0}, std::plus<>(),
                                     [](const SceneBlock &block) { return block.vertices.size(); }));
  std::optional<SideRock> rock; // beyond viscous sides
  if (!run.scene.earthquake.viscous.empty()) {
    rock.emplace(run, slab, first);
  }
  BlockSystem fixed;
  for (std::size_t k = 0; k < slab.size(); ++k) {
    const SceneBlock &block = slab[k];
    const Material &material = run.scene.materials[static_cast<std::size_t>(block.material)];
    const FidelityChoice choice = choose_fidelity(run.scene, run.scene.joints, block);
    count_kind(run, block, choice);
    append_block(block.fixed ? fixed : run.blocks, BlockId{first + static_cast<std::int64_t>(k)}, block,
                 material, choice.kind, run.scene.run.plane_strain);
    part_sides(block.fixed ? fixed : run.blocks, run.scene.joints);
    if (!block.fixed && rock) {
      add_dashpot(run, block, *rock);
    }
  }
  run.fidelity.num_asked = agreed_sum(run.communicator, run.fidelity.num_asked);
  run.fidelity.num_rigid = agreed_sum(run.communicator, run.fidelity.num_rigid);
  run.fidelity.num_deformable = agreed_sum(run.communicator, run.fidelity.num_deformable);
  run.fidelity.worst_rigid = agreed_max(run.communicator, run.fidelity.worst_rigid);
  run.fidelity.worst_deformable = agreed_max(run.communicator, run.fidelity.worst_deformable);
  doubt_stiff_joints(run);
  if (rock) {
    run.notes.push_back(
        on_viscous_sides(run.scene, agreed_sum(run.communicator, std::ssize(run.blocks.dashpot))));
    stop_on_errors(run.notes);
  }
  run.blocks.num_owned = run.blocks.num_rows();
  Bytes mine;
  for (std::size_t row = 0; row < fixed.num_rows(); ++row) {
    pack_row(fixed, row, mine);
  }
  for (const Bytes &message :
       run.communicator.all_gather(mine)) { // slabs ascend with the ranks, and so do ids
    unpack_rows(message, run.blocks);
  }
  run.blocks.num_fixed = run.blocks.num_rows() - run.blocks.num_owned;
  run.fastest_given = fastest_at_start(run);
}

// By cell, of the initial configuration. Faces that touch count as contacts whatever their rounding.
std::vector<std::int64_t> count_contact_work(RunState &run) {
  run.neighbours.ghosts.rebuild(run.blocks, reach_boxes(run.blocks, run.neighbours.base_skin));
  WorkOfBlocks work(run.blocks.num_owned);
  for (const auto &[lower, higher] :
       find_pairs(run.blocks, reach_boxes(run.blocks, 0.1 * run.neighbours.base_skin))) {
    work.add_pair(lower, higher);
  }
  std::vector<Vec2> centroids;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    centroids.push_back(run.blocks.centroid(row));
  }
  return weights_by_cell(run.communicator, run.neighbours.map.grid, centroids, work.counted());
}

// Cells are weighted first by blocks, then, once the neighbourhoods are known, by counted contact work.
void distribute(RunState &run, const Beginning &beginning) {
  stop_on_errors(open_block_file(run.communicator, run.scene));
  stop_on_errors(judge_size(run.communicator, run.scene));
  take_prints(run, beginning); // of the scene as it was read
  std::vector<SceneBlock> slab = load_slab(run, cut_region(run));
  run.loads.load_sides(slab);
  note_groups(run, slab);
  find_model_sizes(run, slab);
  place_monitors(run, slab);
  survey_blocks(run, slab);
  expect_poissons_ratios(run, slab);
  doubt_blocks(run, slab);
  std::vector<Vec2> centroids;
  for (const SceneBlock &block : slab) {
    if (!block.fixed) {
      centroids.push_back(polygon_moments(block.vertices).centroid);
    }
  }
  run.neighbours.map.grid = lay_grid(run.communicator, centroids);
  const std::vector<std::int64_t> equal(centroids.size(), 1);
  run.neighbours.map = partition_cells(
      run.neighbours.map.grid, weights_by_cell(run.communicator, run.neighbours.map.grid, centroids, equal),
      run.communicator.size(), &run.neighbours.partition);
  identify(run, slab);
  take_blocks(run, std::exchange(slab, {}));
  give_back_free_memory();
  find_wet_joints(run);
  doubt_water(run);
  if (run.scene.in_situ.present) {
    apply_in_situ_stress(run);
  }
  stiffen_anchors(run.blocks, stiffest_joint(run.scene.joints)); // of the start, also for a restart
  ContactMemory memory;
  if (!beginning.folder.empty()) { // rows are those of the slab still
    restore(run, beginning, memory);
  }
  migrate(run.communicator, run.neighbours.map, run.blocks, memory);
  if (run.restored) {
    run.restored->memory = std::move(memory.others);
  }
  run.neighbours.map = partition_cells(run.neighbours.map.grid, count_contact_work(run),
                                       run.communicator.size(), &run.neighbours.partition);
}

/// Warnings about values of the scene and of its stages, which the clock holds while it runs.
Diagnostics doubts_of_values(RunState &run) {
  if (!run.clock.is_staged) {
    return implausible_values(run.scene);
  }
  std::swap(run.scene.stages, run.clock.stages);
  Diagnostics doubts = implausible_values(run.scene);
  std::swap(run.scene.stages, run.clock.stages);
  return doubts;
}

} // namespace

void start(RunState &run, const Beginning &beginning) {
  run.loads.list_courses(run.scene, run.clock.stages);
  plan_all_stages(run);
  open_earthquake(run);
  const Diagnostics doubts = doubts_of_values(run);
  run.notes.insert(run.notes.begin(), doubts.begin(), doubts.end());
  stop_on_errors(run.notes);
  distribute(run, beginning);
  run.restored ? run.bolts.take_laws(run.scene) : change_support(run, {}, {});
  scale_masses(run);
  find_bound(run);
  plan_stage(run);
  warn_of_lively_impacts(run);
  prepare_matrices(run);
  refresh(run, run.restored ? ContactMemory{{}, std::move(run.restored->memory)} : ContactMemory{});
  warn_of_driven_paths(run.scene, run.blocks, run.notes);
  if (run.restored) {
    go_on(run);
  } else {
    find_initial_state(run);
    doubt_gaps(run);
    doubt_outlines(run);
    doubt_monitors(run);
    doubt_loads(run);
    doubt_bolts(run);
    doubt_stiffness(run);
    doubt_stretch_of_bonds(run);
  }
  stop_on_errors(run.notes);
  std::stable_sort(run.notes.begin(), run.notes.end(), // warnings in one block
                   [](const Diagnostic &a, const Diagnostic &b) { return a.severity < b.severity; });
  give_back_free_memory();
}

} // namespace gcpdda
