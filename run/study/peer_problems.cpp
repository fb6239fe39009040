// The problems of the accuracy chart that engines for rigid bodies can compute.

#include "accuracy_problems.hpp"
#include "model/generators.hpp"
#include "peers/peers.hpp"
#include "support/incline.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iostream>

namespace gcpdda::study {

using namespace testing;

namespace {

struct PeerProblem {
  std::string name;
  PeerScene scene;
  std::function<double(const PeerResult &)> error;
};

double kinetic_energy(const PeerState &body) {
  return 0.5 * (body.mass * dot(body.velocity, body.velocity) + body.inertia * body.omega * body.omega);
}

PeerProblem slide() {
  const Incline incline;
  PeerScene scene{.bodies = {{incline.plane(), true}, {incline.flat_square(0.0)}},
                  .friction = std::tan(incline.friction_deg * degree),
                  .duration = 2.0};
  return {"incline", std::move(scene), [incline](const PeerResult &result) {
            return std::abs(dot(result.bodies[1].moved, incline.downhill()) / (2.0 * incline.acceleration()) -
                            1.0);
          }};
}

PeerProblem collide() {
  PeerScene scene{.bodies = {{rectangle({-1.0, 0.0}, {0.0, 1.0}), false, {1.0, 0.2}},
                             {rectangle({0.05, 0.5}, {1.05, 1.5}), false, {-1.0, 0.0}}},
                  .gravity = {},
                  .restitution = 1.0,
                  .duration = 0.4};
  return {"oblique_impact", std::move(scene), [](const PeerResult &result) {
            const double before = 0.5 * result.bodies[0].mass * (1.0 + 0.04 + 1.0);
            const double after = kinetic_energy(result.bodies[0]) + kinetic_energy(result.bodies[1]);
            return std::abs(after / before - 1.0);
          }};
}

PeerProblem topple() {
  constexpr double start = 5.0 * degree;
  const double turn = -(std::atan2(0.5, 1.0) + start);
  PeerScene scene{.bodies = {{rectangle({-5.0, -2.0}, {5.0, 0.0}), true},
                             {placed(rectangle({-0.5, 0.0}, {0.0, 1.0}), turn, {})}},
                  .friction = std::tan(60.0 * degree),
                  .duration = 0.8};
  return {"toppling_block", std::move(scene), [](const PeerResult &result) {
            const double exact = toppling_angle(0.5, 1.0, start, 0.8) - start;
            return std::abs(-result.bodies[1].angle / exact - 1.0);
          }};
}

PeerProblem pile(const std::string &name, const BrickGenerator &bricks, std::int64_t top, double height) {
  PeerScene scene{
      .bodies = {{rectangle({-20.0, -2.0}, {40.0, 0.0}), true}}, .friction = 0.6, .duration = 2.0};
  for (std::int64_t i = 0; i < num_blocks(bricks); ++i) {
    scene.bodies.push_back({make_block(bricks, i).vertices});
  }
  return {name, std::move(scene), [=](const PeerResult &result) {
            return norm(result.bodies[static_cast<std::size_t>(top)].moved) / height;
          }};
}

} // namespace

std::vector<Peer> peers() {
  std::vector<Peer> found;
#ifdef GCPDDA_HAS_BOX2D
  found.push_back({"Box2D", run_box2d});
#else
  std::cout << "Box2D (libbox2d-dev) is not installed: left out\n";
#endif
#ifdef GCPDDA_HAS_CHIPMUNK
  found.push_back({"Chipmunk", run_chipmunk});
#else
  std::cout << "Chipmunk (libchipmunk-dev) is not installed: left out\n";
#endif
  return found;
}

// Where none is installed the table of an earlier study stays as it is.
void compare_with_peers(const Options &options) {
  const std::vector<Peer> installed = peers();
  if (installed.empty()) {
    return;
  }
  const PileSizes sizes = pile_sizes(options.quick);
  BrickGenerator wall;
  wall.rows = sizes.wall_rows;
  wall.columns = sizes.wall_columns;
  wall.block_size = {1.0, 0.5};
  BrickGenerator pyramid;
  pyramid.kind = BrickGenerator::Kind::pyramid;
  pyramid.rows = sizes.pyramid_rows;
  pyramid.block_size = {1.0, 1.0};
  const std::vector<PeerProblem> problems{
      slide(), collide(), topple(), pile("wall", wall, sizes.top_of_wall(), 0.5 * sizes.wall_rows),
      pile("pyramid", pyramid, sizes.top_of_pyramid(), sizes.pyramid_rows)};
  std::vector<PeerSettings> settings{{60, 8, 3}, {960, 8, 3}};
  if (!options.quick) {
    settings = {{60, 8, 3}, {60, 50, 20}, {120, 8, 3}, {240, 8, 3}, {960, 8, 3}, {3840, 8, 3}};
  }
  Table table(options.folder / "peers.csv",
              {"problem", "compared", "factor", "value", "safety", "time_step", "normal_stiffness", "error",
               "cpu_s", "evaluations", "contact_steps", "steps", "on_front"});
  for (const Peer &peer : installed) {
    for (const auto &[name, scene, error] : problems) {
      for (const PeerSettings &s : settings) {
        std::vector<double> times;
        PeerResult result;
        for (int k = 0; k < (options.quick || result.cpu > 0.2 ? 1 : 5); ++k) {
          result = peer.run(scene, s);
          times.push_back(result.cpu);
        }
        const std::int64_t none = 0;
        table.add({name, std::string("as ours"), peer.name,
                   fmt::format("{} iterations", s.velocity_iterations), 1.0, 1.0 / s.steps_per_second, 0.0,
                   error(result), median(times), none, none,
                   static_cast<std::int64_t>(scene.duration * s.steps_per_second + 0.5), none});
      }
    }
  }
}

} // namespace gcpdda::study
