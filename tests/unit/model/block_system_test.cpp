#include "model/block_system.hpp"

#include "parallel/packing.hpp"
#include "support/blocks.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace gcpdda::block_system_test {
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
  EXPECT_EQ(distant.reference_vertex, near.reference_vertex);
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
  const TrialOutline unmoved(system, 0);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(norm(unmoved.vertex[k] - triangle[k]), 0.0, 4.0 * epsilon);
  }
  const Vec2 centre{16.0, 3.5};
  EXPECT_NEAR(norm(system.motion[1].centroid - centre), 0.0, 32.0 * epsilon);
  const TrialOutline turned(system, 1);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 expected = centre + perp(triangle[k] - Vec2{1.0, 0.5});
    EXPECT_NEAR(norm(turned.vertex[k] - expected), 0.0, 64.0 * epsilon);
    EXPECT_NEAR(norm(turned.normal[k] - perp(system.reference_normal[k])), 0.0, 4.0 * epsilon);
    EXPECT_GE(turned.vertex[k].x, system.motion[1].box.low.x);
    EXPECT_LE(turned.vertex[k].y, system.motion[1].box.high.y);
  }
  // The state of t_n is another configuration than the trial one.
  const std::vector<Vec2> current = current_vertices(system, 1);
  EXPECT_NEAR(norm(current[0] - Vec2{5.0, 5.0}), 0.0, 32.0 * epsilon);
  system.displacement[1] = system.trial[1];
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(norm(current_vertices(system, 1)[k] - turned.vertex[k]), 0.0, 32.0 * epsilon);
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
      const Vec2 end = polygon[k] + reference_length(system, 0, k) * perp(system.reference_normal[k]);
      EXPECT_NEAR(norm(end - next), 0.0, 32.0 * epsilon);
    }
  }
}

const Material elastic_rock{"rock", 2600.0, 4e9, 0.3};

SceneBlock block_of(const std::vector<Vec2> &vertices) {
  SceneBlock block;
  block.vertices = vertices;
  return block;
}

// S is the polygon's second moment; the stiffness area * D of both plane states, from the compliance
// [std] eps = [1 -nu; -nu 1] sigma/E (plane stress) and E/(1 - nu^2), nu/(1 - nu) in their places (strain).
TEST(BlockSystem, ConstantsOfADeformableBlock) {
  for (const bool plane_strain : {false, true}) {
    BlockSystem system;
    SceneBlock block = block_of(rectangle({1.0, 1.0}, {4.0, 3.0}));
    block.velocity = {1.0, 2.0, 3.0};
    append_block(system, BlockId{0}, block, elastic_rock, BlockKind::deformable, plane_strain);
    ASSERT_TRUE(system.is_deformable(0));
    EXPECT_FALSE(system.has_matrix(0));
    const Deformation &d = system.deformation_of(0);
    EXPECT_NEAR(d.second_moment.xx, 2600.0 * 2.0 * 27.0 / 12.0, 1e-11);
    EXPECT_NEAR(d.second_moment.yy, 2600.0 * 3.0 * 8.0 / 12.0, 1e-11);
    EXPECT_NEAR(d.second_moment.xy, 0.0, 1e-11);
    EXPECT_EQ(d.rate, (Mat2{0.0, -3.0, 3.0, 0.0}));
    const double nu = plane_strain ? 0.3 / 0.7 : 0.3;
    const double modulus = plane_strain ? 4e9 / 0.91 : 4e9;
    // Stress along x alone of 1 Pa.
    const double along = (1.0 / modulus) * d.stiffness_direct - (nu / modulus) * d.stiffness_cross;
    const double across = (1.0 / modulus) * d.stiffness_cross - (nu / modulus) * d.stiffness_direct;
    EXPECT_NEAR(along, 6.0, 1e-13);
    EXPECT_NEAR(across, 0.0, 1e-13);
    EXPECT_NEAR(d.stiffness_shear, 6.0 * 4e9 / 2.6, 1e-4);
  }
}

// Its points stand where x = x_c + F X says, its normals on the current edges.
TEST(BlockSystem, PoseOfADeformableBlock) {
  BlockSystem system;
  append_block(system, BlockId{0}, block_of(triangle), elastic_rock, BlockKind::deformable);
  Deformation &d = system.deformation_of(0);
  d.trial = {0.1, -1.2, 0.9, 0.2}; // turned by some 90 degrees, stretched and sheared
  d.gradient = {1.0, 0.5, 0.0, 1.0};
  system.trial[0] = {{2.0, -1.0}, 77.0};
  pose(system, 0, 1);
  const Vec2 centre{3.0, -0.5};
  const TrialOutline outline(system, 0);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 expected = centre + d.trial(triangle[k] - Vec2{1.0, 0.5});
    EXPECT_NEAR(norm(outline.vertex[k] - expected), 0.0, 16.0 * epsilon);
    const Vec2 edge = outline.vertex[(k + 1) % 3] - outline.vertex[k];
    EXPECT_NEAR(outline.length[k], norm(edge), 16.0 * epsilon);
    EXPECT_NEAR(norm(edge - outline.length[k] * perp(outline.normal[k])), 0.0, 16.0 * epsilon);
    EXPECT_GE(outline.vertex[k].x, system.motion[0].box.low.x);
    const Vec2 sheared = Vec2{1.0, 0.5} + d.gradient(triangle[k] - Vec2{1.0, 0.5});
    EXPECT_NEAR(norm(current_vertices(system, 0)[k] - sheared), 0.0, 16.0 * epsilon);
  }
  EXPECT_LE(norm(system.trial_inverse[0] * d.trial - Mat2::identity()), 16.0 * epsilon);
}

TEST(BlockSystem, AttachmentsInReferenceAxes) {
  BlockSystem system;
  SceneBlock block = block_of(triangle);
  block.fixed_points = {{0.0, 0.0}};
  block.loads = {{{3.0, 0.0}, {5.0, -7.0}}, {{1.0, 0.5}, {1.0, 1.0}}};
  append_block(system, BlockId{0}, block, elastic_rock, BlockKind::rigid);
  append_block(system, BlockId{1}, block_of(triangle), elastic_rock, BlockKind::rigid);
  ASSERT_EQ(system.loads_of(0).size(), 2U);
  EXPECT_LE(norm(system.loads_of(0)[0].point - Vec2{2.0, -0.5}), 4.0 * epsilon);
  EXPECT_EQ(system.loads_of(0)[0].force, (Vec2{5.0, -7.0}));
  ASSERT_EQ(system.anchors_of(0).size(), 1U);
  EXPECT_LE(norm(system.anchors_of(0)[0].point - Vec2{-1.0, -0.5}), 4.0 * epsilon);
  EXPECT_TRUE(system.loads_of(1).empty());
  EXPECT_TRUE(system.anchors_of(1).empty());
  block.fixed = true;
  append_block(system, BlockId{2}, block, elastic_rock, BlockKind::fixed);
  EXPECT_TRUE(system.anchors_of(2).empty()) << "a fixed block is held anyway";
}

/// Three blocks of different vertex counts, one deformable, with every field filled differently.
BlockSystem filled_system() {
  BlockSystem system;
  SceneBlock held = block_of(random_polygon(1, 3, 1.0, {}));
  held.fixed_points = {{0.1, 0.2}};
  held.loads = {{{0.2, 0.1}, {1.0, 2.0}}, {{0.0, 0.1}, {3.0, 4.0}}};
  append_block(system, BlockId{0}, held, elastic_rock, BlockKind::rigid);
  append_block(system, BlockId{1}, block_of(random_polygon(2, 8, 1.0, {5.0, 0.0})), elastic_rock,
               BlockKind::deformable);
  append_block(system, BlockId{2}, block_of(random_polygon(3, 5, 1.0, {9.0, 0.0})), elastic_rock,
               BlockKind::rigid);
  system.num_owned = 3;
  std::mt19937 engine(7);
  const auto number = [&] { return uniform(engine, -1.0, 1.0); };
  const auto dof = [&] { return RigidDof{{number(), number()}, number()}; };
  const auto matrix = [&] { return Mat2{number(), number(), number(), number()}; };
  for (std::size_t row = 0; row < 3; ++row) {
    system.displacement[row] = dof();
    system.velocity[row] = dof();
    system.acceleration[row] = dof();
    system.trial[row] = dof();
    system.refreshed[row] = dof();
    system.contact[row] = {dof(), dof(), dof()};
    system.ledger[row] = {number(), number(), number(), number()};
    system.properties[row].material = static_cast<std::int32_t>(row) + 4;
  }
  Deformation &d = system.deformation[0];
  for (Mat2 *field :
       {&d.gradient, &d.rate, &d.acceleration, &d.trial, &d.refreshed, &d.second_moment, &d.internal,
        &d.contact.force, &d.contact.shear, &d.contact.damping, &d.load_force, &d.anchor_force}) {
    *field = matrix();
  }
  system.matrix_begin = {0, 1, 2, 2};
  for (int k = 0; k < 2; ++k) {
    BlockMatrix &own = system.matrix.emplace_back();
    for (double &entry : own.factor) {
      entry = number();
    }
  }
  system.applied[0] = {dof(), dof().u, dof()};
  system.anchor[0].stiffness = number();
  system.anchor[0].held = {number(), number()};
  return system;
}

/// Bytes, so that no field is forgotten: these structures are numbers without gaps.
template <class T> void expect_same_bytes(std::span<const T> a, std::span<const T> b) {
  ASSERT_EQ(a.size(), b.size());
  if (!a.empty()) {
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size_bytes()), 0);
  }
}

void expect_same_row(const BlockSystem &a, std::size_t i, const BlockSystem &b, std::size_t j) {
  const BlockProperties &p = a.properties[i];
  const BlockProperties &q = b.properties[j];
  EXPECT_EQ(p.id, q.id);
  EXPECT_EQ(p.material, q.material);
  EXPECT_EQ(p.kind, q.kind);
  EXPECT_EQ(p.is_convex, q.is_convex);
  EXPECT_EQ(p.area, q.area);
  EXPECT_EQ(p.mass, q.mass);
  EXPECT_EQ(p.inertia, q.inertia);
  EXPECT_EQ(p.radius, q.radius);
  EXPECT_EQ(p.width, q.width);
  EXPECT_EQ(p.centroid, q.centroid);
  for (const auto field : {&BlockSystem::displacement, &BlockSystem::velocity, &BlockSystem::acceleration,
                           &BlockSystem::trial, &BlockSystem::refreshed}) {
    EXPECT_EQ((a.*field)[i], (b.*field)[j]);
  }
  expect_same_bytes(std::span(&a.ledger[i], 1), std::span(&b.ledger[j], 1));
  expect_same_bytes(std::span(&a.contact[i], 1), std::span(&b.contact[j], 1));
  const auto expect_same_list = [&](auto begins, auto... fields) {
    const auto slice = [&](const BlockSystem &system, auto field, std::size_t row) {
      return std::span(system.*field)
          .subspan((system.*begins)[row], (system.*begins)[row + 1] - (system.*begins)[row]);
    };
    (expect_same_bytes(slice(a, fields, i), slice(b, fields, j)), ...);
  };
  std::apply([&](auto... list) { (std::apply(expect_same_list, list), ...); }, BlockSystem::lists());
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
  EXPECT_TRUE(to.is_deformable(5));
  EXPECT_FALSE(to.is_deformable(4));
  EXPECT_EQ(to.loads_of(4).size(), 2U);
}

// As rows appended one run after the other.
TEST(BlockSystem, TakenRowsKeepEveryBit) {
  const BlockSystem from = filled_system();
  BlockSystem joining;
  append_row(joining, from, 2);
  append_row(joining, from, 1);
  joining.properties[1].has_edge_joints = true; // of which the system knows none
  joining.edge_joint.assign(joining.reference_vertex.size(), -1);
  joining.edge_joint.back() = 2;
  const std::vector<RowRun> runs{{1, 2, true}, {0, 2, false}, {0, 1, true}, {2, 3, false}};
  BlockSystem expected;
  for (const RowRun &run : runs) {
    append_rows(expected, run.joins ? joining : from, run.first, run.last);
  }
  BlockSystem system = from;
  take_rows(system, joining, runs, 3);
  ASSERT_EQ(system.num_rows(), 5U);
  for (std::size_t row = 0; row < system.num_rows(); ++row) {
    SCOPED_TRACE(row);
    expect_same_row(system, row, expected, row);
  }
  EXPECT_EQ(system.edge_joint, expected.edge_joint);
  EXPECT_EQ(system.edge_joints(0).back(), 2);
  EXPECT_TRUE(system.is_deformable(2));

  take_rows(system, {}, {}, 0);
  EXPECT_EQ(system.num_rows(), 0U);
  EXPECT_TRUE(system.reference_vertex.empty());
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
} // namespace gcpdda::block_system_test
