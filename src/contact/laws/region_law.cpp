#include "contact/laws/region_law.hpp"

#include "contact/pair_forces.hpp"

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

/// Whether an outline goes on from a piece to the other one inside of the other block.
bool goes_on(const Piece &piece, const Piece &next) {
  return norm(piece.end() - next.begin) < std::min(piece.depth_end, next.depth_begin);
}

/// Whether an outline goes on from one region to the other one: both are parts of one overlap.
bool goes_on(std::span<const Piece> pieces, const Region &region, const Region &next) {
  const auto within = [&](std::uint32_t begin, std::uint32_t end) {
    return pieces.subspan(begin, end - begin);
  };
  const auto any_goes_on = [](std::span<const Piece> from, std::span<const Piece> to) {
    return std::any_of(from.begin(), from.end(), [&](const Piece &piece) {
      return std::any_of(to.begin(), to.end(), [&](const Piece &other) { return goes_on(piece, other); });
    });
  };
  return any_goes_on(within(region.begin, region.middle), within(next.begin, next.middle)) ||
         any_goes_on(within(region.middle, region.end), within(next.middle, next.end));
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
                           std::span<const Piece> pieces, const Region &region,
                           std::span<const double> bonded) {
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
      const double whole = pieces[k].length * (pieces[k].depth_begin + pieces[k].depth_end);
      pressure += law_of(k) == law ? whole - (bonded.empty() ? 0.0 : 2.0 * bonded[k]) : 0.0;
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

std::int32_t PairForces::law_beside(const Region &region) const {
  const auto is_part_of = [&](const Region &other) {
    return goes_on(overlap_.pieces(), region, other) || goes_on(overlap_.pieces(), other, region);
  };
  const auto beside = std::find_if(found_.begin(), found_.end(), [&](const FoundRegion &other) {
    return other.known != nullptr && is_part_of(*other.region);
  });
  return beside != found_.end() ? beside->known->law : -1;
}

void PairForces::choose_law(const BlockSystem &system, const CandidatePair &pair, const Region &region,
                            const BondShare &bonds, RegionMemory &memory) {
  const JointLaws &joints = parameters_->joints;
  const std::span<const Piece> pieces = overlap_.pieces();
  std::int32_t edges = law_of_region(system, joints, pair, pieces, region);
  memory.law = memory.law < 0 ? edges : memory.law;
  if (bonds.holds && bonds.free_length > 0.0) {
    find_bonded(system, pair, region);
    edges = law_of_region(system, joints, pair, pieces, region, bonded_);
  }
  memory.law = joints.slid_to(memory.law, edges);
}

} // namespace gcpdda
