// Factors of safety of blocks that slide, whose limit is known in closed form, found with the default
// settings of gcpdda fos. All belong to the untouched half of the known limits.

#include "safety_limits.hpp"

#include "geometry/polygon.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace gcpdda::testing::safety_limits_test {
namespace {

/// Gravity on a plane that falls by `dip` (rad) towards +x and lies along x.
Vec2 gravity_on(double dip) {
  return {earth_gravity * std::sin(dip), -earth_gravity * std::cos(dip)};
}
const std::string long_plane = block_toml("plane", rectangle({-2.0, -1.0}, {40.0, 0.0}), "fixed = true");

// F = tan(phi)/tan(th), phi = th + 7 degrees.
TEST(SafetyLimits, InclinesAtFiveAngles) {
  for (const int dip : {10, 20, 30, 40, 50}) {
    const double phi = dip + 7.0;
    const std::string toml = head({.gravity = gravity_on(dip * degree), .friction_deg = phi}) + long_plane +
                             block_toml("block", rectangle({0.0, 0.0}, {2.0, 1.0}));
    expect_factor(
        {fmt::format("incline at {} degrees", dip), std::tan(phi * degree) / std::tan(dip * degree)}, toml);
  }
}

Scene on_the_plane_at_30_degrees(const std::string &blocks) {
  return scene_of(without_duration(head({.gravity = gravity_on(30.0 * degree), .friction_deg = 37.0}) +
                                   long_plane + blocks) +
                  "[[stage]]\nkind = \"settle\"\nlimit = 10.0\n");
}
const double limit_of_the_plane = std::tan(37.0 * degree) / std::tan(30.0 * degree);

// A block that slides on and finds hold before it has moved by a tenth of its size has not failed, whatever
// its friction is, and no bound may say so. As it lies, it holds up to the limit of the plane.
void expect_hold_after_a_slide(const char *name, const Scene &scene) {
  EXPECT_EQ(search_quietly(scene).report.holds, scene.reduction.to) << name;
  const SafetyReport found = search_quietly(scene, true).report;
  EXPECT_FALSE(found.bound) << name;
  EXPECT_NEAR(found.resting_bound.value_or(0.0), limit_of_the_plane, 3e-3 * limit_of_the_plane) << name;
}

std::string before_a_stop(double gap) {
  return block_toml("block", rectangle({0.0, 0.0}, {2.0, 1.0})) +
         block_toml("stop", rectangle({2.0 + gap, 0.0}, {3.0 + gap, 1.0}), "fixed = true");
}

TEST(SafetyLimits, ABlockThatFindsHoldHasNoBound) {
  expect_hold_after_a_slide("wide gap", on_the_plane_at_30_degrees(before_a_stop(0.05)));
  const std::string a_small_block =
      block_toml("small", rectangle({4.0, 0.0}, {4.3, 0.3})) +
      block_toml("before_it", rectangle({4.3, 0.0}, {5.0, 1.0}), "fixed = true");
  expect_hold_after_a_slide("a smaller block elsewhere",
                            on_the_plane_at_30_degrees(before_a_stop(0.1) + a_small_block));
  // The tip slides in under the corner of the stop, which stands beyond the lower end of the face.
  expect_hold_after_a_slide(
      "corner beyond an edge",
      on_the_plane_at_30_degrees(block_toml("block", {{0.0, 0.0}, {2.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}) +
                                 block_toml("stop", rectangle({2.075, 0.01}, {3.0, 1.0}), "fixed = true")));

  const Scene near = on_the_plane_at_30_degrees(before_a_stop(1e-4));
  EXPECT_EQ(search_quietly(near).report.holds, near.reduction.to);
  EXPECT_FALSE(search_quietly(near, true).report.bound || search_quietly(near, true).report.resting_bound);
}

TEST(SafetyLimits, ABlockThatFindsNoHoldInTimeHasTheBoundOfThePlane) {
  const Scene scene = on_the_plane_at_30_degrees(before_a_stop(0.5));
  const SafetyReport found = search_quietly(scene).report;
  ASSERT_TRUE(found.holds && found.fails);
  EXPECT_NEAR(0.5 * (*found.holds + *found.fails), limit_of_the_plane, 0.01 * limit_of_the_plane);
  const SafetyReport bounds = search_quietly(scene, true).report;
  EXPECT_NEAR(bounds.bound.value_or(0.0), limit_of_the_plane, 3e-3 * limit_of_the_plane);
  EXPECT_EQ(bounds.bound, bounds.resting_bound);
}

// It leaves the rock above it, whose corner stands beside its own, a micrometre higher and as far away: it
// cannot come to lie under that corner, which would hold it with any friction.
TEST(SafetyLimits, ABlockThatLeavesACornerHasTheBoundOfThePlane) {
  const Scene scene = on_the_plane_at_30_degrees(
      block_toml("block", rectangle({0.0, 0.0}, {2.0, 1.0})) +
      block_toml("rock", rectangle({-2.0, 0.0}, {-1e-6, 1.000001}), "fixed = true"));
  const SafetyReport bounds = search_quietly(scene, true).report;
  EXPECT_NEAR(bounds.bound.value_or(0.0), limit_of_the_plane, 3e-3 * limit_of_the_plane);
}

// F = (c + N tan(phi))/S over a base of 4 m, N and S the forces of the weight on it. A bond bears the
// pressure on its length: what is left of the strength when it has broken does not act beside it.
TEST(SafetyLimits, ABondedBlockHasTheBoundOfItsBond) {
  struct Law {
    double friction_deg, cohesion, tension, residual_cohesion;
  };
  for (const Law &law : {Law{20.0, 20e3, 0.0, 20e3}, Law{20.0, 20e3, 5e3, 0.0}, Law{0.0, 20e3, 5e3, 20e3},
                         Law{40.0, 5e3, 3e3, 0.0}}) {
    const Scene scene = scene_of(
        without_duration(head({.gravity = gravity_on(20.0 * degree), .friction_deg = law.friction_deg}) +
                         fmt::format("[joint.glued]\nfriction_angle_deg = {}\ncohesion = {}\ntension = {}\n"
                                     "residual_cohesion = {}\n",
                                     law.friction_deg, law.cohesion, law.tension, law.residual_cohesion) +
                         long_plane +
                         block_toml("block", rectangle({0.0, 0.0}, {4.0, 1.0}),
                                    "edge_joints = [\"glued\", \"\", \"\", \"\"]")) +
        "[fos]\nto = 10.0\n[[stage]]\nkind = \"settle\"\nlimit = 10.0\n");
    const double stress = rock_density * earth_gravity * std::sin(20.0 * degree);
    const double exact =
        law.cohesion / stress + std::tan(law.friction_deg * degree) / std::tan(20.0 * degree);
    EXPECT_NEAR(search_quietly(scene, true).report.bound.value_or(0.0), exact, 3e-3 * exact);
  }
}

// The block before it is taken away: the trials begin with fewer blocks than the scene has.
TEST(SafetyLimits, InclineAfterAnExcavation) {
  const Scene scene = scene_of(
      without_duration(head({.gravity = gravity_on(30.0 * degree), .friction_deg = 37.0}) + long_plane +
                       before_a_stop(0.0)) +
      "[[stage]]\nkind = \"settle\"\nlimit = 10.0\n[[stage]]\nkind = \"excavate\"\nblocks = [\"stop\"]\n"
      "[[stage]]\nkind = \"settle\"\nlimit = 10.0\n");
  expect_factor({"incline after an excavation", limit_of_the_plane}, scene);
}

// One of more than a thousand blocks is few enough for a static trial not to wait for it (0.1 %) if it stays
// near. Here it slides on: the motion of single blocks or else the step that confirms the trial sees it.
TEST(SafetyLimits, ASlidingBlockAmongAThousandAtRest) {
  const double dip = 30.0 * degree;
  const Vec2 down{std::cos(dip), -std::sin(dip)};
  const Vec2 up{std::sin(dip), std::cos(dip)};
  const auto on_plane = [&](double along, double above) { return along * down + above * up; };
  const std::string toml =
      head({.friction_deg = 37.0}) +
      "[[wall]]\nname = \"wall\"\nmaterial = \"rock\"\norigin = [100.0, 0.0]\n"
      "rows = 24\ncolumns = 48\nblock_size = [1.0, 0.5]\n" +
      block_toml("floor", rectangle({98.0, -1.0}, {152.0, 0.0}), "fixed = true") +
      block_toml("plane",
                 {on_plane(-2.0, -1.0), on_plane(40.0, -1.0), on_plane(40.0, 0.0), on_plane(-2.0, 0.0)},
                 "fixed = true") +
      block_toml("block", {on_plane(0.0, 0.0), on_plane(2.0, 0.0), on_plane(2.0, 1.0), on_plane(0.0, 1.0)});
  KnownLimit limit{"block on an incline beside a wall of a thousand",
                   std::tan(37.0 * degree) / std::tan(dip)};
  limit.bound_tolerance = 0.0; // a linear programme of some thousand forces says nothing new
  expect_factor(limit, toml);
}

// Two blocks on each other slide on the lower joint, which carries more and has the same friction, or where
// the upper one has less, on that: F = tan(phi)/tan(th) of the weaker joint.
TEST(SafetyLimits, WeakerOfTwoJoints) {
  const double dip = 25.0 * degree;
  std::string toml = head({.gravity = gravity_on(dip), .friction_deg = 45.0});
  toml.insert(toml.find("[joint.default]"), "[material.cap]\ndensity = 2600.0\n");
  toml += "[joint.weak]\nmaterials = [\"rock\", \"cap\"]\nfriction_angle_deg = 35.0\n" + long_plane +
          block_toml("lower", rectangle({0.0, 0.0}, {3.0, 1.0})) +
          "[[block]]\nname = \"upper\"\nmaterial = \"cap\"\n"
          "vertices = [[0.5, 1.0], [2.5, 1.0], [2.5, 2.0], [0.5, 2.0]]\n";
  expect_factor({"two blocks on an incline", std::tan(35.0 * degree) / std::tan(dip)}, toml);
}

// A block that would slide alone leans on one below it with a rougher base. The joint between them is smooth
// (one with friction passes weight to the rougher base, and the factor depends on how much): both slide
// together, and F = (tan(phi1) + tan(phi2))/(2 tan(th)) for blocks of the same weight.
TEST(SafetyLimits, BlockHeldByAnother) {
  const double dip = 30.0 * degree;
  std::string toml = head({.gravity = gravity_on(dip), .friction_deg = 25.0});
  toml.insert(toml.find("[joint.default]"),
              "[material.rough]\ndensity = 2600.0\n[material.upper]\ndensity = 2600.0\n");
  toml += "[joint.rough]\nmaterials = [\"rock\", \"rough\"]\nfriction_angle_deg = 50.0\n"
          "[joint.smooth]\nmaterials = [\"upper\", \"rough\"]\nfriction_angle_deg = 0.0\n" +
          long_plane +
          "[[block]]\nname = \"upper\"\nmaterial = \"upper\"\n"
          "vertices = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]\n"
          "[[block]]\nname = \"lower\"\nmaterial = \"rough\"\n"
          "vertices = [[2.0, 0.0], [4.0, 0.0], [4.0, 1.0], [2.0, 1.0]]\n";
  expect_factor(
      {"block held by another", (std::tan(25.0 * degree) + std::tan(50.0 * degree)) / (2.0 * std::tan(dip))},
      toml);
}

// A horizontal force H on a block on a floor: F = W tan(phi)/H.
TEST(SafetyLimits, BlockPushedOnAFloor) {
  const double weight = rock_density * earth_gravity * 2.0;
  const std::string toml =
      head({.friction_deg = 30.0}) + long_plane + block_toml("block", rectangle({0.0, 0.0}, {2.0, 1.0})) +
      fmt::format("[[block.load]]\npoint = [1.0, 0.2]\nforce = [{:.17g}, 0.0]\n", 0.4 * weight);
  expect_factor({"block pushed on a floor", std::tan(30.0 * degree) / 0.4}, toml);
}

// Cohesion alone, nearly: F = (W cos(th) tan(phi) + c l)/(W sin(th)).
TEST(SafetyLimits, CohesionWithLittleFriction) {
  const double dip = 30.0 * degree;
  const double weight = rock_density * earth_gravity * 2.0;
  const double cohesion = 1.5 * weight * std::sin(dip) / 2.0; // 1.5 of what drives, over a joint of 2 m
  std::string toml = head({.gravity = gravity_on(dip), .friction_deg = 5.0});
  toml.insert(toml.find("friction_angle_deg"), fmt::format("cohesion = {:.17g}\n", cohesion));
  toml += long_plane + block_toml("block", rectangle({0.0, 0.0}, {2.0, 1.0}));
  expect_factor({"block with cohesion", 1.5 + std::tan(5.0 * degree) / std::tan(dip)}, toml);
}

// A plane failure with a tension crack behind it and water that stands z above the plane everywhere, so that
// the forces of the water do not change while it slides: V = w z^2/2 on the crack, U = w z l on the plane,
// and on the submerged part of the face, which rises by 16 m in 4 m, R = w z y/2 towards the slope and R/4
// downwards, with y = z/(1 - tan(th)/4) the height at which the face leaves the water.
//     S = W sin + V cos - (R cos - R/4 sin),  N = W cos - U - V sin + R sin + R/4 cos,  F = N tan(phi)/S.
TEST(SafetyLimits, WetPlaneFailureWithTensionCrack) {
  const double dip = 30.0 * degree;
  const double behind = 20.0;
  const double crack_end = behind * std::tan(dip);
  const double unit_weight = 1000.0 * earth_gravity;
  for (const double level : {1.5, 3.0}) {
    const std::vector<Vec2> outline{{0.0, 0.0}, {behind, crack_end}, {behind, 16.0}, {4.0, 16.0}};
    const double weight = rock_density * earth_gravity * signed_area(outline);
    const double uplift = unit_weight * level * behind / std::cos(dip);
    const double thrust = 0.5 * unit_weight * level * level;
    const double face = 0.5 * unit_weight * level * level / (1.0 - 0.25 * std::tan(dip));
    const double normal = weight * std::cos(dip) - uplift - thrust * std::sin(dip) + face * std::sin(dip) +
                          0.25 * face * std::cos(dip);
    const double driving =
        weight * std::sin(dip) + thrust * std::cos(dip) - face * std::cos(dip) + 0.25 * face * std::sin(dip);
    const std::string toml =
        head({.friction_deg = 45.0}) +
        fmt::format("[water.table]\nphreatic = [[-40.0, {:.17g}], [{:.17g}, {:.17g}]]\n",
                    level - 40.0 * std::tan(dip), behind, crack_end + level) +
        block_toml("base",
                   {{-10.0, -20.0}, {behind, -20.0}, {behind, crack_end}, {-10.0, -10.0 * std::tan(dip)}},
                   "fixed = true") +
        block_toml("slide", outline);
    expect_factor({fmt::format("wet plane failure, water {} m above the plane", level),
                   normal * std::tan(45.0 * degree) / driving},
                  toml);
  }
}

// A cable normal to the plane, put in with the tension T, soft enough to keep it and so long that it does not
// turn while the block fails (a short one resists the slide by T s/L): F = (W cos(th) + T) tan(phi)/(W
// sin(th)).
TEST(SafetyLimits, BoltedBlock) {
  const double dip = 35.0 * degree;
  const double weight = rock_density * earth_gravity * 2.0;
  const double tension = 0.3 * weight;
  const std::string toml =
      head({.gravity = gravity_on(dip), .friction_deg = 36.0}) +
      block_toml("plane", rectangle({-2.0, -101.0}, {40.0, 0.0}), "fixed = true") +
      block_toml("block", rectangle({0.0, 0.0}, {2.0, 1.0})) +
      fmt::format("[support.steel]\nkind = \"anchored\"\naxial_stiffness = 1e2\npretension = {:.17g}\n"
                  "[[bolt]]\nsupport = \"steel\"\nfrom = [1.0, 0.5]\nto = [1.0, -100.0]\n",
                  tension);
  expect_factor({"bolted block",
                 (weight * std::cos(dip) + tension) * std::tan(36.0 * degree) / (weight * std::sin(dip))},
                toml);
}

/// Supports up the plane bear nothing as long as friction holds, and all that they can, Y, when it does not:
/// F = W cos(th) tan(phi)/(W sin(th) - Y), which a bound finds that lets them take more than they do at
/// first.
/// @param length  across it the bound lets a support pull by Y times a tenth of the block's size over this
void expect_limit_with_support(const char *name, const std::string &support, double strength, double length) {
  const Scene scene =
      on_the_plane_at_30_degrees(block_toml("block", rectangle({0.0, 0.0}, {2.0, 1.0})) + support);
  const double weight = rock_density * earth_gravity * 2.0;
  const double dip = 30.0 * degree;
  const double limit = weight * std::cos(dip) * std::tan(37.0 * degree) / (weight * std::sin(dip) - strength);
  const SafetyReport found = search_quietly(scene).report;
  ASSERT_TRUE(found.holds && found.fails) << name;
  EXPECT_NEAR(0.5 * (*found.holds + *found.fails), limit, 0.01 * limit) << name;
  for (const StrengthTrial &trial : found.trials) {
    // With all of the support's stiffness in K what hangs on it at its yield moves on for 5,000 to 14,000.
    EXPECT_LT(trial.steps, 1500) << name << " with a factor of " << trial.factor;
  }
  const double across = strength * 0.1 * std::sqrt(2.0) / length;
  const double bound = search_quietly(scene, true).report.bound.value_or(0.0);
  EXPECT_GE(bound, (1.0 - 3e-3) * limit) << name;
  EXPECT_LE(bound, (1.0 + 3e-3 + across / (weight * std::cos(dip))) * limit) << name;
}

TEST(SafetyLimits, BlockOnACableThatYields) {
  expect_limit_with_support(
      "cable",
      block_toml("head", rectangle({-102.0, 0.0}, {-100.0, 1.0}), "fixed = true") +
          "[support.steel]\nkind = \"anchored\"\naxial_stiffness = 1e7\naxial_yield = 5e3\n"
          "[[bolt]]\nsupport = \"steel\"\nfrom = [1.0, 0.5]\nto = [-101.0, 0.5]\n",
      5e3, 102.0);
}

// Sprayed on the block and on rock above it; fibres keep its tensile strength where it cracks.
TEST(SafetyLimits, BlockOnALinerThatYields) {
  expect_limit_with_support(
      "liner",
      block_toml("rock", rectangle({-2.0, 0.0}, {0.0, 1.0}), "fixed = true") +
          "[support.shotcrete]\nkind = \"liner\"\nthickness = 0.01\nyoungs_modulus = 1e9\n"
          "compressive_strength = 5e5\ntensile_strength = 5e5\nresidual_tensile_strength = 5e5\n"
          "[[liner]]\nsupport = \"shotcrete\"\npoints = [[-2.0, 1.0], [2.0, 1.0]]\n",
      5e3, 2.0);
}

TEST(SafetyLimits, ABlockHeldAtAPointHasNoBound) {
  const Scene scene = on_the_plane_at_30_degrees(
      block_toml("block", rectangle({0.0, 0.0}, {2.0, 1.0}), "fixed_points = [[0.5, 0.5]]"));
  EXPECT_EQ(search_quietly(scene).report.holds, scene.reduction.to);
  const SafetyReport found = search_quietly(scene, true).report;
  EXPECT_FALSE(found.bound || found.resting_bound);
}

/// An active block on a steep plane that pushes a passive one along a flatter plane, across a vertical joint.
/// Both rise to the right; the joint is at x = 0. The lowest tip of the active block is cut off, because it
/// would run into the flatter plane, and the tip alone would carry the block.
struct ActivePassive {
  double active_dip;          ///< rad
  double passive_dip;         ///< rad
  double friction;            ///< rad, of all joints
  double height = 6.0;        ///< of the joint, m
  double length = 8.0;        ///< of the passive block, m
  double active_length = 0.0; ///< of a block as high as the joint, m; 0: a triangle with a flat top

  static constexpr double cut = 0.7;
  [[nodiscard]] std::vector<Vec2> active() const {
    const double rise = std::tan(active_dip);
    const double run = active_length > 0.0 ? active_length : height / rise;
    std::vector<Vec2> outline{{cut, cut * rise}, {run, run * rise}};
    if (active_length > 0.0) {
      outline.push_back({run, run * rise + height});
    }
    outline.insert(outline.end(), {{0.0, height}, {0.0, height / 3.0}});
    return outline;
  }
  [[nodiscard]] std::vector<Vec2> passive() const {
    const double down = -length * std::tan(passive_dip);
    return {{-length, down}, {0.0, 0.0}, {0.0, height}, {-length, down + height}};
  }
  /// What drives both beyond what holds them when tan(phi) is `tangent` on all joints. A block with the
  /// weight W on a base of dip th that slides down and bears a force (h, v) has N = (W - v) cos(th) - h
  /// sin(th) and is in balance along its base where (W - v) sin(th) + h cos(th) = N t; h is counted downhill.
  /// The joint carries P, and the active block, which moves down along it, is held up by P t: for it h = -P,
  /// v = P t, and for the passive one h = P, v = -P t. P follows from the first, the rest from the second.
  [[nodiscard]] double unbalanced(double t) const {
    const double gamma = rock_density * earth_gravity;
    const double upper = gamma * signed_area(active());
    const double lower = gamma * signed_area(passive());
    const double s1 = std::sin(active_dip);
    const double c1 = std::cos(active_dip);
    const double s2 = std::sin(passive_dip);
    const double c2 = std::cos(passive_dip);
    const double push = upper * (s1 - t * c1) / ((t * s1 + c1) + t * (s1 - t * c1));
    return (lower + push * t) * (s2 - t * c2) + push * (c2 + t * s2);
  }
  [[nodiscard]] double factor() const {
    double low = 0.01;                  // of the tangent that balances
    double high = std::tan(active_dip); // with which the active block needs no help
    for (int k = 0; k < 200; ++k) {
      const double middle = 0.5 * (low + high);
      (unbalanced(middle) > 0.0 ? low : high) = middle;
    }
    return std::tan(friction) / high;
  }
  [[nodiscard]] std::string toml() const {
    const double far = std::max(height / std::tan(active_dip), active_length) * 2.0;
    const double deep = -4.0 * length;
    const double ahead = 3.0 * length;
    return head({.friction_deg = friction / degree}) +
           block_toml("steep", {{0.0, deep}, {far, deep}, {far, far * std::tan(active_dip)}, {0.0, 0.0}},
                      "fixed = true") +
           block_toml("flat",
                      {{-ahead, deep}, {0.0, deep}, {0.0, 0.0}, {-ahead, -ahead * std::tan(passive_dip)}},
                      "fixed = true") +
           block_toml("active", active()) + block_toml("passive", passive());
  }
};

TEST(SafetyLimits, ActiveAndPassiveBlocks) {
  for (const ActivePassive &slide : {ActivePassive{45.0 * degree, 10.0 * degree, 30.0 * degree},
                                     ActivePassive{45.0 * degree, 20.0 * degree, 35.0 * degree},
                                     ActivePassive{50.0 * degree, 5.0 * degree, 30.0 * degree}}) {
    expect_factor({fmt::format("active block at {:.0f} and passive one at {:.0f} degrees",
                               slide.active_dip / degree, slide.passive_dip / degree),
                   slide.factor()},
                  slide.toml());
  }
}

// Blocks of the same weight W and the same friction on both bases and on a vertical joint between them. With
// the angle p of friction at the limit, the force P across the joint acts at p to the horizontal. Every base
// carries its force at p to its normal, so that the law of sines gives, for the two force triangles,
//     P/W = sin(a - p)/cos(a - 2 p) = sin(p - b)/cos(2 p - b),  F = tan(phi)/tan(p),
// a and b the dips of the active and of the passive block. This gives 1.2317 and 1.1691, known from the
// literature on two-block slides. A joint without friction gives 1.1091 and 1.0991, blocks of another ratio
// of weights give other numbers.
TEST(SafetyLimits, ActiveAndPassiveBlocksOfTheSameWeight) {
  struct Case {
    double passive_deg, friction_deg, digits;
  };
  for (const Case &c : {Case{10.0, 30.0, 1.2317}, {20.0, 35.0, 1.1691}}) {
    ActivePassive slide{45.0 * degree, c.passive_deg * degree, c.friction_deg * degree, 3.0};
    slide.active_length = 6.0;
    slide.length = signed_area(slide.active()) / slide.height;
    const double p = std::atan(std::tan(slide.friction) / slide.factor());
    EXPECT_NEAR(std::sin(slide.active_dip - p) / std::cos(slide.active_dip - 2.0 * p),
                std::sin(p - slide.passive_dip) / std::cos(2.0 * p - slide.passive_dip), 1e-12);
    EXPECT_NEAR(slide.factor(), c.digits, 5e-5);
    expect_factor(
        {fmt::format("active block at 45 and passive one at {:.0f} degrees, equal weights", c.passive_deg),
         slide.factor()},
        slide.toml());
  }
}

} // namespace
} // namespace gcpdda::testing::safety_limits_test
