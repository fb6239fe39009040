#pragma once

// Products with the stiffness K of contacts.
//
// The solution with K takes some thirty products an evaluation, and each of them reads all springs: those of
// 10^5 blocks do not stay in a cache. They are therefore kept in single precision, 48 bytes in place of 112,
// which takes a quarter off the solution. What it is found to (a tenth) and what it is for (a step towards
// equilibrium, which the forces alone decide) ask for no more; sums are in double precision. Rounded, K is
// still symmetric and never negative, because each spring is one number times one stretch.

#include "statics/field.hpp"
#include "statics/springs.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace gcpdda::statics {

struct LeanSpring {
  std::uint32_t lower = 0; ///< rows
  std::uint32_t higher = 0;
  // As those of ContactSpring.
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

/// Which springs K has of regions that slip.
enum class SlipSprings { all, none_tangential };

/// Those that ContactSprings::for_lists() tells, in order.
void take_lean(const ContactSprings &springs, SlipSprings of_slip, std::vector<LeanSpring> &lean);

/// y += K p. Rows of y that are not owned get sums that mean nothing.
void add_product(const BlockSystem &system, std::span<const LeanSpring> springs, const Field &p, Field &y);

} // namespace gcpdda::statics
