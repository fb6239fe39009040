#include "dynamics/water_pressure.hpp"

namespace gcpdda {

namespace {

/// int p ds and int p s ds along an edge.
struct PressureIntegral {
  double total = 0.0;
  double along = 0.0;

  /// Of max(0, p), p linear from p0 at s0 to p1 at s1.
  void add(double s0, double p0, double s1, double p1) {
    if (p0 < 0.0 && p1 < 0.0) {
      return;
    }
    const double root = s0 + (s1 - s0) * (p0 / (p0 - p1));
    if (p0 < 0.0) {
      s0 = root;
      p0 = 0.0;
    } else if (p1 < 0.0) {
      s1 = root;
      p1 = 0.0;
    }
    const double length = s1 - s0;
    const double part = 0.5 * length * (p0 + p1);
    total += part;
    along += s0 * part + length * length * (p0 + 2.0 * p1) / 6.0;
  }
};

/// Of an edge from `begin` along `tangent` the stretch from s to `last`.
PressureIntegral pressure_on_stretch(const Water &water, Vec2 begin, Vec2 tangent, double s, double last,
                                     double unit_weight) {
  PressureIntegral sum;
  const auto pressure = [&](double at) {
    const Vec2 x = begin + at * tangent;
    return unit_weight * (water.head(x.x) - x.y);
  };
  double here = pressure(s);
  const std::size_t count = water.phreatic.size();
  for (std::size_t k = 0; k < count && tangent.x != 0.0; ++k) {
    const Vec2 corner = water.phreatic[tangent.x > 0.0 ? k : count - 1 - k];
    const double at_corner = (corner.x - begin.x) / tangent.x;
    if (at_corner > s && at_corner < last) {
      const double there = unit_weight * (corner.y - (begin.y + at_corner * tangent.y));
      sum.add(s, here, at_corner, there);
      s = at_corner;
      here = there;
    }
  }
  sum.add(s, here, last, pressure(last));
  return sum;
}

} // namespace

WaterLoad water_load(const BlockSystem &system, std::size_t row, std::span<const Water> water, double gravity,
                     const RigidDof *from, TrialOutline &outline) {
  WaterLoad load;
  const Vec2 centroid = system.motion[row].centroid;
  const RigidDof back = from != nullptr ? *from - system.trial[row] : RigidDof{};
  const Rotation turn = Rotation::of(back.r);
  outline.find(system, row);
  for (const Water &of : water) {
    if (!of.active) {
      continue;
    }
    for_wet_stretches(system, row, of, [&](std::size_t k, double first, double last) {
      const Vec2 tangent = perp(outline.normal[k]);
      const Vec2 arm = outline.vertex[k] - centroid;
      const double length = outline.length[k];
      const PressureIntegral p =
          from != nullptr ? pressure_on_stretch(of, centroid + back.u + turn(arm), turn(tangent),
                                                first * length, last * length, of.density * gravity)
                          : pressure_on_stretch(of, outline.vertex[k], tangent, first * length, last * length,
                                                of.density * gravity);
      const Vec2 moment = p.total * arm + p.along * tangent;
      load.force += -p.total * outline.normal[k];
      load.dyad += outer(-1.0 * outline.normal[k], moment);
    });
  }
  return load;
}

} // namespace gcpdda
