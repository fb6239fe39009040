// C6: a pyramid of unit squares settles and stays.

#include "problem.hpp"
#include "support/contact_regions.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gcpdda::testing::pyramid_test {
namespace {

constexpr double watch = 5.0; ///< s

/// Mean overlaps N/(k_n l) of the joints from the top block down to the floor, summed along the column of
/// half joints on the left or right of the axis.
double joint_overlaps(Simulation &simulation, int rows, bool right) {
  std::vector<std::int64_t> column{0}; // the floor
  for (int row = 0, first = 1; row < rows; first += rows - row, ++row) {
    column.push_back(first + (rows - 1 - row + (right ? 1 : 0)) / 2);
  }
  double sum = 0.0;
  for (const RegionForce &force : regions_of(simulation)) {
    const CandidatePair &pair = simulation.candidates().pairs[force.pair];
    const std::int64_t a = simulation.blocks().properties[pair.lower.value].id.value;
    const std::int64_t b = simulation.blocks().properties[pair.higher.value].id.value;
    const auto at = std::find(column.begin(), column.end(), a == 0 ? b : a);
    if (at != column.end() && (a == 0 || (at + 1 < column.end() && *(at + 1) == b))) {
      const double stiffness = 2.0 * simulation.contacts().parameters().constants(pair.law).half_stiffness;
      sum += force.normal_force / (stiffness * (force.extent_end - force.extent_begin));
    }
  }
  return sum;
}

// The time to settle is that of the slowest mode: height over wave speed, with a stiffness proportional to
// the height the root of the height. Blocks beside the axis tilt, which closes one end of a joint and opens
// the other: its mean overlap, from its force, is that of its middle. That leaves out d/l of a flush
// joint, 1.2e-3.
TEST(Pyramid, StandsAndStays) {
  const int rows = full_size() ? 100 : 20;
  const double settling = 0.3 * std::sqrt(rows);
  Simulation simulation(Communicator::self(), scene_of(settling_pyramid_toml(rows, settling + watch)));
  const BlockSystem &blocks = simulation.blocks();
  const std::string problem = fmt::format("C6 pyramid of {} squares, local damping 0.8: ", blocks.num_owned);
  run_until(simulation, settling);
  const std::vector<RigidDof> rest = blocks.displacement;
  const double sag = -displacement_of(simulation, static_cast<int>(blocks.num_owned)).u.y;
  const double joints =
      0.5 * (joint_overlaps(simulation, rows, false) + joint_overlaps(simulation, rows, true));
  expect_value(problem + "sag of the top, m", joints, sag, 2e-3);
  double drift = 0.0;
  double moved = 0.0;
  while (!simulation.finished()) {
    step(simulation);
    for (std::size_t row = 0; row < blocks.num_owned; ++row) {
      const RigidDof d = blocks.displacement[row] - rest[row];
      drift = std::max(drift, norm(d.u) + blocks.properties[row].radius * std::abs(d.r));
      moved = std::max(moved, norm(blocks.displacement[row].u));
    }
  }
  ASSERT_FALSE(simulation.fault().has_value());
  expect_below(problem + fmt::format("drift over 5 s after {:.2g} s of settling, m", settling), 1e-6, drift);
  expect_below(problem + "largest displacement over the sag of the top", 1.2, moved / sag);
}

} // namespace
} // namespace gcpdda::testing::pyramid_test
