#pragma once

// Who is seen by whom.
//
// Requirement: if the reach boxes (box at the refresh, inflated by half the skin) of an owned block of rank p
// and of an owned block of rank q meet, each rank holds a ghost of the other's block. Every rank therefore
// publishes, per occupied cell of a grid over its own blocks, the union of the reach boxes of the blocks
// whose centroid lies there, and a block goes to every rank one of whose published boxes its own reach box
// meets. The union contains the partner's box, so the requirement follows; testing a block's box against
// cells alone would miss blocks that stick out of their cell, and one box per rank would let a single huge
// block inflate the whole halo.

#include "gcpdda/parallel/communicator.hpp"
#include "model/block_system.hpp"
#include "partition/domain_map.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace gcpdda {

/// An owned row that a rank needs, however far away its blocks are.
struct FarGhost {
  int rank = 0;
  std::uint32_t row = 0;
};

/// The plan of ghost messages; rebuilt at every refresh, used at every step.
class Ghosts {
public:
  explicit Ghosts(const Communicator &communicator) : communicator_(communicator) {}

  /// Send full copies of border blocks and append the received ones, sorted by id. The system holds no ghosts
  /// before.
  ///
  /// @param boxes  reach boxes of the owned rows
  /// @param far  further rows to send, in any order
  /// @param owners  the map, where all blocks are with the ranks it says: spares looking at those inside
  void rebuild(BlockSystem &system, std::span<const Aabb> boxes, std::span<const FarGhost> far = {},
               const DomainMap *owners = nullptr);

  /// Owned rows whose motion begin() sends, message by message: a row that several ranks see is listed for
  /// each of them.
  [[nodiscard]] std::span<const std::uint32_t> sent_rows() const { return sent_rows_; }
  /// Start to send the coming trial configurations and the velocities of border rows to their ghosts, by
  /// requests that were prepared at the rebuild. Until finish() ghost rows keep the old ones.
  /// @param trials  by entry of sent_rows()
  void begin(const BlockSystem &system, std::span<const TrialConfiguration> trials);
  /// Let the messages under way make progress.
  void progress() { motion_.progress(); }
  /// Wait for the messages; on return the ghosts are posed.
  void finish(BlockSystem &system);

  /// Owners' accelerations to their ghosts.
  void copy_accelerations(BlockSystem &system);

  /// Owners' entries of any array with one entry a row to their ghosts.
  template <class T> void copy(std::vector<T> &per_row) {
    copy_by([&](std::uint32_t row) { return per_row[row]; },
            [&](std::uint32_t row, const T &value) { per_row[row] = value; });
  }
  /// The same of what get(row) says of owned rows; set(row, value) for the ghosts.
  template <class Get, class Set> void copy_by(Get &&get, Set &&set) {
    using T = std::invoke_result_t<Get, std::uint32_t>;
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<Bytes> send;
    for (const Neighbour &n : neighbours_) {
      Bytes &message = send.emplace_back(n.send_rows.size() * sizeof(T));
      for (std::size_t i = 0; i < n.send_rows.size(); ++i) {
        const T value = get(n.send_rows[i]);
        std::memcpy(message.data() + i * sizeof(T), &value, sizeof(T));
      }
    }
    const std::vector<Bytes> received = exchange(send, sizeof(T));
    for (std::size_t k = 0; k < neighbours_.size(); ++k) {
      const std::vector<std::uint32_t> &rows = neighbours_[k].receive_rows;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        T value;
        std::memcpy(&value, received[k].data() + i * sizeof(T), sizeof(T));
        set(rows[i], value);
      }
    }
  }

  /// visit(rank, owned rows sent to it, ghost rows that it sends) for each rank with such rows.
  template <class Visit> void for_neighbours(Visit &&visit) const {
    for (const Neighbour &n : neighbours_) {
      visit(n.rank, n.send_rows, n.receive_rows);
    }
  }

  /// What begin() sends from this rank.
  [[nodiscard]] std::int64_t messages_per_update() const { return messages_; }
  [[nodiscard]] std::int64_t bytes_per_update() const { return bytes_; }

private:
  struct Neighbour {
    int rank = 0;
    std::vector<std::uint32_t> send_rows;
    std::vector<std::uint32_t> receive_rows;
    Bytes send; ///< buffers of motion_
    Bytes receive;
  };

  void prepare_motion(const BlockSystem &system);
  /// One message to each neighbour, and one of so many bytes a ghost from each.
  [[nodiscard]] std::vector<Bytes> exchange(std::vector<Bytes> &send, std::size_t bytes_per_row) const;

  Communicator communicator_;
  std::vector<Neighbour> neighbours_;
  std::vector<std::uint32_t> sent_rows_;
  MessageRound motion_;
  std::int64_t messages_ = 0;
  std::int64_t bytes_ = 0;
};

/// The grid by whose cells this rank publishes these owned blocks: cells of about half a block, over strips
/// that lie askew too.
CellGrid publishing_grid(const BlockSystem &system, std::span<const Aabb> boxes,
                         std::span<const std::uint32_t> rows);
/// How far the owned blocks of a rank reach.
struct RankReach {
  Aabb hull;           ///< of their boxes
  double beyond = 0.0; ///< largest way along an axis from a centroid to the end of its block's box, m
};
/// @param own  boxes of the owned rows
RankReach reach_of_rank(const BlockSystem &system, std::span<const Aabb> own);
/// Owned rows of which a box of another rank may meet the box: all that can be anybody's ghosts.
/// @param owners  as in Ghosts::rebuild
std::vector<std::uint32_t> rows_near_others(std::span<const Aabb> own, std::span<const RankReach> ranks,
                                            std::size_t rank, const DomainMap *owners);

/// For each rank the owned rows it needs, ascending; nothing for the own rank. Collective.
std::vector<std::vector<std::uint32_t>> border_rows(const Communicator &communicator,
                                                    const BlockSystem &system, std::span<const Aabb> boxes,
                                                    const DomainMap *owners = nullptr);

} // namespace gcpdda
