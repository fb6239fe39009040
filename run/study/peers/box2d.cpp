#include "peers.hpp"

#include "../study.hpp"
#include "geometry/polygon.hpp"

#include <box2d/box2d.h>

namespace gcpdda::study {

namespace {

b2Vec2 to_peer(Vec2 v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y)};
}

} // namespace

PeerResult run_box2d(const PeerScene &scene, const PeerSettings &settings) {
  b2World world(to_peer(scene.gravity));
  world.SetAllowSleeping(false);
  std::vector<b2Body *> bodies;
  std::vector<Vec2> start;
  for (const PeerBody &body : scene.bodies) {
    start.push_back(polygon_moments(body.vertices).centroid);
    b2BodyDef definition;
    definition.type = body.fixed ? b2_staticBody : b2_dynamicBody;
    definition.position = to_peer(start.back());
    definition.linearVelocity = to_peer(body.velocity);
    std::vector<b2Vec2> points;
    for (const Vec2 v : body.vertices) {
      points.push_back(to_peer(v - start.back()));
    }
    b2PolygonShape shape;
    shape.Set(points.data(), static_cast<int32>(points.size()));
    b2FixtureDef fixture;
    fixture.shape = &shape;
    fixture.density = static_cast<float>(scene.density);
    fixture.friction = static_cast<float>(scene.friction);
    fixture.restitution = static_cast<float>(scene.restitution);
    fixture.restitutionThreshold = 0.0F;
    bodies.push_back(world.CreateBody(&definition));
    bodies.back()->CreateFixture(&fixture);
  }
  const auto steps = static_cast<int>(scene.duration * settings.steps_per_second + 0.5);
  const auto dt = static_cast<float>(scene.duration / steps);
  const double begin = cpu_seconds();
  for (int k = 0; k < steps; ++k) {
    world.Step(dt, settings.velocity_iterations, settings.position_iterations);
  }
  PeerResult result{.bodies = {}, .cpu = cpu_seconds() - begin};
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const b2Body &body = *bodies[i];
    const Vec2 position{body.GetPosition().x, body.GetPosition().y};
    result.bodies.push_back({position - start[i],
                             body.GetAngle(),
                             {body.GetLinearVelocity().x, body.GetLinearVelocity().y},
                             body.GetAngularVelocity(),
                             body.GetMass(),
                             body.GetInertia()});
  }
  return result;
}

} // namespace gcpdda::study
