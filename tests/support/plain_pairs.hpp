#pragma once

// Plain pairs in the lanes against the same ones in another way.

#include "blocks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <tuple>

namespace gcpdda::testing {

/// Two benches of the same blocks, one of which takes no pair as plain.
struct TwoWays {
  ContactBench plain;
  ContactBench general;

  TwoWays(const BlockSystem &system, const JointLaws &joints, double damping_ratio)
      : plain(system, joints, damping_ratio), general(system, joints, damping_ratio) {
    Candidates &all = general.candidates;
    for (std::uint32_t k = 0; k < all.pairs.size(); ++k) {
      all.pairs[k].is_plain = false;
      all.general.push_back(k);
    }
    all.num_interior_general = all.pairs.size();
    all.num_interior_plain = 0;
    all.plain.clear();
    all.groups = {PairGroup{.is_last = true}};
    all.waiting = all.general;
    all.is_added.assign(all.is_added.size(), 0);
    all.are_added.assign(all.are_added.size(), 0);
  }
};

/// Mean number of edges in the chains of both blocks.
inline double edges_a_pair(const Candidates &candidates) {
  double edges = 0.0;
  for (const PlainPair &plain : candidates.plain) {
    edges += plain.kind.lower_edges + plain.kind.higher_edges;
  }
  return edges / static_cast<double>(candidates.plain.size());
}

inline void expect_near(Vec2 a, Vec2 b, double tolerance, const char *what) {
  EXPECT_NEAR(a.x, b.x, tolerance) << what;
  EXPECT_NEAR(a.y, b.y, tolerance) << what;
}

inline void expect_near(const Mat2 &a, const Mat2 &b, double tolerance, const char *what) {
  EXPECT_NEAR(norm(a - b), 0.0, tolerance) << what;
}

/// Moments do not depend on the point the dyad is about.
inline Mat2 about_zero(const Mat2 &dyad, Vec2 origin, Vec2 force) {
  return dyad + outer(origin, force);
}

/// Returns what a dyad may be off.
inline double expect_same(const RegionForce &a, const RegionForce &b, double stiffness, double far) {
  EXPECT_EQ(a.born, b.born);
  EXPECT_EQ(a.normal_undefined, b.normal_undefined);
  // Depths are differences of coordinates up to `far`, integrated along edges of a few metres.
  const double rounding = 64.0 * std::numeric_limits<double>::epsilon() * far;
  const double force = stiffness * rounding + 1e-13 * norm(b.force);
  const double turned = force / b.normal_force; // an error of n_r
  const double forces = force + turned * norm(b.force);
  expect_near(a.force, b.force, forces, "force");
  EXPECT_NEAR(a.normal_force, b.normal_force, force);
  expect_near(a.normal, b.normal, turned, "normal");
  expect_near(a.point, b.point, rounding + turned, "point");
  expect_near(a.grip, b.grip, rounding + turned, "grip");
  EXPECT_NEAR(a.overlap, b.overlap, rounding + turned);
  EXPECT_NEAR(a.extent_end - a.extent_begin, b.extent_end - b.extent_begin, rounding + turned);
  EXPECT_NEAR(a.shear, b.shear, forces);
  EXPECT_NEAR(a.cap, b.cap, forces);
  expect_near(a.shear_force, b.shear_force, forces, "shear force");
  expect_near(a.damping_force, b.damping_force, forces, "damping force");
  expect_near(about_zero(a.dyad, a.origin, a.force), about_zero(b.dyad, b.origin, b.force),
              4.0 * far * forces, "dyad");
  for (const std::size_t k : {0U, 1U}) { // about centroids 2 m away
    EXPECT_NEAR(a.torque[k], b.torque[k], 8.0 * forces);
    EXPECT_NEAR(a.shear_torque[k], b.shear_torque[k], 8.0 * forces);
    EXPECT_NEAR(a.damping_torque[k], b.damping_torque[k], 8.0 * forces);
  }
  return 4.0 * far * forces;
}

/// Of the only contact of a deformable row.
inline const BlockGradientSum &dyads_on(const ContactBench &bench, std::size_t row) {
  return bench.system.deformation_of(row).contact;
}

inline void evaluate_and_finish(ContactBench &first, ContactBench &second) {
  for (ContactBench *bench : {&first, &second}) {
    bench->evaluate();
    bench->forces.finish_sums(bench->system, bench->candidates);
  }
}

/// @return how many rows that deform have a contact
inline std::size_t expect_same_sums(const ContactBench &got, const ContactBench &wanted) {
  const auto sums = [](const auto &f) { return std::tie(f.force, f.shear, f.damping); };
  const std::span<const BlockContactSum> of_blocks = wanted.forces.sums().of_blocks();
  std::size_t deforming = 0;
  for (std::size_t row = 0; row < of_blocks.size(); ++row) {
    EXPECT_EQ(sums(got.forces.sums().of_blocks()[row]), sums(of_blocks[row]));
    if (wanted.system.is_deformable(row)) {
      EXPECT_EQ(sums(dyads_on(got, row)), sums(dyads_on(wanted, row)));
      deforming += norm(of_blocks[row].force.u) > 0.0 ? 1 : 0;
    }
  }
  return deforming;
}

inline std::ptrdiff_t num_seen_as(PlainOverlap overlap, const ContactHistory &history) {
  return std::ranges::count(history.overlaps, overlap);
}

/// Where a couple stands in the list of pairs; none for one that is left out.
inline std::optional<std::size_t> find_pair(const ContactBench &bench, const CandidatePair &wanted) {
  for (std::size_t k = 0; k < bench.candidates.pairs.size(); ++k) {
    const CandidatePair &pair = bench.candidates.pairs[k];
    if (pair.lower.value == wanted.lower.value && pair.higher.value == wanted.higher.value) {
      return k;
    }
  }
  return std::nullopt;
}

} // namespace gcpdda::testing
