#pragma once

// A spring between two blocks where a bolt crosses the joint between them, or between the two ends of a
// cable, and the element of a liner between two neighbouring blocks of a face.
//
// Its ends are material points A of one block and B of the other, r = x_B - x_A, L = |r| when it was put in.
//   axial   e = |r| - L,  N = T_0 + k_a (e - e_p),  along r, T_0 the pre-tension.
//   shear   (grouted) the bolt is clamped in both blocks: its direction d, a unit vector when it was put in,
//           is convected with each of them, d_A = F_A D_A, d_B = F_B D_B, and with m along d_A + d_B and
//           t = perp(m)
//               s = t . r,  Q = k_s (s - s_p),  along t.
//   bending (liner)  the angle between both convected directions,
//               phi = angle(d_A -> d_B),  M = k_b (phi - phi_p).
// e, s and phi do not change when both blocks move as one, so neither N, Q nor M does; an elastic link has
// the potential N^2/(2 k_a) + Q^2/(2 k_s) + M^2/(2 k_b). The variation of s,
//     ds = t . dr - (m . r)/|d_A + d_B| t . (dF_A D_A + dF_B D_B),
// is that of two forces -Q t at x_B - c d_B and Q t at x_A + c d_A, c = (m . r)/|d_A + d_B|: about the middle
// of the link. These points differ by s t, so the pair has no torque, and all of it holds for rigid and
// deformable blocks alike (material points X_B - c D_B, X_A + c D_A). A long slip turns r, so a grouted bolt
// takes shear as tension too, as it does in rock. That of phi is perp(d).dF D/|d|^2 for B less that for A: a
// couple M on both.
//
// A liner's element is a straight beam that is clamped in both blocks; e, s and phi are all of its modes of
// deformation: stretch, bending with one point of inflexion (the moment Q L/2 at the ends, none in the
// middle), and bending by a constant moment M (dynamics/liner_section.hpp).
//
// Both are elastic and plastic: e_p and s_p grow where N and Q would exceed their capacity. The steel bears
// its yield force. Grout of the length l on the shorter side of the joint bears b l, b its strength per
// metre; with a slip g in the grout, which pulling makes larger, it bears
//     b (l - max(g, 0)),
// because the bar has been drawn out of it by g. The slip of an evaluation is solved for with that decrease,
// so N depends on where the ends are and not on the number of evaluations on the way there. The weaker of
// steel and grout flows, e_p = e_y + g with e_y the flow of the steel. At g = l the bar is out, and the link
// is broken for good. A cable with a free length is slack in compression. Rupture: an elongation of the steel
// e - g + T_0/k_a beyond rupture_strain L breaks it for good. What plastic flow, slip and rupture take is
// counted link by link. A liner yields, cracks and breaks by its section.
//
// Forces are taken at the trial configuration like contact forces. All numbers are per metre of thickness:
// those of a bolt divided by its spacing out of plane.

#include "dynamics/frequency_bound.hpp"
#include "dynamics/liner_section.hpp"
#include "gcpdda/model/support.hpp"
#include "model/block_system.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace gcpdda {

/// Constants of one link, per metre of thickness.
struct LinkLaw {
  double axial_stiffness = 0.0;                  ///< Pa
  double shear_stiffness = 0.0;                  ///< Pa; 0: none
  double axial_yield = SupportType::unlimited;   ///< of the steel
  double bond_capacity = SupportType::unlimited; ///< b l, what the grout bears before it slips
  double bond_strength = 0.0;                    ///< b, Pa; what a metre of slip takes of bond_capacity
  double shear_yield = SupportType::unlimited;
  double pretension = 0.0;
  double rupture = SupportType::unlimited; ///< elongation of the steel, m
  bool slack_in_compression = false;
  double bending_stiffness = 0.0; ///< k_b, N; of a liner, and the next two
  double length = 0.0;            ///< L, m
  LinerSection section;
};

/// Largest forces of a link since it was put in, in the steps of the dynamic solver, N/m.
struct LinkPeaks {
  double tension = -SupportType::unlimited;
  double compression = 0.0;   ///< of a liner
  double moment = 0.0;        ///< at the ends of a liner's element, N
  double shear = 0.0;         ///< absolute value
  double strength_used = 0.0; ///< of a liner

  friend bool operator==(const LinkPeaks &, const LinkPeaks &) = default;
};

struct LinkMemory {
  double axial_slip = 0.0; ///< e_p, m
  double shear_slip = 0.0; ///< s_p, m
  double dissipated = 0.0; ///< J/m
  double axial = 0.0;      ///< N of the last evaluation, tension positive, N/m
  double shear = 0.0;      ///< Q, N/m
  double extension = 0.0;  ///< e, m
  double slide = 0.0;      ///< s, m
  bool yielded = false;
  bool broken = false;
  bool cracked = false;   ///< a liner, this and the next three
  double turn_slip = 0.0; ///< phi_p, rad
  double moment = 0.0;    ///< M, N
  double turn = 0.0;      ///< phi, rad
  // Of the last evaluation, for the static solver.
  bool axial_gives = false; ///< N has flown, or the link is slack
  bool shear_gives = false; ///< Q has flown
  // Parts of e_p of a grouted bolt, m.
  double steel_slip = 0.0; ///< e_y
  double grout_slip = 0.0; ///< g, from where `BoltLink::grout` is measured
  LinkPeaks largest = {};

  friend bool operator==(const LinkMemory &, const LinkMemory &) = default;
};

struct LinkEnd {
  std::int64_t block = -1;
  Vec2 point; ///< X, reference axes, m
  Vec2 along; ///< D, from the block of lower id towards the other one
  /// Half of the angle by which a liner turns away from the rock between this element and the next one, rad.
  double away = 0.0;
};

struct BoltLink {
  std::int32_t bolt = 0;            ///< index into Scene::bolts; -1 of a liner
  std::int32_t liner = -1;          ///< index into Scene::liners; -1 of a bolt
  std::array<LinkEnd, 2> end;       ///< by block id
  bool head_first = true;           ///< end[0] is on the side of the bolt's head, or first on the face
  double length = 0.0;              ///< L, m
  double bond_length = 0.0;         ///< grout on the shorter side when it was put in, m
  std::array<double, 2> overhang{}; ///< from the link's ends to the bolt's: towards the head, the tip, m
  /// From the middle of the link to where the grouted bar ends: towards the head, the tip, m; unlimited
  /// towards a face plate, and of a cable or liner.
  std::array<double, 2> grout{SupportType::unlimited, SupportType::unlimited};
  LinkMemory memory;
};

LinkLaw law_of(const SupportType &support, const BoltLink &link);

/// What a link of a bolt bears along its axis after the slip of its grout, N/m.
double axial_capacity(const LinkLaw &law, const LinkMemory &memory);

/// How a link lies in the trial configuration.
struct LinkPose {
  double extension = 0.0;
  double slide = 0.0;
  double turn = 0.0;
  Vec2 axis;                       ///< along r
  Vec2 tangent;                    ///< t
  std::array<Vec2, 2> shear_point; ///< material points the shear force acts at, reference axes
};

/// @param rows  of the blocks of the link's ends
LinkPose pose_of(const BlockSystem &system, const BoltLink &link, const std::array<std::size_t, 2> &rows);

/// The memory at a new extension, slide and turn.
LinkMemory respond(const LinkLaw &law, LinkMemory memory, double extension, double slide, double turn = 0.0);

/// Of a liner: the largest share of its strength that its forces use, 1 where it is broken.
double strength_used(const LinkLaw &law, const LinkMemory &memory);

/// Its largest forces, those of the last evaluation among them.
LinkPeaks with_last(const LinkLaw &law, const LinkMemory &memory);

/// J/m.
double stored_energy(const LinkLaw &law, const LinkMemory &memory);

/// What a link does to its two blocks: about their trial centroids, and on F.
struct LinkForce {
  std::array<RigidDof, 2> rigid;
  std::array<Mat2, 2> gradient;
};
LinkForce force_of(const BlockSystem &system, const BoltLink &link, const std::array<std::size_t, 2> &rows,
                   const LinkPose &pose, const LinkMemory &memory);

/// Springs that hold a block at least as stiffly as one end of the link does, whichever way the link turns,
/// up to a strain of 1: the stiffness of a tensioned link across itself, N/|r|, is less than k_a. Bending has
/// two springs of k_b/(2 h^2) at the distance h = L/2 before and behind the end.
std::array<PointSpring, 4> springs_of(const LinkLaw &law, const BoltLink &link, std::size_t end);

/// Position of a material point in the trial configuration.
Vec2 trial_position(const BlockSystem &system, std::size_t row, Vec2 point);

} // namespace gcpdda
