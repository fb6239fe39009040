#include "simulation/dust.hpp"

#include "base/round_numbers.hpp"
#include "geometry/mean_width.hpp"
#include "geometry/point_text.hpp"
#include "geometry/polygon.hpp"
#include "model/generators.hpp"
#include "simulation/rank_facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

namespace gcpdda {

namespace {

/// A block by its mean width.
struct Narrow {
  double width = std::numeric_limits<double>::infinity(); ///< m
  std::int64_t block = -1;
  Vec2 centroid;

  friend bool operator<(const Narrow &a, const Narrow &b) {
    return std::tie(a.width, a.block) < std::tie(b.width, b.block);
  }
};

std::string what_to_try(const RockRegion &region, double side) {
  if (region.min_width < dust_share * side) {
    return fmt::format("region.min_width = {:.2g} makes them parts of their neighbours",
                       two_digits_above(sliver_share_of_side * side));
  }
  return "region.min_width leaves them, because no neighbour has their material and opening: move the joint "
         "or the outline that cuts them off";
}

} // namespace

std::optional<Diagnostic> doubt_dust(const Communicator &communicator, const RockRegion &region,
                                     std::span<const SceneBlock> slab, std::int64_t first,
                                     std::int64_t first_cut) {
  if (!region.present()) {
    return std::nullopt;
  }
  std::vector<double> sides;
  std::vector<Narrow> narrow;
  for (std::size_t k = 0; k < slab.size(); ++k) {
    const std::int64_t id = first + static_cast<std::int64_t>(k);
    if (id >= first_cut && !slab[k].fixed) {
      const Moments moments = polygon_moments(slab[k].vertices);
      sides.push_back(std::sqrt(moments.area));
      narrow.push_back({mean_width(moments.area, slab[k].vertices), id, moments.centroid});
    }
  }
  if (total(communicator, sides.size()) == 0) {
    return std::nullopt;
  }
  const double side = agreed_median(communicator, sides);
  const double limit = dust_share * side;
  const std::int64_t count =
      total(communicator, std::count_if(narrow.begin(), narrow.end(),
                                        [limit](const Narrow &block) { return block.width < limit; }));
  if (count == 0) {
    return std::nullopt;
  }
  const auto mine = std::min_element(narrow.begin(), narrow.end());
  Narrow worst;
  for (const std::vector<Narrow> &theirs :
       communicator.all_gather(std::vector<Narrow>(mine, narrow.empty() ? mine : mine + 1))) {
    worst = theirs.empty() ? worst : std::min(worst, theirs[0]);
  }
  return Diagnostic{
      Severity::warning, region.where,
      fmt::format("{} cut from the region {} a mean width below {:.2g} m, 1/1000 of the median side of the "
                  "blocks: the narrowest is b{} at {} with {:.2g} m",
                  count == 1 ? "1 block" : fmt::format("{} blocks", count), count == 1 ? "has" : "have",
                  limit, worst.block, point_text(worst.centroid), worst.width),
      "joints that close by an ordinary amount close through such a block, which stops the run, and the "
      "smallest block sets the time step",
      what_to_try(region, side)};
}

double width_against_dust(const Scene &scene, std::int64_t block, std::int64_t other, double width) {
  const std::int64_t first_cut = num_blocks(scene) - scene.num_region_blocks;
  if (!scene.region.present() || scene.num_region_blocks == 0 || std::max(block, other) < first_cut) {
    return 0.0;
  }
  const double side =
      std::sqrt(signed_area(scene.region.outline) / static_cast<double>(scene.num_region_blocks));
  const double enough = two_digits_above(sliver_share_of_side * side);
  return width < enough && scene.region.min_width < enough ? enough : 0.0;
}

} // namespace gcpdda
