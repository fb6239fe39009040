// Liners against closed forms: a block that hangs in a lined roof, a ring under pressure, a beam that is
// bent.

#include "blockgen/region_cutter.hpp"
#include "problem.hpp"

#include "simulation/energy_ledger.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

namespace gcpdda::testing::lined_block_test {
namespace {

constexpr double weight = rock_density * earth_gravity; ///< of a unit square, N/m
constexpr double thickness = 0.1;                       ///< t, m
constexpr double plane_modulus = 24e9 / (1.0 - 0.2 * 0.2);
constexpr double shear_modulus = 24e9 / 2.4;
constexpr double rigidity = plane_modulus * thickness * thickness * thickness / 12.0; ///< E'I

/// Stiffness across an element, 12 E'I/(L^3 (1 + Phi)).
double stiffness_across(double length) {
  const double phi = 12.0 * rigidity / (5.0 / 6.0 * shear_modulus * thickness * length * length);
  return 12.0 * rigidity / (length * length * length * (1.0 + phi));
}

std::string layer_toml(const std::string &strength = "") {
  return fmt::format("[support.layer]\nkind = \"liner\"\nthickness = {}\nyoungs_modulus = 24e9\n{}\n",
                     thickness, strength);
}

std::string liner_toml(const std::string &name, const std::string &points, const std::string &more = "") {
  return fmt::format("[[liner]]\nname = \"{}\"\nsupport = \"layer\"\npoints = {}\n{}\n", name, points, more);
}

std::string rock(const std::string &fidelity, Vec2 gravity = {0.0, -earth_gravity}) {
  return without_duration(
      head({.gravity = gravity, .fidelity = fidelity, .youngs_modulus = 20e9, .poissons_ratio = 0.25}));
}

/// A unit square between two fixed blocks that it does not touch, over a face at y = 0. The nodes of a liner
/// from x = -2 to 2 are in the middles of the blocks' faces, at -1.255, 0 and 1.255. A second square on a
/// floor far away gives the scene a contact, by whose overlap a stage tells rest.
std::string roof_toml(const std::string &fidelity) {
  return rock(fidelity) + block_toml("left", rectangle({-2.0, 0.0}, {-0.51, 1.0}), "fixed = true") +
         block_toml("loose", rectangle({-0.5, 0.0}, {0.5, 1.0})) +
         block_toml("right", rectangle({0.51, 0.0}, {2.0, 1.0}), "fixed = true") +
         block_toml("floor", rectangle({9.0, -1.0}, {12.0, 0.0}), "fixed = true") +
         block_toml("other", rectangle({10.0, 0.0}, {11.0, 1.0}));
}
constexpr double length = 1.255;
const std::string face = "[[-2, 0], [2, 0]]";

std::string settle_toml(const std::string &solver, const std::string &more = "") {
  return fmt::format("[[stage]]\nkind = \"settle\"\nlimit = 20\ntolerance = 1e-7\nsolver = \"{}\"\n{}\n",
                     solver, more);
}

const LinkMemory &memory_of(const Simulation &simulation, std::size_t link) {
  return simulation.bolts().links().at(link).memory;
}

// Each side bears W/2 across and sags by W/(2 k); the chord of the sagging element takes less than
// k_a s^2/(2 L^2 k) = 1e-4 of it. A deformable block adds its own strain, W/E = 1e-6 of 3e-4 m.
TEST(LinedBlock, HangsInARoof) {
  for (const std::string fidelity : {"rigid", "deformable"}) {
    for (const std::string solver : {"static", "dynamic"}) {
      Simulation simulation(Communicator::self(), scene_of(roof_toml(fidelity) + layer_toml() +
                                                           liner_toml("roof", face) + settle_toml(solver)));
      ASSERT_EQ(simulation.bolts().links().size(), 2U);
      const double span = simulation.bolts().links()[0].length;
      expect_value(fmt::format("liners: {} block in a roof, {}, length of an element, m", fidelity, solver),
                   length, span, 0.5 * thickness / 8.0); // half the distance of stations
      const double sag = 0.5 * weight / stiffness_across(span);
      run_stages(simulation, step);
      EXPECT_EQ(simulation.stage_results().back().verdict, Verdict::settled);
      const std::string what = fmt::format("liners: {} block in a roof, {}, ", fidelity, solver);
      const double tolerance = fidelity == "rigid" ? 2e-4 : 0.01;
      expect_value(what + "sag, m", sag, -displacement_of(simulation, 1).u.y, tolerance);
      for (std::size_t side = 0; side < 2; ++side) {
        expect_value(what + "shear, N/m", 0.5 * weight, std::abs(memory_of(simulation, side).shear), 1e-3);
      }
    }
  }
}

// The liner peels off where adhesion times the width of the bond is less than W/2 (Barrett and McCreath). The
// weight comes slowly: an element that met all of it at once would bear twice as much.
TEST(LinedBlock, FallsWhereTheBondBearsLessThanHalfItsWeight) {
  for (const std::string fidelity : {"rigid", "deformable"}) {
    for (const std::string solver : {"static", "dynamic"}) {
      for (const double share : {0.995, 1.005}) {
        const std::string strength =
            fmt::format("adhesion = {:.17g}\nbond_width = 0.03\n", share * 0.5 * weight / 0.03);
        std::string toml =
            roof_toml(fidelity) + layer_toml(strength) + liner_toml("roof", face) + settle_toml(solver);
        if (solver == "dynamic") {
          toml.insert(toml.find("[run]\n") + 6, "gravity_ramp = 2.0\n");
        }
        Simulation simulation(Communicator::self(), scene_of(toml));
        run_stages(simulation, step);
        const bool falls = share < 1.0;
        EXPECT_EQ(memory_of(simulation, 0).broken, falls) << fidelity << solver << share;
        EXPECT_EQ(simulation.stage_results().back().verdict == Verdict::failed, falls)
            << fidelity << solver << share;
      }
    }
  }
}

// A layer takes what comes after it: W stays on the first one, and a later load is shared by both.
TEST(LinedBlock, IsPutInWithoutStress) {
  const double load = 5e4;
  for (const std::string solver : {"static", "dynamic"}) {
    Simulation simulation(
        Communicator::self(),
        scene_of(
            roof_toml("rigid") + layer_toml() + liner_toml("first", face) +
            liner_toml("second", face, "active = false") + settle_toml(solver) +
            settle_toml(solver, fmt::format("set = {{ \"liner.second.active\" = true, \"block.loose.load\" = "
                                            "[{{ point = [0, 0.5], force = [0, -{}] }}] }}",
                                            load))));
    run_stages(simulation, step);
    ASSERT_EQ(simulation.bolts().links().size(), 4U);
    const std::string what = fmt::format("liners: block on two layers, {}, ", solver);
    expect_value(what + "shear of the first, N/m", 0.5 * weight + 0.25 * load,
                 std::abs(memory_of(simulation, 0).shear), 1e-3);
    expect_value(what + "shear of the second, N/m", 0.25 * load, std::abs(memory_of(simulation, 2).shear),
                 1e-3);
  }
}

// With the right block gone the left element is a cantilever with W at its end, below the centroid of the
// block: P L^3/(3 E'I) + P L/(5/6 G t), the moment at the wall is W L. The block turns by W L^2/(2 E'I) =
// 0.01, which carries its centroid 5 mm out and adds 0.4 % to the moment; L^3 may be wrong by 1.5 % as a node
// is.
TEST(LinedBlock, IsACantileverOnceItsNeighbourIsExcavated) {
  Simulation simulation(Communicator::self(),
                        scene_of(roof_toml("rigid") + layer_toml() + liner_toml("roof", face) +
                                 settle_toml("static") +
                                 "[[stage]]\nkind = \"excavate\"\nblocks = [\"right\"]\nrelax = 0.1\n" +
                                 settle_toml("dynamic")));
  run_stages(simulation, step);
  ASSERT_EQ(simulation.bolts().links().size(), 1U);
  const double deflection = weight * std::pow(length, 3) / (3.0 * rigidity) +
                            weight * length / (5.0 / 6.0 * shear_modulus * thickness);
  expect_value("liners: block on a cantilever, deflection, m", deflection,
               -displacement_of(simulation, 1).u.y, 0.02);
  const LinkMemory &memory = memory_of(simulation, 0);
  expect_value("liners: block on a cantilever, moment at the wall, N", weight * length,
               std::abs(memory.moment) + 0.5 * length * std::abs(memory.shear), 0.02);
}

// All of its weight at once, and the crack comes on the way down; then the block falls. What the crack and
// the bond take is in the ledger. A step changes Q by 2 % of what it is in the end, and the work of the step
// in which the liner peels off is known by its trapezoid, to a half of Q times the motion in a step.
TEST(LinedBlock, LosesWhatCracksAndBondsTake) {
  for (const std::string fidelity : {"rigid", "deformable"}) {
    const std::string strength =
        fmt::format("compressive_strength = 30e6\ntensile_strength = 3e6\nresidual_tensile_strength = 2e6\n"
                    "adhesion = {:.17g}\nbond_width = 0.03\n",
                    0.4 * weight / 0.03);
    Simulation simulation(Communicator::self(),
                          scene_of(roof_toml(fidelity) + layer_toml(strength) + liner_toml("roof", face) +
                                       "[[stage]]\nkind = \"run\"\nduration = 0.1\n",
                                   {"run.contact_damping=0", "run.safety=0.1"}));
    EnergyLedger ledger(simulation.state());
    while (!simulation.stage_is_over()) {
      step(simulation);
    }
    const EnergyRow row = ledger.row(simulation.state());
    const LinkMemory &memory = memory_of(simulation, 0);
    EXPECT_TRUE(memory.cracked && memory.broken);
    EXPECT_EQ(row.support, 0.0);
    const std::string what = fmt::format("liners: {} block falls through its liner, ", fidelity);
    expect_value(what + "energy lost, J/m", 2.0 * memory.dissipated, row.support_loss, 1e-9);
    expect_below(what + "energy residual over what is lost", 0.01, std::abs(row.residual) / row.support_loss);
  }
}

/// Wedges around a circle, apart from each other, pressed inwards by P each. The nodes are on the apothem R.
/// The first one is fixed, because forces that keep their directions would turn a free ring around; it takes
/// P.
std::string ring_toml(int count, double radius, double load, const std::string &fidelity) {
  std::string toml = rock(fidelity, {});
  std::string points;
  const double half = std::numbers::pi / count;
  for (int k = 0; k < count; ++k) {
    const auto at = [&](double along, double out) {
      const double angle = 2.0 * half * k;
      return Vec2{out * std::cos(angle) - along * std::sin(angle),
                  out * std::sin(angle) + along * std::cos(angle)};
    };
    const double side = radius * std::tan(half);
    const double gap = 0.005;
    const std::vector<Vec2> wedge{at(gap - side, radius), at(gap - side, radius + 1.0),
                                  at(side - gap, radius + 1.0), at(side - gap, radius)};
    const Vec2 centre = at(0.0, radius + 0.5);
    const Vec2 force = at(0.0, -load);
    toml += block_toml(fmt::format("w{}", k), wedge, k == 0 ? "fixed = true" : "");
    toml += k == 0 ? ""
                   : fmt::format("[[block.load]]\npoint = [{:.17g}, {:.17g}]\nforce = [{:.17g}, {:.17g}]\n",
                                 centre.x, centre.y, force.x, force.y);
    const Vec2 corner = at(-side, radius);
    points += fmt::format("{}[{:.17g}, {:.17g}]", k > 0 ? ", " : "", corner.x, corner.y);
  }
  // Once around and on over the first block: the last element is that between the last block and the first.
  const double side = radius * std::tan(half);
  points += fmt::format(", [{:.17g}, {:.17g}], [{:.17g}, {:.17g}]", radius, -side, radius, side);
  return toml + layer_toml() + liner_toml("ring", "[" + points + "]");
}

// Each block is in equilibrium with two elements: P = 2 N sin(pi/n), which is N = p R/cos(pi/n) for the
// pressure p = P/(2 R tan(pi/n)) on the polygon. Elements are chords of L = 2 R sin(pi/n) that stay chords,
// so that N = E' t u/R without a discretisation error. The squares
// of its strain of 4e-5 are what may be left.
TEST(LinedRing, BearsPressureByThrust) {
  const int count = 12;
  const double radius = 2.0;
  const double pressure = 5e4; // a fifteenth of what would buckle it, 3 E'I/R^3 = 781 kPa
  const double half = std::numbers::pi / count;
  const double load = 2.0 * radius * std::tan(half) * pressure;
  for (const std::string fidelity : {"rigid", "deformable"}) {
    for (const std::string solver : {"static", "dynamic"}) {
      Simulation simulation(Communicator::self(),
                            scene_of(ring_toml(count, radius, load, fidelity) + settle_toml(solver)));
      ASSERT_EQ(simulation.bolts().links().size(), 12U);
      run_stages(simulation, step);
      const std::string what = fmt::format("liners: ring of {} blocks, {}, ", fidelity, solver);
      const double thrust = pressure * radius / std::cos(half);
      double least = 1e300;
      double most = 0.0;
      for (const BoltLink &link : simulation.bolts().links()) {
        least = std::min(least, -link.memory.axial);
        most = std::max(most, -link.memory.axial);
      }
      expect_value(what + "smallest thrust, N/m", thrust, least, 1e-5);
      expect_value(what + "largest thrust, N/m", thrust, most, 1e-5);
      if (fidelity == "rigid") {
        expect_value(what + "closure across, m", 2.0 * thrust * radius / (plane_modulus * thickness),
                     displacement_of(simulation, count / 2).u.x, 1e-6);
      }
    }
  }
}

/// Two blocks of which the second is turned about the middle of the element between them.
std::string bent_toml(double speed, const std::string &strength) {
  return head({.duration = 0.2, .fidelity = "rigid"}) +
         block_toml("held", rectangle({-1.0, 0.0}, {-0.01, 1.0}), "fixed = true") +
         block_toml("turned", rectangle({0.01, 0.0}, {1.0, 1.0}),
                    fmt::format("prescribed_velocity = [{:.17g}, {:.17g}, {:.17g}]", -0.5 * speed,
                                0.505 * speed, speed)) +
         layer_toml(strength) + liner_toml("beam", "[[-1, 0], [1, 0]]");
}

// In pure bending the moment rises to f_t t^2/6 and falls to that of the residual stress blocks,
// (f_c f_r/(f_c + f_r)) t^2/2; what turns the beam in one step may be beyond it. The first crack takes the
// energy between both. The block moves on a straight line and not on a circle, which squeezes the beam by
// theta^2/4 m and is 0.2 % of its strength at the crack. Strengths are a tenth of concrete's for that reason.
TEST(LinedBeam, CracksUnderAMoment) {
  const double speed = 0.002; // rad/s
  for (const double residual : {0.0, 1e5}) {
    Simulation simulation(
        Communicator::self(),
        scene_of(bent_toml(speed, fmt::format("compressive_strength = 3e6\ntensile_strength = 3e5\n"
                                              "residual_tensile_strength = {}\n",
                                              residual))));
    ASSERT_EQ(simulation.bolts().links().size(), 1U);
    const double span = simulation.bolts().links()[0].length;
    double largest = 0.0;
    double at_crack = 0.0;
    while (!simulation.finished()) {
      step(simulation);
      const LinkMemory &memory = memory_of(simulation, 0);
      if (!memory.cracked) {
        largest = std::max(largest, std::abs(memory.moment));
      } else if (at_crack == 0.0) {
        at_crack = memory.turn;
      }
    }
    const double cracking = 3e5 * thickness * thickness / 6.0;
    const double after = 3e6 * residual / (3e6 + residual) * thickness * thickness / 2.0;
    const double stiffness = rigidity / span;
    const double of_step = stiffness * speed * simulation.plan().time_step / cracking;
    const std::string what = fmt::format("liners: bent beam, residual strength {:g} Pa, ", residual);
    expect_below(what + "share of the moment that comes in a step", 0.02, of_step);
    expect_value(what + "largest moment, N", cracking, largest, of_step + 0.003);
    expect_value(what + "turn at the crack, rad", cracking / stiffness, at_crack, of_step + 0.003);
    const LinkMemory &memory = memory_of(simulation, 0);
    EXPECT_TRUE(memory.cracked);
    if (residual > 0.0) {
      expect_value(what + "moment after the crack, N", after, std::abs(memory.moment), 0.01);
      const double flow = after * (memory.turn - after / stiffness - (cracking - after) / stiffness);
      const double crack = (cracking * cracking - after * after) / (2.0 * stiffness);
      expect_value(what + "energy lost, J/m", flow + crack, memory.dissipated, 0.02);
    } else {
      EXPECT_LT(std::abs(memory.moment), 1e-3 * cracking);
    }
  }
}

// Around a ring in rock under even stress there is neither shear nor moment, and the rock presses on it with
// N/r. Bricks give single elements a shear of 3 % of the thrust, which is six times the bond and a fifth of
// what the pressure beside a joint holds. An elastic plate gives way to the pressure N/r by r (1 + nu)/E of
// it, the ring by r^2/(E' t), so that N is the stress times r over 1 + (r/(E' t))/((1 + nu)/E); joints and
// the size of the plate let the rock move farther, by less than a fifth here.
TEST(LinedBlock, ARingUnderEvenPressureKeepsItsElements) {
  constexpr double stress = 2.6e6;
  constexpr double radius = 3.0;
  constexpr double depth = 0.3; // of the ring
  Scene scene = scene_of(R"(
[run]
fidelity = "deformable"
gravity = [0, 0]
[material.rock]
density = 2600.0
youngs_modulus = 1e9
poissons_ratio = 0.25
[joint.default]
normal_stiffness = 1e10
friction_angle_deg = 45.0
cohesion = 1e9
[in_situ]
vertical_stress = 2.6e6
k0 = 1.0
[region]
material = "rock"
polygon = [[-15, -15], [15, -15], [15, 15], [-15, 15]]
stress = ["bottom", "left", "right", "top"]
min_width = 0.1
[[bricks]]
block_size = [1.0, 1.0]
bond = 0.0
[[opening]]
name = "tunnel"
shape = "circle"
centre = [0.0, 0.0]
width = 6.0
chords = 48
[support.ring]
kind = "liner"
thickness = 0.3
youngs_modulus = 20e9
poissons_ratio = 0.2
adhesion = 1e6
[[liner]]
name = "ring"
support = "ring"
opening = "tunnel"
active = false
[[stage]]
kind = "settle"
limit = 2.0
[[stage]]
kind = "excavate"
openings = ["tunnel"]
relax = 0.1
[[stage]]
kind = "change"
set = { "liner.ring.active" = true }
[[stage]]
kind = "settle"
limit = 5.0
)");
  scene.region_blocks = std::make_shared<RegionCutter>(scene);
  Simulation simulation(Communicator::self(), std::move(scene));
  run_stages(simulation);
  const std::vector<LinerLine> elements =
      simulation.bolts().liner_lines(Communicator::self(), simulation.blocks());
  ASSERT_GT(elements.size(), 16U);
  double thrust = 0.0;
  for (const LinerLine &element : elements) {
    EXPECT_FALSE(element.memory.broken);
    thrust -= element.memory.axial / static_cast<double>(elements.size());
  }
  const double rock = radius * 1.25 / 1e9;
  const double ring = radius * radius / (20e9 / (1.0 - 0.04) * depth);
  const double in_elastic_plate = stress * radius * rock / (rock + ring);
  EXPECT_GT(thrust, in_elastic_plate);
  EXPECT_LT(thrust, 1.2 * in_elastic_plate);
}

} // namespace
} // namespace gcpdda::testing::lined_block_test
