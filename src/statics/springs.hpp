#pragma once

// The stiffness of contacts, as springs between blocks.
//
// A region of length l along t_r with the normal n = n_r carries a pressure k_n d over its length. Where its
// blocks move by small u + H a (field.hpp), the pressure changes by k_n n.[...] along the region, [...] being
// the difference of both motions, and its stick spring by k_t t.[...]. With x_m the middle of the region, a =
// x_m - x_c the arms of the two blocks A and B, and s the place along t from x_m,
//     e_n = n.(u_A + H_A a_A - u_B - H_B a_B),   e_r = n.(H_A - H_B) t,   e_t = t.(the same difference),
//     int k_n (e_n + s e_r)^2 ds + k_t (e_t + s_g e_s)^2 = k_n l e_n^2 + (k_n l^3/12) e_r^2 + k_t (...)^2:
// three springs with one set of constants (`ContactSpring`). Friction acts at the grip of the region
// (contact/laws/grip.hpp), s_g from x_m, and e_s = t.(H_A - H_B) t is how far the strains of the blocks
// differ along t. Where a joint gapes the grip is up to half of its length from the middle of what is closed:
// with friction in the middle, K has as little as a quarter of the true stiffness of soft blocks between
// stiff joints, and the iteration swings for ever. Two rigid blocks see e_r = -(r_A - r_B), e_s = 0 and the
// levers a x n and a x t. Left out is what the turning of n adds, of the order of
// the force over the length, against k_n times the length: the share by which the joint is closed.
//
// K need not be the tangent of the force. It is the mass of a motion in pseudo-time (pseudo_time.hpp), which
// is stable as long as the true stiffness is below four times K along each motion and quick where it is near
// K. Five rules keep it so.
// - A region whose shear is at its cap has no tangential stiffness. It keeps `slip_share` of k_t here: with
//   none its blocks would run as far as their mass lets them. A mechanism near its limit slides on with a
//   force that hardly changes, held back by these springs alone. Where a region has slipped to one side for
//   `slide_memory` evaluations its share therefore fades, by `slide_fade` at each further one, to
//   `slide_floor` of it. (With a tenth, walls that rock near their limit stall.) Where it goes on to that
//   side for `long_slide` evaluations the share fades further, by `long_slide_fade` to `long_slide_floor`:
//   what rocks has turned by then. (A few blocks of a bench that slide to their rest just below the limit of
//   a slope of 10,883 see a stiffness of 1e-4 of K with the first floor, and its trials took 620 to 1,500
//   evaluations, without an order in the factor; with the second one 390 to 550. They rest where they did, by
//   the scatter of last bits.)
// - Where slip has turned from one cap to the other the region sticks on the way with all of k_t, many
//   times what the first rule gives it, and would swing between its caps for ever. It keeps all of k_t for
//   the next `turn_memory` evaluations.
// - A region that opens keeps its springs, weaker by `fade` at each evaluation, for `open_memory` of them: a
//   block that has lost its contact is braked by them, and speeds up only as fast as they fade. One that gets
//   shorter, or closes again at a corner, is not weaker than that either: with the springs of a sliver alone
//   its blocks would run into each other by the whole width of the joint.
// - Where a motion begins anew (pseudo_time.hpp) it may go either way. A region that slips would stick if it
//   turned, and all regions keep all of k_t for that step (`hold_slip`). Where it has begun anew within
//   `short_run` evaluations ten times in a row they keep it until it goes on for longer: a region that
//   slips, is driven back with all of k_t and slips again to the same side has not turned, and with its small
//   share a slope of 95 blocks swung with a period of four evaluations for ever (182 with this rule).
// - Slip of a region that dilates opens its joint (contact/laws/dilation.hpp): with the slip x along t and
// the
//   opening y along n of its blocks N = k_n l (tan(psi) x - y), and friction is tan(phi) N. The stiffness of
//   both together is k_n l m p^T with m = n - tan(phi) t and p = n - tan(psi) t. The normal spring therefore
//   acts along p. With any spring a of the slip K is k_n l p p^T + a t t^T, and K^-1 times that stiffness has
//   the eigenvalue 1. With a spring along n it has 1 + k_n l tan(phi) tan(psi)/a, 2.4 for psi = 2 degrees at
//   the first floor of a and 15 at the second, and blocks that ride up on their joints, which nothing holds
//   back, would count as strained. (Trials of a slope of 278 blocks with psi = 2 degrees swung on and left
//   their verdicts to 13,000 to 43,000 steps of motion; they take 500 to 1,150 evaluations.)
// While loads come in friction takes the path of slow loading: no share fades, and a turn is remembered for
// half as long, since a region that keeps all of k_t lags behind the load (`under_load`). A kept spring also
// ends when its blocks are farther apart than `reach`, which both ranks of a border pair know from exact
// copies.
//
// Bolts and elements of liners are springs of the same kind (`links`), which are found anew at each
// evaluation. What of them flows has the share of a region that slips, which does not fade.
//
// Springs of two blocks that rest while others move (`set_moving`) stay as they are, in a list of their own:
// an update passes over those at work alone.
//
// The list ascends by pair as Candidates::pairs do, so that a block adds its springs in the order of its
// partners' ids and gets the same bits on any number of ranks.

#include "base/ids.hpp"
#include "contact/contact_forces.hpp"
#include "statics/field.hpp"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace gcpdda::statics {

/// Springs of one region.
struct ContactSpring {
  std::uint32_t lower = 0; ///< rows
  std::uint32_t higher = 0;
  Vec2 normal;
  Vec2 lower_arm; ///< of the middle of the region from the centroids
  Vec2 higher_arm;
  double normal_stiffness = 0.0; ///< k_n l, Pa
  double bending = 0.0;          ///< k_n l^3/12, N
  double tangential = 0.0;       ///< Pa
  double grip = 0.0;             ///< where it acts along t from the middle, m
  double sticking = 0.0;         ///< the tangential one if the region stuck, Pa
};

/// What is remembered of a region from one evaluation to the next.
struct SpringMemory {
  BlockId lower;
  BlockId higher;
  std::int8_t side = 0;      ///< sign of the shear when the region slipped last; 0: never
  std::uint8_t turned = 0;   ///< evaluations for which it keeps all of k_t
  std::uint8_t open_for = 0; ///< evaluations since it has opened; 0: it is closed
  std::uint8_t slid_for = 0; ///< evaluations in a row that it has slipped to one side; 255: or more
};

/// A spring that travels: its rows are found where it arrives.
struct SpringRecord {
  ContactSpring spring;
  SpringMemory memory;
};

struct SpringRules {
  double slip_share = 0.06;
  std::uint8_t slide_memory = 10;
  double slide_fade = 0.9;
  double slide_floor = 0.3;
  std::uint8_t long_slide = 60;
  double long_slide_fade = 0.95;
  double long_slide_floor = 0.03;
  bool slides_fade = true;
  std::uint8_t turn_memory = 20;
  double fade = 0.8;
  std::uint8_t open_memory = 40;
  double reach = 0.0; ///< m
};

/// Rules for as long as loads come in.
SpringRules under_load(SpringRules rules);

class ContactSprings {
public:
  /// Springs of all regions of the last evaluation at a row that moves, and those that are kept. The
  /// arguments are those of the evaluation, which has kept its details.
  void update(const BlockSystem &system, const Candidates &candidates, const ContactHistory &history,
              const ContactForces &contacts, const SpringRules &rules);

  /// Of contacts at a row that moves.
  [[nodiscard]] std::span<const ContactSpring> springs() const { return at_work_.springs; }
  [[nodiscard]] std::span<const SpringMemory> memories() const { return at_work_.memories; }
  /// Springs of links, from here on, in an order that every rank knows.
  void set_links(std::vector<ContactSpring> links) { links_ = std::move(links); }
  /// Call f with each list of springs: of contacts those at a row that moves, then all links.
  template <class F> void for_lists(F &&f) const {
    f(springs());
    f(std::span<const ContactSpring>(links_));
  }
  /// Regions that slip, and links that flow, have all of their stiffness up to the next update.
  void hold_slip();
  /// Which rows move from here on.
  /// @param moves  by row; empty: all do
  void set_moving(std::vector<std::uint8_t> moves);

  /// All springs, for a neighbourhood that is made anew.
  [[nodiscard]] std::vector<SpringRecord> records() const;
  /// Springs of these records between rows of the system; others are dropped, and doubles.
  void take(const BlockSystem &system, std::vector<SpringRecord> records);
  void clear();

private:
  /// Springs with their memories, which ascend by pair.
  struct List {
    std::vector<ContactSpring> springs;
    std::vector<SpringMemory> memories;

    void clear();
    void push_back(const ContactSpring &spring, const SpringMemory &memory);
  };

  [[nodiscard]] bool both_rest(std::size_t lower, std::size_t higher) const {
    return moves_[lower] == 0 && moves_[higher] == 0;
  }
  /// Call f(spring, memory) for all springs, those at rest among them, in order.
  template <class F> void for_all(F &&f) const;
  /// Call f(number) for each candidate with a row that moves.
  template <class F> void for_pairs_at_work(const Candidates &candidates, F &&f);
  void keep_open(const BlockSystem &system, std::size_t number, const SpringRules &rules);

  List at_work_; ///< at a row that moves
  List next_;    ///< what they become in an update
  std::vector<ContactSpring> links_;
  std::vector<std::uint8_t> moves_; ///< by row; empty: all do
  // While some rows rest.
  List before_;                              ///< all springs when that was set
  bool are_held_ = false;                    ///< hold_slip() has been called since
  std::vector<std::uint32_t> pairs_at_work_; ///< of the candidates at hand; none: not found yet
};

} // namespace gcpdda::statics
