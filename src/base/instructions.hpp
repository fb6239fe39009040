#pragma once

// The instruction sets that kernels are compiled for.

#include <cstddef>

namespace gcpdda {

/// What lanes (lanes.hpp) are computed with: the widest registers this machine has, or those every machine
/// has. The results are the same. Without these instructions of its own avx2 means the next narrower ones.
enum class Instructions { widest, avx2, portable };

/// Of any set of instructions.
constexpr std::size_t most_lanes = 8;

} // namespace gcpdda
