#pragma once

// What a state belongs to. A checkpoint holds no shapes, densities or names: it fits one set of blocks only,
// and says which by two numbers made of everything that may not change under a state.

#include "gcpdda/model/scene.hpp"

#include <bit>
#include <cstdint>
#include <span>

namespace gcpdda {

/// Spreads the bits of a number over all of 64 (the finaliser of splitmix64).
constexpr std::uint64_t scattered(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

/// Outline, material, what holds or drives a block, and its velocity at t = 0; not its loads, its name or
/// where it stands in the scene. Sums of these (modulo 2^64) over any ranges of ids are those of all.
std::uint64_t fingerprint(std::int64_t id, const SceneBlock &block);

/// Constants of all materials in their order.
std::uint64_t fingerprint(std::span<const Material> materials);

/// Of a number that stands in a place of its own.
inline std::uint64_t fingerprint(std::uint64_t place, double value) {
  return scattered(scattered(place) ^ std::bit_cast<std::uint64_t>(value));
}

} // namespace gcpdda
