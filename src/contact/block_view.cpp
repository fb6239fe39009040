#include "contact/block_view.hpp"

namespace gcpdda {

BlockView view_of(const BlockSystem &system, std::size_t row, TrialOutline &outline) {
  outline.find(system, row);
  BlockView view{outline.vertex,
                 outline.normal,
                 outline.length,
                 system.motion[row].box,
                 system.properties[row].is_convex,
                 {},
                 system.properties[row].has_parted_sides};
  if (system.is_deformable(row)) {
    view.frame = {system.motion[row].centroid, system.deformation_of(row).trial,
                  system.trial_inverse[system.deformation_begin[row]],
                  system.of_row(system.reference_vertex, row), system.of_row(system.reference_normal, row)};
  }
  return view;
}

Vec2 reference_point(const BlockSystem &system, std::size_t row, Vec2 x) {
  const Vec2 arm = x - system.motion[row].centroid;
  return system.is_deformable(row) ? system.trial_inverse[system.deformation_begin[row]](arm)
                                   : Rotation::of(-system.trial[row].r)(arm);
}

Vec2 current_point(const BlockSystem &system, std::size_t row, Vec2 x) {
  return system.motion[row].centroid + (system.is_deformable(row) ? system.deformation_of(row).trial(x)
                                                                  : Rotation::of(system.trial[row].r)(x));
}

} // namespace gcpdda
