#pragma once

// Equilibrium of blocks as the rest of a damped motion in pseudo-time.
//
// Blocks with the forces f(x) move without friction of their own in a pseudo-time whose step is 1, with the
// stiffness of their contacts as mass,
//     (K + rho D) x'' + c (K + rho D) x' = f(x).
// K is near the true stiffness, so that all motions have frequencies near 1, however large the pile: the wave
// that carries a load through the layers of a pile under its true mass, and takes a step for each of them,
// is gone. rho D is a share of the stiffness that a block could have; it moves what nothing touches. In
// central differences, with v the motion of a step and q = (K + rho D) v its momentum,
//     v = a v + b (K + rho D)^-1 f,   q = a q + b f,   x = x + v,   a = (2 - c)/(2 + c),   b = 2/(2 + c).
// The slowest motion of a pile of L layers is a wave of a quarter of its length in it, for which K is about
// (pi/2L)^2 D: it keeps a frequency near 1 as long as rho is no more than that, about 2.5/N for N blocks. A
// block that nothing touches wants rho large, or it flies. Between the two, by runs of 2,000 to 100,000
// blocks,
//     rho = 5e-4 min(1, (2000/N)^(1/2)).
//
// Once all of the load acts damping follows the frequency of the motion that goes on, c = c_share 2 w (1 is
// critical damping of that motion), with Rayleigh's quotient of the step behind,
//     w^2 = v.(f_before - f)/(v.q),   cut to [0, 3.9], where central differences are stable.
// f_before is f at the beginning of the step under the loads that it ended with. q is summed along, so that
// no product is needed for it. Where f.v < 0 the motion has passed its rest: it begins anew, v = q = 0. The
// first step from rest takes b = 1/2: a whole one would be Newton's, which runs away where the true stiffness
// is more than twice K. In it regions that slip have all of k_t, since they may turn (springs.hpp).
//
// Near a limit the slowest motion is a slide. Of the regions that slip K has a small share (springs.hpp), the
// forces hardly change with it, and w and c ought to go to zero. Then nothing damps the few blocks elsewhere
// that are hit or stick again, and their swings, in the same sums, keep w^2 at 0.003 to 0.5 and stop the pile
// again and again: a slope of 10,883 blocks 1 % below its limit had come half of its way after 1,500
// evaluations. Motions that strain what does not slip are therefore damped for themselves. K' is K without
// the tangential springs of regions that slip and without rho D, blocks' own springs included, and
//     (K + rho D) x'' + c (K + rho D) x' + g K' x' = f(x),   g = (1 - c)(1 - s)   where c < 1,
// one product an evaluation, in place of f:
//     v = a v + b (K + rho D)^-1 (f - g K' v).
// A motion without slip has K' = K. With c and s small nothing is left of its v, and it takes Newton's steps;
// with c = 1 it is damped critically by the first term alone. A slide has K' v = 0 and is damped by c alone,
// which now follows its own w. Steps of strains are stable up to a true stiffness of 4 - 2 (1 - c) times K.
// s = v.K' v/(v.q) says which of the two goes on: 0.02 to 0.05 near the limit of a slope, 0.97 where a wedge
// between two joints is strained and slips on both. Its friction follows the strain, the forces hardly
// change, w^2 is 0.004, and with g = 1 - c the unbalanced ratio fell by a 250th at each evaluation: 1,007 of
// them in place of 280 for a tunnel with bolts. While loads come in joints close that K does not have yet,
// many times as stiff: there the term is left out. (With it such joints close by more than half of a block.)
//
// Loads come in increments. What is out of balance when a stage begins, f_0, is held by an opposite force and
// let go in `increments` parts, one an evaluation: f = f(x) - (1 - s) f_0 with s from 0 to 1. It is all that
// the stage has changed (weight, excavated rock, strength, water, stress), whatever that was. Blocks follow
// the load near equilibrium, and friction takes the path of slow loading. The increments are small where
// joints that carry nothing yet close, and fall to nothing at the end, so that the motion neither lags nor
// runs past the equilibrium under all of the load: after the share u of them
//     s = 2 u^2 - u^4.
// (Ramps that begin or end faster lead 40 random rock masses farther from slow loading, in as many
// evaluations.)
//
// While the load grows c is the same for all motions, c_load. One that follows the load steadily has
// f = c (K + rho D) v and is c/w^2 evaluations behind its equilibrium: regions that slip lag by most, and
// slip under other forces than in slow loading, which asks for a small c. With c = c_share 2 w, however, what
// slides is hardly held, runs past the place where it would rest and may fail: of 72 trials of a wet slope
// 0.2 to 1 % below its limit, which differ in factor and last bits, 4 with c_share = 0.7 and 11 with 0.4,
// none with c_load = 0.7. The equilibria of 60 random rock masses and of three slopes are nearer to slow
// loading with it than with c_share = 0.7, and about as near as with 0.4. (A force of c times the mean
// momentum of some evaluations, against the lag, leads four times as far away: blocks run past equilibrium.)
//
// A block that nothing touches falls, under a force that does not change. It has no frequency, and in the
// sums over v would say that nothing needs damping: they leave it out. Where it lands, it begins anew by
// itself, with b = 1/2, and is left out once more, so that a pebble does not stop the pile.
//
// The coarse matrix is made anew at every `coarse_every`th evaluation, and at each of the first ones: joints
// that begin open close in them, and with a matrix that has not seen their springs a solution takes 66 to 200
// products in place of 10.
//
// The step of a block is at most `steps_of_overlap` of the largest overlap, the length by which contacts
// carry what they carry, and at most `step_of_width` of its narrowest width: a block that has lost its
// contacts neither flies through its neighbours nor hits them deeper than a joint may close.
//
// Once all of the load acts, all blocks move in `all_move` of `window` evaluations (in `all_move_near_rest`
// where the unbalanced ratio is near the tolerance), and in the others those far from balance with what
// surrounds them, and those too fast to be stopped (far_rows.hpp). The others stay where they are, without
// velocity: contacts and springs of two of them are as they were, to the same bits, and their rows are left
// out of the solution with K. Forces on them are known at each evaluation, and which blocks move is asked
// anew each time that the coarse matrix is made. All equations above are those of the blocks that move; the
// quotient of a step is found from those that took it.
//
// An evaluation of all costs three of the few. Where a slope slides to its rest or fails, 5 of 30 take about
// as many evaluations as 10 of 30 and a tenth less time each (trials of gcpdda fos with 100,290 blocks);
// where joints close under the weight they take a third more. Near rest a verdict asks for what 5 evaluations
// after a pause do not show: a slope of 100,290 blocks 1 % below its limit, with a few blocks out of balance,
// had no verdict after 1,800 of them.

#include "statics/far_rows.hpp"
#include "statics/iteration_state.hpp"
#include "statics/stiffness_solver.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace gcpdda::statics {

struct IterationRules {
  double mass_share = 5e-4;             ///< rho
  double damping_share = 0.5;           ///< c_share once all of the load acts
  double damping_under_load = 0.7;      ///< c_load
  std::int64_t increments = 50;         ///< of the load
  std::int64_t coarse_every = 5;        ///< evaluations between two coarse matrices, once there were so many
  double steps_of_overlap = 10.0;       ///< largest step of a block
  double step_of_width = 0.05;          ///< largest step of a block over its narrowest width
  std::int64_t stall_window = 300;      ///< evaluations in which the least ratio has to fall by half
  std::int64_t window = 30;             ///< evaluations from one time that all blocks move to the next
  std::int64_t all_move = 10;           ///< of these, ...
  std::int64_t all_move_in_trial = 5;   ///< ... in a trial of gcpdda fos, ...
  std::int64_t all_move_near_rest = 10; ///< ... and near rest
  std::int64_t short_run = 6;           ///< evaluations from a new beginning to the next one ...
  std::int64_t most_short_runs = 9;     ///< ... and how many in a row are no swing for ever
  FarRules far;
  SpringRules springs;
};

/// rho of a model of so many mobile blocks.
double mass_share(std::int64_t num_blocks);

/// F of a deformable block after a step v of its six freedoms, of which the last four are dF F^-1 to first
/// order: R(w) (I + E) F, with w and E the antisymmetric and the symmetric part. A step that turns leaves the
/// strain as it was, while (I + v) F would stretch the block by w^2/2.
Mat2 gradient_after(const Mat2 &gradient, const std::array<double, 6> &v);

class PseudoTime {
public:
  PseudoTime(const Communicator &communicator, const IterationRules &rules)
      : rules_(rules), communicator_(communicator), far_(communicator, rules.far), solver_(communicator) {}

  [[nodiscard]] const IterationRules &rules() const { return rules_; }
  [[nodiscard]] IterationRules &rules() { return rules_; }
  [[nodiscard]] ContactSprings &springs() { return springs_; }
  [[nodiscard]] const ContactSprings &springs() const { return springs_; }
  /// Share of the load that acts after so many evaluations.
  [[nodiscard]] double load_share(std::int64_t evaluations) const {
    const double share = static_cast<double>(evaluations) / static_cast<double>(rules_.increments);
    return share < 1.0 ? share * share * (2.0 - share * share) : 1.0;
  }
  /// The next evaluation needs nothing of those before but what a checkpoint holds.
  [[nodiscard]] bool may_pause(const IterationState &state) const {
    return state.evaluations % rules_.coarse_every == 0;
  }

  /// Rows have been found anew. Collective.
  /// @param stiffness  of the joints of each owned row
  /// @param any_deformable  on any rank
  void lay(BlockSystem &system, std::span<const StiffnessBound> stiffness, bool any_deformable,
           std::vector<BorderRows> border);
  /// What this rank has sent to others, but for reductions.
  [[nodiscard]] const BorderExchange::Sent &sent() const { return solver_.sent(); }
  /// Owned rows that the next step moves; the others have no velocity.
  [[nodiscard]] std::span<const RowRun> moving() const { return moving_; }
  /// Some blocks stay where they are while others move.
  [[nodiscard]] bool is_local() const { return is_local_; }
  /// What is out of balance is held from here on. The forces are those of the last evaluation.
  void hold(BlockSystem &system);
  /// From the forces of an evaluation to the motion of the next step, in PseudoMotion::velocity. Collective.
  /// @param overlap  largest one of this rank, m
  /// @param balanced  N/m: what may be left on a block that is balanced
  /// @param is_near_rest  the largest force that is left is not much more than a verdict asks for
  void find_motion(BlockSystem &system, const Candidates &candidates, const ContactHistory &history,
                   const ContactForces &contacts, double overlap, double balanced, bool is_near_rest,
                   IterationState &state);
  /// Owned rows move by it. Their trial configurations and states are the same afterwards, and at rest.
  void move(BlockSystem &system) const;
  /// The next step takes back the last one.
  void turn_back(BlockSystem &system) const;

private:
  /// What touches a row, as far as damping is concerned.
  enum class Standing : std::uint8_t {
    touched, ///< for two evaluations at least
    lands,   ///< nothing did at the evaluation before
    free
  };
  /// From the springs that are closed. Rows that land are stopped.
  void find_standing(BlockSystem &system);
  /// Which blocks move from here on, where that is asked. Collective.
  /// @return others than before may
  [[nodiscard]] bool choose_rows(BlockSystem &system, double balanced, bool is_near_rest,
                                 const IterationState &state);
  /// Blocks that rest stay where they are, on all ranks. Collective.
  void keep_resting(BlockSystem &system);
  /// Takes note of where the motion begins anew.
  /// @return it has done so again and again after a few evaluations
  [[nodiscard]] bool swings(bool begins, IterationState &state) const;
  /// Unbalanced forces when this share of the load acts.
  void gather(const BlockSystem &system, double share);
  /// v.f. Collective.
  [[nodiscard]] double power(const BlockSystem &system) const;
  [[nodiscard]] double longest_step(double overlap, IterationState &state) const;
  /// v = a v + b g, q = a q + b f, within the largest step. Collective.
  void advance(BlockSystem &system, double a, double b, double limit, IterationState &state);

  IterationRules rules_;
  Communicator communicator_;
  FarRows far_;
  StiffnessSolver solver_;
  ContactSprings springs_;
  std::size_t width_ = 3;
  bool is_local_ = false;
  std::vector<RowRun> moving_;
  std::vector<Standing> stands_; ///< by row
  Field force_;
  Field driving_; ///< the same without what damps strains
  Field direction_;
};

} // namespace gcpdda::statics
