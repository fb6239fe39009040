// Every function of the wall, at whatever rank count the binary is started with. Each rank checks what it
// received against what the others must have sent; the main reduces the verdict.

#include "gcpdda/parallel/communicator.hpp"

#include "base/check.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace gcpdda::communicator_test {
namespace {

std::byte letter(int from, int to, std::size_t position) {
  return static_cast<std::byte>((31 * from + 7 * to + static_cast<int>(position % 200)) % 251);
}

Bytes text(int from, int to, std::size_t size) {
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i) {
    bytes[i] = letter(from, to, i);
  }
  return bytes;
}

// Some messages are empty, the two directions of a pair differ, one is beyond the eager limit of any
// transport.
std::size_t message_size(int from, int to) {
  if ((from + 2 * to) % 3 == 0) {
    return 0;
  }
  return from == 0 ? 300'000 : static_cast<std::size_t>(5 * from + to + 1);
}

TEST(Communicator, RanksAreNumbered) {
  const Communicator world = Communicator::world();
  EXPECT_GE(world.rank(), 0);
  EXPECT_LT(world.rank(), world.size());
  EXPECT_EQ(world.is_root(), world.rank() == 0);
  EXPECT_NE(world.native(), nullptr);
  std::int64_t sum = world.rank();
  world.sum(std::span(&sum, 1));
  EXPECT_EQ(sum, std::int64_t{world.size()} * (world.size() - 1) / 2);
}

TEST(Communicator, SelfIsAlone) {
  const Communicator self = Communicator::self();
  EXPECT_EQ(self.rank(), 0);
  EXPECT_EQ(self.size(), 1);
  std::int64_t value = 40 + Communicator::world().rank();
  const std::int64_t before = value;
  self.max(std::span(&value, 1));
  EXPECT_EQ(value, before);
  const Bytes mine = text(1, 2, 9);
  EXPECT_EQ(self.all_to_all(std::vector<Bytes>{mine}), std::vector<Bytes>{mine});
}

TEST(Communicator, ReductionsActOnEachEntry) {
  const Communicator world = Communicator::world();
  const int rank = world.rank();
  const int last = world.size() - 1;
  std::array<double, 3> reals{1.5 * rank, -1.0 - rank, rank == last ? 1e300 : -1e300};
  world.max(reals);
  EXPECT_EQ(reals, (std::array<double, 3>{1.5 * last, -1.0, 1e300}));

  constexpr std::int64_t big = std::numeric_limits<std::int64_t>::max();
  std::array<std::int64_t, 3> integers{rank, -rank, rank == 0 ? big : 0};
  world.max(integers);
  EXPECT_EQ(integers, (std::array<std::int64_t, 3>{last, 0, big}));

  std::array<std::int64_t, 2> counts{1, std::int64_t{1} << 40};
  world.sum(counts);
  EXPECT_EQ(counts, (std::array<std::int64_t, 2>{world.size(), world.size() * (std::int64_t{1} << 40)}));

  world.max(std::span<double>());
  world.sum(std::span<std::int64_t>());
}

TEST(Communicator, ReductionsAreCountedForAllCopies) {
  const Communicator world = Communicator::world();
  const Communicator copy = world; // NOLINT(performance-unnecessary-copy-initialization)
  const std::int64_t before = copy.reductions();
  std::array<std::int64_t, 2> counts{1, 2};
  world.sum(counts);
  world.max(counts);
  std::array<double, 3> values{};
  copy.max(values);
  EXPECT_EQ(copy.max(1.0), 1.0);
  EXPECT_EQ(world.reductions() - before, 4);
  EXPECT_EQ(Communicator::self().reductions(), 0);
}

TEST(Communicator, BroadcastReplacesWhatOthersHeld) {
  const Communicator world = Communicator::world();
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{70'000}}) {
    Bytes bytes = world.is_root() ? text(3, 4, size) : Bytes(static_cast<std::size_t>(world.rank()) * 10);
    world.broadcast(bytes);
    EXPECT_EQ(bytes, text(3, 4, size));
  }
  std::string scene = world.is_root() ? std::string("duration = 2.0\n\0x", 17) : "nothing yet";
  world.broadcast(scene);
  EXPECT_EQ(scene, std::string("duration = 2.0\n\0x", 17));
}

TEST(Communicator, AllToAllDeliversEveryPair) {
  const Communicator world = Communicator::world();
  const int me = world.rank();
  for (int round = 0; round < 3; ++round) {
    std::vector<Bytes> send;
    for (int to = 0; to < world.size(); ++to) {
      send.push_back(text(me + round, to, message_size(me, to)));
    }
    const std::vector<Bytes> received = world.all_to_all(send);
    ASSERT_EQ(received.size(), send.size());
    for (int from = 0; from < world.size(); ++from) {
      EXPECT_EQ(received[static_cast<std::size_t>(from)], text(from + round, me, message_size(from, me)))
          << "from " << from << " to " << me;
    }
  }
  const std::vector<Bytes> nothing(static_cast<std::size_t>(world.size()));
  EXPECT_EQ(world.all_to_all(nothing), nothing);
}

TEST(Communicator, AllToAllRefusesAWrongNumberOfMessages) {
  const Communicator world = Communicator::world();
  EXPECT_THROW(static_cast<void>(world.all_to_all(std::vector<Bytes>())), InternalError);
}

TEST(Communicator, TypedAllToAllKeepsValues) {
  struct Item {
    double value;
    std::int32_t from;
    std::int32_t to;
    bool operator==(const Item &) const = default;
  };
  const Communicator world = Communicator::world();
  const auto items = [](int from, int to) {
    return std::vector<Item>(static_cast<std::size_t>((from + to) % 3), {0.1 * from + to, from, to});
  };
  std::vector<std::vector<Item>> send;
  for (int to = 0; to < world.size(); ++to) {
    send.push_back(items(world.rank(), to));
  }
  const auto received = world.all_to_all(send);
  for (int from = 0; from < world.size(); ++from) {
    EXPECT_EQ(received[static_cast<std::size_t>(from)], items(from, world.rank()));
  }
}

TEST(Communicator, AllGatherIsOrderedByRank) {
  const Communicator world = Communicator::world();
  const std::vector<Bytes> all = world.all_gather(text(world.rank(), 0, message_size(world.rank(), 1)));
  const auto typed = world.all_gather(std::vector<double>(static_cast<std::size_t>(world.rank()), 0.5));
  ASSERT_EQ(all.size(), static_cast<std::size_t>(world.size()));
  ASSERT_EQ(typed.size(), all.size());
  for (int from = 0; from < world.size(); ++from) {
    const auto r = static_cast<std::size_t>(from);
    EXPECT_EQ(all[r], text(from, 0, message_size(from, 1)));
    EXPECT_EQ(typed[r], std::vector<double>(r, 0.5));
  }
}

TEST(Communicator, ExchangeKeepsTheOrderOfSeveralMessagesPerPeer) {
  const Communicator world = Communicator::world();
  const int me = world.rank();
  const int next = (me + 1) % world.size();
  const int previous = (me + world.size() - 1) % world.size();
  constexpr std::size_t per_peer = 3;
  const auto size = [](int from, int to, std::size_t k) { return k == 1 ? 0 : message_size(from, to) + k; };

  for (int round = 0; round < 20; ++round) {
    std::vector<Bytes> out;
    std::vector<Bytes> in;
    for (std::size_t k = 0; k < per_peer; ++k) {
      out.push_back(text(me + round + static_cast<int>(k), next, size(me, next, k)));
      in.emplace_back(size(previous, me, k));
    }
    std::vector<Communicator::Message> send;
    std::vector<Communicator::Message> receive;
    for (std::size_t k = 0; k < per_peer; ++k) {
      send.push_back({next, out[k]});
      receive.push_back({previous, in[k]});
    }
    world.exchange(send, receive);
    for (std::size_t k = 0; k < per_peer; ++k) {
      EXPECT_EQ(in[k], text(previous + round + static_cast<int>(k), me, size(previous, me, k)))
          << "round " << round << ", message " << k;
    }
  }
}

// The ghost exchange's pattern: ranks with different numbers of partners, some with none.
TEST(Communicator, ExchangeWithUnequalNumbersOfPartners) {
  const Communicator world = Communicator::world();
  const int me = world.rank();
  std::vector<Bytes> out;
  std::vector<Bytes> in;
  std::vector<Communicator::Message> send;
  std::vector<Communicator::Message> receive;
  const auto partners = [](int a, int b) { return a != b && (a + b) % 2 == 1; };
  for (int peer = 0; peer < world.size(); ++peer) {
    out.push_back(text(me, peer, 1000));
    in.emplace_back(1000);
  }
  for (int peer = 0; peer < world.size(); ++peer) {
    if (partners(me, peer)) {
      send.push_back({peer, out[static_cast<std::size_t>(peer)]});
      receive.push_back({peer, in[static_cast<std::size_t>(peer)]});
    }
  }
  world.exchange(send, receive);
  for (int peer = 0; peer < world.size(); ++peer) {
    EXPECT_EQ(in[static_cast<std::size_t>(peer)], partners(me, peer) ? text(peer, me, 1000) : Bytes(1000));
  }
  world.exchange({}, {});
}

TEST(Communicator, FailedCallNamesItself) {
  const Communicator world = Communicator::world();
  Bytes bytes(8);
  const Communicator::Message nobody{world.size() + 5, bytes};
  try {
    world.exchange(std::span(&nobody, 1), {});
    ADD_FAILURE() << "a message to nobody was accepted";
  } catch (const InternalError &error) {
    EXPECT_NE(std::string(error.what()).find("MPI_Isend"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("rank"), std::string::npos) << error.what();
  }
}

TEST(Communicator, TooLongMessageIsRefused) {
  const Communicator world = Communicator::world();
  std::byte one{};
  // The span is never read: its length alone must be refused.
  const Communicator::Message long_message{world.rank(), std::span(&one, std::size_t{1} << 31)};
  try {
    world.exchange(std::span(&long_message, 1), {});
    ADD_FAILURE() << "a message of 2^31 bytes was accepted";
  } catch (const InternalError &error) {
    EXPECT_NE(std::string(error.what()).find("2147483648"), std::string::npos) << error.what();
  }
  world.barrier();
}

TEST(Communicator, ManyCommunicatorsAreFreed) {
  // Open MPI has 65536 context ids per process: a leak would end here.
  for (int i = 0; i < 70'000; ++i) {
    const Communicator copy = Communicator::self();
    ASSERT_EQ(copy.size(), 1);
  }
}

// Each rank sends its count to the next one, the last to the first; other messages pass meanwhile.
TEST(MessageRound, RunsAgainAndAgain) {
  const Communicator world = Communicator::world();
  const int next = (world.rank() + 1) % world.size();
  const int previous = (world.rank() + world.size() - 1) % world.size();
  Bytes out(200'000); // longer than what Open MPI sends at once
  Bytes in(out.size());
  const std::vector<Communicator::Message> send{{next, out}};
  const std::vector<Communicator::Message> receive{{previous, in}};
  MessageRound round(world, send, receive);
  MessageRound moved_to = std::move(round);
  for (int count = 0; count < 50; ++count) {
    const int told = 100 * world.rank() + count;
    std::memcpy(out.data() + out.size() - sizeof(int), &told, sizeof(int));
    moved_to.start();
    const auto all = world.all_gather(std::vector<int>{count});
    EXPECT_EQ(all[static_cast<std::size_t>(previous)][0], count);
    for (int look = 0; look < count; ++look) { // it may arrive before it is finished, or not
      moved_to.progress();
    }
    moved_to.finish();
    int heard = -1;
    std::memcpy(&heard, in.data() + in.size() - sizeof(int), sizeof(int));
    EXPECT_EQ(heard, 100 * previous + count);
  }
}

TEST(MessageRound, WithoutMessagesDoesNothing) {
  const Communicator world = Communicator::world();
  MessageRound none;
  MessageRound empty(world, {}, {});
  for (MessageRound *round : {&none, &empty}) {
    round->start();
    round->progress();
    round->finish();
  }
}

TEST(Communicator, FindsTheLargestOfOneNumberEach) {
  const Communicator world = Communicator::world();
  for (int round = 0; round < 20; ++round) {
    EXPECT_EQ(world.max(static_cast<double>((world.rank() + round) % world.size())), world.size() - 1);
  }
}

} // namespace
} // namespace gcpdda::communicator_test
