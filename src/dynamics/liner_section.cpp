#include "dynamics/liner_section.hpp"

#include <algorithm>
#include <cmath>

namespace gcpdda {

namespace {

double end_moment(double length, const LinerForces &forces) {
  return std::abs(forces.moment) + 0.5 * length * std::abs(forces.shear);
}

double tensile_strength(const LinerSection &section, bool is_cracked) {
  return is_cracked ? section.residual_strength : section.tensile_strength;
}

/// Share of a capacity; of none, of an unlimited one or of a force that is not there: 0.
double share_of(double force, double capacity) {
  return force > 0.0 && capacity > 0.0 ? std::min(1.0, force / capacity) : 0.0;
}

} // namespace

LinerSection section_of(const SupportType &support) {
  return {support.thickness,
          support.compressive_strength,
          support.tensile_strength,
          support.residual_tensile_strength,
          support.shear_strength * support.thickness,
          support.adhesion * support.bond_width,
          {}};
}

double pull_on_bond(const LinerSection &section, const LinerForces &forces) {
  const auto [above, below] = section.away;
  return std::max(forces.shear + above * forces.axial, below * forces.axial - forces.shear);
}

double plastic_moment(const LinerSection &section, double tensile_strength, double axial) {
  const double t = section.thickness;
  const double compressive = section.compressive_strength;
  const double tensile_room = std::max(0.0, tensile_strength * t - axial);
  const double compressive_room = std::max(0.0, compressive * t + axial);
  if (std::isinf(tensile_strength)) {
    return 0.5 * t * compressive_room;
  }
  if (std::isinf(compressive)) {
    return 0.5 * t * tensile_room;
  }
  const double sum = compressive + tensile_strength;
  return 0.5 * tensile_room * compressive_room / sum;
}

bool is_overstretched(const LinerSection &section, double length, const LinerForces &forces) {
  const double t = section.thickness;
  return forces.axial * t + 6.0 * end_moment(length, forces) > section.tensile_strength * t * t;
}

LinerForces held_forces(const LinerSection &section, bool is_cracked, double length, LinerForces forces) {
  const double tensile = tensile_strength(section, is_cracked);
  const double t = section.thickness;
  forces.axial = std::clamp(forces.axial, -section.compressive_strength * t, tensile * t);
  const double capacity = plastic_moment(section, tensile, forces.axial);
  forces.moment = std::clamp(forces.moment, -capacity, capacity);
  const double left = std::isinf(capacity) ? capacity : 2.0 * (capacity - std::abs(forces.moment)) / length;
  forces.shear = std::clamp(forces.shear, -left, left);
  return forces;
}

double strength_used(const LinerSection &section, bool is_cracked, double length, const LinerForces &forces) {
  const double t = section.thickness;
  const double tensile = tensile_strength(section, is_cracked);
  const double end = end_moment(length, forces);
  const double stretched = is_cracked ? share_of(forces.axial, tensile * t)
                                      : share_of(forces.axial * t + 6.0 * end, tensile * t * t);
  return std::max({share_of(-forces.axial, section.compressive_strength * t), stretched,
                   share_of(end, plastic_moment(section, tensile, forces.axial)),
                   share_of(std::abs(forces.shear), section.shear_limit),
                   share_of(pull_on_bond(section, forces), section.bond_limit)});
}

} // namespace gcpdda
