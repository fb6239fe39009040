#pragma once

// Where the energy of a run is and where it went.
//
// With x* the trial configurations the scheme is a leapfrog, and with KE_{n+1/2} the kinetic energy of
// (x*_{n+1} - x*_n)/dt
//     KE_{n+1/2} - KE_{n-1/2} = f_n . (x*_{n+1} - x*_{n-1})/2
// holds to rounding. All terms of a row are therefore taken at the middle of x*_n and x*_{n+1}: the kinetic
// energy of their difference, contact_normal as the mean of both, contact_stick as F_n F_{n+1}/(2 k), works
// by the trapezoid plus the half step that is still open. Adding KE(t_n) to U(x*) would mix two times (1 -
// af) dt apart. The row at t = 0 is taken from x_0, v_0.
//
// contact_normal is the true potential of the contact pressure, (k_n/2) int_S (d_A + d_B) dA, not an
// accumulated work: the residual shows what the time steps made of it, O(dt^2), plus the offset of O(dt^2)
// between t_n and the middle. The leapfrog of a linear spring keeps k d_n d_{n+1}/2, and the mean of both
// energies is larger by k (d_{n+1} - d_n)^2/4 = (sqrt U_{n+1} - sqrt U_n)^2/2: the row's `excess`, by which
// the residual is too large while contacts close or open. friction_loss is the work against friction
// and bonds that is not stored in stick springs and bonds: what a broken bond held is in it. Bolts enter like
// contact pressure, by their potential (support) and by what yielding and rupture have taken (support_loss),
// as the means of both trial configurations.

#include "gcpdda/io/run_summary.hpp"
#include "simulation/run_state.hpp"

#include <array>
#include <vector>

namespace gcpdda {

class EnergyLedger {
public:
  /// Energies of the initial state. Collective.
  explicit EnergyLedger(RunState &run);
  /// Of a run that goes on: what the first one found.
  explicit EnergyLedger(const RunFacts &facts)
      : total_at_start_(facts.total_at_start), stick_at_start_(facts.stick_at_start),
        time_step_(facts.time_step) {
    const auto middle = facts.ledger.begin() + std::ssize(facts.ledger) / 2;
    before_.assign(facts.ledger.begin(), middle);
    at_end_.assign(middle, facts.ledger.end());
  }

  /// A stage has ended. Collective.
  void note_end(RunState &run);
  /// The state has been changed at once since: what was lost and worked so far stays, and the residual goes
  /// on from where it was. Collective.
  void step_over(RunState &run);
  /// Into what a checkpoint holds.
  void tell(RunFacts &facts) const;

  /// The row of the current state, which stays as it is. Collective.
  [[nodiscard]] EnergyRow row(RunState &run) const;

private:
  double total_at_start_ = 0.0;
  double stick_at_start_ = 0.0;
  double time_step_ = 0.0; ///< of the stage at hand, s
  /// Columns that go on through such changes.
  static constexpr std::array<double EnergyRow::*, 6> carried{
      &EnergyRow::gravity,       &EnergyRow::friction_loss, &EnergyRow::damping_loss,
      &EnergyRow::boundary_work, &EnergyRow::support_loss,  &EnergyRow::residual};
  std::vector<double> before_; ///< what these leave out since then; empty before the first change
  std::vector<double> at_end_; ///< of the last stage that has ended
};

} // namespace gcpdda
