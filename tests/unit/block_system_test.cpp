#include "gcpdda/model/block_system.hpp"

#include "gcpdda/parallel/packing.hpp"
#include "support/blocks.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gcpdda {
namespace {

using namespace testing;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

const std::vector<Vec2> triangle{{0.0, 0.0}, {3.0, 0.0}, {0.0, 1.5}};

TEST(BlockSystem, PropertiesOfATriangle) {
  const BlockProperties p = system_of({triangle}, {}, 2000.0).properties[0];
  // Area 9/4, inertia rho area (b^2 + h^2)/18.
  EXPECT_NEAR(p.area, 2.25, 4.0 * epsilon);
  EXPECT_NEAR(p.mass, 4500.0, 4500.0 * 4.0 * epsilon);
  EXPECT_NEAR(p.inertia, 4500.0 * 11.25 / 18.0, 2812.5 * 8.0 * epsilon);
  EXPECT_NEAR(norm(p.centroid - Vec2{1.0, 0.5}), 0.0, 4.0 * epsilon);
  EXPECT_NEAR(p.radius, std::hypot(2.0, 0.5), 8.0 * epsilon);
  EXPECT_NEAR(p.width, 4.5 / std::hypot(3.0, 1.5), 8.0 * epsilon) << "height on the longest edge";
  EXPECT_EQ(p.kind, BlockKind::rigid);
}

// Coordinates in eighths are exact at 1e6 m too: the shape must keep every bit.
TEST(BlockSystem, DistantOriginCostsNoDigitsOfTheShape) {
  const Vec2 far{1e6, -2e6};
  const BlockSystem near = system_of({triangle}, {}, 2000.0);
  const BlockSystem distant = system_of({placed(triangle, 0.0, far)}, {}, 2000.0);
  EXPECT_EQ(distant.properties[0].mass, near.properties[0].mass);
  EXPECT_EQ(distant.properties[0].inertia, near.properties[0].inertia);
  EXPECT_EQ(distant.properties[0].width, near.properties[0].width);
  EXPECT_EQ(distant.edge_length, near.edge_length);
  EXPECT_EQ(distant.reference_normal, near.reference_normal);
  // The centroid is rounded to the spacing of doubles at 2e6 m.
  EXPECT_NEAR(norm(distant.properties[0].centroid - far - near.properties[0].centroid), 0.0,
              2e6 * 2.0 * epsilon);
}

TEST(BlockSystem, FixedBlocksAreInfinitelyHeavyAndAtRest) {
  BlockSystem system;
  SceneBlock block;
  block.vertices = triangle;
  block.fixed = true;
  block.velocity = {1.0, 2.0, 3.0};
  append_block(system, BlockId{0}, block, {"rock", 2000.0, 0.0, 0.0});
  EXPECT_TRUE(std::isinf(system.properties[0].mass));
  EXPECT_TRUE(std::isinf(system.properties[0].inertia));
  EXPECT_EQ(system.properties[0].kind, BlockKind::fixed);
  EXPECT_EQ(system.velocity[0], RigidDof{});
  block.fixed = false;
  append_block(system, BlockId{1}, block, {"rock", 2000.0, 0.0, 0.0});
  EXPECT_EQ(system.velocity[1], (RigidDof{{1.0, 2.0}, 3.0}));
}

TEST(BlockSystem, PoseTurnsAboutTheCentroid) {
  BlockSystem system = system_of({triangle, placed(triangle, 0.0, {5.0, 5.0})}, {});
  constexpr double quarter = 1.5707963267948966;
  system.trial[1] = {{10.0, -2.0}, quarter};
  pose(system, 0, 2);
  // Unmoved: the scene's vertices to the rounding of centroid and offset.
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(norm(system.vertex[k] - triangle[k]), 0.0, 4.0 * epsilon);
  }
  const Vec2 centre{16.0, 3.5};
  EXPECT_NEAR(norm(system.trial_centroid[1] - centre), 0.0, 32.0 * epsilon);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 expected = centre + perp(triangle[k] - Vec2{1.0, 0.5});
    EXPECT_NEAR(norm(system.vertex[3 + k] - expected), 0.0, 64.0 * epsilon);
    EXPECT_NEAR(norm(system.normal[3 + k] - perp(system.reference_normal[k])), 0.0, 4.0 * epsilon);
    EXPECT_GE(system.vertex[3 + k].x, system.box[1].low.x);
    EXPECT_LE(system.vertex[3 + k].y, system.box[1].high.y);
  }
  // The state of t_n is another configuration than the trial one.
  const std::vector<Vec2> current = current_vertices(system, 1);
  EXPECT_NEAR(norm(current[0] - Vec2{5.0, 5.0}), 0.0, 32.0 * epsilon);
  system.displacement[1] = system.trial[1];
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(norm(current_vertices(system, 1)[k] - system.vertex[3 + k]), 0.0, 32.0 * epsilon);
  }
}

TEST(BlockSystem, NormalsPointOutAndEdgesFollow) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const std::vector<Vec2> polygon = random_polygon(seed, 3 + static_cast<int>(seed % 6), 2.0, {1.0, -3.0});
    const BlockSystem system = system_of({polygon}, {});
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vec2 next = polygon[(k + 1) % polygon.size()];
      EXPECT_NEAR(norm(system.reference_normal[k]), 1.0, 4.0 * epsilon);
      EXPECT_GT(dot(system.reference_normal[k], system.reference_vertex[k]), 0.0);
      const Vec2 end = polygon[k] + system.edge_length[k] * perp(system.reference_normal[k]);
      EXPECT_NEAR(norm(end - next), 0.0, 32.0 * epsilon);
    }
  }
}

/// Three blocks of different vertex counts with every field filled differently.
BlockSystem filled_system() {
  BlockSystem system = system_of({random_polygon(1, 3, 1.0, {}), random_polygon(2, 8, 1.0, {5.0, 0.0}),
                                  random_polygon(3, 5, 1.0, {9.0, 0.0})},
                                 {});
  std::mt19937 engine(7);
  const auto dof = [&] {
    return RigidDof{{uniform(engine, -1.0, 1.0), uniform(engine, -1.0, 1.0)}, uniform(engine, -1.0, 1.0)};
  };
  for (std::size_t row = 0; row < 3; ++row) {
    system.displacement[row] = dof();
    system.velocity[row] = dof();
    system.acceleration[row] = dof();
    system.trial[row] = dof();
    system.trial_previous[row] = dof();
    system.refreshed[row] = dof();
    system.ledger[row] = {dof(), dof(), dof().u, dof().r, dof().r, dof().r};
    system.properties[row].material = static_cast<std::int32_t>(row) + 4;
  }
  return system;
}

void expect_same_row(const BlockSystem &a, std::size_t i, const BlockSystem &b, std::size_t j) {
  const BlockProperties &p = a.properties[i];
  const BlockProperties &q = b.properties[j];
  EXPECT_EQ(p.id, q.id);
  EXPECT_EQ(p.material, q.material);
  EXPECT_EQ(p.kind, q.kind);
  EXPECT_EQ(p.area, q.area);
  EXPECT_EQ(p.mass, q.mass);
  EXPECT_EQ(p.inertia, q.inertia);
  EXPECT_EQ(p.radius, q.radius);
  EXPECT_EQ(p.width, q.width);
  EXPECT_EQ(p.centroid, q.centroid);
  EXPECT_EQ(a.displacement[i], b.displacement[j]);
  EXPECT_EQ(a.velocity[i], b.velocity[j]);
  EXPECT_EQ(a.acceleration[i], b.acceleration[j]);
  EXPECT_EQ(a.trial[i], b.trial[j]);
  EXPECT_EQ(a.trial_previous[i], b.trial_previous[j]);
  EXPECT_EQ(a.refreshed[i], b.refreshed[j]);
  EXPECT_EQ(a.ledger[i].shear_force, b.ledger[j].shear_force);
  EXPECT_EQ(a.ledger[i].damping_force, b.ledger[j].damping_force);
  EXPECT_EQ(a.ledger[i].gravity_force, b.ledger[j].gravity_force);
  EXPECT_EQ(a.ledger[i].shear_work, b.ledger[j].shear_work);
  EXPECT_EQ(a.ledger[i].damping_work, b.ledger[j].damping_work);
  EXPECT_EQ(a.ledger[i].gravity_work, b.ledger[j].gravity_work);
  ASSERT_EQ(a.num_vertices(i), b.num_vertices(j));
  for (std::size_t k = 0; k < a.num_vertices(i); ++k) {
    EXPECT_EQ(a.of_row(a.reference_vertex, i)[k], b.of_row(b.reference_vertex, j)[k]);
    EXPECT_EQ(a.of_row(a.reference_normal, i)[k], b.of_row(b.reference_normal, j)[k]);
    EXPECT_EQ(a.of_row(a.edge_length, i)[k], b.of_row(b.edge_length, j)[k]);
  }
}

TEST(BlockSystem, AppendedRowsKeepEveryBit) {
  const BlockSystem from = filled_system();
  BlockSystem to = filled_system();
  for (const std::size_t row : {2U, 0U, 1U}) {
    append_row(to, from, row);
  }
  ASSERT_EQ(to.num_rows(), 6U);
  expect_same_row(to, 3, from, 2);
  expect_same_row(to, 4, from, 0);
  expect_same_row(to, 5, from, 1);
  expect_same_row(to, 1, from, 1);
}

TEST(BlockSystem, PackedRowsKeepEveryBit) {
  BlockSystem from = filled_system();
  from.velocity[1].u.x = -0.0;
  from.displacement[1].r = std::numeric_limits<double>::denorm_min();
  Bytes message;
  for (const std::size_t row : {1U, 2U, 0U}) {
    pack_row(from, row, message);
  }
  BlockSystem to = filled_system();
  unpack_rows(message, to);
  ASSERT_EQ(to.num_rows(), 6U);
  expect_same_row(to, 3, from, 1);
  expect_same_row(to, 4, from, 2);
  expect_same_row(to, 5, from, 0);
  EXPECT_TRUE(std::signbit(to.velocity[3].u.x));

  message.pop_back();
  BlockSystem broken;
  EXPECT_ANY_THROW(unpack_rows(message, broken)) << "half a row";
}

} // namespace
} // namespace gcpdda
