#pragma once

// The generalized-alpha family (doi:10.1115/1.2900803), one step from (d, v, a) at t_n:
//     d' = d + dt v + dt^2 [(1/2 - b) a + b a'],   v' = v + dt [(1 - g) a + g a']
//     M [(1 - am) a' + am a] = F
// with am = (2r - 1)/(r + 1), af = r/(r + 1), g = 1/2 - am + af, b = (1 - am + af)^2/4, r the spectral radius
// at infinity. Blocks share no unknowns, so contact forces enter explicitly and all depends on WHERE they are
// taken. Every member of the family takes them at a trial configuration
//     x* = x_n + c1 dt v_n + c2 dt^2 a_n.
//
// leapfrog (the default): c1 = 1 - af, c2 = (2r - 1)(1 - r)/(2 (1 + r)^2), the only values for which
//     x*_{n+1} - 2 x*_n + x*_{n-1} = dt^2 M^-1 f(x*_n)     exactly, for any non-linear f.
// With dt = 1 the first difference is x*_{n+1} - x*_n = v_n + P a_n + Q a_{n+1}, P = 1/2 - b + c1 (1 - g) -
// c2, Q = b + c1 g + c2, so the second is Q a_{n+1} + (g + P - Q) a_n + (1 - g - P) a_{n-1}. It equals M^-1 f
// = (1 - am) a_{n+1} + am a_n if and only if P = 1 - g and Q = 1 - am (the middle term then agrees). Their
// sum gives c1 = 3/2 - g - am = 1 - af, and c2 = 1 - am - b - c1 g. So the contact sees a symplectic, neutral
// scheme with limit W = 2, whatever r.
//
// start: x* = x_n, the literal reading of "explicit contact". Energy grows by (1 - af) W^2/2 a step for every
// dt: it is here to be measured, not used.

#include "gcpdda/model/scene.hpp"

namespace gcpdda {

/// Numbers of one member of the family; constant during a run.
struct Scheme {
  double alpha_m = 0.0;
  double alpha_f = 0.0;
  double beta = 0.0;
  double gamma = 0.0;
  double load_time = 0.0;          ///< loads are taken at t_n + load_time dt
  double trial_velocity = 0.0;     ///< c1
  double trial_acceleration = 0.0; ///< c2
};

/// @param spectral_radius  in [0, 1]; used by the two generalized-alpha kinds
/// @param contact_time     used by generalized_alpha
Scheme make_scheme(SchemeKind kind, double spectral_radius, ContactTime contact_time);

/// Shares of the accelerations in the way between two trial configurations,
///     x*_{n+1} - x*_n = dt v_n + dt^2 (old a_n + coming a_{n+1}),
/// P and Q of the derivation above.
struct TrialWay {
  double old = 0.0;
  double coming = 0.0;
};
inline TrialWay trial_way(const Scheme &s) {
  return {0.5 - s.beta + s.trial_velocity * (1.0 - s.gamma) - s.trial_acceleration,
          s.beta + s.trial_velocity * s.gamma + s.trial_acceleration};
}

/// Whether nothing can be taken implicitly: q_{n+1-af} does not depend on q''_{n+1}.
inline bool is_explicit(const Scheme &scheme) {
  return (1.0 - scheme.alpha_f) * scheme.beta == 0.0;
}

/// Where the elastic force is taken indeed: an explicit scheme has no choice.
inline Elasticity elasticity_of(const Scheme &scheme, Elasticity wanted) {
  return is_explicit(scheme) ? Elasticity::explicit_ : wanted;
}

/// Spectral radius of the amplification matrix of one oscillator on a contact spring, W = omega dt, with a
/// dashpot of ratio xi taken at v_n.
double amplification(const Scheme &scheme, double frequency, double damping_ratio);

/// Largest W up to which no smaller W amplifies (growth per step <= 1e-9); 0 if every W does.
///
/// Local damping of share a drives back what moves away with (1 + a) times its force. What swings fastest
/// moves away in every step, and then W grows by sqrt(1 + a) and the dashpot's ratio too: at a = 0.8 a
/// neutral scheme has a limit of 1.49. Deformable blocks do not grow there, but they come to rest below this
/// limit only (local_damping.hpp). (Not a bound for a scheme that takes forces later than leapfrog does:
/// central differences have 1.09.)
double stability_limit(const Scheme &scheme, double damping_ratio, double local_damping = 0.0);

} // namespace gcpdda
