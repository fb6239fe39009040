#pragma once

// All contact regions of the last evaluation at once, which no run ever holds, and what follows from them one
// block after the other.

#include "contact/contact_forces.hpp"
#include "simulation/simulation.hpp"

#include <array>
#include <vector>

namespace gcpdda::testing {

class Regions {
public:
  Regions() = default;
  Regions(const BlockSystem &system, const Candidates &candidates, const ContactHistory &history,
          ContactForces &forces)
      : ranges_(candidates.pairs.size()) {
    forces.for_regions(
        system, candidates, history, 0, static_cast<std::uint32_t>(ranges_.size()),
        [this](std::uint32_t pair, std::span<const RegionForce> regions) { take(pair, regions); });
  }
  explicit Regions(Simulation &simulation) : ranges_(simulation.candidates().pairs.size()) {
    for_regions(simulation.state(), 0, ranges_.size(),
                [this](std::uint32_t pair, std::span<const RegionForce> regions) { take(pair, regions); });
  }

  /// Those of a pair together, by pair.
  [[nodiscard]] const std::vector<RegionForce> &all() const { return all_; }
  [[nodiscard]] std::span<const RegionForce> of_pair(std::size_t pair) const {
    return std::span(all_).subspan(ranges_[pair].begin, ranges_[pair].count);
  }
  /// visit(region, is the block the lower one) in the order of the other blocks' ids.
  template <class Visit> void for_block(const Candidates &candidates, std::size_t row, Visit &&visit) const {
    for (std::size_t k = 0; k < ranges_.size(); ++k) {
      const CandidatePair &pair = candidates.pairs[k];
      if (pair.lower.value == row || pair.higher.value == row) {
        for (const RegionForce &force : of_pair(k)) {
          visit(force, pair.lower.value == row);
        }
      }
    }
  }
  [[nodiscard]] BlockContactSum sum_contacts(const Candidates &candidates, std::size_t row) const {
    BlockContactSum sum;
    for_block(candidates, row, [&](const RegionForce &f, bool is_lower) {
      const double sign = is_lower ? 1.0 : -1.0;
      const std::size_t k = is_lower ? 0 : 1;
      sum.force += RigidDof{sign * f.force, f.torque[k]};
      sum.shear += RigidDof{sign * f.shear_force, f.shear_torque[k]};
      sum.damping += RigidDof{sign * f.damping_force, f.damping_torque[k]};
    });
    return sum;
  }

private:
  void take(std::uint32_t pair, std::span<const RegionForce> regions) {
    ranges_[pair] = {static_cast<std::uint32_t>(all_.size()), static_cast<std::uint32_t>(regions.size())};
    all_.insert(all_.end(), regions.begin(), regions.end());
  }

  std::vector<RegionForce> all_;
  std::vector<RegionRange> ranges_;
};

inline std::vector<RegionForce> regions_of(Simulation &simulation) {
  return Regions(simulation).all();
}

} // namespace gcpdda::testing
