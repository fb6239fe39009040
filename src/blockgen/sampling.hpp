#pragma once

// Spacings, lengths and dips of joints, drawn at random.

#include "gcpdda/model/rock_region.hpp"
#include "model/draw.hpp"

namespace gcpdda::blockgen {

/// A length: within [lowest_share, highest_share] of its mean, drawn again until it is.
double sample_length(const Scattered &length, Draw draw);

/// The angle of the trace of one plane of a set in space, rad. Its pole is drawn about the mean pole by
/// Fisher's distribution, and again with the probability that such a plane misses the section: planes meet a
/// section in proportion to the part of their pole that lies in it.
double sample_trace_angle(const JointPlane &plane, Draw draw);

/// An angle, rad. Fisher: angle a between two directions with density ~ sin(a) exp(k cos(a)), inverse of its
/// distribution in closed form (doi:10.1098/rspa.1953.0064), to either side alike.
double sample_angle(const Scattered &angle, Draw draw);

} // namespace gcpdda::blockgen
