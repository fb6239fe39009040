#pragma once

// The same problems in engines that others use, each driven as its manual recommends and with finer steps.

#include "gcpdda/geometry/vec2.hpp"

#include <functional>
#include <string>
#include <vector>

namespace gcpdda::study {

struct PeerBody {
  std::vector<Vec2> vertices; ///< convex, counter-clockwise, m
  bool fixed = false;
  Vec2 velocity{};
};

struct PeerScene {
  std::vector<PeerBody> bodies;
  Vec2 gravity{0.0, -9.81};
  double friction = 0.0;
  double restitution = 0.0;
  double density = 2600.0;
  double duration = 1.0; ///< s
};

/// How often a second is cut, and how often the engine's solver goes round in a step.
struct PeerSettings {
  int steps_per_second = 60;
  int velocity_iterations = 8;
  int position_iterations = 3; ///< Box2D only
};

struct PeerState {
  Vec2 moved;         ///< of the body's origin of coordinates, the centroid, m
  double angle = 0.0; ///< rad
  Vec2 velocity;
  double omega = 0.0;
  double mass = 0.0;
  double inertia = 0.0;
};

struct PeerResult {
  std::vector<PeerState> bodies;
  double cpu = 0.0; ///< of stepping, s
};

PeerResult run_box2d(const PeerScene &scene, const PeerSettings &settings);
PeerResult run_chipmunk(const PeerScene &scene, const PeerSettings &settings);

struct Peer {
  std::string name;
  std::function<PeerResult(const PeerScene &, const PeerSettings &)> run;
};
/// Those that were found when this was built; says on stdout which were not.
std::vector<Peer> peers();

} // namespace gcpdda::study
