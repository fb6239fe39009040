#pragma once

// What a state belongs to. A checkpoint holds no shapes, densities or laws: it fits one scene only, and says
// which by numbers made of everything in it that the state depends on.

#include "gcpdda/model/scene.hpp"

#include <array>
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

/// Parts of a scene with a fingerprint each, so that a message can name what is different: keys of the scene.
inline constexpr std::array scene_parts{"[run]",    "[joint]",   "[material]",   "[[block]]", "[water]",
                                        "[[bolt]]", "[in_situ]", "[earthquake]", "[[stage]]", "[[liner]]"};
using ScenePrints = std::array<std::uint64_t, scene_parts.size()>;

/// Of what a state depends on besides its blocks, once a scene has gone through its first stages: settings of
/// the run, laws, materials, loads, water, bolts and liners in place, stress, ground motion, and what those
/// stages did.
///
/// Left out is what says nothing of a state: names, duration and limits (of drag as well), how the strengths
/// of a trial fall (no run begins with a state of one), the time step (a checkpoint holds its own), what is
/// written how often, monitors, bolts and liners that have not been put in, stages to come.
///
/// @param start   before its first stage, as it was read; its record, if any, has been opened
/// @param stages  the first ones
ScenePrints fingerprints(const Scene &start, std::span<const Stage> stages);

/// All parts in one.
std::uint64_t fingerprint(const ScenePrints &prints);

/// Of a number that stands in a place of its own.
inline std::uint64_t fingerprint(std::uint64_t place, double value) {
  return scattered(scattered(place) ^ std::bit_cast<std::uint64_t>(value));
}

} // namespace gcpdda
