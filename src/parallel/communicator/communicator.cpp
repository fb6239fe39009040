// The wall: the MPI calls of the program outside parallel HDF5. MPI errors are returned, not fatal, so that a
// failed call ends with its name and reason in the ordinary error path.

#include "gcpdda/parallel/communicator.hpp"

#include "base/check.hpp"
#include "parallel/communicator/idle_threads.hpp"

// Open MPI's and MPICH's old C++ interface would need a library of its own.
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <chrono>
#include <cstdlib>
#include <exception>
#include <limits>
#include <utility>

namespace gcpdda {

namespace {

constexpr int exchange_tag = 2;
constexpr int round_tag = 3;

void check(int code, const char *call) {
  if (code == MPI_SUCCESS) {
    return;
  }
  char text[MPI_MAX_ERROR_STRING] = "";
  int length = 0;
  MPI_Error_string(code, text, &length);
  throw InternalError(std::string(call) + " failed: " + text);
}

/// Counts of MPI 3 are int.
int count_of(std::size_t size) {
  if (size > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw InternalError("a message of " + std::to_string(size) +
                        " is too long: MPI counts end at 2^31-1 bytes or entries, use more ranks");
  }
  return static_cast<int>(size);
}

template <class T>
void reduce(std::span<T> values, MPI_Datatype type, MPI_Op operation, MPI_Comm communicator) {
  check(MPI_Allreduce(MPI_IN_PLACE, values.data(), count_of(values.size()), type, operation, communicator),
        "MPI_Allreduce");
}

void wait_all(std::vector<MPI_Request> &requests) {
  check(MPI_Waitall(count_of(requests.size()), requests.data(), MPI_STATUSES_IGNORE), "MPI_Waitall");
}

template <class Text> void broadcast_resizable(Text &data, MPI_Comm communicator) {
  std::uint64_t size = data.size();
  check(MPI_Bcast(&size, 1, MPI_UINT64_T, 0, communicator), "MPI_Bcast");
  const int count = count_of(size);
  data.resize(size);
  check(MPI_Bcast(data.data(), count, MPI_BYTE, 0, communicator), "MPI_Bcast");
}

} // namespace

struct Communicator::Handle {
  MPI_Comm value = MPI_COMM_NULL;
  /// Kept between rounds so that a step does not allocate.
  std::vector<MPI_Request> requests;
  std::int64_t reductions = 0;

  explicit Handle(MPI_Comm parent) {
    check(MPI_Comm_dup(parent, &value), "MPI_Comm_dup");
    return_errors();
  }
  Handle(MPI_Comm parent, int group, int rank) {
    check(MPI_Comm_split(parent, group, rank, &value), "MPI_Comm_split");
    return_errors();
  }
  void return_errors() const {
    check(MPI_Comm_set_errhandler(value, MPI_ERRORS_RETURN), "MPI_Comm_set_errhandler");
  }
  ~Handle() {
    int finalized = 0;
    MPI_Finalized(&finalized);
    // Freeing is collective: after an exception the other ranks are elsewhere.
    if (finalized == 0 && std::uncaught_exceptions() == 0) {
      MPI_Comm_free(&value);
    }
  }
  Handle(const Handle &) = delete;
  Handle &operator=(const Handle &) = delete;
};

Communicator::Communicator(std::shared_ptr<Handle> handle) : handle_(std::move(handle)) {
  check(MPI_Comm_rank(handle_->value, &rank_), "MPI_Comm_rank");
  check(MPI_Comm_size(handle_->value, &size_), "MPI_Comm_size");
}

Communicator Communicator::world() {
  return Communicator(std::make_shared<Handle>(MPI_COMM_WORLD));
}

Communicator Communicator::self() {
  return Communicator(std::make_shared<Handle>(MPI_COMM_SELF));
}

Communicator Communicator::split(int group) const {
  return Communicator(std::make_shared<Handle>(handle_->value, group, rank_));
}

int Communicator::ranks_on_node() const {
  MPI_Comm node = MPI_COMM_NULL;
  check(MPI_Comm_split_type(handle_->value, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &node),
        "MPI_Comm_split_type");
  int count = 0;
  check(MPI_Comm_size(node, &count), "MPI_Comm_size");
  check(MPI_Comm_free(&node), "MPI_Comm_free");
  return count;
}

std::int64_t Communicator::reductions() const {
  return handle_->reductions;
}

void Communicator::barrier() const {
  check(MPI_Barrier(handle_->value), "MPI_Barrier");
}

void Communicator::max(std::span<double> values) const {
  ++handle_->reductions;
  reduce(values, MPI_DOUBLE, MPI_MAX, handle_->value);
}

void Communicator::max(std::span<std::int64_t> values) const {
  ++handle_->reductions;
  reduce(values, MPI_INT64_T, MPI_MAX, handle_->value);
}

void Communicator::sum(std::span<std::int64_t> values) const {
  ++handle_->reductions;
  reduce(values, MPI_INT64_T, MPI_SUM, handle_->value);
}

void Communicator::broadcast(Bytes &bytes) const {
  broadcast_resizable(bytes, handle_->value);
}

void Communicator::broadcast(std::string &text) const {
  broadcast_resizable(text, handle_->value);
}

std::vector<std::size_t> Communicator::sizes_from_others(const std::vector<std::size_t> &send) const {
  const auto num_ranks = static_cast<std::size_t>(size_);
  expect(send.size() == num_ranks, "all_to_all: one message for each rank");
  std::vector<int> send_sizes(num_ranks);
  std::vector<int> receive_sizes(num_ranks);
  for (std::size_t r = 0; r < num_ranks; ++r) {
    send_sizes[r] = r == static_cast<std::size_t>(rank_) ? 0 : count_of(send[r]);
  }
  check(MPI_Alltoall(send_sizes.data(), 1, MPI_INT, receive_sizes.data(), 1, MPI_INT, handle_->value),
        "MPI_Alltoall");
  return {receive_sizes.begin(), receive_sizes.end()};
}

std::vector<Bytes> Communicator::all_gather(const Bytes &mine) const {
  const auto num_ranks = static_cast<std::size_t>(size_);
  const int my_size = count_of(mine.size());
  std::vector<int> sizes(num_ranks);
  check(MPI_Allgather(&my_size, 1, MPI_INT, sizes.data(), 1, MPI_INT, handle_->value), "MPI_Allgather");
  std::vector<int> offsets(num_ranks);
  std::size_t total = 0;
  for (std::size_t r = 0; r < num_ranks; ++r) {
    offsets[r] = count_of(total);
    total += static_cast<std::size_t>(sizes[r]);
  }
  Bytes all(static_cast<std::size_t>(count_of(total)));
  check(MPI_Allgatherv(mine.data(), my_size, MPI_BYTE, all.data(), sizes.data(), offsets.data(), MPI_BYTE,
                       handle_->value),
        "MPI_Allgatherv");

  std::vector<Bytes> received(num_ranks);
  for (std::size_t r = 0; r < num_ranks; ++r) {
    const auto begin = all.begin() + offsets[r];
    received[r].assign(begin, begin + sizes[r]);
  }
  return received;
}

void Communicator::exchange(std::span<const Message> send, std::span<const Message> receive) const {
  // Several messages to one peer share the tag: MPI keeps their order.
  std::vector<MPI_Request> &requests = handle_->requests;
  requests.assign(send.size() + receive.size(), MPI_REQUEST_NULL);
  std::size_t next = 0;
  for (const Message &message : receive) {
    check(MPI_Irecv(message.bytes.data(), count_of(message.bytes.size()), MPI_BYTE, message.peer,
                    exchange_tag, handle_->value, &requests[next++]),
          "MPI_Irecv");
  }
  for (const Message &message : send) {
    check(MPI_Isend(message.bytes.data(), count_of(message.bytes.size()), MPI_BYTE, message.peer,
                    exchange_tag, handle_->value, &requests[next++]),
          "MPI_Isend");
  }
  wait_all(requests);
}

const void *Communicator::native() const {
  return &handle_->value;
}

// Over one rank it takes MPI microseconds, as long as the step of a few blocks.
double Communicator::max(double value) const {
  double largest = value;
  ++handle_->reductions;
  if (size_ > 1) {
    check(MPI_Allreduce(&value, &largest, 1, MPI_DOUBLE, MPI_MAX, handle_->value), "MPI_Allreduce");
  }
  return largest;
}

struct MessageRound::Requests {
  std::vector<MPI_Request> all;
  bool running = false;
  bool arrived = false; ///< all of a round that is not finished

  Requests() = default;
  ~Requests() {
    int finalized = 0;
    MPI_Finalized(&finalized);
    if (finalized != 0 || running) { // a round under way ends here only by an exception
      return;
    }
    for (MPI_Request &request : all) {
      MPI_Request_free(&request);
    }
  }
  Requests(const Requests &) = delete;
  Requests &operator=(const Requests &) = delete;
};

MessageRound::MessageRound() noexcept = default;
MessageRound::~MessageRound() = default;
MessageRound::MessageRound(MessageRound &&) noexcept = default;
MessageRound &MessageRound::operator=(MessageRound &&) noexcept = default;

MessageRound::MessageRound(const Communicator &communicator, std::span<const Communicator::Message> send,
                           std::span<const Communicator::Message> receive)
    : requests_(send.empty() && receive.empty() ? nullptr : std::make_unique<Requests>()) {
  if (requests_ == nullptr) { // Open MPI takes no empty list of requests
    return;
  }
  const MPI_Comm comm = communicator.handle_->value;
  requests_->all.reserve(send.size() + receive.size());
  for (const Communicator::Message &message : receive) {
    MPI_Request request = MPI_REQUEST_NULL;
    check(MPI_Recv_init(message.bytes.data(), count_of(message.bytes.size()), MPI_BYTE, message.peer,
                        round_tag, comm, &request),
          "MPI_Recv_init");
    requests_->all.push_back(request);
  }
  for (const Communicator::Message &message : send) {
    MPI_Request request = MPI_REQUEST_NULL;
    check(MPI_Send_init(message.bytes.data(), count_of(message.bytes.size()), MPI_BYTE, message.peer,
                        round_tag, comm, &request),
          "MPI_Send_init");
    requests_->all.push_back(request);
  }
}

void MessageRound::start() {
  if (requests_ == nullptr) {
    return;
  }
  expect(!requests_->running, "a round is started once at a time");
  requests_->running = true;
  requests_->arrived = false;
  check(MPI_Startall(count_of(requests_->all.size()), requests_->all.data()), "MPI_Startall");
}

void MessageRound::progress() {
  if (requests_ == nullptr || !requests_->running || requests_->arrived) {
    return;
  }
  int arrived = 0;
  check(MPI_Testall(count_of(requests_->all.size()), requests_->all.data(), &arrived, MPI_STATUSES_IGNORE),
        "MPI_Testall");
  requests_->arrived = arrived != 0;
}

void MessageRound::finish() {
  if (requests_ == nullptr) {
    return;
  }
  expect(requests_->running, "only a started round is finished");
  if (!requests_->arrived) {
    wait_all(requests_->all);
  }
  requests_->running = false;
}

MpiScope::MpiScope(int &argc, char **&argv) {
  // Files have no shared file pointers. The component of Open MPI 4 that keeps them in a file beside each
  // file writes the path of that file behind the end of a field of 256 characters.
  ::setenv("OMPI_MCA_sharedfp", "^lockedfile", 0);
  int provided = 0; // files are synced by a thread that does not call MPI
  check(MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided), "MPI_Init_thread");
}

MpiScope::~MpiScope() {
  if (std::uncaught_exceptions() > 0) {
    abort(1); // MPI_Finalize would wait for ranks that wait for this one
  }
  // MPI_Init leaves an event to Open MPI's own thread. MPI_Finalize of Open MPI 4 unloads the code that
  // handles it without asking whether it has been handled: on a busy machine a short run would end in a crash
  // (issue 10117 of Open MPI). Threads that never sleep end the wait after its limit.
  wait_for_idle_threads(std::chrono::seconds(10));
  MPI_Finalize();
}

void MpiScope::abort(int exit_code) {
  MPI_Abort(MPI_COMM_WORLD, exit_code);
  std::_Exit(exit_code);
}

} // namespace gcpdda
