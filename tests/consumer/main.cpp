// A block slides down a plane of 30 degrees with a friction angle of 15 degrees: s = g (sin 30 - tan 15 cos
// 30) t^2/2.

#include <gcpdda/driver/stepwise_run.hpp>
#include <gcpdda/model/scene_building.hpp>
#include <gcpdda/parallel/communicator.hpp>

#include <cmath>
#include <cstdio>
#include <numbers>

int main(int argc, char **argv) {
  const gcpdda::MpiScope mpi(argc, argv);
  const gcpdda::Communicator world = gcpdda::Communicator::world();
  constexpr double degree = std::numbers::pi / 180.0;
  const double slope = 30.0 * degree;
  const gcpdda::Vec2 along{std::cos(slope), -std::sin(slope)};
  const gcpdda::Vec2 up{std::sin(slope), std::cos(slope)};
  const auto box = [&](double from, double to, double low, double high) { // along and across the plane
    return std::vector<gcpdda::Vec2>{from * along + low * up, to * along + low * up, to * along + high * up,
                                     from * along + high * up};
  };

  gcpdda::JointLaw joint;
  joint.normal_stiffness = 1e9;
  joint.tan_friction = std::tan(15.0 * degree);
  gcpdda::Scene scene = gcpdda::make_scene(joint, 1.0);
  gcpdda::add_material(scene, {"rock", 2600.0});
  gcpdda::add_block(scene, "plane", box(-5.0, 25.0, -2.0, 0.0)).fixed = true;
  gcpdda::add_block(scene, "slider", box(0.0, 1.0, 0.0, 1.0));

  gcpdda::StepwiseRun run(world, scene);
  while (!run.is_finished()) {
    run.step();
  }
  for (const gcpdda::FrameRow &block : run.blocks()) {
    if (block.block == 1) { // on one of the ranks
      std::printf("the slider has moved by %.4f m in %.4f s\n", norm(block.displacement), run.time());
    }
  }
}
