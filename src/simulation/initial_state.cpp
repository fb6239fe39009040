#include "simulation/initial_state.hpp"

#include "contact/laws/bonds.hpp"
#include "contact/laws/initial_friction.hpp"
#include "simulation/doubts.hpp"
#include "simulation/evaluation.hpp"
#include "simulation/in_situ_state.hpp"
#include "simulation/initial_overlaps.hpp"
#include "simulation/static_stage.hpp"
#include "simulation/step_report.hpp"
#include "simulation/step_rows.hpp"

#include <fmt/format.h>

namespace gcpdda {

namespace {

// The blocks of a bond must stay candidates until it breaks.
void check_bonds(RunState &run) {
  for (const JointLaw &law : run.scene.joints.laws) {
    const double opening = law.tension / law.normal_stiffness;
    if (law.has_bonds && opening > 0.5 * run.neighbours.base_skin) {
      run.notes.push_back(
          {Severity::error,
           {},
           fmt::format("bonds of [joint.{}] open by {:.3g} m before they break", law.name, opening),
           fmt::format("that is tension/normal_stiffness, and blocks are looked for within {:.3g} m",
                       0.5 * run.neighbours.base_skin),
           "raise normal_stiffness or lower tension"});
    }
  }
}

void find_initial_friction(RunState &run) {
  InitialStick stick(run.blocks, run.neighbours.candidates, run.contacts, run.neighbours.history,
                     !is_static(run));
  run.neighbours.ghosts.copy(stick.contact_counts());
  const auto sweep = [&] {
    run.neighbours.ghosts.copy_accelerations(run.blocks);
    double residual = stick.sweep();
    run.communicator.max(std::span(&residual, 1));
    accelerate_owned(run);
    return residual;
  };
  constexpr int num_sweeps = 50;
  accelerate_owned(run);
  const double before = sweep();
  double after = before;
  for (int done = 1; done <= num_sweeps && after > 0.0; ++done) {
    after = sweep();
  }
  if (before > 0.0 && !(after < before)) {
    stick.reset();
    accelerate_owned(run);
    run.notes.push_back(
        {Severity::info,
         {},
         "friction starts at zero",
         fmt::format("{} sweeps did not bring the initial stick forces nearer to equilibrium", num_sweeps),
         ""});
  }
}

} // namespace

// a_0 = M^-1 F(0): constant acceleration is then exact from the first step.
void find_initial_state(RunState &run) {
  check_bonds(run); // told with the other faults of the initial state
  bond_joints(run.blocks, run.neighbours.candidates, run.contacts.parameters().joints, run.in_situ_overlap,
              run.neighbours.history);
  evaluate_all(run);
  check_initial_overlaps(run);
  explain_slivers(run);
  if (run.scene.run.initial_friction == InitialFriction::consistent && !run.scene.in_situ.present) {
    find_initial_friction(run);
  } else {
    if (run.scene.in_situ.present) {
      put_initial_shear(run);
    }
    accelerate_owned(run);
  }
  AdvanceReport all;
  all.rows_to_check = {{0, run.blocks.num_owned}};
  report_step(run, all);
  run.counters.evaluations = 0; // these are of steps
  run.counters.block_steps = 0;
  run.counters.contact_steps = 0;
  run.counters.messages = 0;
  run.counters.bytes = 0;
  run.first_reduction = run.communicator.reductions();
}

} // namespace gcpdda
