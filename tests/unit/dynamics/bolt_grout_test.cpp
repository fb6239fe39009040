// Grout of a bar: how a slip draws the bar out of it, and what an excavation leaves of it.

#include "dynamics/bolt_link.hpp"
#include "simulation/bolt_pieces.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace gcpdda::testing::bolt_grout_test {
namespace {

/// Elastic with 2e8 N/m, in 0.2 m of grout that bears 1e5 N/m.
LinkLaw short_bar() {
  LinkLaw law;
  law.axial_stiffness = 2e8;
  law.bond_strength = 1e5;
  law.bond_capacity = 2e4;
  return law;
}

// With the slip g = e - N/k the grout bears N = b (l - g), so N = b (l - e)/(1 - b/k); work of the slip is
// b (l g - g^2/2). All of it up to rounding, however many evaluations are on the way.
TEST(BoltGrout, IsDrawnOutOfItsGrout) {
  const LinkLaw law = short_bar();
  const double ratio = law.bond_strength / law.axial_stiffness;
  LinkMemory by_steps;
  for (int k = 1; k <= 150; ++k) {
    const double e = 1e-3 * k;
    by_steps = respond(law, by_steps, e, 0.0);
    const double force = 1e5 * (0.2 - e) / (1.0 - ratio);
    const double slip = e - force / law.axial_stiffness;
    EXPECT_NEAR(by_steps.axial, force, 1e-8);
    EXPECT_NEAR(axial_capacity(law, by_steps), force, 1e-8);
    EXPECT_NEAR(by_steps.dissipated, 1e5 * (0.2 * slip - 0.5 * slip * slip), 1e-9);
  }
  EXPECT_TRUE(by_steps.yielded);
  EXPECT_FALSE(by_steps.broken);
  const LinkMemory at_once = respond(law, {}, 0.15, 0.0);
  EXPECT_NEAR(at_once.axial, by_steps.axial, 1e-8);
  EXPECT_NEAR(respond(law, at_once, 0.15, 0.0).axial, at_once.axial, 1e-8);
  // Out at e = l, and then for good.
  EXPECT_FALSE(respond(law, by_steps, 0.19999, 0.0).broken);
  const LinkMemory out = respond(law, by_steps, 0.20001, 0.0);
  EXPECT_TRUE(out.broken);
  EXPECT_EQ(out.axial, 0.0);
  EXPECT_NEAR(out.dissipated, 0.5 * 1e5 * 0.2 * 0.2, 1e-9);
  EXPECT_EQ(respond(law, out, 0.0, 0.0).axial, 0.0);
}

// Pushed back by more than it was drawn out it has all of its grout, and is drawn out of it only once it has
// come as far again.
TEST(BoltGrout, RegainsItsGroutAsItIsPushedBack) {
  const LinkLaw law = short_bar();
  const LinkMemory drawn = respond(law, {}, 0.05, 0.0);
  const double slip = drawn.grout_slip;
  EXPECT_NEAR(slip, 0.05 - 1e5 * 0.15 / (1.0 - 5e-4) / 2e8, 1e-12);
  // -N = b (l - g) with g = e - N/k: N = -b (l - e)/(1 + b/k).
  const LinkMemory back = respond(law, drawn, 0.02, 0.0);
  EXPECT_NEAR(back.axial, -1e5 * 0.18 / (1.0 + 5e-4), 1e-8);
  const LinkMemory beyond = respond(law, back, -0.01, 0.0);
  EXPECT_NEAR(beyond.axial, -2e4, 1e-8);
  EXPECT_NEAR(beyond.grout_slip, -0.01 + 1e-4, 1e-12);
  const LinkMemory pulled = respond(law, beyond, -0.005, 0.0);
  EXPECT_NEAR(pulled.axial, 2e4, 1e-8);
  const LinkMemory again = respond(law, pulled, 0.05, 0.0);
  EXPECT_NEAR(again.axial, drawn.axial, 1e-8);
  EXPECT_NEAR(again.grout_slip, slip, 1e-12);
  EXPECT_GT(again.dissipated, drawn.dissipated + 2e4 * 0.05);
}

// A bar softer than its grout is brittle comes out at once: what it stores is lost.
TEST(BoltGrout, ComesOutAtOnceOnASoftSpring) {
  LinkLaw law = short_bar();
  law.axial_stiffness = 5e4;
  EXPECT_NEAR(respond(law, {}, 0.399, 0.0).axial, 5e4 * 0.399, 1e-8);
  const LinkMemory out = respond(law, {}, 0.401, 0.0);
  EXPECT_TRUE(out.broken);
  EXPECT_EQ(out.axial, 0.0);
  EXPECT_NEAR(out.dissipated, 0.5 * 2e4 * 2e4 / 5e4, 1e-8);
}

// The grout slips at 2e4 N, so the steel never stretches by more than 1e-4 m; steel that yields below that
// breaks by its flow.
TEST(BoltGrout, BreaksByTheElongationOfItsSteelAlone) {
  LinkLaw law = short_bar();
  law.rupture = 1.001e-4;
  law.axial_yield = 3e4;
  const LinkMemory slipped = respond(law, {}, 0.1, 0.0);
  EXPECT_FALSE(slipped.broken);
  EXPECT_EQ(slipped.steel_slip, 0.0);
  law.axial_yield = 1e4;
  const LinkMemory yielded = respond(law, {}, 1e-4, 0.0);
  EXPECT_FALSE(yielded.broken);
  EXPECT_EQ(yielded.grout_slip, 0.0);
  EXPECT_TRUE(respond(law, yielded, 1.002e-4, 0.0).broken);
}

/// Blocks 0, 1, 2, 3 of 1 m each from the head, and what is left of the grout of the joints between those of
/// them that stay.
std::vector<BoltLink> left_without(std::int64_t gone, bool plate, double slip = 0.0) {
  Bolt bolt;
  bolt.from = {0.5, 4.0};
  bolt.to = {0.5, 0.0};
  SupportType support;
  support.axial_stiffness = 1e8;
  support.active_length = 0.4;
  support.plate = plate;
  std::vector<BoltPiece> pieces{{0, 0, 0.0, 0.25}, {0, 1, 0.25, 0.5}, {0, 2, 0.5, 0.75}, {0, 3, 0.75, 1.0}};
  std::vector<BoltLink> links = links_of(bolt, 0, support, pieces);
  for (BoltLink &link : links) {
    link.memory.grout_slip = slip;
  }
  const auto is_gone = [&](std::int64_t block) { return block == gone; };
  end_bars_at_voids(links, is_gone);
  std::erase_if(
      links, [&](const BoltLink &link) { return is_gone(link.end[0].block) || is_gone(link.end[1].block); });
  return links;
}

TEST(BoltGrout, BarsEndWhereBlocksHaveBeenExcavated) {
  const double unlimited = SupportType::unlimited;
  const auto expect_grout = [](const BoltLink &link, double head, double tip) {
    EXPECT_DOUBLE_EQ(link.grout[0], head);
    EXPECT_DOUBLE_EQ(link.grout[1], tip);
  };
  for (const bool plate : {false, true}) {
    const auto without_head = left_without(0, plate); // and so without the plate
    ASSERT_EQ(without_head.size(), 2U);
    expect_grout(without_head[0], 1.0, 2.0);
    expect_grout(without_head[1], 2.0, 1.0);
    const auto without_tip = left_without(3, plate);
    ASSERT_EQ(without_tip.size(), 2U);
    expect_grout(without_tip[0], plate ? unlimited : 1.0, 2.0);
    expect_grout(without_tip[1], plate ? unlimited : 2.0, 1.0);
    const auto upper = left_without(2, plate);
    ASSERT_EQ(upper.size(), 1U);
    expect_grout(upper[0], plate ? unlimited : 1.0, 1.0);
    const auto lower = left_without(1, plate);
    ASSERT_EQ(lower.size(), 1U);
    expect_grout(lower[0], 1.0, 1.0);
    const auto whole = left_without(9, plate);
    ASSERT_EQ(whole.size(), 3U);
    expect_grout(whole[0], plate ? unlimited : 1.0, 3.0);
  }
}

// Of the 3 m above the upper joint 0.4 m have been drawn out; 2 m of rock are left, all filled by the bar,
// and 1 m minus the slip where the end was drawn out of the shorter side.
TEST(BoltGrout, BarsThatHaveBeenDrawnOutEndInTheRockThatIsLeft) {
  const auto plated = left_without(3, true, 0.4);
  EXPECT_NEAR(plated[0].grout[1], 2.0, 1e-12);
  EXPECT_EQ(plated[0].memory.grout_slip, 0.0);
  const auto plain = left_without(3, false, 0.4);
  EXPECT_NEAR(plain[0].grout[0], 0.6, 1e-12);
  EXPECT_NEAR(plain[0].grout[1], 2.0, 1e-12);
  EXPECT_NEAR(left_without(9, false, 0.4)[0].grout[0], 1.0, 1e-12);
  EXPECT_EQ(left_without(9, false, 0.4)[0].memory.grout_slip, 0.4);
}

} // namespace
} // namespace gcpdda::testing::bolt_grout_test
