#pragma once

// Products with the stiffness K of contacts.
//
// The solution with K takes some thirty products an evaluation, and each of them passes over all springs. It
// is therefore done in single precision. What it is found to (a tenth) and what it is for (a step towards
// equilibrium, which the forces alone decide) ask for no more. Rounded, K is still symmetric and never
// negative, because each spring is one number times one stretch. Springs are taken four at a time, one
// in each place of a register; their forces are added one after the other, so that a block has the sum of its
// springs in the order of the list.

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
  void take(const BlockSystem &system, const ContactSprings &springs, SlipSprings of_slip, std::size_t width);
  /// y += K p. Rows of y that are not owned get sums that mean nothing.
  void add(const LeanField &p, LeanField &y) const;

private:
  /// Springs between rigid blocks.
  struct FourSprings {
    std::array<std::uint32_t, 4> lower{}; ///< rows; those that fill up the last four have no stiffness
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
  /// The same where blocks deform.
  struct FourStraining {
    std::array<std::uint32_t, 4> lower{};
    std::array<std::uint32_t, 4> higher{};
    Four lower_deforms{}; ///< 1, or 0 for a rigid row
    Four higher_deforms{};
    Four normal_x{};
    Four normal_y{};
    Four lower_x{}; ///< arms
    Four lower_y{};
    Four higher_x{};
    Four higher_y{};
    Four grip{};
    Four normal_stiffness{};
    Four tangential{};
    Four bending{};
  };

  void append_rigid(const ContactSpring &spring, double tangential);
  void append_straining(const BlockSystem &system, const ContactSpring &spring, double tangential);
  void add_rigid(const LeanField &p, LeanField &y) const;
  void add_straining(const LeanField &p, LeanField &y) const;

  std::vector<FourSprings> rigid_; ///< where no block deforms, else
  std::vector<FourStraining> straining_;
  std::size_t num_springs_ = 0;
};

} // namespace gcpdda::statics
