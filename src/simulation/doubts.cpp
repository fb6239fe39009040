#include "simulation/doubts.hpp"

#include "base/edit_distance.hpp"
#include "base/round_numbers.hpp"
#include "contact/stiffness_bound.hpp"
#include "geometry/holds_point.hpp"
#include "geometry/mean_width.hpp"
#include "geometry/polygon.hpp"
#include "io/results/id_slabs.hpp"
#include "simulation/dust.hpp"
#include "simulation/far_coordinates.hpp"
#include "simulation/fault_doubts.hpp"
#include "simulation/plausibility.hpp"
#include "simulation/rank_facts.hpp"
#include "simulation/stage_changes.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <set>

namespace gcpdda {

namespace {

SourcePosition place_in(const Scene &scene, const std::string &path) {
  const auto found = scene.places.find(path);
  return found == scene.places.end() ? SourcePosition{} : found->second;
}

std::string and_more(std::int64_t others, const char *what) {
  return others > 0 ? fmt::format(" ({} more {})", others, what) : "";
}

/// Laws that something of the region asks for, wherever it lies.
void note_laws_of_region(const RockRegion &region, std::vector<std::int64_t> &used) {
  const auto note = [&](const auto &parts) {
    for (const auto &part : parts) {
      if (part.joint >= 0) {
        used[static_cast<std::size_t>(part.joint)] = 1;
      }
    }
  };
  note(region.joint_sets);
  note(region.faults);
  note(region.maps);
  note(region.openings);
  note(region.layers);
  note(region.voronoi);
  note(region.bricks);
}

void warn_of_unused(const Scene &scene, const char *table, const std::vector<std::string> &names,
                    const std::vector<std::int64_t> &used, Diagnostics &notes) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (used[i] != 0) {
      continue;
    }
    std::vector<std::string> others = names;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const std::string near = nearest_word(names[i], others);
    notes.push_back({Severity::warning, place_in(scene, fmt::format("{}.{}", table, names[i])),
                     fmt::format("nothing uses [{}.{}]", table, names[i]), "its values change nothing",
                     near.empty() ? "name it where it is meant, or leave it out"
                                  : fmt::format("did you mean '{}'?", near)});
  }
}

/// Two edges that face each other and run along each other for at least half of the shorter one.
struct Gap {
  double width = 0.0; ///< m
  std::int64_t lower = -1;
  std::int64_t higher = -1;
};

/// What lies between two edges that face each other.
struct Between {
  double width = std::numeric_limits<double>::infinity(); ///< m; infinite where they do not
  Vec2 middle;
};

Between between(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  constexpr double parallel = 0.9994; // cos 2 degrees
  const double length = norm(b - a);
  const double other = norm(d - c);
  const Vec2 along = (1.0 / length) * (b - a);
  if (dot(along, d - c) > -parallel * other) {
    return {};
  }
  const double end = dot(c - a, along);
  const double from = std::max(0.0, dot(d - a, along));
  const double to = std::min(length, end);
  if (to - from < 0.5 * std::min(length, other)) {
    return {};
  }
  const Vec2 outwards = -perp(along); // counter-clockwise: the interior lies on the left
  const double first = dot(c - a, outwards);
  const double second = dot(d - a, outwards);
  if (std::min(first, second) <= 0.0) {
    return {};
  }
  const double at = 0.5 * (from + to);
  const double across = first + (second - first) * (end - at) / dot(c - d, along);
  return {std::max(first, second), a + at * along + (0.5 * across) * outwards};
}

/// Between the edges of two blocks that are nearest to each other.
Between between(std::span<const Vec2> first, std::span<const Vec2> second) {
  Between nearest;
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (std::size_t k = 0; k < second.size(); ++k) {
      const Between edges =
          between(first[i], first[(i + 1) % first.size()], second[k], second[(k + 1) % second.size()]);
      nearest = edges.width < nearest.width ? edges : nearest;
    }
  }
  return nearest;
}

/// For each block the candidates for contact with it.
std::vector<std::vector<std::size_t>> neighbours_of_blocks(const RunState &run) {
  std::vector<std::vector<std::size_t>> neighbours(run.blocks.properties.size());
  for (const CandidatePair &pair : run.neighbours.candidates.pairs) {
    neighbours[pair.lower.value].push_back(pair.higher.value);
    neighbours[pair.higher.value].push_back(pair.lower.value);
  }
  return neighbours;
}

/// Bricks of one wall or pyramid stand apart where it says so.
bool is_given_gap(const Scene &scene, std::int64_t a, std::int64_t b) {
  auto first = static_cast<std::int64_t>(scene.blocks.size());
  for (const BrickGenerator &generator : scene.generators) {
    const std::int64_t end = first + num_blocks(generator);
    if (generator.gap > 0.0 && a >= first && b >= first && a < end && b < end) {
      return true;
    }
    first = end;
  }
  return false;
}

/// Loads of the scene that their blocks hardly feel, the forces of one block together.
void warn_of_light_loads(const Scene &scene, Diagnostics &notes) {
  constexpr double least_share = 1e-3; // as if N were kN
  std::int64_t count = 0;
  Diagnostic warning;
  for (const SceneBlock &block : scene.blocks) {
    const double weight = scene.materials[static_cast<std::size_t>(block.material)].density *
                          signed_area(block.vertices) * norm(scene.run.gravity);
    for (const PointLoad &load : block.loads) {
      double factor = load.table.empty() ? 1.0 : 0.0;
      for (const LoadRow &row : load.table) {
        factor = std::max(factor, std::abs(row.factor));
      }
      const double force = factor * norm(load.force);
      if (force > 0.0 && force < least_share * weight && count++ == 0) {
        warning = {
            Severity::warning, block.where,
            fmt::format("a load of block '{}' is {:.3g} N/m at most, and the block weighs {:.3g} N/m",
                        block.name, force, weight),
            "the block hardly feels it",
            fmt::format("if it is in kN/m, write [{:g}, {:g}]", 1e3 * load.force.x, 1e3 * load.force.y)};
      }
    }
  }
  if (count > 0) {
    warning.what += and_more(count - 1, "like it");
    notes.push_back(std::move(warning));
  }
}

// A law is used by edges, by a part of the region or by a pair of materials that are.
void doubt_use(RunState &run, std::span<const SceneBlock> slab) {
  std::vector<std::int64_t> materials(run.scene.materials.size(), 0);
  for (const SceneBlock &block : slab) {
    materials[static_cast<std::size_t>(block.material)] = 1;
  }
  if (run.scene.region.present()) {
    materials[static_cast<std::size_t>(run.scene.region.material)] = 1;
    for (const Layer &layer : run.scene.region.layers) {
      materials[static_cast<std::size_t>(layer.material)] = 1;
    }
  }
  run.communicator.max(materials);
  const JointLaws &joints = run.scene.joints;
  std::vector<std::int64_t> laws(joints.laws.size(), 0);
  std::vector<std::string> names;
  laws[0] = 1; // the others take what they do not say from it
  for (std::size_t i = 0; i < laws.size(); ++i) {
    names.push_back(joints.laws[i].name);
    laws[i] = std::max<std::int64_t>(laws[i], joints.laws[i].is_on_edges ? 1 : 0);
  }
  note_laws_of_region(run.scene.region, laws);
  for (std::int32_t a = 0; a < joints.num_materials; ++a) {
    for (std::int32_t b = 0; b < joints.num_materials; ++b) {
      if (materials[static_cast<std::size_t>(a)] != 0 && materials[static_cast<std::size_t>(b)] != 0) {
        laws[static_cast<std::size_t>(joints.between(a, b))] = 1;
      }
    }
  }
  warn_of_unused(run.scene, "joint", names, laws, run.notes);
  names.clear();
  for (const Material &material : run.scene.materials) {
    names.push_back(material.name);
  }
  warn_of_unused(run.scene, "material", names, materials, run.notes);
}

void doubt_holds(RunState &run, std::span<const SceneBlock> slab) {
  const auto is_held = [](const SceneBlock &b) { return b.fixed || b.driven || !b.fixed_points.empty(); };
  const auto can_move = [](const SceneBlock &b) { return !b.fixed; };
  const std::int64_t held = total(run.communicator, std::count_if(slab.begin(), slab.end(), is_held));
  const std::int64_t mobile = total(run.communicator, std::count_if(slab.begin(), slab.end(), can_move));
  const Vec2 gravity = run.scene.run.gravity;
  const bool is_carried =
      std::any_of(run.scene.in_situ.boundaries.begin(), run.scene.in_situ.boundaries.end(),
                  [&](const Boundary &side) { return dot(side.normal, gravity) > 0.0; });
  if (held == 0 && norm(gravity) > 0.0 && !is_carried) {
    run.notes.push_back({Severity::warning, place_in(run.scene, "run.gravity"),
                         "gravity acts and no block is fixed, held at a point or driven",
                         "all blocks fall together",
                         "write fixed = true for a block below them, or region.fixed = [\"bottom\"]"});
  }
  if (mobile == 0) {
    run.notes.push_back({Severity::warning,
                         {},
                         "all blocks are fixed",
                         "nothing moves",
                         "leave fixed = true out where a block is to move"});
  }
}

// One line where a wrong stiffness shows in all contacts. Under in-situ stress they would all be refused.
void doubt_stiffness(RunState &run, double pressure, double size) {
  constexpr double largest_share = 0.01;
  constexpr double good_share = 1e-3;
  constexpr double hopeless_share = 0.5;
  std::int64_t others = -1;
  Diagnostic warning;
  for (const JointLaw &law : run.scene.joints.laws) {
    const double overlap = pressure / law.normal_stiffness;
    const std::string path = fmt::format("joint.{}.normal_stiffness", law.name);
    const bool is_given = run.scene.places.empty() || run.scene.places.contains(path);
    if (law.allowed_overlap == 0.0 && is_given && overlap > largest_share * size && ++others == 0) {
      warning = {
          Severity::warning, place_in(run.scene, path),
          fmt::format("{} is {:g} Pa/m: contacts at rest overlap by up to {:.2g} m, and the median block "
                      "measures {:.2g} m",
                      path, law.normal_stiffness, overlap, size),
          fmt::format("they bear up to {:.2g} Pa, and more than 1 % of a block is no small overlap",
                      pressure),
          fmt::format("use {:.2g} or more, or allowed_overlap = {:g}",
                      two_digits_above(pressure / (good_share * size)), good_share)};
    }
  }
  if (others >= 0) {
    warning.what += and_more(others, "laws like it");
    run.notes.push_back(std::move(warning));
  }
  if (run.scene.in_situ.present && others + 1 == std::ssize(run.scene.joints.laws) &&
      pressure > hopeless_share * size * stiffest_joint(run.scene.joints)) {
    run.notes.back().severity = Severity::error;
  }
}

/// Box of all blocks of all ranks.
Aabb box_of_blocks(const Communicator &communicator, std::span<const SceneBlock> slab) {
  Aabb box;
  for (const SceneBlock &block : slab) {
    box.include(bounding_box(block.vertices));
  }
  std::array<double, 4> largest{-box.low.x, -box.low.y, box.high.x, box.high.y};
  communicator.max(largest);
  return {{-largest[0], -largest[1]}, {largest[2], largest[3]}};
}

// The deepest contact of a pile bears its weight, or the in-situ stress if that is more.
void doubt_sizes(RunState &run, std::span<const SceneBlock> slab) {
  const double gravity = norm(run.scene.run.gravity);
  const Vec2 down = gravity > 0.0 ? (1.0 / gravity) * run.scene.run.gravity : Vec2{0.0, -1.0};
  std::vector<double> sizes;
  std::array<double, 3> largest{0.0, -std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity()};
  auto &[densest, lowest, minus_highest] = largest;
  for (const SceneBlock &block : slab) {
    if (!block.fixed) {
      sizes.push_back(std::sqrt(signed_area(block.vertices)));
      densest = std::max(densest, run.scene.materials[static_cast<std::size_t>(block.material)].density);
      for (const Vec2 x : block.vertices) {
        lowest = std::max(lowest, dot(x, down));
        minus_highest = std::max(minus_highest, -dot(x, down));
      }
    }
  }
  run.communicator.max(largest);
  const std::int64_t num_mobile = total(run.communicator, std::ssize(sizes));
  if (num_mobile == 0) {
    return;
  }
  const double size = agreed_median(run.communicator, sizes);
  double pressure = densest * gravity * (lowest + minus_highest);
  if (run.scene.in_situ.present) {
    for (const double head : {-minus_highest, lowest}) {
      const Mat2 stress = run.scene.in_situ.compression_at(head * run.scene.in_situ.down);
      pressure = std::max(pressure, principal_values(stress).largest);
    }
  }
  doubt_stiffness(run, pressure, size);
  double smallest = std::numeric_limits<double>::infinity();
  for (const double own : sizes) {
    smallest = std::min(smallest, own);
  }
  smallest = -run.communicator.max(-smallest);
  doubt_coordinates(run, {box_of_blocks(run.communicator, slab), num_mobile, smallest, pressure});
  const Diagnostics doubts = implausible_size(run.scene, size);
  run.notes.insert(run.notes.end(), doubts.begin(), doubts.end());
}

// Contacts push a thin block together by as much as a thick one.
void doubt_slivers(RunState &run, std::span<const SceneBlock> slab) {
  if (!run.scene.in_situ.present || !run.scene.region.present()) {
    return;
  }
  constexpr double thin_share = 0.05;
  const std::int64_t first =
      slab_begin(num_blocks(run.scene), run.communicator.size(), run.communicator.rank());
  std::vector<double> widths; // of blocks cut out of the region
  for (std::size_t k = 0; k < slab.size(); ++k) {
    const bool is_cut =
        first + static_cast<std::int64_t>(k) >= num_blocks(run.scene) - run.scene.num_region_blocks;
    if (is_cut && !slab[k].fixed) {
      widths.push_back(mean_width(signed_area(slab[k].vertices), slab[k].vertices));
    }
  }
  if (total(run.communicator, widths.size()) == 0) {
    return;
  }
  const double limit = thin_share * agreed_median(run.communicator, widths);
  const auto is_thin = [limit](double width) { return width < limit; };
  const std::int64_t count = total(run.communicator, std::count_if(widths.begin(), widths.end(), is_thin));
  if (count > 0) {
    run.notes.push_back(
        {Severity::warning, run.scene.region.where,
         fmt::format("{} under in-situ stress {} a mean width below {:.2g} m, 1/20 of the median",
                     count == 1 ? "1 block" : fmt::format("{} blocks", count), count == 1 ? "has" : "have",
                     limit),
         "the stress presses slivers together by more than their width bears, and they limit the step",
         fmt::format("region.min_width = {:.2g} merges them with their neighbours",
                     two_digits_above(limit))});
  }
}

// Under in-situ stress a larger width is named.
void doubt_cuts(RunState &run, std::span<const SceneBlock> slab) {
  if (run.scene.in_situ.present) {
    return;
  }
  const std::int64_t all = num_blocks(run.scene);
  const std::int64_t first = slab_begin(all, run.communicator.size(), run.communicator.rank());
  if (auto dust =
          doubt_dust(run.communicator, run.scene.region, slab, first, all - run.scene.num_region_blocks)) {
    run.notes.push_back(std::move(*dust));
  }
}

void doubt_faults(RunState &run, std::span<const SceneBlock> slab) {
  const std::int64_t all = num_blocks(run.scene);
  const std::int64_t first = slab_begin(all, run.communicator.size(), run.communicator.rank());
  if (auto idle = doubt_idle_faults(run.communicator, run.scene.region, slab, first,
                                    all - run.scene.num_region_blocks)) {
    run.notes.push_back(std::move(*idle));
  }
}

} // namespace

void doubt_blocks(RunState &run, std::span<const SceneBlock> slab) {
  doubt_use(run, slab);
  doubt_holds(run, slab);
  doubt_sizes(run, slab);
  doubt_slivers(run, slab);
  doubt_cuts(run, slab);
  doubt_faults(run, slab);
  warn_of_light_loads(run.scene, run.notes);
  if (has_errors(run.notes)) {
    throw SceneError(run.notes);
  }
}

// Why pairs of blocks have been refused, and which width would merge the thin ones. A block may be thin at
// one end.
void explain_slivers(RunState &run) {
  if (!run.scene.in_situ.present || !run.scene.region.present() || !has_errors(run.notes)) {
    return;
  }
  constexpr double deepest_share = 0.05;
  std::vector<std::int64_t> mine;
  double width = 0.0;
  for_regions(run, 0, run.neighbours.candidates.pairs.size(),
              [&](std::uint32_t number, std::span<const RegionForce> regions) {
                const CandidatePair &pair = run.neighbours.candidates.pairs[number];
                const BlockProperties &a = run.blocks.properties[pair.lower.value];
                const BlockProperties &b = run.blocks.properties[pair.higher.value];
                const std::size_t row = a.width < b.width ? pair.lower.value : pair.higher.value;
                const BlockProperties &thin = run.blocks.properties[row];
                const auto is_too_deep = [&](const RegionForce &force) {
                  return force.overlap > deepest_share * thin.width;
                };
                if (!run.blocks.is_fixed(row) && std::any_of(regions.begin(), regions.end(), is_too_deep)) {
                  mine.push_back(thin.id.value);
                  width = std::max(
                      width, mean_width(thin.area, run.blocks.of_row(run.blocks.reference_vertex, row)));
                }
              });
  std::set<std::int64_t> all;
  for (const std::vector<std::int64_t> &theirs : run.communicator.all_gather(mine)) {
    all.insert(theirs.begin(), theirs.end());
  }
  width = run.communicator.max(width);
  if (!all.empty()) {
    constexpr double above = 1.0 + 1e-6;
    run.notes.insert(
        run.notes.begin(),
        {Severity::warning, run.scene.region.where,
         fmt::format("the in-situ stress presses {} thin block{} together by more than 5 % of the width",
                     all.size(), all.size() == 1 ? "" : "s"),
         "contacts close by stress/normal_stiffness, whatever the width of their blocks",
         fmt::format(
             "try region.min_width = {:.2g}, which merges such blocks with their neighbours, or a higher "
             "normal_stiffness",
             two_digits_above(above * width))});
  }
}

void doubt_gaps(RunState &run) {
  constexpr double widest_share = 0.1 * (1.0 + 1e-9);
  constexpr double rounding = 1e-6;
  std::vector<Gap> mine(1);
  std::int64_t count = 0;
  std::vector<std::vector<std::size_t>> near; // made for the first gap
  const auto holds_block = [&](std::size_t a, std::size_t b, Vec2 place) {
    if (near.empty()) {
      near = neighbours_of_blocks(run);
    }
    return std::any_of(near[a].begin(), near[a].end(), [&](std::size_t row) {
      return row != b && holds_point(current_vertices(run.blocks, row), place);
    });
  };
  for (std::size_t k = 0; k < run.neighbours.candidates.pairs.size(); ++k) {
    const CandidatePair &pair = run.neighbours.candidates.pairs[k];
    const std::size_t a = pair.lower.value;
    const std::size_t b = pair.higher.value;
    const bool moves = norm(run.blocks.velocity[a].u) > 0.0 || norm(run.blocks.velocity[b].u) > 0.0;
    if (run.neighbours.history.is_living(k) || moves || !counts_here(run.blocks, pair.lower)) {
      continue;
    }
    const BlockProperties &first = run.blocks.properties[a];
    const BlockProperties &second = run.blocks.properties[b];
    const double size = std::sqrt(std::min(first.area, second.area));
    const Between gap = between(current_vertices(run.blocks, a), current_vertices(run.blocks, b));
    if (gap.width > rounding * size && gap.width <= widest_share * size &&
        !is_given_gap(run.scene, first.id.value, second.id.value) && !holds_block(a, b, gap.middle)) {
      ++count;
      const Gap found{gap.width, first.id.value, second.id.value};
      mine[0] = gap.width > mine[0].width ? found : mine[0];
    }
  }
  count = total(run.communicator, count);
  Gap widest;
  for (const auto &theirs : run.communicator.all_gather(mine)) {
    const Gap &other = theirs[0];
    const bool is_first = other.width == widest.width &&
                          std::pair(other.lower, other.higher) < std::pair(widest.lower, widest.higher);
    widest = other.width > widest.width || is_first ? other : widest;
  }
  if (count > 0) {
    run.notes.push_back(
        {Severity::warning, block_position(run.scene, widest.higher),
         fmt::format("blocks '{}' and '{}' face each other across a gap of {:.2g} m{}",
                     block_name(run.scene, widest.lower), block_name(run.scene, widest.higher), widest.width,
                     and_more(count - 1, "pairs of blocks across smaller gaps or equal ones")),
         "they do not touch, and nothing holds them together until the gap has closed",
         "give them the same coordinates where they are to touch"});
  }
}

} // namespace gcpdda
