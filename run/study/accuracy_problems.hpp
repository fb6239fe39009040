#pragma once

// The problems whose error is charted against the cost of reaching it, in whatever way they are computed.

#include "study.hpp"

#include <functional>
#include <string>
#include <vector>

namespace gcpdda::study {

/// One way to compute a problem: the defaults but for one factor, and the share of the stable step.
struct Choice {
  std::string factor = "default"; ///< what differs from the defaults
  std::string value{};
  double safety = 0.0; ///< 0: the program's own
  double allowed_overlap = 1e-3;
  std::string run_keys{};           ///< of [run], where that makes the difference
  std::string fidelity = "fitting"; ///< fitting: rigid, but deformable where the problem has a modulus
};

struct Measured {
  double error = 0.0; ///< infinite: the run failed
  Cost cost;
  double normal_stiffness = 0.0; ///< Pa/m
  double time_step = 0.0;        ///< s
};

struct Problem {
  std::string name;
  std::string error;            ///< what is compared, and with what
  bool stiffness_is_free;       ///< no part of the problem: the rule sets it
  bool is_elastic;              ///< has a modulus
  double floor;                 ///< errors below are as good as none: round-off of the comparison
  std::vector<double> safeties; ///< of the curves
  std::function<Measured(const Choice &)> compute;
};

/// @param quick  smaller models and fewer steps sizes, the same problems
std::vector<Problem> accuracy_problems(bool quick);

struct PileSizes {
  int wall_rows; ///< even; every second one, the last one too, has one brick more, two of them cut
  int wall_columns;
  int pyramid_rows;
  /// Numbers of the bricks in the middle of the top, counted behind the ground.
  [[nodiscard]] int top_of_wall() const {
    return wall_rows * wall_columns + wall_rows / 2 - (wall_columns + 1) / 2;
  }
  [[nodiscard]] int top_of_pyramid() const { return pyramid_rows * (pyramid_rows + 1) / 2; }
};
PileSizes pile_sizes(bool quick);

/// The same problems by engines that are installed: peers.csv.
void compare_with_peers(const Options &options);

/// Angle of a block that topples about a fixed corner, rad: the line from the corner to the centroid starts
/// at rest at `start` from the vertical. Runge-Kutta in steps of 1e-5 s, error below 1e-12.
double toppling_angle(double width, double height, double start, double time);

/// The chosen settings as lines of [run].
std::string run_keys(const Choice &choice);

} // namespace gcpdda::study
