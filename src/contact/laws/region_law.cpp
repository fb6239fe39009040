#include "contact/laws/region_law.hpp"

#include "contact/pair_forces.hpp"
#include "geometry/polygon.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace gcpdda {

namespace {

constexpr std::array<std::int32_t, 1> none{-1};

/// At least one: an edge without a law of its own counts as one of law -1.
std::span<const std::int32_t> laws_on(const BlockSystem &system, BlockIndex row) {
  const std::span<const std::int32_t> joints = system.edge_joints(row.value);
  return joints.empty() ? std::span<const std::int32_t>(none) : joints;
}

std::int32_t by_materials(const BlockSystem &system, const JointLaws &joints, const CandidatePair &pair) {
  return joints.between(system.properties[pair.lower.value].material,
                        system.properties[pair.higher.value].material);
}

/// Whether two edges of a block are parts of one straight side (BlockProperties::has_parted_sides).
bool are_parted(const BlockSystem &system, BlockIndex row, std::int32_t edge, std::int32_t other) {
  const auto normal = system.of_row(system.reference_normal, row.value);
  return edge != other && system.properties[row.value].has_parted_sides &&
         are_in_one_side(normal[static_cast<std::size_t>(edge)], normal[static_cast<std::size_t>(other)]);
}

/// Whether an outline goes on from one region to the other one: both are parts of one overlap, and not of
/// what vertices within straight sides part for good.
bool goes_on(const BlockSystem &system, const CandidatePair &pair, std::span<const Piece> pieces,
             const Region &region, const Region &next) {
  const auto any_goes_on = [&](std::array<std::uint32_t, 2> from, std::array<std::uint32_t, 2> to,
                               BlockIndex own, BlockIndex other) {
    for (const Piece &piece : pieces.subspan(from[0], from[1] - from[0])) {
      for (const Piece &then : pieces.subspan(to[0], to[1] - to[0])) {
        if (norm(piece.end() - then.begin) < std::min(piece.depth_end, then.depth_begin) &&
            !are_parted(system, own, piece.edge, then.edge) &&
            !are_parted(system, other, piece.face, then.face)) {
          return true;
        }
      }
    }
    return false;
  };
  return any_goes_on({region.begin, region.middle}, {next.begin, next.middle}, pair.lower, pair.higher) ||
         any_goes_on({region.middle, region.end}, {next.middle, next.end}, pair.higher, pair.lower);
}

} // namespace

std::int32_t law_of_edges(const BlockSystem &system, const JointLaws &joints, const CandidatePair &pair,
                          std::int32_t lower_edge, std::int32_t higher_edge) {
  const auto on = [&](BlockIndex row, std::int32_t edge) {
    const std::span<const std::int32_t> laws = system.edge_joints(row.value);
    return laws.empty() ? -1 : laws[static_cast<std::size_t>(edge)];
  };
  return joints.of_edges(on(pair.lower, lower_edge), on(pair.higher, higher_edge),
                         by_materials(system, joints, pair));
}

PossibleLaws possible_laws(const BlockSystem &system, const JointLaws &joints, const CandidatePair &pair) {
  const std::int32_t otherwise = by_materials(system, joints, pair);
  const std::span<const std::int32_t> on_lower = laws_on(system, pair.lower);
  const std::span<const std::int32_t> on_higher = laws_on(system, pair.higher);
  const std::int32_t first = joints.of_edges(on_lower.front(), on_higher.front(), otherwise);
  PossibleLaws laws{first, true};
  for (const std::int32_t a : on_lower) {
    for (const std::int32_t b : on_higher) {
      const std::int32_t law = joints.of_edges(a, b, otherwise);
      laws.are_constant = laws.are_constant && joints.laws[static_cast<std::size_t>(law)].is_constant();
      if (law != first) {
        laws.only.reset();
      }
    }
  }
  return laws;
}

std::int32_t law_of_region(const BlockSystem &system, const JointLaws &joints, const CandidatePair &pair,
                           std::span<const Piece> pieces, const Region &region) {
  const auto law_of = [&](std::uint32_t i) {
    const Piece &piece = pieces[i];
    const bool on_lower = i < region.middle;
    return law_of_edges(system, joints, pair, on_lower ? piece.edge : piece.face,
                        on_lower ? piece.face : piece.edge);
  };
  std::int32_t carrying = -1;
  double most = -1.0;
  for (std::uint32_t i = region.begin; i < region.end; ++i) {
    const std::int32_t law = law_of(i);
    double pressure = 0.0;
    for (std::uint32_t k = region.begin; k < region.end; ++k) {
      pressure += law_of(k) == law ? pieces[k].length * (pieces[k].depth_begin + pieces[k].depth_end) : 0.0;
    }
    if (pressure > most || (pressure == most && law < carrying)) {
      most = pressure;
      carrying = law;
    }
  }
  return carrying;
}

void take_law(const BlockSystem &system, const ContactParameters &parameters, std::int32_t law,
              CandidatePair &pair) {
  const double stiffness = parameters.joints.stiffness(law).normal_stiffness;
  const BlockProperties &a = system.properties[pair.lower.value];
  const BlockProperties &b = system.properties[pair.higher.value];
  pair.law = law;
  // A fixed or driven block counts as infinitely heavy and sets no length.
  const bool a_fixed = a.keeps_its_velocity();
  const bool b_fixed = b.keeps_its_velocity();
  pair.mass = a_fixed ? b.mass : b_fixed ? a.mass : a.mass * b.mass / (a.mass + b.mass);
  const double smaller_area = a_fixed ? b.area : b_fixed ? a.area : std::min(a.area, b.area);
  // c' = 2 xi sqrt(k_n m_eff / L_ref) + beta k_n, half of it for each side's pieces.
  pair.damping = parameters.damping_ratio * std::sqrt(stiffness * pair.mass / std::sqrt(smaller_area)) +
                 0.5 * parameters.stiffness_damping * stiffness;
}

std::int32_t PairForces::law_beside(const BlockSystem &system, const CandidatePair &pair,
                                    const Region &region) const {
  const auto is_part_of = [&](const Region &other) {
    return goes_on(system, pair, overlap_.pieces(), region, other) ||
           goes_on(system, pair, overlap_.pieces(), other, region);
  };
  const auto beside = std::find_if(found_.begin(), found_.end(), [&](const FoundRegion &other) {
    return other.known != nullptr && is_part_of(*other.region);
  });
  return beside != found_.end() ? beside->known->law : -1;
}

void PairForces::choose_law(const BlockSystem &system, const CandidatePair &pair, const Region &region,
                            RegionMemory &memory) const {
  const JointLaws &joints = parameters_->joints;
  const std::int32_t edges = law_of_region(system, joints, pair, overlap_.pieces(), region);
  memory.law = memory.law < 0 ? edges : joints.slid_to(memory.law, edges);
}

} // namespace gcpdda
