#pragma once

// Which law a contact region takes where edges belong to joint families.
//
// A piece of the boundary of the overlap lies on an edge of one block and is nearest to an edge of the other
// one: these two edges meet there, and JointLaws::of_edges says under which law. A region takes, in the step
// of its birth, the law under which most of its pressure int d ds acts (of equal shares the law that the
// scene names first). Nothing in this depends on the neighbourhood's refreshes or on ranks, and the law
// travels with the region's memory.
//
// Strength follows the edges. A block that slides out over the corner of another one is met there first by
// the edges of the cross joint, and a moment later lies on bedding. The choice is therefore made anew when
// the region has slid on by a tenth of half the narrowest width of its blocks, or has become twice as long:
// friction, cohesion, bonds' residual strength, dilation and roughness are those of the edges that carry most
// from there on. (With the law of their birth three blocks at the foot of a slope had the cross joint's
// strength under more and more of their base, 40 degrees in place of 31, and held at 1.27 where they slide at
// 1.21.)
//
// Stiffness stays that of the birth. The pressure p = (k_n/2) d derives from the energy (k_n/2) int_S (d_A +
// d_B) dA, which is single-valued only while k_n is a constant of the region: a k_n that changes at an
// overlap of energy U adds (k_n'/k_n - 1) U, and a block that rocks to and fro between two edges, deep on the
// soft one and shallow on the stiff one, would gain that in every cycle. The same holds for k_t and the stick
// spring. At birth and death U is 0 but for what one step closes, so a constant stiffness costs no energy.
// Friction and cohesion only take energy away. A region that comes off another one of its pair, at a corner
// where the outline goes on from one to the other inside of the other block, is born with an energy: it takes
// the stiffness of that one, and its strength from its edges. (With the stiffness of its edges the force
// jumped each time that the two parted, and such blocks never came to rest.)
//
// A pair whose edges all lead to the same law is as one without families: its law stands in CandidatePair and
// its regions remember none. Of a mixed pair that is plain (candidates.hpp) the lanes take the constants of
// the law that its region remembers; a choice, which looks at the edges, is left to the general way.

#include "contact/candidates.hpp"
#include "contact/geometry/overlap.hpp"

#include <bit>
#include <cstdint>
#include <optional>
#include <span>

namespace gcpdda {

/// Where an edge of the lower block meets one of the higher block.
std::int32_t law_of_edges(const BlockSystem &system, const JointLaws &joints, const CandidatePair &pair,
                          std::int32_t lower_edge, std::int32_t higher_edge);

/// The laws that the edges of two blocks allow.
struct PossibleLaws {
  std::optional<std::int32_t> only; ///< if it is one
  bool are_constant = true;         ///< JointLaw::is_constant of all
};
PossibleLaws possible_laws(const BlockSystem &system, const JointLaws &joints, const CandidatePair &pair);

/// The law of the edges on which most of a region of a mixed pair lies, from its pieces: [begin, middle) on
/// the lower block's edges, [middle, end) on the higher one's.
std::int32_t law_of_region(const BlockSystem &system, const JointLaws &joints, const CandidatePair &pair,
                           std::span<const Piece> pieces, const Region &region);

/// Where a region stands on its way, as far as a choice among laws is concerned: another number where it has
/// slid on, or become longer, by so much that the choice is to be made anew.
inline std::uint16_t place_on_way(const CandidatePair &pair, const RegionState &memory) {
  constexpr double share = 0.1; // of half the narrowest width
  constexpr unsigned byte = 0xff;
  const auto way = static_cast<std::uint64_t>(memory.slip / (share * pair.allowed_overlap));
  const std::uint64_t doublings = std::bit_cast<std::uint64_t>(memory.longest) >> 52U; // the exponent
  return static_cast<std::uint16_t>((doublings & byte) << 8U | (way & byte));
}
/// A region of this memory is to choose among laws at its next evaluation.
inline bool chooses_law(const CandidatePair &pair, const RegionState &memory) {
  return pair.is_mixed && memory.law >= 0 && memory.seen_at != place_on_way(pair, memory);
}
/// It has been evaluated after a choice. Where that changed its law, the next evaluation looks once more: a
/// region that then rests has the same bits from there on.
inline void note_choice(const CandidatePair &pair, bool is_new, RegionState &memory) {
  const std::uint16_t place = place_on_way(pair, memory);
  memory.seen_at = is_new ? static_cast<std::uint16_t>(~place) : place;
}

/// Put the constants of a law into a pair.
void take_law(const BlockSystem &system, const ContactParameters &parameters, std::int32_t law,
              CandidatePair &pair);

/// The constants that a region with this memory has.
inline CandidatePair constants_of(const BlockSystem &system, const ContactParameters &parameters,
                                  const CandidatePair &pair, std::int32_t law) {
  CandidatePair own = pair;
  if (law >= 0 && law != pair.law) {
    take_law(system, parameters, law, own);
  }
  return own;
}

} // namespace gcpdda
