
#include "contact/contact_sums.hpp"

namespace gcpdda {

ContactPart contact_part(const RegionForce &force, bool is_lower, Vec2 centroid) {
  const double sign = is_lower ? 1.0 : -1.0;
  return {sign * force.force, sign * (force.dyad + outer(force.origin - centroid, force.force))};
}

BlockGradientSum in_reference_axes(const BlockGradientSum &sum, const Mat2 &to_reference) {
  const auto work_on_gradient = [&](const Mat2 &dyad) { return transposed(to_reference * dyad); };
  return {work_on_gradient(sum.force), work_on_gradient(sum.shear), work_on_gradient(sum.damping)};
}

} // namespace gcpdda
