// gcpdda blocks: cut, check and draw without a run. Every rank cuts its share of the tiles; only counts, the
// worst blocks and, for the picture, drawings travel.

#include "app/blocks.hpp"

#include "app/joint_drawing.hpp"
#include "app/root_file.hpp"
#include "base/input_file.hpp"
#include "blockgen/drawing.hpp"
#include "blockgen/joint_map.hpp"
#include "blockgen/quality.hpp"
#include "blockgen/region_cutter.hpp"
#include "blockgen/set_statistics.hpp"
#include "gcpdda/blockgen/region_blocks.hpp"
#include "geometry/point_text.hpp"
#include "geometry/polygon.hpp"
#include "io/blocks/block_file_writer.hpp"
#include "io/results/id_slabs.hpp"
#include "io/results/result_directory.hpp"
#include "model/generators.hpp"
#include "simulation/dust.hpp"
#include "simulation/rank_facts.hpp"
#include "simulation/region_slabs.hpp"
#include "simulation/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <numeric>
#include <optional>

namespace gcpdda {

namespace {

constexpr std::int64_t longest_map = 256 << 20; // bytes

std::int64_t agreed_sum(const Communicator &world, std::int64_t value) {
  world.sum(std::span(&value, 1));
  return value;
}

double agreed_sum(const Communicator &world, ExactSum sum) {
  world.sum(sum.limbs());
  return sum.value();
}

/// What all ranks know of the blocks together.
struct Report {
  BlockQuality quality; ///< without all_areas
  CutReport cut;
  std::int64_t num_tiles = 0;
  std::int64_t first_id = 0; ///< of the region
  double area = 0.0;         ///< of the blocks, m2
  double region_area = 0.0;
  double excavated_area = 0.0;
  double median_area = 0.0;
  double perimeter = 0.0;                    ///< of the blocks, m
  std::vector<std::int64_t> in_opening;      ///< blocks, by opening
  std::vector<blockgen::SetStatistics> sets; ///< on the root only

  /// Of the areas that should be equal, relative.
  [[nodiscard]] double difference() const { return (area + excavated_area - region_area) / region_area; }
};

std::vector<PoorBlock> worst_of_all(const Communicator &world, const std::vector<PoorBlock> &mine) {
  std::vector<PoorBlock> all;
  for (const std::vector<PoorBlock> &theirs : world.all_gather(mine)) {
    all.insert(all.end(), theirs.begin(), theirs.end());
  }
  keep_worst(all);
  return all;
}

void agree(const Communicator &world, BlockQuality &quality) {
  for (std::int64_t *count : {&quality.num_blocks, &quality.num_fixed, &quality.num_vertices,
                              &quality.num_non_convex, &quality.num_needles, &quality.num_slivers}) {
    *count = agreed_sum(world, *count);
  }
  world.sum(quality.areas.counts());
  world.sum(quality.edges.counts());
  quality.sharpest = worst_of_all(world, quality.sharpest);
  quality.narrowest = worst_of_all(world, quality.narrowest);
}

/// How many blocks the ranks before this one have cut.
std::int64_t blocks_before(const Communicator &world, const std::vector<SceneBlock> &blocks) {
  const auto counts = counts_by_rank(world, static_cast<std::int64_t>(blocks.size()));
  return std::accumulate(counts.begin(), counts.begin() + world.rank(), std::int64_t{0});
}

Report survey(const Communicator &world, const Scene &scene, const RegionCutter &cutter,
              const std::vector<SceneBlock> &blocks, const CutReport &cut) {
  Report report;
  report.num_tiles = cutter.num_columns() * cutter.num_rows();
  report.first_id = num_blocks(scene);
  std::int64_t id = report.first_id + blocks_before(world, blocks);
  report.in_opening.assign(scene.region.openings.size(), 0);
  for (const SceneBlock &block : blocks) {
    report.quality.add(id++, block);
    if (block.opening >= 0) {
      ++report.in_opening[static_cast<std::size_t>(block.opening)];
    }
  }
  world.sum(report.in_opening);
  report.median_area = agreed_median(world, report.quality.all_areas);
  report.area = agreed_sum(world, report.quality.area);
  report.perimeter = agreed_sum(world, report.quality.perimeter);
  report.excavated_area = agreed_sum(world, cut.excavated_area);
  report.region_area = signed_area(scene.region.outline);
  agree(world, report.quality);
  if (world.is_root()) {
    report.sets = blockgen::set_statistics(scene.region);
  }
  report.cut.merged_slivers = agreed_sum(world, cut.merged_slivers);
  report.cut.cut_rings = agreed_sum(world, cut.cut_rings);
  report.cut.t_junctions = agreed_sum(world, cut.t_junctions);
  for (const std::vector<Vec2> &theirs : world.all_gather(cut.kept_slivers)) {
    report.cut.kept_slivers.insert(report.cut.kept_slivers.end(), theirs.begin(), theirs.end());
  }
  return report;
}

std::string line(const char *what, const std::string &text) {
  return fmt::format("{:<10} {}\n", what, text);
}

std::string worst_lines(const char *what, const std::vector<PoorBlock> &blocks, const char *unit,
                        double limit) {
  std::string text;
  for (const PoorBlock &block : blocks) {
    if (block.value < limit) {
      text += line(text.empty() ? what : "", fmt::format("b{} at {}: {:.3g}{}", block.id,
                                                         point_text(block.centroid), block.value, unit));
    }
  }
  return text;
}

std::string histogram_lines(const char *what, const PowerHistogram &histogram, const char *unit) {
  const auto counts = histogram.counts();
  const std::int64_t most = *std::max_element(counts.begin(), counts.end());
  std::string text;
  for (std::size_t bin = 0; bin < counts.size(); ++bin) {
    if (counts[bin] > 0) {
      constexpr double longest_bar = 40.0;
      const double length = longest_bar * static_cast<double>(counts[bin]) / static_cast<double>(most);
      text += line(text.empty() ? what : "",
                   fmt::format("{:>9.3g} to {:<9.3g} {}  {:>9}  {}", PowerHistogram::low(bin),
                               2.0 * PowerHistogram::low(bin), unit, counts[bin],
                               std::string(static_cast<std::size_t>(std::ceil(length)), '#')));
    }
  }
  return text;
}

std::string text_of(const Report &report, const Scene &scene) {
  const BlockQuality &q = report.quality;
  std::string text = fmt::format("scene '{}'\n", scene.stem);
  text += line("blocks", fmt::format("{} cut in {} tile{}, b{} to b{}, and {} fixed along the sides",
                                     q.num_blocks, report.num_tiles, report.num_tiles == 1 ? "" : "s",
                                     report.first_id, report.first_id + q.num_blocks - 1, q.num_fixed));
  text += line(
      "area",
      fmt::format("{:.9g} m2 of blocks + {:.9g} m2 excavated = {:.9g} m2 of region, but for {:.1e} of it",
                  report.area, report.excavated_area, report.region_area, std::abs(report.difference())));
  text += line("size", fmt::format("median area {:.4g} m2, median side (its root) {:.4g} m",
                                   report.median_area, std::sqrt(report.median_area)));
  text += line("shape", fmt::format("{} vertices, {} blocks not convex, {} T junctions", q.num_vertices,
                                    q.num_non_convex, report.cut.t_junctions));
  text += line("mended", fmt::format("{} slivers merged, {} kept; {} rings cut", report.cut.merged_slivers,
                                     report.cut.kept_slivers.size(), report.cut.cut_rings));
  for (std::size_t k = 0; k < scene.region.openings.size(); ++k) {
    const Opening &opening = scene.region.openings[k];
    text += line("opening", opening.excavated
                                ? fmt::format("'{}': excavated", opening.name)
                                : fmt::format("'{}': {} blocks", opening.name, report.in_opening[k]));
  }
  const std::vector<std::string> set_words = blockgen::words_on_sets(scene.region, report.sets);
  for (const std::string &words : set_words) {
    text += line(&words == &set_words.front() ? "joint sets" : "", words);
  }
  text += histogram_lines("areas", q.areas, "m2");
  text += histogram_lines("edges", q.edges, "m");
  text += line("corners", fmt::format("{} blocks with one below {:g} degrees", q.num_needles,
                                      BlockQuality::needle_angle));
  text += worst_lines("", q.sharpest, " degrees", BlockQuality::needle_angle);
  text += line("thin", fmt::format("{} blocks with a mean width below {:g} of their size", q.num_slivers,
                                   BlockQuality::sliver_ratio));
  return text + worst_lines("", q.narrowest, " of its size", BlockQuality::sliver_ratio);
}

std::string json_of(const PowerHistogram &histogram) {
  std::string text;
  for (std::size_t bin = 0; bin < histogram.counts().size(); ++bin) {
    if (histogram.counts()[bin] > 0) {
      text += fmt::format("{}[{:g}, {}]", text.empty() ? "" : ", ", PowerHistogram::low(bin),
                          histogram.counts()[bin]);
    }
  }
  return "[" + text + "]";
}

std::string json_of(const std::vector<PoorBlock> &blocks) {
  std::string text;
  for (const PoorBlock &block : blocks) {
    text += fmt::format("{}{{\"block\": \"b{}\", \"x\": {:.17g}, \"y\": {:.17g}, \"value\": {:.17g}}}",
                        text.empty() ? "" : ", ", block.id, block.centroid.x, block.centroid.y, block.value);
  }
  return "[" + text + "]";
}

std::string json_of(const Report &report, const Scene &scene) {
  const BlockQuality &q = report.quality;
  std::string openings;
  for (std::size_t k = 0; k < scene.region.openings.size(); ++k) {
    openings += fmt::format("{}\"{}\": {}", openings.empty() ? "" : ", ", scene.region.openings[k].name,
                            report.in_opening[k]);
  }
  std::string text = "{\n";
  const auto add = [&](const char *key, const auto &value) {
    text += fmt::format("  \"{}\": {},\n", key, value);
  };
  add("blocks", q.num_blocks);
  add("fixed_blocks", q.num_fixed);
  add("first_id", report.first_id);
  add("tiles", report.num_tiles);
  add("vertices", q.num_vertices);
  add("area", fmt::format("{:.17g}", report.area));
  add("excavated_area", fmt::format("{:.17g}", report.excavated_area));
  add("region_area", fmt::format("{:.17g}", report.region_area));
  add("median_area", fmt::format("{:.17g}", report.median_area));
  add("non_convex", q.num_non_convex);
  add("t_junctions", report.cut.t_junctions);
  add("merged_slivers", report.cut.merged_slivers);
  add("kept_slivers", report.cut.kept_slivers.size());
  add("cut_rings", report.cut.cut_rings);
  add("needles", q.num_needles);
  add("slivers", q.num_slivers);
  add("openings", "{" + openings + "}");
  add("joint_sets", blockgen::json_of_sets(scene.region, report.sets));
  add("areas_from", json_of(q.areas));
  add("edges_from", json_of(q.edges));
  add("sharpest", json_of(q.sharpest));
  text += fmt::format("  \"narrowest\": {}\n}}\n", json_of(q.narrowest));
  return text;
}

void draw(const Communicator &world, const Scene &scene, const std::vector<SceneBlock> &blocks,
          const Report &report, const std::string &path) {
  const std::int64_t count = report.quality.num_blocks + report.quality.num_fixed;
  if (count > RegionDrawing::most_blocks) {
    throw FileError(
        fmt::format("error: a picture of {} blocks is too large, at most {} are drawn, leave --svg out "
                    "or draw a part of the region",
                    count, RegionDrawing::most_blocks));
  }
  const RegionDrawing drawing(scene);
  const std::string mine = drawing.blocks(blocks);
  std::vector<std::vector<char>> to_root(static_cast<std::size_t>(world.size()));
  to_root[0].assign(mine.begin(), mine.end());
  std::string text = drawing.head();
  for (const std::vector<char> &theirs : world.all_to_all(to_root)) {
    text.append(theirs.begin(), theirs.end());
  }
  write_on_root(world, path, text + drawing.end(report.quality.sharpest, report.quality.narrowest),
                "the picture");
}

/// Traces of a map, the same on all ranks.
/// @param kept  file with the lines of a drawing that a run has kept; empty for none
JointMapReading read_map(const Communicator &world, JointMap &map, const std::filesystem::path &kept) {
  if (!is_drawing(map.path)) {
    return read_joint_map(read_on_root(world, map.path, "the joint map", longest_map), map.path);
  }
  std::string trouble;
  DrawnLines drawn;
  if (world.is_root()) {
    const bool is_kept = !kept.empty() && std::filesystem::exists(kept);
    const std::string source = is_kept ? kept.string() : map.path;
    trouble = look_at_input_file(source).trouble;
    if (trouble.empty() && is_kept) {
      drawn.geojson = read_input_file(source, longest_map).text;
    } else if (trouble.empty()) {
      drawn = lines_of_drawing(map);
    }
    map.converted = std::make_shared<const std::string>(drawn.geojson);
  }
  for (std::string *text : {&trouble, &drawn.what, &drawn.why, &drawn.hint, &drawn.geojson}) {
    world.broadcast(*text);
  }
  if (!trouble.empty()) {
    throw FileError(map.path + ": error: cannot open the joint map, " + trouble + ", check the path");
  }
  if (!drawn.what.empty()) {
    return {{}, {{Severity::error, map.where, drawn.what, drawn.why, drawn.hint}}};
  }
  return read_joint_map(drawn.geojson, map.path + ".geojson");
}

} // namespace

void tell_joint_sets(const Communicator &world, const Scene &scene, RunOptions &options) {
  if (!world.is_root()) {
    return;
  }
  const std::vector<blockgen::SetStatistics> all = blockgen::set_statistics(scene.region);
  for (std::size_t i = 0; i < all.size(); ++i) {
    JointSetSummary &set = options.joint_sets.emplace_back();
    set.name = blockgen::bare_name(scene.region.joint_sets[i]);
    set.asked = all[i].asked;
    if (all[i].is_drawn) {
      set.drawn = all[i].drawn;
      set.joints = all[i].joints;
      set.lines = all[i].lines;
    }
  }
  for (const std::string &words : blockgen::words_on_sets(scene.region, all)) {
    options.words_on_joint_sets.push_back("joint set " + words);
  }
}

std::string words_on_joint_sets(const Scene &scene) {
  std::string text;
  for (const std::string &words :
       blockgen::words_on_sets(scene.region, blockgen::set_statistics(scene.region))) {
    text += fmt::format("{:<11} {}\n", text.empty() ? "joint sets" : "", words);
  }
  return text;
}

void prepare_region(const Communicator &world, Scene &scene, const std::string &kept_in) {
  if (!scene.region.present()) {
    return;
  }
  Diagnostics faults;
  for (std::size_t i = 0; i < scene.region.maps.size(); ++i) {
    JointMap &map = scene.region.maps[i];
    JointMapReading reading =
        read_map(world, map, kept_in.empty() ? std::filesystem::path() : kept_joint_map(kept_in, i));
    map.lines = std::move(reading.lines);
    faults.insert(faults.end(), reading.faults.begin(), reading.faults.end());
  }
  if (!faults.empty()) {
    throw SceneError(faults);
  }
  cut_region(scene);
}

void cut_blocks(const Communicator &world, const Scene &scene, const BlocksOptions &options) {
  if (!scene.region.present()) {
    throw SceneError({{Severity::error,
                       {},
                       "the scene has no region",
                       "there is nothing to cut",
                       "write [region], or use gcpdda inspect"}});
  }
  const RegionCutter cutter(scene);
  CutReport cut;
  BlockSource::Made made = cutter.make(slab_begin(cutter.num_tiles(), world.size(), world.rank()),
                                       slab_begin(cutter.num_tiles(), world.size(), world.rank() + 1), cut);
  if (const Diagnostics faults = all_faults(world, made.faults); has_errors(faults)) {
    throw SceneError(faults);
  }
  const Report report = survey(world, scene, cutter, made.blocks, cut);
  const std::int64_t first = report.first_id + blocks_before(world, made.blocks);
  const std::optional<Diagnostic> dust = doubt_dust(world, scene.region, made.blocks, first, report.first_id);
  if (world.is_root()) {
    std::cout << text_of(report, scene) << (dust ? to_string(*dust) + "\n" : "") << std::flush;
  }
  if (!options.json.empty()) {
    write_on_root(world, options.json, json_of(report, scene), "the report");
  }
  if (!options.out.empty()) {
    write_block_file(world, options.out, made.blocks);
  }
  if (!options.svg.empty()) {
    draw(world, scene, made.blocks, report, options.svg);
  }
  // Vertices are rounded, and straight ones left out within that. Where GEOS has to node on a grid, that is
  // coarser than rounding near the origin.
  constexpr double grid = 1e-10;
  const double rounding = cutter.rounding() * report.perimeter / report.region_area;
  if (std::abs(report.difference()) > std::max(grid, rounding)) {
    throw InternalError(
        fmt::format("the blocks have {:.3g} of the region's area too much", report.difference()));
  }
}

} // namespace gcpdda
