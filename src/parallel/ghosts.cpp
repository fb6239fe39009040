#include "parallel/ghosts.hpp"

#include "base/check.hpp"
#include "parallel/packing.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace gcpdda {

namespace {

/// What the owner of a ghost sends each step.
struct GhostMotion {
  RigidDof trial;
  RigidDof velocity;
};
/// And of a deformable one.
struct GhostDeformation {
  Mat2 trial;
  Mat2 rate;
};

std::size_t bytes_of_motion(const BlockSystem &system, std::span<const std::uint32_t> rows) {
  std::size_t bytes = rows.size() * sizeof(GhostMotion);
  for (const std::uint32_t row : rows) {
    bytes += system.is_deformable(row) ? sizeof(GhostDeformation) : 0;
  }
  return bytes;
}

template <class T> std::byte *put(std::byte *to, const T &value) {
  std::memcpy(to, &value, sizeof(T));
  return to + sizeof(T);
}
template <class T> const std::byte *take(const std::byte *from, T &value) {
  std::memcpy(&value, from, sizeof(T));
  return from + sizeof(T);
}

/// A published box of another rank.
struct PublishedBox {
  std::int32_t rank = 0;
  Aabb box;
};

/// Published boxes of other ranks, sorted by the background cells they cover, where one may be asked for:
/// ranks that lie askew publish far more than what is near their border.
class BoxesByCell {
public:
  /// @param rows  those that will be asked for, of `own`
  BoxesByCell(const CellGrid &grid, const std::vector<PublishedBox> &boxes, std::span<const Aabb> own,
              std::span<const std::uint32_t> rows)
      : grid_(grid), boxes_(boxes), is_listed_(static_cast<std::size_t>(grid.num_cells()), false) {
    std::vector<bool> is_asked(is_listed_.size(), false);
    for (const std::uint32_t row : rows) {
      for_cells(own[row], [&](std::int64_t cell) { is_asked[static_cast<std::size_t>(cell)] = true; });
    }
    for (std::uint32_t k = 0; k < boxes.size(); ++k) {
      for_cells(boxes[k].box, [&](std::int64_t cell) {
        if (is_asked[static_cast<std::size_t>(cell)]) {
          is_listed_[static_cast<std::size_t>(cell)] = true;
          entries_.emplace_back(cell, k);
        }
      });
    }
    std::sort(entries_.begin(), entries_.end());
  }

  /// Ranks with a published box that meets this one, ascending, each once.
  void ranks_meeting(const Aabb &box, std::vector<std::int32_t> &ranks) const {
    ranks.clear();
    for_cells(box, [&](std::int64_t cell) {
      if (!is_listed_[static_cast<std::size_t>(cell)]) {
        return;
      }
      auto entry = std::lower_bound(entries_.begin(), entries_.end(), std::pair(cell, std::uint32_t{0}));
      for (; entry != entries_.end() && entry->first == cell; ++entry) {
        if (boxes_[entry->second].box.meets(box)) {
          ranks.push_back(boxes_[entry->second].rank);
        }
      }
    });
    std::sort(ranks.begin(), ranks.end());
    ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
  }

private:
  // Cells are clamped to the grid, which is monotone: two boxes that meet share a cell.
  template <class Visit> void for_cells(const Aabb &box, Visit &&visit) const {
    const CellGrid::Place low = grid_.place_of(box.low);
    const CellGrid::Place high = grid_.place_of(box.high);
    for (std::int64_t row = low.row; row <= high.row; ++row) {
      for (std::int64_t column = low.column; column <= high.column; ++column) {
        visit(row * grid_.columns + column);
      }
    }
  }

  CellGrid grid_;
  const std::vector<PublishedBox> &boxes_;
  std::vector<bool> is_listed_; ///< cells with an entry
  std::vector<std::pair<std::int64_t, std::uint32_t>> entries_;
};

/// Union of the reach boxes of these owned blocks in each cell that one of them occupies.
std::vector<Aabb> boxes_of_cells(const CellGrid &grid, const BlockSystem &system, std::span<const Aabb> boxes,
                                 std::span<const std::uint32_t> rows) {
  std::vector<std::pair<std::int64_t, std::uint32_t>> rows_by_cell;
  rows_by_cell.reserve(rows.size());
  for (const std::uint32_t row : rows) {
    rows_by_cell.emplace_back(grid.cell_of(system.centroid(row)), row);
  }
  std::sort(rows_by_cell.begin(), rows_by_cell.end());
  std::vector<Aabb> published;
  for (std::size_t k = 0; k < rows_by_cell.size(); ++k) {
    if (k == 0 || rows_by_cell[k].first != rows_by_cell[k - 1].first) {
      published.emplace_back();
    }
    published.back().include(boxes[rows_by_cell[k].second]);
  }
  return published;
}

} // namespace

RankReach reach_of_rank(const BlockSystem &system, std::span<const Aabb> own) {
  RankReach reach;
  for (std::size_t row = 0; row < own.size(); ++row) {
    const Vec2 centroid = system.centroid(row);
    reach.hull.include(own[row]);
    for (const Vec2 beyond : {centroid - own[row].low, own[row].high - centroid}) {
      reach.beyond = std::max({reach.beyond, beyond.x, beyond.y});
    }
  }
  return reach;
}

// A block of another rank that meets a box has its centroid in that box inflated by what it may reach beyond
// it, and places in a grid are monotone: one of the cells between those of the corners is its, and so the
// other rank's.
std::vector<std::uint32_t> rows_near_others(std::span<const Aabb> own, std::span<const RankReach> ranks,
                                            std::size_t rank, const DomainMap *owners) {
  constexpr std::int64_t most_cells = 1024; // more take longer than they save
  constexpr double rounding = 1.0 + 1e-9;
  std::vector<std::uint32_t> near;
  std::vector<Aabb> others;
  double beyond = 0.0;
  for (std::size_t r = 0; r < ranks.size(); ++r) {
    if (r != rank && ranks[r].hull.meets(ranks[rank].hull)) {
      others.push_back(ranks[r].hull);
      beyond = std::max(beyond, ranks[r].beyond);
    }
  }
  const auto is_by_others = [&](const Aabb &box) {
    const CellGrid::Place low = owners->grid.place_of(box.low);
    const CellGrid::Place high = owners->grid.place_of(box.high);
    bool is_by = (high.row - low.row + 1) * (high.column - low.column + 1) > most_cells;
    for (std::int64_t row = low.row; row <= high.row && !is_by; ++row) {
      const auto cells = owners->owner.begin() + row * owners->grid.columns;
      is_by = std::any_of(cells + low.column, cells + high.column + 1,
                          [&](std::int32_t owner) { return static_cast<std::size_t>(owner) != rank; });
    }
    return is_by;
  };
  for (std::uint32_t row = 0; row < own.size(); ++row) {
    if (std::any_of(others.begin(), others.end(), [&](const Aabb &hull) { return hull.meets(own[row]); }) &&
        (owners == nullptr || is_by_others(own[row].inflated(rounding * beyond)))) {
      near.push_back(row);
    }
  }
  return near;
}

CellGrid publishing_grid(const BlockSystem &system, std::span<const Aabb> boxes,
                         std::span<const std::uint32_t> rows) {
  if (rows.empty()) {
    return {};
  }
  std::vector<Vec2> centroids;
  centroids.reserve(rows.size());
  double extent = 0.0;
  for (const std::uint32_t row : rows) {
    centroids.push_back(system.centroid(row));
    extent += std::max(boxes[row].extent().x, boxes[row].extent().y);
  }
  const auto num_blocks = static_cast<double>(rows.size());
  const double cell_size = std::sqrt(0.5) * extent / num_blocks;
  const Aabb region = box_without_strays(centroids);
  const double cells = region.extent().x / cell_size * (region.extent().y / cell_size);
  const double most = std::min(64.0 * num_blocks, static_cast<double>(max_background_cells));
  return CellGrid::over(region, static_cast<std::int64_t>(std::clamp(cells, 1.0, most)));
}

std::vector<std::vector<std::uint32_t>> border_rows(const Communicator &communicator,
                                                    const BlockSystem &system, std::span<const Aabb> boxes,
                                                    const DomainMap *owners) {
  const auto num_ranks = static_cast<std::size_t>(communicator.size());
  const std::span<const Aabb> own = boxes.first(system.num_owned);
  const RankReach reach = reach_of_rank(system, own);
  // One hull from everybody, then details only between ranks whose hulls meet.
  std::vector<RankReach> ranks;
  for (const std::vector<RankReach> &of_rank : communicator.all_gather(std::vector<RankReach>{reach})) {
    ranks.push_back(of_rank.front());
  }
  const std::vector<std::uint32_t> near =
      rows_near_others(own, ranks, static_cast<std::size_t>(communicator.rank()), owners);
  const CellGrid grid = publishing_grid(system, boxes, near);
  const std::vector<Aabb> mine = boxes_of_cells(grid, system, boxes, near);
  std::vector<std::vector<Aabb>> details(num_ranks);
  for (std::size_t r = 0; r < num_ranks; ++r) {
    if (static_cast<int>(r) != communicator.rank() && ranks[r].hull.meets(reach.hull)) {
      std::copy_if(mine.begin(), mine.end(), std::back_inserter(details[r]),
                   [&](const Aabb &box) { return box.meets(ranks[r].hull); });
    }
  }
  std::vector<PublishedBox> published;
  const auto received = communicator.all_to_all(details);
  for (std::size_t r = 0; r < num_ranks; ++r) {
    for (const Aabb &box : received[r]) {
      published.push_back({static_cast<std::int32_t>(r), box});
    }
  }
  const BoxesByCell lookup(grid, published, own, near);
  std::vector<std::vector<std::uint32_t>> rows(num_ranks);
  std::vector<std::int32_t> meeting;
  for (const std::uint32_t row : near) {
    lookup.ranks_meeting(boxes[row], meeting);
    for (const std::int32_t r : meeting) {
      rows[static_cast<std::size_t>(r)].push_back(row);
    }
  }
  return rows;
}

namespace {

/// Ghosts as they arrived, with the rank each came from.
struct Arrivals {
  BlockSystem blocks;
  std::vector<int> sender;

  explicit Arrivals(const std::vector<Bytes> &received) {
    for (std::size_t r = 0; r < received.size(); ++r) {
      unpack_rows(received[r], blocks);
      sender.resize(blocks.num_rows(), static_cast<int>(r));
    }
  }
  [[nodiscard]] std::vector<std::size_t> by_id() const {
    std::vector<std::size_t> order(blocks.num_rows());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return blocks.properties[a].id < blocks.properties[b].id;
    });
    return order;
  }
};

} // namespace

void Ghosts::rebuild(BlockSystem &system, std::span<const Aabb> boxes, std::span<const FarGhost> far,
                     const DomainMap *owners) {
  expect(system.num_ghosts == 0, "ghosts are rebuilt from owned blocks alone");
  if (communicator_.size() == 1) {
    return;
  }
  auto rows = border_rows(communicator_, system, boxes, owners);
  for (const FarGhost &ghost : far) {
    std::vector<std::uint32_t> &of_rank = rows[static_cast<std::size_t>(ghost.rank)];
    const auto place = std::lower_bound(of_rank.begin(), of_rank.end(), ghost.row);
    if (place == of_rank.end() || *place != ghost.row) {
      of_rank.insert(place, ghost.row);
    }
  }
  std::vector<Bytes> messages(rows.size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (const std::uint32_t row : rows[r]) {
      pack_row(system, row, messages[r]);
    }
  }
  const std::vector<Bytes> received = communicator_.all_to_all(std::move(messages));
  motion_ = MessageRound(); // its buffers go
  neighbours_.clear();
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (!rows[r].empty() || !received[r].empty()) {
      neighbours_.push_back({static_cast<int>(r), rows[r], {}, {}, {}});
    }
  }

  BlockSystem fixed;
  append_rows(fixed, system, system.num_owned, system.num_rows());
  keep_rows(system, system.num_owned);
  // Senders pack in order of id, so walking the ghosts by id meets each sender's rows in message order.
  const Arrivals arrivals(received);
  const std::vector<std::size_t> order = arrivals.by_id();
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) { // rows that stay together
    for (end = begin; end < order.size() && order[end] == order[begin] + (end - begin); ++end) {
      const int sender = arrivals.sender[order[end]];
      const auto neighbour = std::find_if(neighbours_.begin(), neighbours_.end(),
                                          [&](const Neighbour &n) { return n.rank == sender; });
      neighbour->receive_rows.push_back(static_cast<std::uint32_t>(system.num_rows() + (end - begin)));
    }
    append_rows(system, arrivals.blocks, order[begin], order[begin] + (end - begin));
    system.num_ghosts += end - begin;
  }
  append_rows(system, fixed, 0, fixed.num_rows());
  prepare_motion(system);
}

void Ghosts::prepare_motion(const BlockSystem &system) {
  std::vector<Communicator::Message> outgoing;
  std::vector<Communicator::Message> incoming;
  bytes_ = 0;
  sent_rows_.clear();
  for (Neighbour &n : neighbours_) {
    sent_rows_.insert(sent_rows_.end(), n.send_rows.begin(), n.send_rows.end());
    n.send.resize(bytes_of_motion(system, n.send_rows));
    n.receive.resize(bytes_of_motion(system, n.receive_rows));
    if (!n.send.empty()) {
      outgoing.push_back({n.rank, n.send});
      bytes_ += static_cast<std::int64_t>(n.send.size());
    }
    if (!n.receive.empty()) {
      incoming.push_back({n.rank, n.receive});
    }
  }
  messages_ = static_cast<std::int64_t>(outgoing.size());
  motion_ = MessageRound(communicator_, outgoing, incoming);
}

std::vector<Bytes> Ghosts::exchange(std::vector<Bytes> &send, std::size_t bytes_per_row) const {
  std::vector<Bytes> received(neighbours_.size());
  std::vector<Communicator::Message> outgoing;
  std::vector<Communicator::Message> incoming;
  for (std::size_t k = 0; k < neighbours_.size(); ++k) {
    received[k].resize(neighbours_[k].receive_rows.size() * bytes_per_row);
    if (!send[k].empty()) {
      outgoing.push_back({neighbours_[k].rank, send[k]});
    }
    if (!received[k].empty()) {
      incoming.push_back({neighbours_[k].rank, received[k]});
    }
  }
  communicator_.exchange(outgoing, incoming);
  return received;
}

void Ghosts::copy_accelerations(BlockSystem &system) {
  copy(system.acceleration);
  copy_by(
      [&](std::uint32_t row) {
        return system.is_deformable(row) ? system.deformation_of(row).acceleration : Mat2{};
      },
      [&](std::uint32_t row, const Mat2 &acceleration) {
        if (system.is_deformable(row)) {
          system.deformation_of(row).acceleration = acceleration;
        }
      });
}

void Ghosts::begin(const BlockSystem &system, std::span<const TrialConfiguration> trials) {
  expect(trials.size() == sent_rows_.size(), "every row that is sent has a trial configuration");
  auto next = trials.begin();
  for (Neighbour &n : neighbours_) {
    std::byte *to = n.send.data();
    for (const std::uint32_t row : n.send_rows) {
      const TrialConfiguration &trial = *next++;
      to = put(to, GhostMotion{trial.motion, system.velocity[row]});
      if (system.is_deformable(row)) {
        to = put(to, GhostDeformation{trial.gradient, system.deformation_of(row).rate});
      }
    }
  }
  motion_.start();
}

void Ghosts::finish(BlockSystem &system) {
  motion_.finish();
  pose(system, 0, 0); // lists have their lengths
  for (const Neighbour &n : neighbours_) {
    const std::byte *from = n.receive.data();
    for (const std::uint32_t row : n.receive_rows) {
      GhostMotion motion;
      from = take(from, motion);
      system.velocity[row] = motion.velocity;
      GhostDeformation deformation;
      if (system.is_deformable(row)) {
        from = take(from, deformation);
        system.deformation_of(row).rate = deformation.rate;
      }
      set_trial(system, row, {motion.trial, deformation.trial});
    }
  }
  pose(system, system.num_owned, system.first_fixed());
}

} // namespace gcpdda
