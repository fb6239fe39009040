#pragma once

#include "model/block_system.hpp"
#include "partition/domain_map.hpp"

#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <random>
#include <vector>

namespace gcpdda::testing {

/// Reproducible numbers in [0, 1) from any three integers, without state.
inline double hashed(std::int64_t a, std::int64_t b, std::int64_t c) {
  std::uint64_t h = 0x9e3779b97f4a7c15ULL;
  for (const std::int64_t part : {a, b, c}) { // splitmix64
    h += static_cast<std::uint64_t>(part) + 0x9e3779b97f4a7c15ULL;
    h = (h ^ (h >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    h = (h ^ (h >> 27U)) * 0x94d049bb133111ebULL;
    h ^= h >> 31U;
  }
  return static_cast<double>(h >> 11U) * 0x1p-53;
}

/// Every bit of a row that travels, shape included, as words. Padding is left out.
std::vector<std::uint64_t> bits_of_row(const BlockSystem &system, std::size_t row);

/// Any three bit patterns: NaN with payload, negative zero and denormals included.
RigidDof any_bits(std::mt19937_64 &random);

/// A system of `num_mobile` random polygons with ids 0 ... and `num_fixed` fixed ones after them, as one rank
/// alone would hold it. Sizes differ by a factor of 100, block 0 spans the whole region. Every field of the
/// state is filled.
BlockSystem random_system(unsigned seed, int num_mobile, int num_fixed, double region);

/// What rank holds of that system under this map, ghosts aside.
BlockSystem part_of(const BlockSystem &whole, const DomainMap &map, int rank);

/// A map with one owner per cell from a function of column and row.
DomainMap map_of(const CellGrid &grid, const std::function<int(int column, int row)> &owner);

} // namespace gcpdda::testing
