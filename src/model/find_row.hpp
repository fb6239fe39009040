#pragma once

// Rows of blocks by their ids. Owned rows, ghosts and fixed rows are each sorted by id.

#include "model/block_system.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace gcpdda {

/// First of rows [first, last), which are sorted by id, whose id is not below this one; `last` if there is
/// none.
[[nodiscard]] std::size_t first_row_from(const BlockSystem &system, std::size_t first, std::size_t last,
                                         std::int64_t id);

/// Row of a block among rows [first, last), which are sorted by id; none where it is not there.
[[nodiscard]] std::optional<std::size_t> find_row(const BlockSystem &system, std::size_t first,
                                                  std::size_t last, std::int64_t id);
/// Row of an owned, ghost or fixed block.
[[nodiscard]] std::optional<std::size_t> find_row(const BlockSystem &system, std::int64_t id);
[[nodiscard]] std::optional<std::size_t> find_owned_row(const BlockSystem &system, std::int64_t id);
[[nodiscard]] std::optional<std::size_t> find_fixed_row(const BlockSystem &system, std::int64_t id);

} // namespace gcpdda
