#pragma once

// Products with the stiffness K of contacts.
//
// The solution with K takes some thirty products an evaluation, and each of them passes over all springs. It
// is therefore done in single precision. What it is found to (a tenth) and what it is for (a step towards
// equilibrium, which the forces alone decide) ask for no more. Rounded, K is still symmetric and never
// negative, because each spring is one number times one stretch. Springs of rigid blocks are taken four at a
// time, one in each place of a register; their forces are added one after the other, so that a block has the
// sum of its springs in the order of the list.

#include "statics/field.hpp"
#include "statics/springs.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace gcpdda::statics {

/// Which springs K has of regions that slip.
enum class SlipSprings { all, none_tangential };

/// A register that has a number of each of four springs.
using Four = float __attribute__((vector_size(4 * sizeof(float))));

class SpringProducts {
public:
  /// Those that ContactSprings::for_lists() tells, in order.
  /// @param width  of the fields
  void take(const ContactSprings &springs, SlipSprings of_slip, std::size_t width);
  /// y += K p. Rows of y that are not owned get sums that mean nothing.
  void add(const BlockSystem &system, const LeanField &p, LeanField &y) const;

private:
  /// As ContactSpring.
  struct Spring {
    std::uint32_t lower = 0; ///< rows
    std::uint32_t higher = 0;
    float normal_x = 0.0F;
    float normal_y = 0.0F;
    float lower_arm_x = 0.0F;
    float lower_arm_y = 0.0F;
    float higher_arm_x = 0.0F;
    float higher_arm_y = 0.0F;
    float normal_stiffness = 0.0F;
    float bending = 0.0F;
    float tangential = 0.0F;
    float grip = 0.0F;
  };
  /// Springs between rigid blocks; those that fill up the last four have no stiffness.
  struct FourSprings {
    std::array<std::uint32_t, 4> lower{};
    std::array<std::uint32_t, 4> higher{};
    Four normal_x{};
    Four normal_y{};
    Four lower_n{}; ///< levers of the normal and of the tangential force
    Four higher_n{};
    Four lower_t{};
    Four higher_t{};
    Four normal_stiffness{};
    Four tangential{};
    Four bending{};
  };

  void append_rigid(const ContactSpring &spring, double tangential);
  void add_rigid(const LeanField &p, LeanField &y) const;
  void add_any(const BlockSystem &system, const LeanField &p, LeanField &y) const;

  std::vector<Spring> springs_; ///< where blocks deform, else
  std::vector<FourSprings> fours_;
  std::size_t num_rigid_ = 0;
};

} // namespace gcpdda::statics
