#pragma once

// Who is seen by whom.
//
// Requirement: if the reach boxes (box at the refresh, inflated by half the skin) of an owned block of rank p
// and of an owned block of rank q meet, each rank holds a ghost of the other's block. Every rank therefore
// publishes, per occupied background cell, the union of the reach boxes of the blocks whose centroid lies
// there, and a block goes to every rank one of whose published boxes its own reach box meets. The union
// contains the partner's box, so the requirement follows; testing a block's box against cells alone would
// miss blocks that stick out of their cell, and one box per rank would let a single huge block inflate the
// whole halo.

#include "gcpdda/model/block_system.hpp"
#include "gcpdda/parallel/communicator.hpp"
#include "gcpdda/partition/domain_map.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace gcpdda {

/// The plan of ghost messages; rebuilt at every refresh, used at every step.
class Ghosts {
public:
  explicit Ghosts(const Communicator &communicator) : communicator_(communicator) {}

  /// Send full copies of border blocks and append the received ones, sorted by id. The system holds no ghosts
  /// before.
  ///
  /// @param boxes  reach boxes of the owned rows
  void rebuild(const DomainMap &map, BlockSystem &system, std::span<const Aabb> boxes);

  /// Owners' trial configurations and velocities to their ghosts; ghosts are posed.
  void update(BlockSystem &system);

  /// Owners' accelerations to their ghosts.
  void copy_accelerations(BlockSystem &system);

  /// Owners' entries of any array with one entry a row to their ghosts.
  template <class T> void copy(std::vector<T> &per_row) {
    pack([&](std::size_t row, std::byte *to) { std::memcpy(to, &per_row[row], sizeof(T)); }, sizeof(T));
    transfer();
    unpack([&](std::size_t row, const std::byte *from) { std::memcpy(&per_row[row], from, sizeof(T)); },
           sizeof(T));
  }

  [[nodiscard]] std::int64_t messages_sent() const { return messages_sent_; }
  [[nodiscard]] std::int64_t bytes_sent() const { return bytes_sent_; }

private:
  struct Neighbour {
    int rank = 0;
    std::vector<std::uint32_t> send_rows;
    std::vector<std::uint32_t> receive_rows;
    Bytes send;
    Bytes receive;
  };

  template <class Write> void pack(Write &&write, std::size_t bytes_per_row) {
    for (Neighbour &n : neighbours_) {
      n.send.resize(n.send_rows.size() * bytes_per_row);
      n.receive.resize(n.receive_rows.size() * bytes_per_row);
      for (std::size_t i = 0; i < n.send_rows.size(); ++i) {
        write(n.send_rows[i], n.send.data() + i * bytes_per_row);
      }
    }
  }
  template <class Read> void unpack(Read &&read, std::size_t bytes_per_row) {
    for (const Neighbour &n : neighbours_) {
      for (std::size_t i = 0; i < n.receive_rows.size(); ++i) {
        read(n.receive_rows[i], n.receive.data() + i * bytes_per_row);
      }
    }
  }
  void transfer();

  Communicator communicator_;
  std::vector<Neighbour> neighbours_;
  std::vector<Communicator::Message> outgoing_;
  std::vector<Communicator::Message> incoming_;
  std::int64_t messages_sent_ = 0;
  std::int64_t bytes_sent_ = 0;
};

/// For each rank the owned rows it needs, ascending; nothing for the own rank. Collective.
std::vector<std::vector<std::uint32_t>> border_rows(const Communicator &communicator, const DomainMap &map,
                                                    const BlockSystem &system, std::span<const Aabb> boxes);

} // namespace gcpdda
