#include "peers.hpp"

#include "../study.hpp"
#include "geometry/polygon.hpp"

#include <chipmunk/chipmunk.h>

#include <memory>

namespace gcpdda::study {

PeerResult run_chipmunk(const PeerScene &scene, const PeerSettings &settings) {
  const std::unique_ptr<cpSpace, void (*)(cpSpace *)> space(cpSpaceNew(), cpSpaceFree);
  cpSpaceSetGravity(space.get(), cpv(scene.gravity.x, scene.gravity.y));
  cpSpaceSetIterations(space.get(), settings.velocity_iterations);
  cpSpaceSetCollisionSlop(space.get(), 0.005); // m: the manual's 0.1 is meant for pixels
  std::vector<std::unique_ptr<cpShape, void (*)(cpShape *)>> shapes;
  std::vector<std::unique_ptr<cpBody, void (*)(cpBody *)>> bodies;
  std::vector<Vec2> start;
  for (const PeerBody &body : scene.bodies) {
    start.push_back(polygon_moments(body.vertices).centroid);
    std::vector<cpVect> points;
    for (const Vec2 v : body.vertices) {
      points.push_back(cpv(v.x - start.back().x, v.y - start.back().y));
    }
    const auto count = static_cast<int>(points.size());
    const double mass = scene.density * cpAreaForPoly(count, points.data(), 0.0);
    const double inertia = cpMomentForPoly(mass, count, points.data(), cpvzero, 0.0);
    bodies.emplace_back(body.fixed ? cpBodyNewStatic() : cpBodyNew(mass, inertia), cpBodyFree);
    cpBody *made = cpSpaceAddBody(space.get(), bodies.back().get());
    cpBodySetPosition(made, cpv(start.back().x, start.back().y));
    cpBodySetVelocity(made, cpv(body.velocity.x, body.velocity.y));
    shapes.emplace_back(cpPolyShapeNewRaw(made, count, points.data(), 0.0), cpShapeFree);
    cpShape *shape = cpSpaceAddShape(space.get(), shapes.back().get());
    cpShapeSetFriction(shape, std::sqrt(scene.friction));      // the engine multiplies the two bodies' own
    cpShapeSetElasticity(shape, std::sqrt(scene.restitution)); // the same
  }
  const auto steps = static_cast<int>(scene.duration * settings.steps_per_second + 0.5);
  const double begin = cpu_seconds();
  for (int k = 0; k < steps; ++k) {
    cpSpaceStep(space.get(), scene.duration / steps);
  }
  PeerResult result{.bodies = {}, .cpu = cpu_seconds() - begin};
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const cpBody *body = bodies[i].get();
    const cpVect position = cpBodyGetPosition(body);
    const cpVect velocity = cpBodyGetVelocity(body);
    result.bodies.push_back({Vec2{position.x, position.y} - start[i],
                             cpBodyGetAngle(body),
                             {velocity.x, velocity.y},
                             cpBodyGetAngularVelocity(body),
                             cpBodyGetMass(body),
                             cpBodyGetMoment(body)});
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    cpSpaceRemoveShape(space.get(), shapes[i].get());
    cpSpaceRemoveBody(space.get(), bodies[i].get());
  }
  return result;
}

} // namespace gcpdda::study
