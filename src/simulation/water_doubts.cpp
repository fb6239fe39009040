#include "simulation/water_doubts.hpp"

#include "dynamics/water_pressure.hpp"
#include "model/generators.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <string>

namespace gcpdda {

namespace {

constexpr std::int64_t no_block = std::numeric_limits<std::int64_t>::max();

/// The water of the scene from its start or from a stage on.
struct WaterState {
  const std::vector<Water> *tables = nullptr;
  const Stage *stage = nullptr; ///< that sets it; null at the start
};

/// States with different water, in their order.
std::vector<WaterState> water_states(const RunState &run) {
  std::vector<WaterState> states{{&run.scene.water, nullptr}};
  for (const Stage &stage : run.clock.stages) {
    if (stage.after && stage.after->water != *states.back().tables) {
      states.push_back({&stage.after->water, &stage});
    }
  }
  return states;
}

/// Rows that can move, of which each is on one rank: also fixed ones that a stage sets free.
std::vector<std::size_t> movable_rows(const RunState &run) {
  std::vector<std::size_t> rows;
  const auto is_freed = [&](std::int64_t id) {
    return std::any_of(run.clock.stages.begin(), run.clock.stages.end(), [&](const Stage &stage) {
      return stage.after && id < std::ssize(stage.after->blocks) &&
             !stage.after->blocks[static_cast<std::size_t>(id)].fixed;
    });
  };
  for (std::size_t row = 0; row < run.blocks.num_rows(); ++row) {
    if (row < run.blocks.num_owned ||
        (run.communicator.is_root() && is_freed(run.blocks.properties[row].id.value))) {
      rows.push_back(row);
    }
  }
  return rows;
}

/// A stretch of an edge at t = 0.
struct StretchAtStart {
  Vec2 begin;
  Vec2 end;

  StretchAtStart(const BlockSystem &blocks, std::size_t row, std::size_t k, double from, double to) {
    const std::span<const Vec2> shape = blocks.of_row(blocks.reference_vertex, row);
    const Vec2 along = shape[(k + 1) % shape.size()] - shape[k];
    const Vec2 vertex = blocks.properties[row].centroid + shape[k];
    begin = vertex + from * along;
    end = vertex + to * along;
  }

  /// Whether a point of it lies below the lines of both tables.
  [[nodiscard]] bool is_below(const Water &one, const Water &other) const {
    constexpr double rounding = 1e-9; // of its length
    const double least = rounding * norm(end - begin);
    const auto is_wet = [&](double share) {
      const Vec2 x = begin + share * (end - begin);
      return std::min(one.head(x.x), other.head(x.x)) - x.y > least;
    };
    const auto any_corner = [&](const Water &water) {
      return std::any_of(water.phreatic.begin(), water.phreatic.end(), [&](Vec2 corner) {
        const double share = (corner.x - begin.x) / (end.x - begin.x);
        return share > 0.0 && share < 1.0 && is_wet(share);
      });
    };
    return is_wet(0.0) || is_wet(1.0) || any_corner(one) || any_corner(other);
  }
};

/// Whether two tables push on the same stretch of a row's edge.
bool act_together(const BlockSystem &blocks, std::size_t row, const Water &one, const Water &other) {
  bool found = false;
  for_wet_stretches(blocks, row, one, [&](std::size_t k, double from, double to) {
    for_wet_stretches(blocks, row, other, [&](std::size_t l, double other_from, double other_to) {
      const double first = std::max(from, other_from);
      const double last = std::min(to, other_to);
      found = found ||
              (k == l && first < last && StretchAtStart(blocks, row, k, first, last).is_below(one, other));
    });
  });
  return found;
}

SourcePosition place_of_key(const Scene &scene, const Water &water, const char *key) {
  const auto found = scene.places.find(fmt::format("water.{}.{}", water.name, key));
  return found == scene.places.end() ? SourcePosition{} : found->second;
}

/// What one table does in all states in which it is active.
struct TableLook {
  std::int64_t is_active = 0;
  std::int64_t has_edges = 0; ///< with a listed law, at any height
  std::int64_t presses = 0;
};

void look_at(const BlockSystem &blocks, std::span<const std::size_t> rows, const Water &water,
             TableLook &look) {
  look.is_active = 1;
  for (std::size_t i = 0; i < rows.size() && look.presses == 0; ++i) {
    for_wet_stretches(blocks, rows[i], water, [&](std::size_t k, double from, double to) {
      look.has_edges = 1;
      if (StretchAtStart(blocks, rows[i], k, from, to).is_below(water, water)) {
        look.presses = 1;
      }
    });
  }
}

std::string names_of_laws(const Scene &scene, const Water &water) {
  std::string names;
  for (const std::int32_t law : water.joints) {
    names += fmt::format("{}'{}'", names.empty() ? "" : ", ",
                         scene.joints.laws[static_cast<std::size_t>(law)].name);
  }
  return names;
}

void warn_of_dry_tables(RunState &run, std::span<const WaterState> states,
                        std::span<const std::size_t> rows) {
  for (std::size_t i = 0; i < run.scene.water.size(); ++i) {
    TableLook look;
    for (const WaterState &state : states) {
      if ((*state.tables)[i].active && look.presses == 0) {
        look_at(run.blocks, rows, (*state.tables)[i], look);
      }
    }
    std::array<std::int64_t, 2> agreed{look.has_edges, look.presses};
    run.communicator.max(agreed);
    if (look.is_active == 0 || agreed[1] > 0) {
      continue;
    }
    const Water &water = run.scene.water[i];
    const bool lies_too_low = agreed[0] > 0;
    const bool lists_laws = !lies_too_low && !water.joints.empty();
    run.notes.push_back(
        {Severity::warning, place_of_key(run.scene, water, lists_laws ? "joints" : "phreatic"),
         fmt::format("[water.{}] wets no edge of a block that can move", water.name),
         lists_laws ? fmt::format("no contact at the start and no edge without one has its law {}",
                                  names_of_laws(run.scene, water))
                    : "all edges that it may wet lie above its phreatic line, and it acts on nothing",
         lists_laws ? "list laws of joints between blocks, or leave out 'joints' to wet all edges"
                    : "raise 'phreatic', or leave the table out"});
  }
}

/// The first block by id, of all ranks, on an edge of which both tables push; no_block if there is none.
/// Collective.
std::int64_t first_wet_twice(const RunState &run, std::span<const std::size_t> rows, const Water &one,
                             const Water &other) {
  std::int64_t minus_id = -no_block;
  for (const std::size_t row : rows) {
    const std::int64_t id = run.blocks.properties[row].id.value;
    if (-id > minus_id && act_together(run.blocks, row, one, other)) {
      minus_id = -id;
    }
  }
  run.communicator.max(std::span(&minus_id, 1));
  return -minus_id;
}

void warn_of_doubled_pressure(RunState &run, std::span<const WaterState> states,
                              std::span<const std::size_t> rows) {
  for (std::size_t j = 1; j < run.scene.water.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      for (const WaterState &state : states) {
        const Water &one = (*state.tables)[i];
        const Water &other = (*state.tables)[j];
        if (!one.active || !other.active) {
          continue;
        }
        const std::int64_t block = first_wet_twice(run, rows, one, other);
        if (block == no_block) {
          continue;
        }
        const std::string when =
            state.stage == nullptr ? "at the start" : "in stage '" + state.stage->name + "'";
        run.notes.push_back(
            {Severity::warning,
             state.stage == nullptr ? place_of_key(run.scene, other, "phreatic") : state.stage->where,
             fmt::format(
                 "[water.{}] and [water.{}] are both active {} and act on the same edge of block '{}'",
                 one.name, other.name, when, block_name(run.scene, block)),
             "their pressures add up there",
             fmt::format("set water.{}.active = false where water.{} is active, or let them wet different "
                         "'joints'",
                         one.name, other.name)});
        break;
      }
    }
  }
}

} // namespace

void doubt_water(RunState &run) {
  if (run.scene.water.empty()) {
    return;
  }
  const std::vector<WaterState> states = water_states(run);
  const std::vector<std::size_t> rows = movable_rows(run);
  warn_of_dry_tables(run, states, rows);
  warn_of_doubled_pressure(run, states, rows);
}

} // namespace gcpdda
