#include "parallel/packing.hpp"

#include "base/check.hpp"

#include <cstring>

namespace gcpdda {

namespace {

template <class T> void put(Bytes &message, const T *values, std::size_t count) {
  static_assert(std::is_trivially_copyable_v<T>);
  const auto *bytes = reinterpret_cast<const std::byte *>(values);
  message.insert(message.end(), bytes, bytes + count * sizeof(T));
}

template <class T> T take_one(std::span<const std::byte> &message) {
  expect(message.size() >= sizeof(T), "a message of blocks holds whole rows");
  T value;
  std::memcpy(&value, message.data(), sizeof(T));
  message = message.subspan(sizeof(T));
  return value;
}

template <class T> void take(std::span<const std::byte> &message, std::vector<T> &to, std::size_t count) {
  expect(message.size() >= count * sizeof(T), "a message of blocks holds whole rows");
  if (count == 0) {
    return;
  }
  to.resize(to.size() + count);
  std::memcpy(to.data() + (to.size() - count), message.data(), count * sizeof(T));
  message = message.subspan(count * sizeof(T));
}

} // namespace

void pack_row(const BlockSystem &system, std::size_t row, Bytes &message) {
  std::apply([&](auto... field) { (put(message, &(system.*field)[row], 1), ...); },
             BlockSystem::row_fields());
  const auto put_list = [&](auto begins, auto... fields) {
    const std::size_t begin = (system.*begins)[row];
    const std::uint64_t count = (system.*begins)[row + 1] - begin;
    put(message, &count, 1);
    (put(message, (system.*fields).data() + begin, count), ...);
  };
  std::apply([&](auto... list) { (std::apply(put_list, list), ...); }, BlockSystem::lists());
  const std::span<const std::int32_t> joints = system.edge_joints(row);
  put(message, joints.data(), joints.size());
}

void unpack_rows(std::span<const std::byte> message, BlockSystem &system) {
  const auto take_list = [&](auto begins, auto first, auto... fields) {
    const auto count = take_one<std::uint64_t>(message);
    take(message, system.*first, count);
    (take(message, system.*fields, count), ...);
    (system.*begins).push_back(static_cast<std::uint32_t>((system.*first).size()));
  };
  while (!message.empty()) {
    std::apply(
        [&](auto... field) {
          ((system.*field)
               .push_back(take_one<typename std::decay_t<decltype(system.*field)>::value_type>(message)),
           ...);
        },
        BlockSystem::row_fields());
    std::apply([&](auto... list) { (std::apply(take_list, list), ...); }, BlockSystem::lists());
    const std::size_t row = system.num_rows() - 1;
    std::vector<std::int32_t> joints;
    take(message, joints, system.properties[row].has_edge_joints ? system.num_vertices(row) : 0);
    append_edge_joints(system, joints);
  }
}

} // namespace gcpdda
