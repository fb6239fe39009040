#pragma once

// The only way to MPI: communicators, collectives, messages, and its beginning and end.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace gcpdda {

using Bytes = std::vector<std::byte>;

class MessageRound;

/// Owner of one MPI communicator; the only way to messages outside parallel HDF5. Every return code is
/// checked: a failed call throws InternalError. Calls are collective unless said otherwise.
class Communicator {
public:
  /// A duplicate of MPI_COMM_WORLD. MPI must be initialised.
  static Communicator world();
  /// Of the calling rank alone.
  static Communicator self();

  /// Of the ranks that say the same number, in their order here. Collective.
  [[nodiscard]] Communicator split(int group) const;
  /// How many of the ranks share the memory of this one. Collective.
  [[nodiscard]] int ranks_on_node() const;

  /// Number of this rank, from 0.
  [[nodiscard]] int rank() const { return rank_; }
  /// Number of ranks.
  [[nodiscard]] int size() const { return size_; }
  /// Whether this is rank 0.
  [[nodiscard]] bool is_root() const { return rank_ == 0; }

  /// Waits for all ranks. Collective.
  void barrier() const;
  /// In place; largest of each entry over all ranks. NaN is not allowed.
  void max(std::span<double> values) const;
  /// The largest of all ranks.
  [[nodiscard]] double max(double value) const;
  /// In place; largest of each entry over all ranks.
  void max(std::span<std::int64_t> values) const;
  /// In place; sum of each entry over all ranks, exact.
  void sum(std::span<std::int64_t> values) const;
  /// How many maxima and sums over all ranks this communicator and its copies have found so far.
  [[nodiscard]] std::int64_t reductions() const;
  /// Root's bytes to everybody.
  void broadcast(Bytes &bytes) const;
  /// Root's text to everybody.
  void broadcast(std::string &text) const;

  /// Everybody's bytes, by rank, on every rank.
  [[nodiscard]] std::vector<Bytes> all_gather(const Bytes &mine) const;

  /// One message to each rank (send[r] to rank r); received[r] came from rank r. Into vectors that keep their
  /// room from call to call; those that were sent are empty then. What a rank sends to itself is handed over
  /// as it stands.
  template <class T>
  void all_to_all(std::vector<std::vector<T>> &send, std::vector<std::vector<T>> &received) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<std::size_t> sizes;
    for (const std::vector<T> &message : send) {
      sizes.push_back(message.size() * sizeof(T));
    }
    sizes = sizes_from_others(sizes);
    received.resize(send.size());
    std::vector<Message> leaving;
    std::vector<Message> arriving;
    for (std::size_t r = 0; r < send.size(); ++r) {
      if (r == static_cast<std::size_t>(rank_)) {
        received[r].swap(send[r]);
        continue;
      }
      received[r].resize(sizes[r] / sizeof(T));
      add_message(static_cast<int>(r), send[r], leaving);
      add_message(static_cast<int>(r), received[r], arriving);
    }
    exchange(leaving, arriving);
    for (std::vector<T> &message : send) {
      message.clear();
    }
  }
  /// Message k of `send` goes to rank k; returned are those that arrived, by rank. Collective.
  template <class T>
  [[nodiscard]] std::vector<std::vector<T>> all_to_all(std::vector<std::vector<T>> send) const {
    std::vector<std::vector<T>> received;
    all_to_all(send, received);
    return received;
  }
  /// The lists of all ranks, by rank. Collective.
  template <class T> [[nodiscard]] std::vector<std::vector<T>> all_gather(const std::vector<T> &mine) const {
    std::vector<std::vector<T>> received;
    for (const Bytes &bytes : all_gather(to_bytes(mine))) {
      received.push_back(from_bytes<T>(bytes));
    }
    return received;
  }

  /// A message to or from one peer.
  struct Message {
    int peer;
    std::span<std::byte> bytes;
  };
  /// Point-to-point round with known partners: one message to and from each peer. Lengths must match on both
  /// sides; not collective.
  void exchange(std::span<const Message> send, std::span<const Message> receive) const;

  /// The MPI_Comm behind, for parallel HDF5 only: points to an MPI_Comm.
  [[nodiscard]] const void *native() const;

private:
  friend class MessageRound;
  struct Handle;
  explicit Communicator(std::shared_ptr<Handle> handle);

  /// Bytes that each rank has for this one, of what this one has for each: none for itself.
  [[nodiscard]] std::vector<std::size_t> sizes_from_others(const std::vector<std::size_t> &send) const;
  /// Only those that hold something travel.
  template <class T>
  static void add_message(int peer, std::vector<T> &values, std::vector<Message> &messages) {
    if (!values.empty()) {
      messages.push_back({peer, std::as_writable_bytes(std::span(values))});
    }
  }
  template <class T> static Bytes to_bytes(const std::vector<T> &values) {
    static_assert(std::is_trivially_copyable_v<T>);
    Bytes bytes(values.size() * sizeof(T));
    if (!bytes.empty()) {
      std::memcpy(bytes.data(), values.data(), bytes.size());
    }
    return bytes;
  }
  template <class T> static std::vector<T> from_bytes(const Bytes &bytes) {
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!bytes.empty()) {
      std::memcpy(values.data(), bytes.data(), bytes.size());
    }
    return values;
  }

  std::shared_ptr<Handle> handle_;
  int rank_ = 0;
  int size_ = 1;
};

/// A round of messages between fixed peers, from and into fixed buffers: prepared once, run many times. The
/// buffers must stay where they are as long as the round lives. No member is collective.
class MessageRound {
public:
  MessageRound() noexcept; ///< without messages
  /// Prepares the round.
  MessageRound(const Communicator &communicator, std::span<const Communicator::Message> send,
               std::span<const Communicator::Message> receive);
  ~MessageRound();
  /// The buffers stay where they are.
  MessageRound(MessageRound &&) noexcept;
  /// The buffers stay where they are.
  MessageRound &operator=(MessageRound &&) noexcept;

  /// Until finish() the buffers belong to the round.
  void start();
  /// Long messages travel only while somebody looks after them: to be called now and then before finish().
  void progress();
  /// All messages are here, and the buffers are free again.
  void finish();

private:
  struct Requests;
  std::unique_ptr<Requests> requests_;
};

/// MPI_Init and MPI_Finalize as a scope. An exception must be caught inside: one that leaves the scope ends
/// all ranks with exit code 1, because the others may be waiting for this one.
class MpiScope {
public:
  /// MPI takes its own arguments out of these.
  MpiScope(int &argc, char **&argv);
  ~MpiScope();
  MpiScope(const MpiScope &) = delete;
  MpiScope &operator=(const MpiScope &) = delete;
  /// Ends all ranks at once with this exit code; for faults that one rank alone has seen.
  [[noreturn]] static void abort(int exit_code);
};

} // namespace gcpdda
