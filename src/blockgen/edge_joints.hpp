#pragma once

// Which joint law each edge of a block has.

#include "blockgen/traces.hpp"
#include "gcpdda/model/joint_law.hpp"

#include <span>
#include <vector>

namespace gcpdda::blockgen {

/// Finds the traces an edge of a face comes from.
class EdgeJoints {
public:
  /// @param traces    what the faces were made of; they must stay
  /// @param laws      the scene's; they must stay
  /// @param tolerance farther from a trace than this an edge is not of it, m
  EdgeJoints(std::span<const Trace> traces, const JointLaws &laws, const Aabb &box, double tolerance);

  /// Joint of the traces that the edge lies on: the weakest that they name (JointLaws::of_edges), -1 where
  /// they name none.
  [[nodiscard]] std::int32_t of(Vec2 from, Vec2 to) const;
  /// Traces on which a point of the box lies, within the tolerance, in the order of the traces.
  [[nodiscard]] std::vector<std::uint32_t> at(Vec2 p) const;
  [[nodiscard]] bool lies_on(Vec2 p, const Trace &trace) const;

private:
  void enter(std::size_t trace);
  [[nodiscard]] std::size_t column(double x) const;
  [[nodiscard]] std::size_t row(double y) const;

  std::span<const Trace> traces_;
  const JointLaws *laws_;
  Aabb box_;
  double tolerance_;
  std::size_t num_columns_ = 1;
  std::size_t num_rows_ = 1;
  double width_ = 1.0;                           ///< of a bin, m
  double height_ = 1.0;                          ///< of a bin, m
  std::vector<std::vector<std::uint32_t>> bins_; ///< traces that pass, ascending
};

} // namespace gcpdda::blockgen
