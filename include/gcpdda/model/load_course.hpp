#pragma once

// What a load is multiplied by in the course of time.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace gcpdda {

/// A smooth rise from 0 to 1, 3 x^2 - 2 x^3, that begins and ends at rest. By default it is over.
struct Rise {
  double begin = -std::numeric_limits<double>::infinity(); ///< s
  double duration = 0.0;                                   ///< s; 0: at once

  /// Share at a time (s), from 0 to 1.
  [[nodiscard]] double at(double time) const {
    if (time - begin >= duration) {
      return 1.0;
    }
    const double x = std::max(0.0, (time - begin) / duration);
    return time > begin ? x * x * (3.0 - 2.0 * x) : 0.0;
  }
  /// When it is over, s.
  [[nodiscard]] double end() const { return begin + duration; }
};

/// A row of a load's table: what its force is multiplied by. The factor is linear to the next row, and the
/// last one stays.
struct LoadRow {
  double time = 0.0; ///< s, 0 in the first row
  double factor = 0.0;

  /// Equal in time and factor.
  friend bool operator==(const LoadRow &, const LoadRow &) = default;
};

/// What a force is multiplied by in the course of time: the product of its own ramp or table, of a rise with
/// which a stage brings it in, and of what each later stage that takes it out leaves of it.
///
/// Where a stage replaces forces f_0 by f_1 within a time, 1 - s(t) of f_0 and s(t) of f_1 act. A further
/// change to f_2 with s_2 while the first one lasts leaves 1 - s_2 of both, so the factors of all forces add
/// up to 1 whenever the changes come.
struct LoadCourse {
  double begin = 0.0; ///< s, when the time of its ramp or table begins
  double ramp = 0.0;  ///< s
  std::vector<LoadRow> table{};
  Rise in{};
  std::vector<Rise> out{};

  /// What the force is multiplied by at a time (s).
  [[nodiscard]] double factor(double time) const {
    double product = (table.empty() ? Rise{begin, ramp}.at(time) : of_table(time - begin)) * in.at(time);
    for (const Rise &going : out) {
      product *= 1.0 - going.at(time);
    }
    return product;
  }

  /// From when on the factor stays what it is, s; infinite before the force comes in.
  [[nodiscard]] double end() const {
    if (!out.empty()) { // the first one to be over leaves nothing
      double gone = out.front().end();
      for (const Rise &going : out) {
        gone = std::min(gone, going.end());
      }
      return gone;
    }
    return std::max(begin + (table.empty() ? ramp : table.back().time), in.end());
  }

private:
  [[nodiscard]] double of_table(double since) const {
    const auto next = std::upper_bound(table.begin(), table.end(), since,
                                       [](double time, const LoadRow &row) { return time < row.time; });
    if (next == table.begin()) {
      return table.front().factor;
    }
    const LoadRow &row = *(next - 1);
    return next == table.end()
               ? row.factor
               : row.factor + (next->factor - row.factor) * ((since - row.time) / (next->time - row.time));
  }
};

} // namespace gcpdda
