// What is implausible of the blocks of a valid scene together: warnings, one line for each kind.

#include "base/edit_distance.hpp"
#include "contact/stiffness_bound.hpp"
#include "gcpdda/io/result_files.hpp"
#include "geometry/mean_width.hpp"
#include "geometry/polygon.hpp"
#include "simulation/plausibility.hpp"
#include "simulation/rank_facts.hpp"
#include "simulation/simulation.hpp"

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

/// Two digits, upwards.
double rounded_up(double x) {
  const double digit = std::pow(10.0, std::floor(std::log10(x)) - 1.0);
  return std::ceil(x / digit) * digit;
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

/// Width of the gap between an edge and one that faces it; infinite where it does not.
double gap_between(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  constexpr double none = std::numeric_limits<double>::infinity();
  constexpr double parallel = 0.9994; // cos 2 degrees
  const double length = norm(b - a);
  const double other = norm(d - c);
  const Vec2 along = (1.0 / length) * (b - a);
  if (dot(along, d - c) > -parallel * other) {
    return none;
  }
  const double from = std::max(0.0, dot(d - a, along));
  const double to = std::min(length, dot(c - a, along));
  if (to - from < 0.5 * std::min(length, other)) {
    return none;
  }
  const Vec2 outwards = -perp(along); // counter-clockwise: the interior lies on the left
  const double first = dot(c - a, outwards);
  const double second = dot(d - a, outwards);
  return std::min(first, second) > 0.0 ? std::max(first, second) : none;
}

double gap_between(std::span<const Vec2> first, std::span<const Vec2> second) {
  double gap = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (std::size_t k = 0; k < second.size(); ++k) {
      gap = std::min(gap, gap_between(first[i], first[(i + 1) % first.size()], second[k],
                                      second[(k + 1) % second.size()]));
    }
  }
  return gap;
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

} // namespace

void Simulation::doubt_blocks(std::span<const SceneBlock> slab) {
  doubt_use(slab);
  doubt_holds(slab);
  doubt_sizes(slab);
  doubt_slivers(slab);
  warn_of_light_loads(scene_, notes_);
  if (has_errors(notes_)) {
    throw SceneError(notes_);
  }
}

// A law is used by edges, by a part of the region or by a pair of materials that are.
void Simulation::doubt_use(std::span<const SceneBlock> slab) {
  std::vector<std::int64_t> materials(scene_.materials.size(), 0);
  for (const SceneBlock &block : slab) {
    materials[static_cast<std::size_t>(block.material)] = 1;
  }
  if (scene_.region.present()) {
    materials[static_cast<std::size_t>(scene_.region.material)] = 1;
    for (const Layer &layer : scene_.region.layers) {
      materials[static_cast<std::size_t>(layer.material)] = 1;
    }
  }
  communicator_.max(materials);
  const JointLaws &joints = scene_.joints;
  std::vector<std::int64_t> laws(joints.laws.size(), 0);
  std::vector<std::string> names;
  laws[0] = 1; // the others take what they do not say from it
  for (std::size_t i = 0; i < laws.size(); ++i) {
    names.push_back(joints.laws[i].name);
    laws[i] = std::max<std::int64_t>(laws[i], joints.laws[i].is_on_edges ? 1 : 0);
  }
  note_laws_of_region(scene_.region, laws);
  for (std::int32_t a = 0; a < joints.num_materials; ++a) {
    for (std::int32_t b = 0; b < joints.num_materials; ++b) {
      if (materials[static_cast<std::size_t>(a)] != 0 && materials[static_cast<std::size_t>(b)] != 0) {
        laws[static_cast<std::size_t>(joints.between(a, b))] = 1;
      }
    }
  }
  warn_of_unused(scene_, "joint", names, laws, notes_);
  names.clear();
  for (const Material &material : scene_.materials) {
    names.push_back(material.name);
  }
  warn_of_unused(scene_, "material", names, materials, notes_);
}

void Simulation::doubt_holds(std::span<const SceneBlock> slab) {
  const auto is_held = [](const SceneBlock &b) { return b.fixed || b.driven || !b.fixed_points.empty(); };
  const auto can_move = [](const SceneBlock &b) { return !b.fixed; };
  const std::int64_t held = total(communicator_, std::count_if(slab.begin(), slab.end(), is_held));
  const std::int64_t mobile = total(communicator_, std::count_if(slab.begin(), slab.end(), can_move));
  const Vec2 gravity = scene_.run.gravity;
  const bool is_carried = std::any_of(scene_.in_situ.boundaries.begin(), scene_.in_situ.boundaries.end(),
                                      [&](const Boundary &side) { return dot(side.normal, gravity) > 0.0; });
  if (held == 0 && norm(gravity) > 0.0 && !is_carried) {
    notes_.push_back({Severity::warning, place_in(scene_, "run.gravity"),
                      "gravity acts and no block is fixed, held at a point or driven",
                      "all blocks fall together",
                      "write fixed = true for a block below them, or region.fixed = [\"bottom\"]"});
  }
  if (mobile == 0) {
    notes_.push_back({Severity::warning,
                      {},
                      "all blocks are fixed",
                      "nothing moves",
                      "leave fixed = true out where a block is to move"});
  }
}

// The deepest contact of a pile bears its weight, or the in-situ stress if that is more.
void Simulation::doubt_sizes(std::span<const SceneBlock> slab) {
  const double gravity = norm(scene_.run.gravity);
  const Vec2 down = gravity > 0.0 ? (1.0 / gravity) * scene_.run.gravity : Vec2{0.0, -1.0};
  std::vector<double> sizes;
  std::array<double, 3> largest{0.0, -std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity()};
  auto &[densest, lowest, minus_highest] = largest;
  for (const SceneBlock &block : slab) {
    if (!block.fixed) {
      sizes.push_back(std::sqrt(signed_area(block.vertices)));
      densest = std::max(densest, scene_.materials[static_cast<std::size_t>(block.material)].density);
      for (const Vec2 x : block.vertices) {
        lowest = std::max(lowest, dot(x, down));
        minus_highest = std::max(minus_highest, -dot(x, down));
      }
    }
  }
  communicator_.max(largest);
  if (total(communicator_, std::ssize(sizes)) == 0) {
    return;
  }
  const double size = agreed_median(communicator_, sizes);
  double pressure = densest * gravity * (lowest + minus_highest);
  if (scene_.in_situ.present) {
    for (const double head : {-minus_highest, lowest}) {
      const Mat2 stress = scene_.in_situ.compression_at(head * scene_.in_situ.down);
      pressure = std::max(pressure, principal_values(stress).largest);
    }
  }
  doubt_stiffness(pressure, size);
  const Diagnostics doubts = implausible_size(scene_, size);
  notes_.insert(notes_.end(), doubts.begin(), doubts.end());
}

// One line where a wrong stiffness shows in all contacts. Under in-situ stress they would all be refused.
void Simulation::doubt_stiffness(double pressure, double size) {
  constexpr double largest_share = 0.01;
  constexpr double good_share = 1e-3;
  constexpr double hopeless_share = 0.5;
  std::int64_t others = -1;
  Diagnostic warning;
  for (const JointLaw &law : scene_.joints.laws) {
    const double overlap = pressure / law.normal_stiffness;
    const std::string path = fmt::format("joint.{}.normal_stiffness", law.name);
    const bool is_given = scene_.places.empty() || scene_.places.contains(path);
    if (law.allowed_overlap == 0.0 && is_given && overlap > largest_share * size && ++others == 0) {
      warning = {
          Severity::warning, place_in(scene_, path),
          fmt::format("{} is {:g} Pa/m: contacts at rest overlap by up to {:.2g} m, and the median block "
                      "measures {:.2g} m",
                      path, law.normal_stiffness, overlap, size),
          fmt::format("they bear up to {:.2g} Pa, and more than 1 % of a block is no small overlap",
                      pressure),
          fmt::format("use {:.2g} or more, or allowed_overlap = {:g}",
                      rounded_up(pressure / (good_share * size)), good_share)};
    }
  }
  if (others >= 0) {
    warning.what += and_more(others, "laws like it");
    notes_.push_back(std::move(warning));
  }
  if (scene_.in_situ.present && others + 1 == std::ssize(scene_.joints.laws) &&
      pressure > hopeless_share * size * stiffest_joint(scene_.joints)) {
    notes_.back().severity = Severity::error;
  }
}

// Contacts push a thin block together by as much as a thick one.
void Simulation::doubt_slivers(std::span<const SceneBlock> slab) {
  if (!scene_.in_situ.present || !scene_.region.present()) {
    return;
  }
  constexpr double thin_share = 0.05;
  const std::int64_t first = slab_begin(num_blocks(), communicator_.size(), communicator_.rank());
  std::vector<double> widths; // of blocks cut out of the region
  for (std::size_t k = 0; k < slab.size(); ++k) {
    const bool is_cut = first + static_cast<std::int64_t>(k) >= num_blocks() - scene_.num_region_blocks;
    if (is_cut && !slab[k].fixed) {
      widths.push_back(mean_width(signed_area(slab[k].vertices), slab[k].vertices));
    }
  }
  if (total(communicator_, widths.size()) == 0) {
    return;
  }
  const double limit = thin_share * agreed_median(communicator_, widths);
  const auto is_thin = [limit](double width) { return width < limit; };
  const std::int64_t count = total(communicator_, std::count_if(widths.begin(), widths.end(), is_thin));
  if (count > 0) {
    notes_.push_back(
        {Severity::warning, scene_.region.where,
         fmt::format("{} under in-situ stress {} a mean width below {:.2g} m, 1/20 of the median",
                     count == 1 ? "1 block" : fmt::format("{} blocks", count), count == 1 ? "has" : "have",
                     limit),
         "the stress presses slivers together by more than their width bears, and they limit the step",
         fmt::format("region.min_width = {:.2g} merges them with their neighbours", rounded_up(limit))});
  }
}

// Why pairs of blocks have been refused, and which width would merge the thin ones. A block may be thin at
// one end.
void Simulation::explain_slivers() {
  if (!scene_.in_situ.present || !scene_.region.present() || !has_errors(notes_)) {
    return;
  }
  constexpr double deepest_share = 0.05;
  std::vector<std::int64_t> mine;
  double width = 0.0;
  for_regions(0, candidates_.pairs.size(), [&](std::uint32_t number, std::span<const RegionForce> regions) {
    const CandidatePair &pair = candidates_.pairs[number];
    const BlockProperties &a = blocks_.properties[pair.lower.value];
    const BlockProperties &b = blocks_.properties[pair.higher.value];
    const std::size_t row = a.width < b.width ? pair.lower.value : pair.higher.value;
    const BlockProperties &thin = blocks_.properties[row];
    const auto is_too_deep = [&](const RegionForce &force) {
      return force.overlap > deepest_share * thin.width;
    };
    if (!blocks_.is_fixed(row) && std::any_of(regions.begin(), regions.end(), is_too_deep)) {
      mine.push_back(thin.id.value);
      width = std::max(width, mean_width(thin.area, blocks_.of_row(blocks_.reference_vertex, row)));
    }
  });
  std::set<std::int64_t> all;
  for (const std::vector<std::int64_t> &theirs : communicator_.all_gather(mine)) {
    all.insert(theirs.begin(), theirs.end());
  }
  width = communicator_.max(width);
  if (!all.empty()) {
    constexpr double above = 1.0 + 1e-6;
    notes_.insert(
        notes_.begin(),
        {Severity::warning, scene_.region.where,
         fmt::format("the in-situ stress presses {} thin block{} together by more than 5 % of the width",
                     all.size(), all.size() == 1 ? "" : "s"),
         "contacts close by stress/normal_stiffness, whatever the width of their blocks",
         fmt::format(
             "try region.min_width = {:.2g}, which merges such blocks with their neighbours, or a higher "
             "normal_stiffness",
             rounded_up(above * width))});
  }
}

void Simulation::doubt_gaps() {
  constexpr double widest_share = 0.1 * (1.0 + 1e-9);
  constexpr double rounding = 1e-6;
  std::vector<Gap> mine(1);
  std::int64_t count = 0;
  for (std::size_t k = 0; k < candidates_.pairs.size(); ++k) {
    const CandidatePair &pair = candidates_.pairs[k];
    const std::size_t a = pair.lower.value;
    const std::size_t b = pair.higher.value;
    const bool moves = norm(blocks_.velocity[a].u) > 0.0 || norm(blocks_.velocity[b].u) > 0.0;
    if (history_.is_living(k) || moves || !counts_here(pair)) {
      continue;
    }
    const BlockProperties &first = blocks_.properties[a];
    const BlockProperties &second = blocks_.properties[b];
    const double size = std::sqrt(std::min(first.area, second.area));
    const double gap = gap_between(current_vertices(blocks_, a), current_vertices(blocks_, b));
    if (gap > rounding * size && gap <= widest_share * size &&
        !is_given_gap(scene_, first.id.value, second.id.value)) {
      ++count;
      const Gap found{gap, first.id.value, second.id.value};
      mine[0] = gap > mine[0].width ? found : mine[0];
    }
  }
  count = total(communicator_, count);
  Gap widest;
  for (const auto &theirs : communicator_.all_gather(mine)) {
    const Gap &other = theirs[0];
    const bool is_first = other.width == widest.width &&
                          std::pair(other.lower, other.higher) < std::pair(widest.lower, widest.higher);
    widest = other.width > widest.width || is_first ? other : widest;
  }
  if (count > 0) {
    notes_.push_back(
        {Severity::warning, block_position(scene_, widest.higher),
         fmt::format("blocks '{}' and '{}' face each other across a gap of {:.2g} m{}",
                     block_name(scene_, widest.lower), block_name(scene_, widest.higher), widest.width,
                     and_more(count - 1, "pairs of blocks across smaller gaps or equal ones")),
         "they do not touch, and nothing holds them together until the gap has closed",
         "give them the same coordinates where they are to touch"});
  }
}

void Simulation::doubt_monitors() {
  for (const Stage &stage : stages_) {
    const std::vector<std::int64_t> ids = select_blocks(stage.excavated);
    for (const Monitor &monitor : scene_.monitors) {
      if (std::binary_search(ids.begin(), ids.end(), monitor.block)) {
        notes_.push_back({Severity::warning, monitor.where,
                          fmt::format("monitor '{}' follows block '{}', which stage '{}' excavates",
                                      monitor.name, block_name(scene_, monitor.block), stage.name),
                          "its history ends there",
                          "monitor a block that stays, or move the point out of the opening"});
      }
    }
  }
}

} // namespace gcpdda
