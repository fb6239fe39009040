#include "limit_analysis/limit_analysis.hpp"

#include <coin/Clp_C_Interface.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

namespace gcpdda {

namespace {

/// What the simplex method leaves of a share that is 1.
constexpr double rounding_of_share = 1e-7;
/// Of the simplex method in one programme.
constexpr int most_iterations = 50'000;

/// Which columns and rows of a programme are at a bound and which are not, as the simplex method codes it.
using Basis = std::vector<unsigned char>;

/// Columns of a linear programme with three rows for each block.
class Programme {
public:
  explicit Programme(const std::vector<LimitBlock> &blocks) : blocks_(blocks) {
    double sum = 0.0;
    for (const LimitBlock &block : blocks) {
      sum += norm(block.load);
    }
    unit_ = sum > 0.0 ? sum / static_cast<double>(blocks.size()) : 1.0;
    for (std::size_t i = 0; i < blocks.size(); ++i) { // column 0: the share of the load
      const LimitBlock &block = blocks[i];
      const int row = 3 * static_cast<int>(i);
      rows_.insert(rows_.end(), {row, row + 1, row + 2});
      values_.insert(values_.end(),
                     {block.load.x / unit_, block.load.y / unit_, block.torque / (block.size * unit_)});
    }
    close_column(0.0, 1.0);
  }

  /// A force along `direction` at a point of a joint, its size between two bounds (N/m).
  void add(const LimitJoint &joint, Vec2 point, Vec2 direction, double least, double most) {
    put(joint.first, point, direction);
    put(joint.second, point, -1.0 * direction);
    close_column(least / unit_, most / unit_);
  }

  void add(const LimitForce &force) {
    if (force.direction == Vec2{}) {
      put_couple(force.first, 1.0);
      put_couple(force.second, -1.0);
    } else {
      put(force.first, force.point[0], force.direction);
      put(force.second, force.point[1], -1.0 * force.direction);
    }
    close_column(force.least / unit_, force.most / unit_);
  }

  /// The largest share of the load that the forces hold, at most 1.
  /// @param basis  where the simplex method begins, and where it has ended; empty: none is known
  double largest_share(Basis &basis) const {
    const std::unique_ptr<Clp_Simplex, void (*)(Clp_Simplex *)> model(Clp_newModel(), Clp_deleteModel);
    Clp_setLogLevel(model.get(), 0);
    std::vector<double> costs(low_.size(), 0.0);
    costs[0] = -1.0;
    const std::vector<double> balance(3 * blocks_.size(), 0.0);
    Clp_loadProblem(model.get(), static_cast<int>(low_.size()), static_cast<int>(balance.size()),
                    starts_.data(), rows_.data(), values_.data(), low_.data(), high_.data(), costs.data(),
                    balance.data(), balance.data());
    // Numbers are near 1 already, and what rounding leaves of a zero must not set the scale of a row.
    Clp_scaling(model.get(), 0);
    Clp_setMaximumIterations(model.get(), most_iterations);
    if (!basis.empty()) {
      Clp_copyinStatus(model.get(), basis.data());
    }
    if (basis.empty() || Clp_dual(model.get(), 0) != 0) {
      Clp_initialDualSolve(model.get()); // the primal method takes three times as long
    }
    const unsigned char *status = Clp_statusArray(model.get());
    basis.assign(status, status + low_.size() + balance.size());
    if (Clp_status(model.get()) != 0) { // no load needs no force, so that a solution exists
      throw UnsolvedProgramme(blocks_.size(), low_.size());
    }
    return Clp_getColSolution(model.get())[0];
  }

private:
  void close_column(double least, double most) {
    starts_.push_back(static_cast<CoinBigIndex>(rows_.size()));
    low_.push_back(least);
    high_.push_back(most);
  }
  void put(std::int64_t block, Vec2 point, Vec2 force) {
    if (block < 0) {
      return;
    }
    const LimitBlock &on = blocks_[static_cast<std::size_t>(block)];
    const int row = 3 * static_cast<int>(block);
    rows_.insert(rows_.end(), {row, row + 1, row + 2});
    values_.insert(values_.end(), {force.x, force.y, cross(point - on.centroid, force) / on.size});
  }
  void put_couple(std::int64_t block, double couple) {
    if (block >= 0) {
      rows_.push_back(3 * static_cast<int>(block) + 2);
      values_.push_back(couple / blocks_[static_cast<std::size_t>(block)].size);
    }
  }

  const std::vector<LimitBlock> &blocks_;
  double unit_ = 1.0; ///< of forces, N/m
  std::vector<CoinBigIndex> starts_{0};
  std::vector<int> rows_;
  std::vector<double> values_;
  std::vector<double> low_;
  std::vector<double> high_;
};

bool can_hold(const LimitModel &model, double factor, Basis &basis) {
  constexpr double infinite = std::numeric_limits<double>::max();
  Programme programme(model.blocks);
  for (const LimitJoint &joint : model.joints) {
    const double divided = joint.is_weakened ? factor : 1.0;
    const double tan_friction = joint.tan_friction / divided;
    const double tension = joint.tension / divided;
    const Vec2 along = tan_friction * perp(joint.normal);
    for (const Vec2 end : {joint.begin, joint.end}) {
      programme.add(joint, end, joint.normal + along, 0.0, infinite);
      programme.add(joint, end, joint.normal - along, 0.0, infinite);
      if (tension > 0.0) {
        programme.add(joint, end, joint.normal, -0.5 * tension, -0.5 * tension);
      }
    }
    const double most = joint.cohesion / divided - tan_friction * tension;
    if (most > 0.0) {
      programme.add(joint, joint.begin, perp(joint.normal), -most, most);
    }
  }
  for (const LimitForce &force : model.forces) {
    programme.add(force);
  }
  return programme.largest_share(basis) > 1.0 - rounding_of_share;
}

} // namespace

bool can_hold(const LimitModel &model, double factor) {
  Basis basis;
  return can_hold(model, factor, basis);
}

UnsolvedProgramme::UnsolvedProgramme(std::size_t blocks, std::size_t forces)
    : std::runtime_error(
          "limit analysis: the linear programme of " + std::to_string(blocks) + " blocks and " +
          std::to_string(forces) + " forces was not solved in " + std::to_string(most_iterations) +
          " iterations; cut the scene to the blocks around the slip surface, or use fos without "
          "--bound") {}

std::optional<double> bound_of_factor(const LimitModel &model, double least, double most, double tolerance) {
  Basis basis;
  if (!can_hold(model, least, basis)) {
    return least;
  }
  // Up in small steps: a programme that begins where a similar one has ended is solved in a fraction of the
  // iterations, and one far beyond the bound takes most of them.
  constexpr double growth = 1.2;
  double holds = least;
  double fails = least;
  do {
    holds = fails;
    if (holds >= most) {
      return std::nullopt;
    }
    fails = std::min(growth * holds, most);
  } while (can_hold(model, fails, basis));
  while (fails - holds > tolerance * holds) {
    const double middle = std::sqrt(holds * fails);
    (can_hold(model, middle, basis) ? holds : fails) = middle;
  }
  return fails;
}

} // namespace gcpdda
