#include "simulation/link_springs.hpp"

namespace gcpdda {

void append_springs(const BlockSystem &system, const BoltLink &link, const std::array<std::size_t, 2> &rows,
                    const LinkLaw &law, double share, std::vector<statics::ContactSpring> &springs) {
  const std::array<Vec2, 2> ends{trial_position(system, rows[0], link.end[0].point),
                                 trial_position(system, rows[1], link.end[1].point)};
  const LinkPose pose = pose_of(system, link, rows);
  const auto spring_along = [&](Vec2 direction, const std::array<Vec2, 2> &points, double stiffness,
                                bool gives) {
    statics::ContactSpring spring;
    spring.lower = static_cast<std::uint32_t>(rows[0]);
    spring.higher = static_cast<std::uint32_t>(rows[1]);
    spring.normal = -1.0 * perp(direction);
    spring.lower_arm = points[0] - system.motion[rows[0]].centroid;
    spring.higher_arm = points[1] - system.motion[rows[1]].centroid;
    spring.sticking = stiffness;
    spring.tangential = gives ? share * stiffness : stiffness;
    return spring;
  };
  springs.push_back(spring_along(pose.axis, ends, law.axial_stiffness, link.memory.axial_gives));
  springs.back().bending = law.bending_stiffness;
  if (law.shear_stiffness > 0.0) {
    const Vec2 middle = 0.5 * (ends[0] + ends[1]);
    springs.push_back(
        spring_along(pose.tangent, {middle, middle}, law.shear_stiffness, link.memory.shear_gives));
  }
}

} // namespace gcpdda
