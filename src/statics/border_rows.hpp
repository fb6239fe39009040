#pragma once

// Copies of numbers of border rows on the ranks that see them.

#include "gcpdda/parallel/communicator.hpp"
#include "statics/field.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace gcpdda::statics {

/// Rows whose owners send them to a rank, and ghost rows that it sends.
struct BorderRows {
  int rank = 0;
  std::vector<std::uint32_t> send;
  std::vector<std::uint32_t> receive;
};

class BorderExchange {
public:
  struct Sent {
    std::int64_t messages = 0;
    std::int64_t bytes = 0;
  };
  explicit BorderExchange(const Communicator &communicator) : communicator_(communicator) {}
  void take(std::vector<BorderRows> rows);
  /// Rows of the owners to their ghosts.
  template <class Number> void copy(FieldOf<Number> &field) {
    start(field);
    finish(field);
  }
  /// The rows of owners leave as they are now.
  template <class Number> void start(const FieldOf<Number> &field);
  /// Those that have been started are here.
  template <class Number> void finish(FieldOf<Number> &field);
  /// What this rank has sent so far.
  [[nodiscard]] const Sent &sent() const { return all_sent_; }

private:
  /// Of fields of one kind of number and one width.
  struct Round {
    std::size_t bytes_a_row = 0;
    std::vector<Bytes> sent;
    std::vector<Bytes> received;
    MessageRound messages;
  };
  template <class Number> [[nodiscard]] Round &round_of(std::size_t width);

  Communicator communicator_;
  std::vector<BorderRows> rows_;
  Sent all_sent_;
  Round doubles_;
  Round floats_;
};

} // namespace gcpdda::statics
