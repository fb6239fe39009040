#pragma once

// Ground motion and the sides through which waves leave.

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/geometry/vec2.hpp"
#include "gcpdda/model/in_situ.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace gcpdda {

enum class RecordQuantity { velocity, acceleration };
/// What is taken away from an acceleration record: nothing, a constant so that its velocity ends at zero, or
/// a straight line so that velocity and displacement do.
enum class Baseline { none, velocity, displacement };

/// A row of a record: m/s or m/s2, linear to the next row.
struct RecordRow {
  double time = 0.0; ///< s
  Vec2 value;
};

/// How the ground moves.
struct Earthquake {
  std::string file; ///< of the record, as the program opens it; empty without one
  RecordQuantity quantity = RecordQuantity::velocity;
  Baseline baseline = Baseline::none;
  double scale = 1.0;
  double start = 0.0;            ///< s; of the first row
  std::int64_t stage = -1;       ///< number of the stage whose begin it is instead; -1 for none
  std::vector<RecordRow> record; ///< empty until the file has been read; times rise
  /// Sides that let waves out from then on; with the bottom among them the record is the wave that comes in
  /// there, without it the motion of all that is held.
  std::vector<Boundary> viscous;
  bool is_compliant = false; ///< the bottom is one of them
  double p_wave_speed = 0.0; ///< of the rock beyond them, m/s; 0: that of the blocks and joints on this side
  double s_wave_speed = 0.0;
  SourcePosition where; ///< of its file in the scene

  /// Whether the scene has a record.
  [[nodiscard]] bool shakes() const { return !file.empty(); }
};

} // namespace gcpdda
