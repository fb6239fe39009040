// Shipped scenes of blocks that deform, against what is known of them.

#include "problem.hpp"

#include "blockgen/region_cutter.hpp"
#include "dynamics/deformable.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>

namespace gcpdda::testing::deformable_scenes_test {
namespace {

Scene cut_scene(const std::string &name, const std::vector<std::string> &sets) {
  Scene scene = shipped_scene(name, sets);
  scene.region_blocks = std::make_shared<RegionCutter>(scene);
  return scene;
}

/// Root mean square difference of the blocks' stresses from those around a circular opening, over the stress
/// far away.
struct Difference {
  double radial = 0.0;
  double hoop = 0.0;
};

/// deformable_tunnel with blocks of that size, under the same stress from all sides, in a plate that reaches
/// three radii to each side. Stresses of a plate of radius R, that of a circle as large as the square, are
/// (Lame) R^2/(R^2 - a^2) times those of an endless one, 1 -+ a^2/r^2. Blocks within two radii are compared.
Difference around_a_tunnel(double size) {
  constexpr double radius = 3.0;
  constexpr double half = 9.0;
  constexpr double pressure = 2.6e6;
  Simulation simulation(
      Communicator::self(),
      cut_scene("deformable_tunnel", {"in_situ.k0=1", "region.polygon=[[-9, -9], [9, -9], [9, 9], [-9, 9]]",
                                      fmt::format("bricks=[{{block_size=[{0}, {0}], bond=0.0}}]", size),
                                      fmt::format("joint.default.normal_stiffness={}", 3.0 * 10e9 / size)}));
  run_stages(simulation, step);
  EXPECT_FALSE(simulation.fault().has_value());
  EXPECT_EQ(simulation.stage_results().back().verdict, Verdict::settled);
  const BlockSystem &blocks = simulation.blocks();
  const double plate = 1.0 / (1.0 - radius * radius / (4.0 * half * half / std::numbers::pi));
  double area = 0.0;
  Difference sum;
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    const BlockProperties &block = blocks.properties[row];
    const double r = norm(block.centroid);
    if (r > 2.0 * radius || r < radius) {
      continue;
    }
    const Vec2 e = (1.0 / r) * block.centroid;
    const auto [xx, yy, xy] = mean_cauchy_stress(blocks.deformation_of(row), block.area);
    const double radial = e.x * e.x * xx + e.y * e.y * yy + 2.0 * e.x * e.y * xy;
    const double hoop = e.y * e.y * xx + e.x * e.x * yy - 2.0 * e.x * e.y * xy;
    const double share = radius * radius / (r * r);
    const auto squared = [&](double stress, double wanted) {
      const double off = -stress / pressure - plate * wanted;
      return off * off;
    };
    sum.radial += block.area * squared(radial, 1.0 - share);
    sum.hoop += block.area * squared(hoop, 1.0 + share);
    area += block.area;
  }
  return {std::sqrt(sum.radial / area), std::sqrt(sum.hoop / area)};
}

// A block has one strain: it misses what the stress changes across it, of second order in its size, and the
// steps of the wall that the circle cuts out of square blocks, of first order. The square plate and the round
// one of Lame differ by about 0.02 beyond, which stays.
TEST(DeformableScenes, StressAroundATunnelIsKirschs) {
  const Difference coarse = around_a_tunnel(1.0);
  const Difference fine = around_a_tunnel(0.75);
  expect_below("deformable tunnel, L/a = 1/3: rms difference of radial stress over the pressure", 0.05,
               coarse.radial);
  expect_below("deformable tunnel, L/a = 1/3: rms difference of hoop stress over the pressure", 0.06,
               coarse.hoop);
  expect_below("deformable tunnel, L/a = 1/4: radial, over that of L/a = 1/3", 1.0,
               fine.radial / coarse.radial);
  expect_below("deformable tunnel, L/a = 1/4: hoop, over that of L/a = 1/3", 1.0, fine.hoop / coarse.hoop);
}

} // namespace
} // namespace gcpdda::testing::deformable_scenes_test
