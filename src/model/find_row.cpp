#include "model/find_row.hpp"

#include <algorithm>

namespace gcpdda {

std::size_t first_row_from(const BlockSystem &system, std::size_t first, std::size_t last, std::int64_t id) {
  const auto begin = system.properties.begin();
  const auto found =
      std::lower_bound(begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(last),
                       id, [](const BlockProperties &p, std::int64_t wanted) { return p.id.value < wanted; });
  return static_cast<std::size_t>(found - begin);
}

std::optional<std::size_t> find_row(const BlockSystem &system, std::size_t first, std::size_t last,
                                    std::int64_t id) {
  const std::size_t row = first_row_from(system, first, last, id);
  return row < last && system.properties[row].id.value == id ? std::optional(row) : std::nullopt;
}

std::optional<std::size_t> find_row(const BlockSystem &system, std::int64_t id) {
  auto row = find_owned_row(system, id);
  row = row ? row : find_row(system, system.num_owned, system.first_fixed(), id);
  return row ? row : find_fixed_row(system, id);
}

std::optional<std::size_t> find_owned_row(const BlockSystem &system, std::int64_t id) {
  return find_row(system, 0, system.num_owned, id);
}

std::optional<std::size_t> find_fixed_row(const BlockSystem &system, std::int64_t id) {
  return find_row(system, system.first_fixed(), system.num_rows(), id);
}

} // namespace gcpdda
