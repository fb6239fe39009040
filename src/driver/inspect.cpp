#include "driver/inspect.hpp"

#include "base/check.hpp"
#include "base/exact_sum.hpp"
#include "driver/odd_blocks.hpp"
#include "driver/run_words.hpp"
#include "driver/svg.hpp"
#include "geometry/point_text.hpp"
#include "geometry/polygon.hpp"
#include "model/stiffness.hpp"
#include "partition/partition_cells.hpp"
#include "simulation/rank_facts.hpp"
#include "simulation/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <numbers>

namespace gcpdda {

namespace {

constexpr std::int64_t most_drawn = 200'000;

std::string bytes_text(double bytes) {
  return bytes < 1e6   ? fmt::format("{:.0f} kB", bytes / 1e3)
         : bytes < 1e9 ? fmt::format("{:.1f} MB", bytes / 1e6)
                       : fmt::format("{:.2f} GB", bytes / 1e9);
}

std::string seconds_text(double seconds) {
  return seconds < 120.0    ? fmt::format("{:.3g} s", seconds)
         : seconds < 7200.0 ? fmt::format("{:.0f} min", seconds / 60.0)
                            : fmt::format("{:.1f} h", seconds / 3600.0);
}

/// Bytes of this rank's arrays.
std::int64_t state_bytes(const Simulation &simulation) {
  const BlockSystem &blocks = simulation.blocks();
  std::size_t bytes = 0;
  const auto add = [&](const auto &field) { bytes += field.capacity() * sizeof(field[0]); };
  std::apply([&](auto... field) { (add(blocks.*field), ...); }, BlockSystem::row_fields());
  const auto add_list = [&](auto... fields) { (add(blocks.*fields), ...); };
  std::apply([&](auto... list) { (std::apply(add_list, list), ...); }, BlockSystem::lists());
  add(blocks.vertex);
  add(blocks.motion);
  add(blocks.deformed_edge);
  add(simulation.candidates().pairs);
  add(simulation.candidates().plain);
  add(simulation.history().overlaps);
  add(simulation.history().plain);
  add(simulation.history().regions);
  bytes += blocks.num_owned * sizeof(ContactDigest::OnRow);
  add(simulation.domain_map().owner);
  return static_cast<std::int64_t>(bytes);
}

/// The heaviest mobile block; of several the first.
struct Heaviest {
  double weight = 0.0; ///< N/m
  double size = 0.0;   ///< sqrt of its area, m
  std::int64_t block = -1;

  void see(const Heaviest &other) {
    if (other.block >= 0 &&
        (block < 0 || other.weight > weight || (other.weight == weight && other.block < block))) {
      *this = other;
    }
  }
};

class Inspection {
public:
  Inspection(const Communicator &communicator, const Scene &scene, const InspectOptions &options)
      : communicator_(communicator), options_(options), simulation_(communicator, scene) {
    num_subdomains_ = options.ranks > 0 ? options.ranks : communicator.size();
    const BlockSystem &blocks = simulation_.blocks();
    num_mobile_ = total(communicator, static_cast<std::int64_t>(blocks.num_owned));
    partition();
    weigh();
  }

  std::string report() {
    if (!options_.svg.empty()) {
      draw(); // before the trial steps
    }
    std::string text = fmt::format("scene '{}'\n", simulation_.scene().stem);
    text +=
        blocks_line() + fidelity_line() + joint_lines() + step_lines() + contact_line() + partition_line();
    text += stage_lines() + water_lines() + support_lines() + cost_lines() + oddity_lines();
    for (const Diagnostic &note : simulation_.notes()) {
      text += to_string(note) + "\n";
    }
    if (!options_.svg.empty()) {
      text += line("picture", options_.svg.string());
    }
    return text;
  }

private:
  static std::string line(const char *what, const std::string &text) {
    return fmt::format("{:<11} {}\n", what, text);
  }

  std::string blocks_line() {
    const BlockSystem &blocks = simulation_.blocks();
    const std::size_t first_fixed_vertex = blocks.vertex_begin[blocks.first_fixed()];
    const std::int64_t fixed_vertices =
        static_cast<std::int64_t>(blocks.reference_vertex.size() - first_fixed_vertex);
    const std::int64_t vertices =
        total(communicator_, blocks.vertex_begin[blocks.num_owned]) + fixed_vertices;
    std::int64_t reentrant = 0;
    for (std::size_t row = 0; row < blocks.num_rows(); ++row) {
      const bool counted = row < blocks.num_owned || (blocks.is_fixed(row) && communicator_.is_root());
      reentrant += counted && !is_convex(blocks.of_row(blocks.reference_vertex, row)) ? 1 : 0;
    }
    return line("blocks",
                fmt::format("{} mobile, {} fixed, {} vertices, {} with re-entrant vertices", num_mobile_,
                            blocks.num_fixed, vertices, total(communicator_, reentrant)));
  }

  std::string fidelity_line() {
    const FidelityReport &f = simulation_.fidelity();
    const double accepted = simulation_.scene().run.accepted_error;
    std::string text =
        fmt::format("{} rigid, {} deformable; accepted error {:g}", f.num_rigid, f.num_deformable, accepted);
    if (f.num_rigid > 0) {
      text += fmt::format("; k_n L/(E + k_n L) of the rigid blocks is {:.3g} at most", f.worst_rigid);
    }
    if (f.num_deformable > 0) {
      text += fmt::format("; of the deformable ones {:.3g} at most", f.worst_deformable);
    }
    text += f.num_asked > 0 ? fmt::format("; {} as the scene asks, the others by that share", f.num_asked)
                            : "; all by that share";
    return line("fidelity", text);
  }

  static std::string origin_of_stiffness(const JointLaw &law) {
    if (law.rock_mass_modulus > 0.0) {
      return fmt::format(" (from rock_mass_modulus = {:g}, intact_modulus = {:g}, spacing = {:g})",
                         law.rock_mass_modulus, law.intact_modulus, law.spacing);
    }
    return law.allowed_overlap > 0.0 ? fmt::format(" (from allowed_overlap = {:g})", law.allowed_overlap)
                                     : "";
  }

  std::string joint_lines() {
    std::string text;
    for (const JointLaw &law : simulation_.scene().joints.laws) {
      text += line("joint",
                   fmt::format("'{}': k_n {:.6g} Pa/m{}, k_t/k_n {:g}, {}", law.name, law.normal_stiffness,
                               origin_of_stiffness(law), law.tangential_ratio, words_on_strength(law)));
      text += sinking_line(law);
    }
    return text;
  }

  /// What the weight does to a flush joint and to a corner of this law, each alone under it.
  std::string sinking_line(const JointLaw &law) {
    if (heaviest_.block < 0 || !(heaviest_.weight > 0.0) || !(law.normal_stiffness > 0.0)) {
      return "";
    }
    constexpr double deepest = 0.25 * std::numbers::pi; // both edges at 45 degrees
    return line("",
                fmt::format("under {:.3g} N/m, the weight of block '{}', a flush face of {:.3g} m closes by "
                            "{:.3g} m and a right-angled corner sinks by {:.3g} m; under all mobile blocks, "
                            "{:.3g} N/m, a corner by {:.3g} m",
                            heaviest_.weight, block_name(simulation_.scene(), heaviest_.block),
                            heaviest_.size, heaviest_.weight / (law.normal_stiffness * heaviest_.size),
                            corner_sinking(heaviest_.weight, law.normal_stiffness, deepest), weight_of_all_,
                            corner_sinking(weight_of_all_, law.normal_stiffness, deepest)));
  }

  void weigh() {
    const double gravity = norm(simulation_.scene().run.gravity);
    ExactSum sum;
    Heaviest mine;
    const BlockSystem &blocks = simulation_.blocks();
    for (const BlockProperties &block : std::span(blocks.properties).first(blocks.num_owned)) {
      const double weight = block.keeps_its_velocity() ? 0.0 : block.mass * gravity; // borne by its drive
      sum.add(weight);
      mine.see({weight, std::sqrt(block.area), block.id.value});
    }
    communicator_.sum(sum.limbs());
    weight_of_all_ = sum.value();
    for (const auto &other : communicator_.all_gather(std::vector<Heaviest>{mine})) {
      heaviest_.see(other[0]);
    }
  }

  std::string step_lines() {
    const StepBound &bound = simulation_.bound();
    const TimePlan &plan = simulation_.plan();
    const bool given = simulation_.scene().run.time_step > 0.0;
    std::string text =
        line("step", fmt::format("{:.6g} s ({}), {}", plan.time_step, given ? "as given" : "automatic",
                                 words_on_steps(simulation_)));
    if (bound.is_set_by_motion()) {
      return text + line("", words_on_motion_bound(simulation_)) + rayleigh_line();
    }
    if (bound.block < 0 || bound.omega_max <= 0.0) {
      return text + line("", "nothing limits it: forces move no block");
    }
    return text +
           line("", fmt::format("at most {:.6g} s = safety {:g} x limit {:.4g} / omega_max {:.6g} rad/s, "
                                "set by block '{}'",
                                bound.time_step, bound.safety, bound.limit, bound.omega_max,
                                block_name(simulation_.scene(), bound.block))) +
           rayleigh_line();
  }

  /// Its cost, too.
  std::string rayleigh_line() {
    const Rayleigh &rayleigh = simulation_.scene().run.rayleigh;
    const StepBound &bound = simulation_.bound();
    if (!rayleigh.present()) {
      return "";
    }
    const double frequency = bound.omega_max / (2.0 * std::numbers::pi);
    return line(
        "damping",
        fmt::format("Rayleigh, alpha {:.4g} 1/s, beta {:.4g} s; ratio {:.3g} at the {:.4g} Hz of the "
                    "fastest joint: without it the step would be at most {:.6g} s, {:.3g} times as long",
                    rayleigh.mass_damping, rayleigh.stiffness_damping,
                    0.5 * rayleigh.stiffness_damping * bound.omega_max, frequency, bound.undamped_step,
                    bound.undamped_step / bound.stable_step));
  }

  /// Where a stage has its own, and what it costs if the joints and bolts are those of the start.
  std::string rayleigh_of(const Stage &stage, double &before) {
    const double now = stage.after ? stage.after->run.rayleigh.stiffness_damping : before;
    const double omega = simulation_.bound().omega_max;
    if (std::exchange(before, now) == now || now == 0.0 || omega == 0.0) {
      return "";
    }
    const double ratio = 0.5 * now * omega;
    return fmt::format(
        ", Rayleigh damping with ratio {:.3g} at the fastest joint: without it the step would be "
        "{:.3g} times as long",
        ratio, stability_limit(simulation_.scheme(), 0.0) / stability_limit(simulation_.scheme(), ratio));
  }

  std::string stage_lines() {
    std::string text;
    double damping = simulation_.scene().run.rayleigh.stiffness_damping;
    for (const Stage &stage : simulation_.stages()) {
      std::string what =
          stage.kind == StageKind::excavate
              ? stage.relax > 0.0 ? fmt::format(", forces fall to zero in {:g} s", stage.relax) : ""
          : stage.until_verdict ? fmt::format(", until unbalanced forces are {:g}, {:g} s at most",
                                              stage.tolerance, stage.duration)
          : stage.takes_steps() ? fmt::format(", {:g} s", stage.duration)
                                : "";
      text += line("stage", fmt::format("'{}': {}{}{}", stage.name, word_of(stage.kind), what,
                                        rayleigh_of(stage, damping)));
    }
    return text;
  }

  std::string water_lines() {
    std::string text;
    for (const Water &water : simulation_.scene().water) {
      const auto [low, high] = std::minmax_element(water.phreatic.begin(), water.phreatic.end(),
                                                   [](Vec2 a, Vec2 b) { return a.y < b.y; });
      std::string wets;
      for (const std::int32_t joint : water.joints) {
        wets += fmt::format("{}'{}'", wets.empty() ? "" : ", ",
                            simulation_.scene().joints.laws[static_cast<std::size_t>(joint)].name);
      }
      text += line("water", fmt::format("'{}': level between {} and {} m, in {}{}", water.name,
                                        coordinate_text(low->y), coordinate_text(high->y),
                                        wets.empty() ? "all joints" : "joint " + wets,
                                        water.active ? "" : ", put in by a stage"));
    }
    return text;
  }

  std::string support_lines() {
    const auto waiting = [](const auto &list) {
      return std::count_if(list.begin(), list.end(), [](const auto &one) { return !one.active; });
    };
    const std::vector<BoltLink> &links = simulation_.bolts().links();
    const auto elements =
        std::count_if(links.begin(), links.end(), [](const BoltLink &link) { return link.liner >= 0; });
    const Scene &scene = simulation_.scene();
    std::string text;
    if (!scene.bolts.empty()) {
      text +=
          line("bolts", fmt::format("{}, {} of them put in by a stage; {} links across joints now",
                                    scene.bolts.size(), waiting(scene.bolts), std::ssize(links) - elements));
    }
    if (!scene.liners.empty()) {
      text += line("liners", fmt::format("{}, {} of them put in by a stage; {} elements between blocks now",
                                         scene.liners.size(), waiting(scene.liners), elements));
    }
    return text;
  }

  std::string contact_line() {
    std::int64_t candidates = 0;
    std::int64_t touching = 0;
    for (std::size_t k = 0; k < simulation_.candidates().pairs.size(); ++k) {
      if (simulation_.counts_here(simulation_.candidates().pairs[k])) {
        ++candidates;
        touching += simulation_.history().is_living(k) ? 1 : 0;
      }
    }
    touching_ = total(communicator_, touching);
    return line("contacts", fmt::format("{} pairs may touch, {} touch at the start",
                                        total(communicator_, candidates), touching_));
  }

  // What a run on that many ranks would do first, from the same weights.
  void partition() {
    const CellGrid &grid = simulation_.domain_map().grid;
    const BlockSystem &blocks = simulation_.blocks();
    std::vector<Vec2> centroids;
    for (std::size_t row = 0; row < blocks.num_owned; ++row) {
      centroids.push_back(blocks.centroid(row));
    }
    const auto weights =
        weights_by_cell(communicator_, grid, centroids, work_of_blocks(blocks, simulation_.candidates()));
    map_ = partition_cells(grid, weights, num_subdomains_, &partition_);
  }

  std::string partition_line() {
    std::vector<std::int64_t> counts(static_cast<std::size_t>(num_subdomains_), 0);
    for (std::size_t row = 0; row < simulation_.blocks().num_owned; ++row) {
      ++counts[static_cast<std::size_t>(map_.rank_of(simulation_.blocks().centroid(row)))];
    }
    communicator_.sum(counts);
    return line("subdomains",
                fmt::format("{} by {}: {} to {} blocks each, imbalance of the work {:.3f}", num_subdomains_,
                            partition_.by_metis ? "METIS" : "space-filling curve",
                            *std::min_element(counts.begin(), counts.end()),
                            *std::max_element(counts.begin(), counts.end()), partition_.imbalance));
  }

  std::string cost_lines() {
    const BlockSystem &blocks = simulation_.blocks();
    const TimePlan &plan = simulation_.plan();
    const double memory = static_cast<double>(total(communicator_, state_bytes(simulation_)));
    const std::int64_t points =
        total(communicator_, blocks.vertex_begin[blocks.num_owned]) +
        static_cast<std::int64_t>(blocks.reference_vertex.size() - blocks.vertex_begin[blocks.first_fixed()]);
    // f64: five fields of cell data with 1 or 3 columns and the kind; points; a contact is a line of two
    // points.
    const bool contacts = simulation_.scene().output.contacts;
    const double frame = 105.0 * static_cast<double>(simulation_.num_blocks()) +
                         24.0 * static_cast<double>(points) +
                         (contacts ? 150.0 * static_cast<double>(touching_) : 0.0) + 16e3;
    const std::int64_t num_frames = plan.num_steps / plan.steps_per_output + 1;
    const auto frames = static_cast<double>(num_frames);
    return line("memory", fmt::format("{} of state, all ranks together", bytes_text(memory))) +
           line("run time", words_on_run_time()) +
           line("output", fmt::format("{:.0f} frames of about {}, {} in all", frames, bytes_text(frame),
                                      bytes_text(frame * frames)));
  }

  std::string words_on_run_time() {
    const bool is_static = begins_statically(simulation_);
    const double count = is_static ? 100.0 : static_cast<double>(simulation_.plan().num_steps);
    const std::string ranks =
        fmt::format("on {} rank{}", communicator_.size(), communicator_.size() == 1 ? "" : "s");
    const std::string seconds = seconds_text(seconds_per_step() * count);
    return is_static ? fmt::format("about {} for a hundred evaluations of the static solver {} as it starts "
                                   "now, and a stage needs one or a few hundred",
                                   seconds, ranks)
                     : fmt::format("about {} of stepping {} as it starts now", seconds, ranks);
  }

  double seconds_per_step() {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    constexpr double longest = 2.0; // s
    double elapsed = 0.0;
    int steps = 0;
    while (steps < 20 && elapsed < longest && !simulation_.finished()) {
      simulation_.step();
      ++steps;
      elapsed = std::chrono::duration<double>(Clock::now() - start).count();
      communicator_.max(std::span(&elapsed, 1));
    }
    return steps > 0 ? elapsed / steps : 0.0;
  }

  std::string oddity_lines() {
    const OddBlocks odd = odd_blocks(communicator_, simulation_.blocks());
    const auto name = [&](const Oddity &oddity) { return block_name(simulation_.scene(), oddity.block); };
    return line("corners",
                fmt::format("{} blocks with a needle below {:g} degrees; the sharpest corner has {:.3g} "
                            "degrees, block '{}'",
                            odd.needles.count, needle_angle, odd.needles.worst, name(odd.needles))) +
           line("slivers",
                fmt::format("{} blocks narrower than {:g} of sqrt(area); the narrowest has {:.3g}, "
                            "block '{}'",
                            odd.slivers.count, sliver_ratio, odd.slivers.worst, name(odd.slivers)));
  }

  void draw() {
    std::string trouble;
    if (simulation_.num_blocks() > most_drawn) {
      throw FileError(fmt::format("error: a picture of {} blocks is too large, at most {} are drawn, leave "
                                  "--svg out and look at the frames of a short run",
                                  simulation_.num_blocks(), most_drawn));
    }
    const std::vector<DrawnBlock> drawn = gather_drawn();
    if (communicator_.is_root()) {
      std::ofstream file(options_.svg, std::ios::binary);
      file << draw_svg(drawn, num_subdomains_);
      file.close();
      trouble =
          file ? "" : options_.svg.string() + ": error: cannot write the picture, check path and rights";
    }
    communicator_.broadcast(trouble);
    if (!trouble.empty()) {
      throw FileError(trouble);
    }
  }

  std::vector<DrawnBlock> gather_drawn() {
    struct Corner {
      std::int64_t block;
      std::int32_t subdomain;
      std::int32_t deformable;
      Vec2 at;
    };
    const BlockSystem &blocks = simulation_.blocks();
    std::vector<std::vector<Corner>> corners(static_cast<std::size_t>(communicator_.size()));
    for (std::size_t row = 0; row < blocks.num_rows(); ++row) {
      const bool fixed = blocks.is_fixed(row);
      if (row < blocks.num_owned || (fixed && communicator_.is_root())) {
        const std::int32_t subdomain = fixed ? -1 : map_.rank_of(blocks.centroid(row));
        for (const Vec2 x : current_vertices(blocks, row)) {
          corners[0].push_back({blocks.properties[row].id.value, subdomain, blocks.is_deformable(row), x});
        }
      }
    }
    std::vector<DrawnBlock> drawn;
    for (const auto &from_rank : communicator_.all_to_all(corners)) {
      std::int64_t last = -1;
      for (const Corner &corner : from_rank) {
        if (corner.block != last) {
          drawn.push_back({{}, corner.subdomain, corner.deformable != 0});
          last = corner.block;
        }
        drawn.back().vertices.push_back(corner.at);
      }
    }
    return drawn;
  }

  Communicator communicator_;
  InspectOptions options_;
  Simulation simulation_;
  int num_subdomains_ = 1;
  DomainMap map_;
  PartitionReport partition_;
  std::int64_t num_mobile_ = 0;
  Heaviest heaviest_;
  double weight_of_all_ = 0.0; ///< of all mobile blocks, N/m
  std::int64_t touching_ = 0;
};

} // namespace

std::string inspect_scene(const Communicator &communicator, const Scene &scene,
                          const InspectOptions &options) {
  return Inspection(communicator, scene, options).report();
}

} // namespace gcpdda
