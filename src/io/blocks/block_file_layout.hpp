#pragma once

// The datasets of a block file and the first look at one.

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/model/scene.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace gcpdda::block_file {

enum class Number { real64, integer64, integer32, unsigned8 };
/// How many rows a dataset has.
enum class Rows { points, edges, blocks, blocks_and_one };

struct DatasetRule {
  std::string_view name;
  Number number;
  Rows rows;
  std::size_t columns;
  bool required;
  std::string_view doc; ///< one sentence; starts with the unit in brackets if there is one
};

enum Dataset : std::size_t { points, offsets, material, fixed, velocity, edge_joint, count };

/// The datasets of a block file, by Dataset.
inline constexpr std::array<DatasetRule, count> layout{{
    {"points", Number::real64, Rows::points, 2, true,
     "[m] Corners of all blocks, one block after the other, in order around each, either way round."},
    {"offsets", Number::integer64, Rows::blocks_and_one, 1, true,
     "Block k has the points from offsets[k] up to, but not including, offsets[k + 1]; the first is 0, the "
     "last the number of points."},
    {"material", Number::integer32, Rows::blocks, 1, true,
     "Number of the material, from 0 in the order of the scene file."},
    {"fixed", Number::unsigned8, Rows::blocks, 1, true, "1 for a block that never moves, else 0."},
    {"velocity", Number::real64, Rows::blocks, 3, false,
     "[m/s, m/s, rad/s] Initial velocity of the centroid and angular velocity, counter-clockwise positive."},
    {"edge_joint", Number::integer32, Rows::edges, 1, false,
     "Number of the contact law of the edge from each point to the next one of its block: 0 for default, the "
     "others from 1 in the order of the scene file; -1 for the law of the materials."},
}};

/// "64-bit reals".
std::string_view words_of(Number number);
/// "(n, 2)" with n points and nb blocks.
std::string_view shape_of(const DatasetRule &rule);

/// What one process sees of a block file without reading its rows.
struct Overview {
  std::int64_t num_points = 0;
  std::int64_t num_blocks = 0;
  Diagnostics faults;
};
Overview look_at(const BlockFile &file);

} // namespace gcpdda::block_file
