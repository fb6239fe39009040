#pragma once

// Tells whether the time step changes the energy of impacts.
//
// A contact that closes between two trial configurations acts too late. Let a face with spring k and reduced
// mass m approach at v, and let it be a share s of a step deep when it is first seen. In contact the leapfrog
// keeps m v^2/2 + k d_n d_{n+1}/2, in flight m v^2/2, so the impact begins with m v^2/2 (1 - W^2 s (1 - s)),
// W = dt sqrt(k/m), and ends with
//     E/E_0 = (1 - W^2 s (1 - s))/(1 - W^2 s' (1 - s')),
// s' the same share where the faces part: it gains or loses up to W^2/4 whatever its speed, by chance. A
// corner closes softly (its force grows as d^2) and changes less. Contact damping takes energy beside that
// and does not undo it. The speed of approach therefore predicts nothing before the run; the energies of the
// run show it.
//
// The watch looks at rows of the energy ledger. Their residual is the energy that no force accounts for. In
// the middle of an impact it is uncertain: the mean in contact_normal adds at least `excess`, and at most
// (1/4) dt^2 v K v <= (W_max^2/2) kinetic, and at most itself. Between two rows the change is certain as far
// as these bounds allow. It is measured against the energy of the impacts between the rows: what damping
// took, and by what they have done to the velocities
//     sum over the blocks of (mass |change of velocity|^2 + inertia (change of spin)^2)/8.
// An elastic impact of two blocks with reduced mass m turns v into -v, and the sum over both is m v^2/2; one
// with a coefficient of restitution e gives (1 + e)^2/4 of it, and 1 - e^2 is damped, 1 to 1.33 together. Of
// rows within an impact the roots of these sums are added.
// What an impact loses as it begins it may gain as it ends: rows in the middle of one are passed over, they
// show themselves by their bounds, and a change is told when the next row confirms it.
//
// How much energy is worth telling is known when a stage ends: a record, a ramp or a fall begins with motion
// that is dust beside what follows. The watch keeps its findings until then, and drops those whose energy is
// a small share of the largest kinetic energy that the run has had since.
//
// Rows between which no blocks have touched are passed over: whatever has changed their energy, such as the
// vibration of a deformable block on a fixed point, is no impact.
//
// Nothing is done in a step. What is remembered is a velocity per block; it is neither migrated nor in a
// checkpoint: the results do not depend on it.

#include "gcpdda/io/run_summary.hpp"
#include "simulation/simulation.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace gcpdda {

/// Energy that impacts between two rows gained by the time step.
struct ImpactGain {
  double begin = 0.0;  ///< time of the row before, s
  double end = 0.0;    ///< s
  double gained = 0.0; ///< J/m, negative where it was lost
  double energy = 0.0; ///< of the impacts in between, J/m
};

class ImpactWatch {
public:
  /// Changes of more than this share of the energy of the impacts are reported.
  static constexpr double worth_telling = 0.01;

  /// Compare a row of the current state with the rows before. Collective.
  void look(const Simulation &simulation, const EnergyRow &row);
  /// The first change worth telling of all rows so far; nothing after it has been told once. To be asked for
  /// when a stage or the run ends.
  std::optional<ImpactGain> conclude();
  /// The state has been changed at once: the next look starts anew.
  void forget() { has_reference_ = false; }
  /// There is no row to compare the next one with, and the present state can give one.
  [[nodiscard]] bool lacks_reference(const Simulation &simulation) const {
    return !has_told_ && !has_reference_ && sees(simulation);
  }

private:
  static bool sees(const Simulation &simulation);
  struct Seen {
    BlockId id;
    RigidDof velocity;
  };
  /// The residual without what the mean in contact_normal adds lies in between, J/m.
  struct Residual {
    double low = 0.0;
    double high = 0.0;
  };
  void note(const Simulation &simulation, const EnergyRow &row);
  void keep(const ImpactGain &found);
  void drop_dust();
  void begin_at(const Simulation &simulation, Residual residual);
  [[nodiscard]] double turned_since_last_look(const Simulation &simulation) const;
  [[nodiscard]] bool nothing_has_touched(const Simulation &simulation) const;

  bool has_reference_ = false;
  bool has_told_ = false;
  bool is_suspected_ = false; ///< by the look before
  int waits_ = 0;             ///< looks since the reference that were not sharp
  double most_kinetic_ = 0.0;
  double time_ = 0.0;              ///< of the reference
  std::int64_t contact_steps_ = 0; ///< of the reference, Counters::contact_steps of this rank
  Residual residual_;
  double root_ = 0.0;   ///< of the energy that impacts since the reference have turned round
  double damped_ = 0.0; ///< since the reference, J/m
  // Of the last look.
  double damping_loss_ = 0.0;
  std::vector<Seen> seen_; ///< owned blocks, by ascending id
  /// Changes so far, each of at least twice the energy of the one before. The front is the first one that is
  /// no dust: what is dust later is dropped from there.
  std::vector<ImpactGain> findings_;
};

/// What to tell of it, with a step that keeps the change below worth_telling.
Diagnostic warning_of(const Simulation &simulation, const ImpactGain &gain);

} // namespace gcpdda
