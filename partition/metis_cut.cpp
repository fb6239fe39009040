#include "partition/metis_cut.hpp"

#include "base/check.hpp"
#include "partition/curve_cut.hpp"

#include <metis.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>
#include <string>

namespace gcpdda {

namespace {

/// METIS adds weights up in 32-bit integers; sums stay this far below 2^31.
constexpr std::int64_t weight_limit = std::int64_t{1} << 29;

/// The best of so many bisections is about 4 % shorter; large graphs cannot afford it and need it less.
constexpr int num_tries = 4;
constexpr std::size_t max_retried_cells = 200'000;

/// Integers in proportion to weights whose sum is `total`: exact where the sum allows it, at least 1 always.
class Scale {
public:
  explicit Scale(std::int64_t total)
      : factor_(total > weight_limit ? static_cast<double>(weight_limit) / static_cast<double>(total) : 1.0) {
  }
  [[nodiscard]] idx_t operator()(std::int64_t weight) const {
    return std::max(idx_t{1}, static_cast<idx_t>(static_cast<double>(weight) * factor_));
  }

private:
  double factor_;
};

/// Compressed rows: the neighbours of vertex i are neighbours[offsets[i]] up to offsets[i + 1].
struct Graph {
  std::vector<idx_t> offsets{0};
  std::vector<idx_t> neighbours;
  std::vector<idx_t> vertex_weights;
  std::vector<idx_t> edge_weights;
};

bool are_neighbours(const CellGrid &grid, std::int64_t a, std::int64_t b) {
  return std::abs(a / grid.columns - b / grid.columns) <= 1 &&
         std::abs(a % grid.columns - b % grid.columns) <= 1;
}

/// Before and after each cell on the Hilbert curve; -1 where the curve ends or the two cells are neighbours.
std::vector<std::array<std::int32_t, 2>> links_along_curve(const OccupiedCells &cells) {
  std::vector<std::array<std::int32_t, 2>> links(cells.size(), {-1, -1});
  const std::vector<std::size_t> order = rows_along_curve(cells);
  for (std::size_t k = 1; k < order.size(); ++k) {
    if (!are_neighbours(cells.grid, cells.cell[order[k - 1]], cells.cell[order[k]])) {
      links[order[k]][0] = static_cast<std::int32_t>(order[k - 1]);
      links[order[k - 1]][1] = static_cast<std::int32_t>(order[k]);
    }
  }
  return links;
}

/// The edges of the graph. A border through a corner costs half of one through a face. Cells next to each
/// other on the curve are tied by half of a corner: without that METIS scatters unconnected islands over all
/// parts.
class Edges {
public:
  explicit Edges(const OccupiedCells &cells) : cells_(cells), links_(links_along_curve(cells)) {}

  /// Calls visit(row at the other end, weight) for the edges of row i.
  template <class Visit> void for_each(std::size_t i, Visit visit) const {
    for_each_neighbour(cells_.grid, cells_.cell[i], [&](std::int64_t cell, bool shares_face) {
      const std::int32_t j = cells_.row_of[static_cast<std::size_t>(cell)];
      if (j >= 0) {
        visit(j, (shares_face ? 4 : 2) * mean_weight(i, j));
      }
    });
    for (const std::int32_t j : links_[i]) {
      if (j >= 0) {
        visit(j, mean_weight(i, j));
      }
    }
  }

private:
  [[nodiscard]] std::int64_t mean_weight(std::size_t i, std::int32_t j) const {
    return face_weight(cells_.weight[i], cells_.weight[static_cast<std::size_t>(j)]);
  }

  const OccupiedCells &cells_;
  std::vector<std::array<std::int32_t, 2>> links_;
};

Graph graph_of(const OccupiedCells &cells) {
  const Edges edges(cells);
  std::int64_t total_edge_weight = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    edges.for_each(i, [&](std::int32_t, std::int64_t weight) { total_edge_weight += weight; });
  }
  const Scale scaled_vertex(std::accumulate(cells.weight.begin(), cells.weight.end(), std::int64_t{0}));
  const Scale scaled_edge(total_edge_weight);

  Graph graph;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    graph.vertex_weights.push_back(scaled_vertex(cells.weight[i]));
    edges.for_each(i, [&](std::int32_t j, std::int64_t weight) {
      graph.neighbours.push_back(j);
      graph.edge_weights.push_back(scaled_edge(weight));
    });
    graph.offsets.push_back(static_cast<idx_t>(graph.neighbours.size()));
  }
  return graph;
}

} // namespace

std::optional<Cut> cut_by_metis(const OccupiedCells &cells, int num_parts, CutEffort effort) {
  Graph graph = graph_of(cells);
  std::array<idx_t, METIS_NOPTIONS> options;
  METIS_SetDefaultOptions(options.data());
  options[METIS_OPTION_NUMBERING] = 0;
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_UFACTOR] = 1; // heaviest part at most 1.001 of the mean where cells allow it
  options[METIS_OPTION_NCUTS] =
      effort == CutEffort::several_tries && cells.size() <= max_retried_cells ? num_tries : 1;
  auto num_vertices = static_cast<idx_t>(cells.size());
  idx_t num_constraints = 1;
  idx_t parts = num_parts;
  idx_t edge_cut = 0;
  std::vector<idx_t> part(cells.size());
  // Recursive bisection for any number of parts: as tight as this, direct k-way cutting scatters the parts
  // (ten times the border at 128 parts of 78 equal cells), and loose it is no shorter.
  const int status =
      METIS_PartGraphRecursive(&num_vertices, &num_constraints, graph.offsets.data(), graph.neighbours.data(),
                               graph.vertex_weights.data(), nullptr, graph.edge_weights.data(), &parts,
                               nullptr, nullptr, options.data(), &edge_cut, part.data());
  if (status != METIS_OK) {
    throw InternalError("METIS failed with status " + std::to_string(status) + " on " +
                        std::to_string(cells.size()) + " cells");
  }

  std::vector<char> used(static_cast<std::size_t>(num_parts), 0);
  for (const idx_t p : part) {
    used[static_cast<std::size_t>(p)] = 1;
  }
  if (std::find(used.begin(), used.end(), 0) != used.end()) {
    return std::nullopt;
  }
  return Cut(part.begin(), part.end());
}

std::string metis_version() {
  return std::to_string(METIS_VER_MAJOR) + '.' + std::to_string(METIS_VER_MINOR) + '.' +
         std::to_string(METIS_VER_SUBMINOR);
}

} // namespace gcpdda
