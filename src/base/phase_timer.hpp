#pragma once

// Wall time of the phases of a step.

#include <array>
#include <chrono>
#include <cstddef>

namespace gcpdda {

/// Stretches of a run whose wall time is reported; `count` closes the list.
enum class Phase { refresh, predict, ghosts, forces, update, report, output, count };

inline constexpr std::array<const char *, static_cast<std::size_t>(Phase::count)> phase_names{
    "refresh", "predict", "ghosts", "forces", "update", "report", "output"};

/// Wall seconds per phase on this rank, each without those that are measured within it; but output with
/// all that is done for it.
class PhaseTimes {
public:
  class Scope {
  public:
    Scope(PhaseTimes &times, Phase phase) : times_(times), outer_(times.running_) {
      times_.go_over_to(outer_ == Phase::output ? outer_ : phase);
    }
    ~Scope() { times_.go_over_to(outer_); }
    Scope(const Scope &) = delete;
    Scope &operator=(const Scope &) = delete;

  private:
    PhaseTimes &times_;
    Phase outer_;
  };

  [[nodiscard]] Scope measure(Phase phase) { return {*this, phase}; }
  [[nodiscard]] double seconds(Phase phase) const { return seconds_[static_cast<std::size_t>(phase)]; }

private:
  using Clock = std::chrono::steady_clock;
  void go_over_to(Phase phase) {
    const Clock::time_point now = Clock::now();
    seconds_[static_cast<std::size_t>(running_)] += std::chrono::duration<double>(now - since_).count();
    running_ = phase;
    since_ = now;
  }

  std::array<double, static_cast<std::size_t>(Phase::count) + 1> seconds_{};
  Phase running_ = Phase::count; ///< none
  Clock::time_point since_ = Clock::now();
};

} // namespace gcpdda
