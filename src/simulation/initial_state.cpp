// The consistent initial state of a Simulation.

#include "contact/laws/bonds.hpp"
#include "contact/laws/initial_friction.hpp"
#include "simulation/simulation.hpp"

#include <fmt/format.h>

namespace gcpdda {

// The blocks of a bond must stay candidates until it breaks.
void Simulation::check_bonds() {
  for (const JointLaw &law : scene_.joints.laws) {
    const double opening = law.tension / law.normal_stiffness;
    if (law.has_bonds && opening > 0.5 * base_skin_) {
      notes_.push_back(
          {Severity::error,
           {},
           fmt::format("bonds of [joint.{}] open by {:.3g} m before they break", law.name, opening),
           fmt::format("that is tension/normal_stiffness, and blocks are looked for within {:.3g} m",
                       0.5 * base_skin_),
           "raise normal_stiffness or lower tension"});
    }
  }
}

void Simulation::accelerate_owned() {
  sum_forces();
  prepare_forces();
  blocks_.body = {gravity(), ground_acceleration()};
  gather_forces(0, blocks_.num_owned, blocks_.body);
  accelerate(blocks_);
  prescribe_motion();
}

// a_0 = M^-1 F(0): constant acceleration is then exact from the first step.
void Simulation::find_initial_state() {
  check_bonds(); // told with the other faults of the initial state
  bond_joints(blocks_, candidates_, contacts_.parameters().joints, in_situ_overlap_, history_);
  take(contacts_.evaluate(blocks_, candidates_, history_)); // ghosts are whole copies yet
  evaluate_bolts();
  check_initial_overlaps();
  explain_slivers();
  if (scene_.run.initial_friction == InitialFriction::consistent && !scene_.in_situ.present) {
    find_initial_friction();
  } else {
    if (scene_.in_situ.present) {
      put_initial_shear();
    }
    accelerate_owned();
  }
  progress_.report.rows_to_check = {{0, blocks_.num_owned}};
  report();
  counters_.evaluations = 0; // these are of steps
  counters_.block_steps = 0;
  counters_.contact_steps = 0;
  counters_.messages = 0;
  counters_.bytes = 0;
}

void Simulation::find_initial_friction() {
  InitialStick stick(blocks_, candidates_, contacts_, history_);
  ghosts_.copy(stick.contact_counts());
  const auto sweep = [&] {
    ghosts_.copy_accelerations(blocks_);
    double residual = stick.sweep();
    communicator_.max(std::span(&residual, 1));
    accelerate_owned();
    return residual;
  };
  constexpr int num_sweeps = 50;
  accelerate_owned();
  const double before = sweep();
  double after = before;
  for (int done = 1; done <= num_sweeps && after > 0.0; ++done) {
    after = sweep();
  }
  if (before > 0.0 && !(after < before)) {
    stick.reset();
    accelerate_owned();
    notes_.push_back(
        {Severity::info,
         {},
         "friction starts at zero",
         fmt::format("{} sweeps did not bring the initial stick forces nearer to equilibrium", num_sweeps),
         ""});
  }
}

} // namespace gcpdda
