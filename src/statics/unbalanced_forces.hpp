#pragma once

// What is left to balance on a block.

#include "model/block_system.hpp"

#include <array>
#include <cstddef>

namespace gcpdda::statics {

/// Forces on the freedoms of an owned row that nothing balances (field.hpp).
std::array<double, 6> unbalanced_forces(const BlockSystem &system, std::size_t row);

} // namespace gcpdda::statics
