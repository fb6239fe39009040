#include "random_blocks.hpp"

#include "support/scenes.hpp"

#include <cmath>
#include <tuple>

namespace gcpdda::testing {

namespace {

template <class T> void put_words(std::vector<std::uint64_t> &words, const T &value) {
  static_assert(sizeof(T) % sizeof(std::uint64_t) == 0);
  std::uint64_t raw[sizeof(T) / sizeof(std::uint64_t)];
  std::memcpy(raw, &value, sizeof(T));
  words.insert(words.end(), std::begin(raw), std::end(raw));
}

// By field: it has padding. A new field must be added here, which the size reminds of.
void put_words(std::vector<std::uint64_t> &words, const BlockProperties &p) {
  static_assert(sizeof(BlockProperties) == 80);
  for (const std::int64_t whole : {p.id.value, std::int64_t{p.material}, static_cast<std::int64_t>(p.kind),
                                   std::int64_t{p.is_convex}, std::int64_t{p.has_edge_joints}}) {
    words.push_back(static_cast<std::uint64_t>(whole));
  }
  for (const double real :
       {p.area, p.mass, p.inertia, p.mass_scaling, p.radius, p.width, p.centroid.x, p.centroid.y}) {
    words.push_back(std::bit_cast<std::uint64_t>(real));
  }
}

template <class T> void fill_with_any_bits(T &value, std::mt19937_64 &random) {
  static_assert(sizeof(T) % sizeof(std::uint64_t) == 0);
  std::uint64_t raw[sizeof(T) / sizeof(std::uint64_t)];
  for (std::uint64_t &word : raw) {
    word = random();
  }
  std::memcpy(static_cast<void *>(&value), raw, sizeof(T));
}

double uniform(std::mt19937_64 &random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random() >> 11U) * 0x1p-53);
}

} // namespace

std::vector<std::uint64_t> bits_of_row(const BlockSystem &system, std::size_t row) {
  std::vector<std::uint64_t> words;
  std::apply([&](auto... field) { (put_words(words, (system.*field)[row]), ...); },
             BlockSystem::row_fields());
  const auto put_list = [&](auto begins, auto... fields) {
    words.push_back((system.*begins)[row + 1] - (system.*begins)[row]);
    for (std::size_t k = (system.*begins)[row]; k < (system.*begins)[row + 1]; ++k) {
      (put_words(words, (system.*fields)[k]), ...);
    }
  };
  std::apply([&](auto... list) { (std::apply(put_list, list), ...); }, BlockSystem::lists());
  for (const std::int32_t joint : system.edge_joints(row)) {
    words.push_back(static_cast<std::uint64_t>(joint));
  }
  return words;
}

RigidDof any_bits(std::mt19937_64 &random) {
  RigidDof dof;
  fill_with_any_bits(dof, random);
  return dof;
}

BlockSystem random_system(unsigned seed, int num_mobile, int num_fixed, double region) {
  std::mt19937_64 random(seed);
  BlockSystem system;
  const Material material{"rock", 2600.0, 1e9, 0.25};
  for (int k = 0; k < num_mobile + num_fixed; ++k) {
    const double radius = k == 0 ? 0.7 * region : region * 0.005 * std::pow(100.0, uniform(random, 0.0, 0.7));
    const Vec2 centre{uniform(random, 0.0, region), uniform(random, 0.0, region)};
    const int num_vertices = 3 + static_cast<int>(random() % 7);
    SceneBlock block;
    block.vertices = random_polygon(static_cast<unsigned>(random()), num_vertices, radius, centre);
    block.fixed = k >= num_mobile;
    // Every third deforms, some have loads or fixed points.
    for (int i = 0; i < k % 4; ++i) {
      block.loads.push_back({centre, {uniform(random, -1.0, 1.0), 1.0 * i}});
    }
    for (int i = 0; i < k % 5 - 2; ++i) {
      block.fixed_points.push_back(block.vertices[static_cast<std::size_t>(i)]);
    }
    for (int i = 0; k % 4 == 1 && i < num_vertices; ++i) {
      block.edge_joint.push_back(static_cast<int>(random() % 4) - 1);
    }
    const BlockKind kind = block.fixed  ? BlockKind::fixed
                           : k % 3 == 1 ? BlockKind::deformable
                                        : BlockKind::rigid;
    append_block(system, BlockId{k}, block, material, kind);
    const auto row = static_cast<std::size_t>(k);
    if (kind == BlockKind::deformable) {
      const Mat2 trial = system.deformation_of(row).trial; // poses the block: no bits whatever
      fill_with_any_bits(system.deformation_of(row), random);
      system.deformation_of(row).trial = trial;
      system.deformation_of(row).gradient = trial;
      system.matrix.emplace_back();
      fill_with_any_bits(system.matrix.back(), random);
      system.matrix_begin.lengthen(row, 1);
    }
    if (block.fixed) {
      ++system.num_fixed;
      continue;
    }
    ++system.num_owned;
    const auto moved = [&] {
      return RigidDof{{uniform(random, -0.1, 0.1) * region, uniform(random, -0.1, 0.1) * region},
                      uniform(random, -3.0, 3.0)};
    };
    system.displacement[row] = moved();
    system.trial[row] = moved();
    for (auto field : {&BlockSystem::velocity, &BlockSystem::acceleration, &BlockSystem::refreshed}) {
      (system.*field)[row] = any_bits(random);
    }
    fill_with_any_bits(system.ledger[row], random);
    fill_with_any_bits(system.contact[row], random);
    if (k % 3 == 0) {
      fill_with_any_bits(system.applied.emplace_back(), random);
      system.applied_begin.lengthen(row, 1);
    }
    fill_with_any_bits(system.mark.emplace_back(), random);
    system.mark_begin.lengthen(row, 1);
    fill_with_any_bits(system.unshaken.emplace_back(), random);
    system.unshaken_begin.lengthen(row, 1);
    fill_with_any_bits(system.pseudo.emplace_back(), random);
    system.pseudo_begin.lengthen(row, 1);
  }
  return system;
}

BlockSystem part_of(const BlockSystem &whole, const DomainMap &map, int rank) {
  BlockSystem part;
  for (std::size_t row = 0; row < whole.num_rows(); ++row) {
    if (whole.is_fixed(row) || map.rank_of(whole.centroid(row)) == rank) {
      append_row(part, whole, row);
      ++(whole.is_fixed(row) ? part.num_fixed : part.num_owned);
    }
  }
  return part;
}

DomainMap map_of(const CellGrid &grid, const std::function<int(int column, int row)> &owner) {
  DomainMap map{grid, {}};
  for (std::int32_t j = 0; j < grid.rows; ++j) {
    for (std::int32_t i = 0; i < grid.columns; ++i) {
      map.owner.push_back(owner(i, j));
    }
  }
  return map;
}

} // namespace gcpdda::testing
