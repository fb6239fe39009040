#pragma once

// Contact forces of plain pairs (candidates.hpp), several at a time. The laws are those of
// contact_forces.hpp, for convex blocks: one region a pair.

#include "gcpdda/contact/contact_forces.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace gcpdda {

/// What plain pairs are evaluated from.
struct PlainScene {
  const BlockSystem &system;
  const Candidates &candidates;
  const ContactHistory &history;
  std::span<const TrialIncrement> increments;
  std::span<const DeformingBlock> deforming; ///< by entry of BlockSystem::deformation
  double damping_ratio = 0.0;
  double stiffness_damping = 0.0;
};

/// Evaluates as many pairs at once as the registers of its instructions hold. All instructions give the same
/// bits: each operation is rounded by itself.
class PlainBatch {
public:
  virtual ~PlainBatch() = default;
  /// Most pairs at a time.
  [[nodiscard]] virtual std::size_t width() const = 0;
  static constexpr std::size_t most_lanes = 4;
  /// Evaluate up to width() entries of Candidates::plain with like numbers of edges, all rigid or none, with
  /// the constants that go with each.
  /// @return bit i is set where entry i touches
  virtual unsigned evaluate(const PlainScene &scene, std::span<const std::uint32_t> entries,
                            std::span<const CandidatePair *const> constants) = 0;
  /// Where results go, by lane; null where no one asks.
  struct Results {
    std::array<RegionForce *, most_lanes> force{};
    std::array<RegionMemory *, most_lanes> memory{};
  };
  /// Write the results of lanes that touch: all of a force but its pair, birth and bond, and what of the
  /// memory two convex blocks have.
  virtual void store(const Results &results) = 0;
  /// Of a lane that touches where a block is deformable.
  [[nodiscard]] virtual Mat2 damping_dyad(std::size_t lane) const = 0;
};

std::unique_ptr<PlainBatch> make_plain_batch(Instructions instructions);
/// Null where the compiler or the machine lacks AVX2, or where the whole build uses it.
std::unique_ptr<PlainBatch> make_avx2_batch();

} // namespace gcpdda
