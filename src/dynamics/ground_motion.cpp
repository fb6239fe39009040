#include "dynamics/ground_motion.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace gcpdda {

GroundMotion::GroundMotion(const Earthquake &earthquake) {
  const std::vector<RecordRow> &rows = earthquake.record;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    Piece piece;
    piece.time = rows[k].time - rows[0].time;
    const bool is_last = k + 1 == rows.size();
    const double length = is_last ? 1.0 : rows[k + 1].time - rows[k].time;
    const Vec2 value = earthquake.scale * rows[k].value;
    const Vec2 slope = is_last ? Vec2{} : (1.0 / length) * (earthquake.scale * rows[k + 1].value - value);
    if (earthquake.quantity == RecordQuantity::velocity) {
      piece.velocity = value;
      piece.acceleration = slope;
    } else if (!is_last) {
      piece.acceleration = value;
      piece.jerk = slope;
    }
    pieces_.push_back(piece);
  }
  join();
  correct(earthquake.baseline);
  for (std::size_t k = 0; k + 1 < pieces_.size(); ++k) {
    const Piece &piece = pieces_[k];
    const Vec2 end = piece.acceleration + (pieces_[k + 1].time - piece.time) * piece.jerk;
    peak_ = std::max({peak_, norm(piece.acceleration), norm(end)});
  }
}

// Velocity and displacement at the beginning of each piece, from those of the one before.
void GroundMotion::join() {
  for (std::size_t k = 1; k < pieces_.size(); ++k) {
    const Piece &before = pieces_[k - 1];
    const double t = pieces_[k].time - before.time;
    pieces_[k].velocity = before.velocity + t * (before.acceleration + (0.5 * t) * before.jerk);
    pieces_[k].displacement =
        before.displacement +
        t * (before.velocity + (0.5 * t) * (before.acceleration + (t / 3.0) * before.jerk));
  }
}

// Less c + s t, with c T + s T^2/2 = v(T) and, for the displacement, c T^2/2 + s T^3/6 = d(T).
void GroundMotion::correct(Baseline baseline) {
  const double length = duration();
  if (baseline == Baseline::none || length == 0.0) {
    return;
  }
  const Vec2 velocity = pieces_.back().velocity;
  Vec2 slope;
  if (baseline == Baseline::displacement) {
    slope = (6.0 / (length * length)) * (velocity - (2.0 / length) * pieces_.back().displacement);
  }
  const Vec2 constant = (1.0 / length) * velocity - (0.5 * length) * slope;
  for (std::size_t k = 0; k + 1 < pieces_.size(); ++k) {
    pieces_[k].acceleration = pieces_[k].acceleration - (constant + pieces_[k].time * slope);
    pieces_[k].jerk = pieces_[k].jerk - slope;
  }
  join();
}

const GroundMotion::Piece &GroundMotion::piece_at(double time) const {
  const auto after = std::upper_bound(pieces_.begin() + 1, pieces_.end(), time,
                                      [](double t, const Piece &piece) { return t < piece.time; });
  return *std::prev(after);
}

Vec2 GroundMotion::velocity(double time) const {
  const Piece &piece = piece_at(time);
  const double t = std::max(0.0, time - piece.time);
  return piece.velocity + t * (piece.acceleration + (0.5 * t) * piece.jerk);
}

Vec2 GroundMotion::displacement(double time) const {
  const Piece &piece = piece_at(time);
  const double t = std::max(0.0, time - piece.time);
  return piece.displacement +
         t * (piece.velocity + (0.5 * t) * (piece.acceleration + (t / 3.0) * piece.jerk));
}

Vec2 GroundMotion::mean_acceleration(double time, double time_step) const {
  const double end = time + 0.5 * time_step;
  const double begin = std::max(0.0, time - 0.5 * time_step);
  if (pieces_.empty() || end <= 0.0) {
    return {};
  }
  return (1.0 / (end - begin)) * (velocity(end) - velocity(begin));
}

} // namespace gcpdda
