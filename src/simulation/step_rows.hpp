#pragma once

// How owned rows go through a step: each is predicted, loaded and advanced while the cache holds it.
//
// Pairs are evaluated by groups in the order of their blocks' ids (contact/candidates.hpp). Before a group
// only rows below its rows_read need their trial configurations, and after it rows below its rows_finished
// have all their contacts and can be advanced to the end of the step. A few hundred rows lie between the two
// bounds, so that a large model is read from memory once a step instead of three times. Where ids do not
// follow places, all rows are predicted before the first group and advanced after the last one.
//
// A row waits (Candidates::is_added) if it has a pair with a ghost or a general pair; these are evaluated
// last. Where there are bolts all rows wait, because the forces of bolts come after those of all pairs. The
// ghosts on other ranks need the trial configurations of border rows first: they follow from x_n, v_n and a_n
// alone and are sent before the rows themselves are predicted. Each row does the same operations on the same
// numbers whenever it does them, so that the order changes no bit.

#include "dynamics/integrate.hpp"
#include "dynamics/water_pressure.hpp"
#include "simulation/run_state.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace gcpdda {

class StepRows {
public:
  explicit StepRows(RunState &run) : run_(run) {}

  /// Motion that is prescribed, body forces, empty sums.
  void begin();
  void send_border_trials();
  /// Set the trial configurations of owned rows below `end`, which begin a contact evaluation.
  void predict_to(std::size_t end);
  /// Advance owned rows below `end` to the end of the step; rows that wait stay behind.
  void advance_to(std::size_t end);
  void advance_remaining();
  void prescribe_motion();
  [[nodiscard]] const AdvanceReport &report() const { return report_; }

  /// Loads of all rows at the present time, outside of a step.
  void load_all();
  /// The same, and accelerations.
  void accelerate();
  /// Trial configurations of all rows in the next step, ghosts among them, without anything else of it.
  void predict_all();

private:
  struct PrescribedRow {
    std::size_t row;
    RigidDof trial; ///< in the step at hand
    RigidDof increment;
  };

  void find_prescribed_rows();
  void prepare_forces();
  /// Set the trial configurations of owned rows, prescribed ones by their tables.
  void predict_rows(RowSpan rows);
  void advance_rows(std::size_t first, std::size_t end);
  /// @return the first row that is not free
  std::size_t advance_free(std::size_t first, std::size_t end);
  void gather_forces(std::size_t first, std::size_t last, const BodyForces &body);
  AppliedForces gather_block(std::size_t row, const BodyForces &body, const WaterLoad &water);
  void gather_gradient(std::size_t row, const WaterLoad &water);

  RunState &run_;
  OwnForces own_forces_; ///< at the last evaluation
  TrialOutline outline_; ///< of a block in water
  std::vector<PrescribedRow> prescribed_rows_;
  // How far the step has come with the owned rows.
  BodyForces body_;               ///< of this step
  std::size_t predicted_ = 0;     ///< rows below have their trial configurations
  std::size_t advanced_ = 0;      ///< rows below are at the end of the step, except waiting ones
  std::size_t passed_ = 0;        ///< spans of Neighbourhood::waiting below advanced_
  AdvanceReport report_;          ///< of the last step
  double held_force_ = 0.0;       ///< N/m, of this step
  double held_share_ = 0.0;       ///< m/s2
  std::vector<std::size_t> held_; ///< rows that begin it at rest, of those at hand
};

/// Sums of the last evaluation with all loads at the present time, and accelerations by them.
void accelerate_owned(RunState &run);

/// The trial configuration of the next step, which is taken as long as this lives and then given back: what
/// the energy ledger needs. Collective.
class ComingTrial {
public:
  explicit ComingTrial(RunState &run);
  ~ComingTrial();
  ComingTrial(const ComingTrial &) = delete;
  ComingTrial &operator=(const ComingTrial &) = delete;

private:
  BlockSystem &blocks_;
  std::vector<RigidDof> trial_;
  std::vector<Deformation> deformation_;
  std::vector<RigidDof> increments_;
  std::vector<std::array<Vec2, 2>> turns_;
};

} // namespace gcpdda
