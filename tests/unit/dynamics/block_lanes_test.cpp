// Blocks step side by side, with whatever instructions a machine has: to the bits each has alone.

#include "dynamics/block_solve.hpp"

#include "dynamics/deformable.hpp"
#include "dynamics/free_rows.hpp"
#include "simulation/simulation.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <random>
#include <vector>

namespace gcpdda::block_lanes_test {
namespace {

constexpr std::size_t num_blocks = 37; // no multiple of any number of lanes
constexpr std::size_t inside_out = 13; // will be
constexpr double time_step = 1e-4;
constexpr double stiffness_damping = 2e-5;

double next(std::mt19937 &engine) {
  return -1.0 + 2.0 * static_cast<double>(engine()) / 4294967296.0;
}
Mat2 next_matrix(std::mt19937 &engine, double size) {
  return {size * next(engine), size * next(engine), size * next(engine), size * next(engine)};
}
RigidDof next_dofs(std::mt19937 &engine, double size) {
  return {{size * next(engine), size * next(engine)}, size * next(engine)};
}

Scheme usual_scheme() {
  return make_scheme(SchemeKind::generalized_alpha, 0.8, ContactTime::leapfrog);
}

/// Every fifth one hangs on a point, every seventh is rigid and does too.
struct Blocks {
  BlockSystem system;

  Blocks() {
    std::mt19937 engine(17);
    for (std::size_t row = 0; row < num_blocks; ++row) {
      SceneBlock block;
      block.vertices = {{0.0, 0.0}, {2.0 + 0.1 * next(engine), 0.3}, {1.7, 1.2}, {-0.2 * next(engine), 1.0}};
      if (row % 5 == 0 || row % 7 == 0) {
        block.fixed_points = {block.vertices[0]};
      }
      append_block(system, BlockId{static_cast<std::int64_t>(row)}, block, {"rock", 2500.0, 5e8, 0.3},
                   row % 7 == 0 ? BlockKind::rigid : BlockKind::deformable);
    }
    system.num_owned = num_blocks;
    make_block_matrices(system, usual_scheme(), time_step, Elasticity::implicit, 1e9, stiffness_damping);
    pose(system, 0, 0);
    for (std::size_t row = 0; row < num_blocks; ++row) {
      system.velocity[row] = next_dofs(engine, 0.5);
      system.acceleration[row] = next_dofs(engine, 30.0);
      system.contact[row].force = next_dofs(engine, 1e5);
    }
    for (Deformation &d : system.deformation) {
      // Most turn little in the step, some by more than a series reaches.
      const double rate = next(engine) > 0.8 ? 400.0 : 2.0;
      d.gradient = Mat2::identity() + next_matrix(engine, 1e-3);
      d.trial = d.gradient + next_matrix(engine, 1e-5);
      d.rate = Mat2{0.0, -rate, rate, 0.0} + next_matrix(engine, 0.5);
      d.acceleration = next_matrix(engine, 100.0);
      d.initial_strain = next_matrix(engine, 1e-4);
      d.contact.force = next_matrix(engine, 1e5);
    }
    for (std::size_t row = 0; row < num_blocks; ++row) {
      const Mat2 trial = system.is_deformable(row) ? system.deformation_of(row).trial : Mat2{};
      set_trial(system, row, {system.trial[row], trial + next_matrix(engine, 1e-5)});
    }
    system.deformation_of(inside_out).rate = {-2.0 / time_step, 0.0, 0.0, 0.0};
    pose(system, 0, num_blocks);
  }

  std::optional<std::size_t> step(std::size_t first, std::size_t last, Instructions instructions,
                                  Elasticity elasticity) {
    AdvanceReport report;
    const Scheme scheme = usual_scheme();
    solve_by_matrix(system, block_solve({{}, stiffness_damping}, scheme, time_step, elasticity), first, last,
                    0.0, report, instructions);
    return report.broken;
  }
};

void expect_same(const BlockSystem &a, const BlockSystem &b) {
  for (std::size_t row = 0; row < num_blocks; ++row) {
    SCOPED_TRACE(row);
    EXPECT_EQ(a.displacement[row], b.displacement[row]);
    EXPECT_EQ(a.velocity[row], b.velocity[row]);
    EXPECT_EQ(a.acceleration[row], b.acceleration[row]);
    EXPECT_EQ(a.ledger[row].load, b.ledger[row].load);
    EXPECT_EQ(a.ledger[row].damping, b.ledger[row].damping);
  }
  for (std::size_t k = 0; k < a.deformation.size(); ++k) {
    SCOPED_TRACE(k);
    for (const auto field : {&Deformation::gradient, &Deformation::rate, &Deformation::acceleration,
                             &Deformation::internal, &Deformation::anchor_force}) {
      EXPECT_EQ(a.deformation[k].*field, b.deformation[k].*field);
    }
    EXPECT_EQ(a.deformation[k].contact.damping, b.deformation[k].contact.damping);
  }
}

TEST(DeformableLanes, GiveTheSameBitsWithAllInstructionsAndNeighbours) {
  for (const Elasticity elasticity : {Elasticity::implicit, Elasticity::explicit_}) {
    Blocks alone;
    for (std::size_t row = 0; row < num_blocks; ++row) {
      EXPECT_EQ(alone.step(row, row + 1, Instructions::portable, elasticity).has_value(), row == inside_out);
    }
    for (const Instructions instructions :
         {Instructions::portable, Instructions::avx2, Instructions::widest}) {
      Blocks together;
      EXPECT_EQ(together.step(0, num_blocks, instructions, elasticity), inside_out);
      expect_same(together.system, alone.system);
    }
  }
}

TEST(DeformableLanes, LeaveABrokenBlockAsItWas) {
  const Blocks before;
  Blocks after;
  after.step(0, num_blocks, Instructions::widest, Elasticity::implicit);
  EXPECT_EQ(after.system.displacement[inside_out], before.system.displacement[inside_out]);
  EXPECT_EQ(after.system.deformation_of(inside_out).gradient,
            before.system.deformation_of(inside_out).gradient);
  EXPECT_EQ(after.system.deformation_of(inside_out).internal,
            before.system.deformation_of(inside_out).internal);
  EXPECT_NE(after.system.displacement[inside_out + 2], before.system.displacement[inside_out + 2]);
}

TEST(DeformableLanes, TellWhichBlocksMoveMuch) {
  Blocks first;
  first.step(0, num_blocks, Instructions::portable, Elasticity::implicit);
  std::vector<double> motions;
  std::vector<std::size_t> deformable;
  for (std::size_t row = 0; row < num_blocks; ++row) {
    if (first.system.is_deformable(row)) {
      deformable.push_back(row);
      motions.push_back(most_motion(first.system, row, time_step));
    }
  }
  std::nth_element(motions.begin(), motions.begin() + 10, motions.end());
  const double safe_motion = motions[10];
  std::vector<std::size_t> wanted;
  std::copy_if(deformable.begin(), deformable.end(), std::back_inserter(wanted),
               [&](std::size_t row) { return most_motion(first.system, row, time_step) > safe_motion; });
  ASSERT_EQ(wanted.size(), deformable.size() - 11);
  for (const Instructions instructions : {Instructions::portable, Instructions::avx2, Instructions::widest}) {
    Blocks blocks;
    AdvanceReport report;
    const Scheme scheme = usual_scheme();
    solve_by_matrix(blocks.system,
                    block_solve({{}, stiffness_damping}, scheme, time_step, Elasticity::implicit), 0,
                    num_blocks, safe_motion, report, instructions);
    std::vector<std::size_t> listed;
    for (const RowSpan &rows : report.rows_to_check) {
      ASSERT_EQ(rows.last, rows.first + 1);
      listed.push_back(rows.first);
    }
    std::sort(listed.begin(), listed.end());
    EXPECT_EQ(listed, wanted);
  }
}

// What the six equations of a block say, with the forces it was given and those it says it applied.
TEST(DeformableLanes, ObeyTheEquationOfMotion) {
  const Blocks before;
  Blocks after;
  after.step(0, num_blocks, Instructions::widest, Elasticity::implicit);
  const double am = usual_scheme().alpha_m;
  for (std::size_t row = 0; row < num_blocks; ++row) {
    if (!before.system.is_deformable(row) || row == inside_out) {
      continue;
    }
    SCOPED_TRACE(row);
    const Deformation &old = before.system.deformation_of(row);
    const Deformation &now = after.system.deformation_of(row);
    const Mat2 mean = (1.0 - am) * now.acceleration + am * old.acceleration;
    const Mat2 force =
        old.contact.force - now.internal + now.contact.damping - old.contact.damping + now.anchor_force;
    // Cancelling forces of up to 1e8 N solve to rounding of a system with a condition below 1e3.
    const double rounding = 1e-12 * (norm(now.internal) + norm(now.anchor_force) + norm(force) + 1e6);
    EXPECT_NEAR(norm(mean * old.second_moment - force), 0.0, rounding);
    if (row % 5 != 0) {
      const Vec2 a = (1.0 - am) * after.system.acceleration[row].u + am * before.system.acceleration[row].u;
      EXPECT_NEAR(norm(before.system.properties[row].mass * a - before.system.contact[row].force.u), 0.0,
                  1e-8);
    }
  }
}

void expect_same(const BlockLedger &a, const BlockLedger &b) {
  EXPECT_EQ(a.shear, b.shear);
  EXPECT_EQ(a.damping, b.damping);
  EXPECT_EQ(a.load, b.load);
  EXPECT_EQ(a.gravity, b.gravity);
}

void expect_same(const BlockContactSum &a, const BlockContactSum &b) {
  EXPECT_EQ(a.force, b.force);
  EXPECT_EQ(a.shear, b.shear);
  EXPECT_EQ(a.damping, b.damping);
}

void expect_same(const AppliedForces &a, const AppliedForces &b) {
  EXPECT_EQ(a.load, b.load);
  EXPECT_EQ(a.anchor, b.anchor);
  EXPECT_EQ(a.gravity, b.gravity);
}

/// The same scene, but that a point load of nothing keeps its blocks from being free.
Scene with_loads_of_nothing(Scene scene) {
  for (SceneBlock &block : scene.blocks) {
    if (!block.fixed) {
      block.loads.push_back({block.vertices[0], {0.0, 0.0}});
    }
  }
  return scene;
}

void expect_same(const Deformation &a, const Deformation &b) {
  EXPECT_EQ(a.gradient, b.gradient);
  EXPECT_EQ(a.rate, b.rate);
  EXPECT_EQ(a.acceleration, b.acceleration);
  EXPECT_EQ(a.internal, b.internal);
  EXPECT_EQ(a.contact.force, b.contact.force);
  EXPECT_EQ(a.contact.shear, b.contact.shear);
  EXPECT_EQ(a.contact.damping, b.contact.damping);
  EXPECT_EQ(a.load_force, b.load_force);
}

void expect_same_motion(const std::vector<std::string> &sets) {
  for (const char *damping : {"run.local_damping=0.0", "run.local_damping=0.7"}) {
    std::vector<std::string> all = sets;
    all.emplace_back(damping);
    const Scene scene = testing::scene_of(testing::falling_pile_toml(45, 0.2), all);
    Simulation together(Communicator::self(), scene);
    Simulation one_by_one(Communicator::self(), with_loads_of_nothing(scene));
    while (!together.finished() && together.step_count() < 600) {
      together.step();
      one_by_one.step();
    }
    ASSERT_FALSE(together.fault());
    double friction = 0.0;
    for (std::size_t row = 0; row < together.blocks().num_owned; ++row) {
      SCOPED_TRACE(row);
      EXPECT_EQ(together.blocks().displacement[row], one_by_one.blocks().displacement[row]);
      EXPECT_EQ(together.blocks().velocity[row], one_by_one.blocks().velocity[row]);
      EXPECT_EQ(together.blocks().acceleration[row], one_by_one.blocks().acceleration[row]);
      expect_same(together.blocks().contact[row], one_by_one.blocks().contact[row]);
      expect_same(together.blocks().ledger[row], one_by_one.blocks().ledger[row]);
      expect_same(applied_forces(together.blocks(), row), applied_forces(one_by_one.blocks(), row));
      friction += std::abs(together.blocks().ledger[row].shear);
    }
    EXPECT_GT(friction, 0.0) << "blocks that touch";
    for (std::size_t k = 0; k < together.blocks().deformation.size(); ++k) {
      SCOPED_TRACE(k);
      expect_same(together.blocks().deformation[k], one_by_one.blocks().deformation[k]);
    }
  }
}

TEST(FreeRows, MoveAsOneByOne) {
  expect_same_motion({});
}

TEST(FreeRows, MoveAsOneByOneWhileGravityGrowsAndAfterwards) {
  expect_same_motion({"run.gravity_ramp=0.2"});
}

TEST(FreeRows, MoveAsOneByOneWhereTheyDeform) {
  expect_same_motion({R"(run.fidelity="deformable")", "material.rock.youngs_modulus=1e9",
                      "material.rock.poissons_ratio=0.25"});
}

constexpr std::size_t num_free = 29;
constexpr std::size_t not_finite = 11; // will not be
constexpr std::size_t driven = 22;     // ends a run of free rows

struct FreeBlocks {
  BlockSystem system;

  FreeBlocks() {
    std::mt19937 engine(5);
    for (std::size_t row = 0; row < num_free; ++row) {
      SceneBlock block;
      block.vertices = {{0.0, 0.0}, {2.0 + next(engine), 0.3}, {1.7, 1.2}, {0.0, 1.0}};
      block.driven = row == driven;
      append_block(system, BlockId{static_cast<std::int64_t>(row)}, block, {"rock", 2500.0, 0.0, 0.0});
      system.contact[row] = {next_dofs(engine, 1e5), next_dofs(engine, 1e4), next_dofs(engine, 1e4)};
    }
    system.num_owned = num_free;
    pose(system, 0, 0);
    for (std::size_t row = 0; row < num_free; ++row) {
      for (auto *field : {&system.displacement, &system.velocity, &system.acceleration, &system.trial}) {
        (*field)[row] = next_dofs(engine, 1.0);
      }
      system.motion[row].set_increment(next_dofs(engine, 1.0));
    }
    system.velocity[3].u.x = 0.0; // nothing to damp
    system.contact[not_finite].force.r = std::numeric_limits<double>::infinity();
  }

  std::size_t step(Instructions instructions) {
    report = {};
    return advance_free_rows(system, {{{0.3, -9.81}, {0.7, 0.1}}, 0.6, safe_motion}, usual_scheme(),
                             time_step, Elasticity::implicit, 0, num_free, report, instructions);
  }

  double safe_motion = std::numeric_limits<double>::infinity();
  AdvanceReport report;
};

TEST(FreeRows, HaveTheSameBitsWithAllInstructions) {
  FreeBlocks portable;
  const std::size_t end = portable.step(Instructions::portable);
  EXPECT_LE(end, driven); // a build for this very machine has no narrower lanes
  EXPECT_GT(end, not_finite);
  EXPECT_EQ(portable.report.broken, not_finite);
  EXPECT_EQ(portable.system.velocity[not_finite], FreeBlocks().system.velocity[not_finite]);
  for (const Instructions instructions : {Instructions::avx2, Instructions::widest}) {
    FreeBlocks wider;
    const std::size_t wider_end = wider.step(instructions);
    EXPECT_LE(wider_end, driven);
    EXPECT_GT(wider_end, not_finite);
    EXPECT_EQ(wider.report.broken, not_finite);
    for (std::size_t row = 0; row < std::min(end, wider_end); ++row) {
      SCOPED_TRACE(row);
      EXPECT_EQ(wider.system.displacement[row], portable.system.displacement[row]);
      EXPECT_EQ(wider.system.velocity[row], portable.system.velocity[row]);
      EXPECT_EQ(wider.system.acceleration[row], portable.system.acceleration[row]);
      if (row != not_finite) { // infinite less infinite
        expect_same(wider.system.contact[row], portable.system.contact[row]);
        expect_same(wider.system.ledger[row], portable.system.ledger[row]);
      }
    }
  }
}

TEST(FreeRows, AreLookedAtWhereTheyMoveMuch) {
  for (const Instructions instructions : {Instructions::portable, Instructions::avx2, Instructions::widest}) {
    FreeBlocks blocks;
    blocks.system.contact.assign(num_free, {});
    blocks.system.displacement.assign(num_free, {});
    constexpr std::size_t far = 5;
    blocks.system.displacement[far].r = 0.5; // of a block with a radius of 1 m or so
    blocks.safe_motion = 0.1;
    const std::size_t end = blocks.step(instructions);
    std::vector<bool> is_listed(num_free);
    for (const RowSpan &rows : blocks.report.rows_to_check) {
      std::fill(is_listed.begin() + static_cast<std::ptrdiff_t>(rows.first),
                is_listed.begin() + static_cast<std::ptrdiff_t>(rows.last), true);
    }
    EXPECT_TRUE(is_listed[far]);
    EXPECT_FALSE(is_listed[end - 1]);
    for (std::size_t row = 0; row < end; ++row) {
      EXPECT_TRUE(is_listed[row] || most_motion(blocks.system, row, time_step) <= blocks.safe_motion) << row;
    }
  }
}

// Some turn by more than a series reaches.
TEST(Predict, MovesDeformableBlocksSideBySideAsEachAlone) {
  std::mt19937 engine(29);
  constexpr std::size_t count = 3 * most_lanes + 3;
  BlockSystem system;
  for (std::size_t row = 0; row < count; ++row) {
    SceneBlock block;
    block.vertices = {{0.0, 0.0}, {2.0 + next(engine), 0.3}, {1.7, 1.2}, {0.0, 1.0}};
    append_block(system, BlockId{static_cast<std::int64_t>(row)}, block, {"rock", 2500.0, 5e8, 0.3},
                 BlockKind::deformable);
    const double rate = next(engine) > 0.5 ? 4000.0 : 2.0;
    Deformation &d = system.deformation.back();
    d.gradient = Mat2::identity() + next_matrix(engine, 1e-2);
    d.trial = d.gradient + next_matrix(engine, 1e-5);
    d.rate = Mat2{0.0, -rate, rate, 0.0} + next_matrix(engine, 0.5);
    d.acceleration = next_matrix(engine, 100.0);
    for (auto *field : {&system.displacement, &system.velocity, &system.acceleration, &system.trial}) {
      (*field)[row] = next_dofs(engine, 1.0);
    }
  }
  std::vector<BlockSystem> alone(count);
  for (std::size_t row = 0; row < count; ++row) {
    append_row(alone[row], system, row);
    alone[row].num_owned = 1;
    predict(alone[row], usual_scheme(), time_step);
  }
  system.num_owned = count;
  predict(system, usual_scheme(), time_step);
  for (std::size_t row = 0; row < count; ++row) {
    SCOPED_TRACE(row);
    EXPECT_EQ(system.trial[row], alone[row].trial[0]);
    EXPECT_EQ(system.motion[row].increment(), alone[row].motion[0].increment());
    EXPECT_EQ(system.deformation[row].trial, alone[row].deformation[0].trial);
    EXPECT_EQ(system.increment_of(row).turn, alone[row].increment_of(0).turn);
  }
}

TEST(LookAhead, LeavesHowBlocksMoved) {
  Simulation simulation(Communicator::self(),
                        testing::scene_of(testing::falling_pile_toml(45, 0.2),
                                          {R"(run.fidelity="deformable")", "material.rock.youngs_modulus=1e9",
                                           "material.rock.poissons_ratio=0.25"}));
  for (int step = 0; step < 100; ++step) {
    simulation.step();
  }
  const std::vector<BlockMotion> before = simulation.blocks().motion;
  std::size_t ahead = 0; // of rows that deform in another way there
  {
    const ComingTrial coming(simulation.state());
    const BlockSystem &blocks = simulation.blocks();
    for (std::size_t row = 0; row < blocks.num_owned; ++row) {
      ahead += blocks.is_deformable(row) && blocks.motion[row].turn != before[row].turn ? 1 : 0;
    }
  }
  EXPECT_GT(ahead, 0U);
  for (std::size_t row = 0; row < simulation.blocks().num_owned; ++row) {
    SCOPED_TRACE(row);
    EXPECT_EQ(simulation.blocks().motion[row].increment(), before[row].increment());
    EXPECT_EQ(simulation.blocks().motion[row].turn, before[row].turn);
    EXPECT_EQ(simulation.blocks().motion[row].centroid, before[row].centroid);
  }
}

// Blocks with three, four and five vertices, rigid and deformable, in any order; some have turned far.
TEST(Predict, PosesEveryBlockAsPoseDoes) {
  std::mt19937 engine(23);
  BlockSystem system;
  for (std::int64_t id = 0; id < 101; ++id) {
    const int num_vertices = next(engine) > 0.4 ? (next(engine) > 0.0 ? 3 : 5) : 4;
    SceneBlock block;
    block.vertices = testing::random_polygon(static_cast<unsigned>(id + 1), num_vertices, 1.0, {0.0, 0.0});
    append_block(system, BlockId{id}, block, {"rock", 2500.0, 5e8, 0.3},
                 next(engine) > 0.0 ? BlockKind::rigid : BlockKind::deformable);
    system.displacement.back() = next_dofs(engine, id % 9 == 0 ? 3.0 : 0.1);
    system.velocity.back() = next_dofs(engine, 1.0);
    system.acceleration.back() = next_dofs(engine, 10.0);
  }
  for (Deformation &d : system.deformation) {
    d.gradient = Mat2::identity() + next_matrix(engine, 0.1);
    d.rate = next_matrix(engine, 1.0);
    d.acceleration = next_matrix(engine, 10.0);
  }
  system.num_owned = system.num_rows();
  pose(system, 0, system.num_rows());
  predict(system, usual_scheme(), 1e-3);
  BlockSystem one_by_one = system;
  pose(one_by_one, 0, one_by_one.num_rows());
  EXPECT_EQ(system.vertex, one_by_one.vertex);
  EXPECT_EQ(system.trial_inverse, one_by_one.trial_inverse);
  ASSERT_EQ(system.deformed_edge.size(), system.vertex.size());
  for (std::size_t k = 0; k < system.vertex.size(); ++k) {
    EXPECT_EQ(system.deformed_edge[k].slope, one_by_one.deformed_edge[k].slope);
    EXPECT_EQ(system.deformed_edge[k].length, one_by_one.deformed_edge[k].length);
    EXPECT_EQ(system.deformed_edge[k].unit, one_by_one.deformed_edge[k].unit);
  }
  for (std::size_t row = 0; row < system.num_rows(); ++row) {
    EXPECT_EQ(system.motion[row].centroid, one_by_one.motion[row].centroid);
    EXPECT_EQ(system.motion[row].box.low, one_by_one.motion[row].box.low);
    EXPECT_EQ(system.motion[row].box.high, one_by_one.motion[row].box.high);
    EXPECT_EQ(system.motion[row].turn[1], one_by_one.motion[row].turn[1]);
    EXPECT_NE(system.trial[row].u, system.displacement[row].u) << "it has moved";
  }
}

} // namespace
} // namespace gcpdda::block_lanes_test
