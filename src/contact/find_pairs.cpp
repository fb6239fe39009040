
#include "contact/find_pairs.hpp"

#include <algorithm>
#include <cmath>

namespace gcpdda {

namespace {

/// Background grid over the boxes of the mobile blocks.
struct SearchGrid {
  Aabb region;
  double cell = 1.0;
  std::int64_t columns = 1;
  std::int64_t rows = 1;

  [[nodiscard]] std::int64_t column(double x) const {
    return std::clamp(static_cast<std::int64_t>((x - region.low.x) / cell), std::int64_t{0}, columns - 1);
  }
  [[nodiscard]] std::int64_t row(double y) const {
    return std::clamp(static_cast<std::int64_t>((y - region.low.y) / cell), std::int64_t{0}, rows - 1);
  }
  /// Visit the cells that a box covers inside the region.
  template <class Visit> void cover(const Aabb &box, Visit &&visit) const {
    if (!box.meets(region)) {
      return;
    }
    for (std::int64_t j = row(box.low.y); j <= row(box.high.y); ++j) {
      for (std::int64_t i = column(box.low.x); i <= column(box.high.x); ++i) {
        visit(static_cast<std::size_t>(j * columns + i));
      }
    }
  }
};

SearchGrid make_grid(std::span<const Aabb> boxes, std::size_t num_mobile) {
  SearchGrid grid;
  double extent = 0.0;
  for (const Aabb &box : boxes.first(num_mobile)) {
    grid.region.include(box);
    extent += std::max(box.extent().x, box.extent().y);
  }
  const double count = static_cast<double>(num_mobile);
  const Vec2 size = grid.region.extent();
  // About one mean block a cell, but never more cells than a few per block: stray blocks may be far apart.
  grid.cell = std::max(extent / count, std::sqrt(size.x * size.y / (4.0 * count)));
  grid.cell = std::max(grid.cell, std::max(size.x, size.y) / (4.0 * count));
  grid.columns = static_cast<std::int64_t>(size.x / grid.cell) + 1;
  grid.rows = static_cast<std::int64_t>(size.y / grid.cell) + 1;
  return grid;
}

/// Rows by cell, compressed.
struct CellLists {
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> rows;
};

CellLists fill_cells(const SearchGrid &grid, std::span<const Aabb> boxes) {
  CellLists cells;
  cells.begin.assign(static_cast<std::size_t>(grid.columns * grid.rows) + 1, 0);
  for (const Aabb &box : boxes) {
    grid.cover(box, [&](std::size_t cell) { ++cells.begin[cell + 1]; });
  }
  for (std::size_t c = 1; c < cells.begin.size(); ++c) {
    cells.begin[c] += cells.begin[c - 1];
  }
  cells.rows.resize(cells.begin.back());
  std::vector<std::uint32_t> next(cells.begin.begin(), cells.begin.end() - 1);
  for (std::size_t row = 0; row < boxes.size(); ++row) {
    grid.cover(boxes[row],
               [&](std::size_t cell) { cells.rows[next[cell]++] = static_cast<std::uint32_t>(row); });
  }
  return cells;
}

/// visit(p, q) for all pairs p < q of boxes that meet, p one of the first `num_leading` ones.
/// @param num_in_grid  boxes that the background grid is laid over: the leading ones and perhaps more
template <class Visit>
void for_meeting(std::span<const Aabb> boxes, std::size_t num_leading, std::size_t num_in_grid,
                 Visit &&visit) {
  const SearchGrid grid = make_grid(boxes, num_in_grid);
  const CellLists cells = fill_cells(grid, boxes);
  for (std::size_t cell = 0; cell + 1 < cells.begin.size(); ++cell) {
    for (std::uint32_t i = cells.begin[cell]; i < cells.begin[cell + 1]; ++i) {
      const std::uint32_t p = cells.rows[i];
      if (p >= num_leading) {
        break; // rows ascend within a cell: no leading box follows
      }
      for (std::uint32_t j = i + 1; j < cells.begin[cell + 1]; ++j) {
        const std::uint32_t q = cells.rows[j];
        if (!boxes[p].meets(boxes[q])) {
          continue;
        }
        // Several cells may hold the pair: the one with the lower left corner of the common box counts.
        const Vec2 corner{std::max(boxes[p].low.x, boxes[q].low.x), std::max(boxes[p].low.y, boxes[q].low.y)};
        if (static_cast<std::size_t>(grid.row(corner.y) * grid.columns + grid.column(corner.x)) == cell) {
          visit(p, q);
        }
      }
    }
  }
}

std::pair<BlockIndex, BlockIndex> by_id(const BlockSystem &system, std::uint32_t p, std::uint32_t q) {
  const bool ordered = system.properties[p].id < system.properties[q].id;
  return {BlockIndex{ordered ? p : q}, BlockIndex{ordered ? q : p}};
}

void sort_by_id(const BlockSystem &system, std::vector<std::pair<BlockIndex, BlockIndex>> &pairs) {
  const auto key = [&](const std::pair<BlockIndex, BlockIndex> &pair) {
    return std::pair(system.properties[pair.first.value].id, system.properties[pair.second.value].id);
  };
  std::sort(pairs.begin(), pairs.end(), [&](const auto &a, const auto &b) { return key(a) < key(b); });
}

} // namespace

std::vector<Aabb> reach_boxes(const BlockSystem &system, double skin) {
  return reach_boxes(system, skin, 0, system.num_rows());
}

std::vector<Aabb> reach_boxes(const BlockSystem &system, double skin, std::size_t first, std::size_t last) {
  std::vector<Aabb> boxes;
  boxes.reserve(last - first);
  std::vector<Vec2> vertices;
  for (std::size_t row = first; row < last; ++row) {
    vertices.clear();
    append_current_vertices(system, row, vertices);
    boxes.push_back(bounding_box(vertices).inflated(system.is_fixed(row) ? 0.0 : 0.5 * skin));
  }
  return boxes;
}

std::vector<std::pair<BlockIndex, BlockIndex>> find_pairs(const BlockSystem &system,
                                                          std::span<const Aabb> boxes) {
  std::vector<std::pair<BlockIndex, BlockIndex>> pairs;
  if (system.num_owned == 0) {
    return pairs;
  }
  for_meeting(boxes, system.num_owned, system.num_mobile(), [&](std::uint32_t p, std::uint32_t q) {
    if (!system.properties[p].keeps_its_velocity() || !system.properties[q].keeps_its_velocity()) {
      pairs.push_back(by_id(system, p, q));
    }
  });
  sort_by_id(system, pairs);
  return pairs;
}

std::vector<std::pair<BlockIndex, BlockIndex>> find_kept_pairs(const BlockSystem &system, double skin) {
  std::vector<std::pair<BlockIndex, BlockIndex>> pairs;
  std::vector<std::uint32_t> rows;
  std::vector<Aabb> boxes;
  for (std::size_t row = 0; row < system.num_rows(); ++row) {
    if (system.properties[row].keeps_its_velocity()) {
      rows.push_back(static_cast<std::uint32_t>(row));
      boxes.push_back(reach_boxes(system, 0.0, row, row + 1).front().inflated(0.5 * skin));
    }
  }
  if (!rows.empty()) {
    for_meeting(boxes, rows.size(), rows.size(),
                [&](std::uint32_t p, std::uint32_t q) { pairs.push_back(by_id(system, rows[p], rows[q])); });
  }
  sort_by_id(system, pairs);
  return pairs;
}

} // namespace gcpdda
