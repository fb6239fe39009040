#include "gcpdda/parallel/packing.hpp"

#include "gcpdda/base/check.hpp"

#include <cstring>

namespace gcpdda {

namespace {

template <class T> void put(Bytes &message, const T *values, std::size_t count) {
  static_assert(std::is_trivially_copyable_v<T>);
  const auto *bytes = reinterpret_cast<const std::byte *>(values);
  message.insert(message.end(), bytes, bytes + count * sizeof(T));
}

template <class T> void take(std::span<const std::byte> &message, std::vector<T> &to, std::size_t count) {
  expect(message.size() >= count * sizeof(T), "a message of blocks holds whole rows");
  to.resize(to.size() + count);
  std::memcpy(to.data() + (to.size() - count), message.data(), count * sizeof(T));
  message = message.subspan(count * sizeof(T));
}

} // namespace

void pack_row(const BlockSystem &system, std::size_t row, Bytes &message) {
  const std::uint64_t num_vertices = system.num_vertices(row);
  put(message, &num_vertices, 1);
  std::apply([&](auto... field) { (put(message, &(system.*field)[row], 1), ...); },
             BlockSystem::row_fields());
  const std::size_t begin = system.vertex_begin[row];
  std::apply([&](auto... field) { (put(message, (system.*field).data() + begin, num_vertices), ...); },
             BlockSystem::shape_fields());
}

void unpack_rows(std::span<const std::byte> message, BlockSystem &system) {
  while (!message.empty()) {
    std::vector<std::uint64_t> num_vertices;
    take(message, num_vertices, 1);
    std::apply([&](auto... field) { (take(message, system.*field, 1), ...); }, BlockSystem::row_fields());
    std::apply([&](auto... field) { (take(message, system.*field, num_vertices[0]), ...); },
               BlockSystem::shape_fields());
    system.vertex_begin.push_back(static_cast<std::uint32_t>(system.reference_vertex.size()));
  }
}

} // namespace gcpdda
