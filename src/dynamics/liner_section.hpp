#pragma once

// Strength of a liner: a rectangular section of thickness t and unit width in thrust N, moment M and shear Q.
//
// The material is elastic and perfectly plastic: compressive strength f_c, tensile strength f. With the depth
// x in compression, f t - N = (f_c + f) x, and the plastic moment about the middle of the section is
//     M_p(N) = (f_c + f) x (t - x)/2 = (f t - N)(f_c t + N)/(2 (f_c + f)),       -f_c t <= N <= f t.
//
// f is the tensile strength f_t until an extreme fibre of an element reaches it,
//     N/t + 6 (|M| + |Q| L/2)/t^2 > f_t,
// by the elastic stress at the element's ends. Then the element has cracked, for good, and f is the residual
// strength f_r: what fibres or a mesh bear; 0 of plain shotcrete, which then stands by thrust alone.
//
// Three forces share one section, and each is held by what the ones before it leave: first N, then the
// constant moment M by M_p(N), then Q, whose moments at the ends are Q L/2, by 2 (M_p - |M|)/L. Thrust comes
// first because it alone cannot be taken by the other two.
//
// Q is also the force by which one of the two blocks pulls the liner off. Where the liner turns away from the
// rock by 2 a between an element and the next one, thrust presses it on to the rock with -2 a N, half of it
// beside either joint, as the pressure N/r behind a ring. Where
//     |Q| + a N
// at the block that pulls is beyond adhesion times the width of the bond beside a joint, the liner peels off
// [Barrett and McCreath, Tunn. Undergr. Space Technol. 10 (1995) 79-89, on flat ones]; where |Q| is beyond
// the shear strength times t, the block punches through. Either way the element is broken for good.

#include "gcpdda/model/support.hpp"

#include <array>

namespace gcpdda {

struct LinerSection {
  double thickness = 0.0;                               ///< t, m; 0: not a liner
  double compressive_strength = SupportType::unlimited; ///< Pa, this and the next two
  double tensile_strength = SupportType::unlimited;
  double residual_strength = 0.0;
  double shear_limit = SupportType::unlimited; ///< largest |Q|, N/m
  double bond_limit = SupportType::unlimited;  ///< largest |Q| + a N, N/m
  std::array<double, 2> away{};                ///< a at the block that pulls where Q > 0, where Q < 0; rad
};

/// Of a liner that goes straight on.
LinerSection section_of(const SupportType &support);

/// What an element bears.
struct LinerForces {
  double axial = 0.0;  ///< N, tension positive, N/m
  double shear = 0.0;  ///< Q, N/m
  double moment = 0.0; ///< M, N
};

/// Capacity in bending at a thrust (N/m, tension positive) with a tensile strength (Pa); N.
double plastic_moment(const LinerSection &section, double tensile_strength, double axial);

/// By how much of the bond a block pulls the liner off, N/m.
double pull_on_bond(const LinerSection &section, const LinerForces &forces);

/// An extreme fibre of an element of some length (m) has more than the tensile strength.
bool is_overstretched(const LinerSection &section, double length, const LinerForces &forces);

/// Forces held within the strength, but for the shear that breaks the element.
LinerForces held_forces(const LinerSection &section, bool is_cracked, double length, LinerForces forces);

/// Largest share of the strength in compression, tension, bending and shear, 0 to 1; 1 is yielding, and of
/// tension before the first crack, cracking.
double strength_used(const LinerSection &section, bool is_cracked, double length, const LinerForces &forces);

} // namespace gcpdda
