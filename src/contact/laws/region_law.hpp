#pragma once

// Which law a contact region takes where edges belong to joint families.
//
// A piece of the boundary of the overlap lies on an edge of one block and is nearest to an edge of the other
// one: these two edges meet there, and JointLaws::of_edges says under which law. A region takes, in the step
// of its birth, the law under which most of its pressure int d ds acts (of equal shares the law that the
// scene names first) and keeps it until it dies, wherever it slides or rolls. Nothing in this depends on the
// neighbourhood's refreshes or on ranks, and the law travels with the region's memory.
//
// Why it is kept. The pressure p = (k_n/2) d derives from the energy (k_n/2) int_S (d_A + d_B) dA, which is
// single-valued only while k_n is a constant of the region: a k_n that changes at an overlap of energy U adds
// (k_n'/k_n - 1) U, and a block that rocks to and fro between two edges, deep on the soft one and shallow on
// the stiff one, would gain that in every cycle. The same holds for k_t and the stick spring. At birth and
// death U is 0 but for what one step closes, so a constant law costs no energy. Friction and cohesion could
// change without harm, since they only take energy away, but a region with the strength of one joint and the
// stiffness of another would be none of those in the scene. A block that leaves its joint, if only for a
// step, meets the next one under that one's law.
//
// A pair whose edges all lead to the same law is as one without families: its law stands in CandidatePair and
// its regions remember none. Of a mixed pair that is plain (candidates.hpp) the lanes take the constants of
// the law that its region remembers; a birth, which looks at the edges, is left to the general way.

#include "contact/candidates.hpp"
#include "contact/geometry/overlap.hpp"

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

/// The law a region of a mixed pair is born with, from its pieces: [begin, middle) on the lower block's
/// edges, [middle, end) on the higher one's.
std::int32_t law_at_birth(const BlockSystem &system, const JointLaws &joints, const CandidatePair &pair,
                          std::span<const Piece> pieces, const Region &region);

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
