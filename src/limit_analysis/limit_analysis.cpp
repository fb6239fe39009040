#include "limit_analysis/limit_analysis.hpp"

#include "base/check.hpp"

#include <coin/Clp_C_Interface.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

namespace gcpdda {

namespace {

/// Of the simplex method in one programme: about a minute for 2,000 blocks.
constexpr int most_iterations = 50'000;

/// Columns of a linear programme with three rows for each block.
class Programme {
public:
  explicit Programme(const std::vector<LimitBlock> &blocks) : blocks_(blocks) {
    double sum = 0.0;
    for (const LimitBlock &block : blocks) {
      sum += norm(block.load);
    }
    unit_ = sum > 0.0 ? sum / static_cast<double>(blocks.size()) : 1.0;
    for (const LimitBlock &block : blocks) {
      right_.insert(right_.end(),
                    {-block.load.x / unit_, -block.load.y / unit_, -block.torque / (block.size * unit_)});
    }
  }

  /// A force along `direction` at a point of a joint, its size between two bounds (N/m).
  void add(const LimitJoint &joint, Vec2 point, Vec2 direction, double least, double most) {
    put(joint.first, point, direction);
    put(joint.second, point, -1.0 * direction);
    starts_.push_back(static_cast<CoinBigIndex>(rows_.size()));
    low_.push_back(least / unit_);
    high_.push_back(most / unit_);
  }

  /// @param basis  that of a similar programme, or empty; becomes the one of this
  [[nodiscard]] bool is_feasible(std::vector<unsigned char> &basis) const {
    const std::unique_ptr<Clp_Simplex, void (*)(Clp_Simplex *)> model(Clp_newModel(), Clp_deleteModel);
    Clp_setLogLevel(model.get(), 0);
    Clp_loadProblem(model.get(), static_cast<int>(low_.size()), static_cast<int>(right_.size()),
                    starts_.data(), rows_.data(), values_.data(), low_.data(), high_.data(), nullptr,
                    right_.data(), right_.data());
    Clp_setMaximumIterations(model.get(), most_iterations);
    if (basis.empty()) {
      Clp_initialPrimalSolve(model.get());
    } else {
      Clp_copyinStatus(model.get(), basis.data());
      Clp_dual(model.get(), 0);
    }
    const int status = Clp_status(model.get());
    if (status != 0 && status != 1) {
      throw UnsolvedProgramme(blocks_.size(), low_.size());
    }
    const unsigned char *found = Clp_statusArray(model.get());
    basis.assign(found, found + low_.size() + right_.size());
    return status == 0;
  }

private:
  void put(std::int64_t block, Vec2 point, Vec2 force) {
    if (block < 0) {
      return;
    }
    const LimitBlock &on = blocks_[static_cast<std::size_t>(block)];
    const int row = 3 * static_cast<int>(block);
    rows_.insert(rows_.end(), {row, row + 1, row + 2});
    values_.insert(values_.end(), {force.x, force.y, cross(point - on.centroid, force) / on.size});
  }

  const std::vector<LimitBlock> &blocks_;
  double unit_ = 1.0; ///< of forces, N/m
  std::vector<double> right_;
  std::vector<CoinBigIndex> starts_{0};
  std::vector<int> rows_;
  std::vector<double> values_;
  std::vector<double> low_;
  std::vector<double> high_;
};

} // namespace

namespace {

/// @param basis  of the programme with another factor, or empty
bool can_hold_from(const std::vector<LimitBlock> &blocks, const std::vector<LimitJoint> &joints,
                   double factor, std::vector<unsigned char> &basis) {
  constexpr double infinite = std::numeric_limits<double>::max();
  Programme programme(blocks);
  for (const LimitJoint &joint : joints) {
    const double divided = joint.is_weakened ? factor : 1.0;
    const Vec2 along = (joint.tan_friction / divided) * perp(joint.normal);
    for (const Vec2 end : {joint.begin, joint.end}) {
      programme.add(joint, end, joint.normal + along, 0.0, infinite);
      programme.add(joint, end, joint.normal - along, 0.0, infinite);
      if (joint.tension > 0.0) {
        programme.add(joint, end, joint.normal, -0.5 * joint.tension / divided, 0.0);
      }
    }
    if (joint.cohesion > 0.0) {
      const double most = joint.cohesion / divided;
      programme.add(joint, joint.begin, perp(joint.normal), -most, most);
    }
  }
  return programme.is_feasible(basis);
}

} // namespace

UnsolvedProgramme::UnsolvedProgramme(std::size_t blocks, std::size_t forces)
    : std::runtime_error(
          "limit analysis: the linear programme of " + std::to_string(blocks) + " blocks and " +
          std::to_string(forces) + " forces was not solved in " + std::to_string(most_iterations) +
          " iterations; cut the scene to the blocks around the slip surface, or use fos without "
          "--bound") {}

bool can_hold(const std::vector<LimitBlock> &blocks, const std::vector<LimitJoint> &joints, double factor) {
  std::vector<unsigned char> basis;
  return can_hold_from(blocks, joints, factor, basis);
}

std::optional<double> bound_of_factor(const std::vector<LimitBlock> &blocks,
                                      const std::vector<LimitJoint> &joints, double least, double most,
                                      double tolerance) {
  std::vector<unsigned char> basis;
  if (!can_hold_from(blocks, joints, least, basis)) {
    return least;
  }
  if (can_hold_from(blocks, joints, most, basis)) {
    return std::nullopt;
  }
  double holds = least;
  double fails = most;
  while (fails - holds > tolerance * holds) {
    const double middle = std::sqrt(holds * fails);
    (can_hold_from(blocks, joints, middle, basis) ? holds : fails) = middle;
  }
  return fails;
}

} // namespace gcpdda
