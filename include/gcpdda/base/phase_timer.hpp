#pragma once

#include <array>
#include <chrono>
#include <cstddef>

namespace gcpdda {

/// Stretches of a run whose wall time is reported; `count` closes the list.
enum class Phase { refresh, predict, ghosts, forces, update, report, output, count };

inline constexpr std::array<const char *, static_cast<std::size_t>(Phase::count)> phase_names{
    "refresh", "predict", "ghosts", "forces", "update", "report", "output"};

/// Wall seconds per phase on this rank.
class PhaseTimes {
public:
  class Scope {
  public:
    explicit Scope(double &sum) : sum_(sum), start_(Clock::now()) {}
    ~Scope() { sum_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
    Scope(const Scope &) = delete;
    Scope &operator=(const Scope &) = delete;

  private:
    using Clock = std::chrono::steady_clock;
    double &sum_;
    Clock::time_point start_;
  };

  [[nodiscard]] Scope measure(Phase phase) { return Scope(seconds_[static_cast<std::size_t>(phase)]); }
  [[nodiscard]] double seconds(Phase phase) const { return seconds_[static_cast<std::size_t>(phase)]; }

private:
  std::array<double, static_cast<std::size_t>(Phase::count)> seconds_{};
};

} // namespace gcpdda
