#pragma once

// Pairs of blocks that touch in a given way, for tests of what a contact does near one state.

#include "model/block_system.hpp"
#include "shapes.hpp"

#include <array>
#include <string>

namespace gcpdda::testing {

/// How two blocks touch.
enum class Touch {
  face_on_face,
  corner_in_face,
  corner_on_corner,
  teeth_on_face,
  teeth_on_teeth,
  in_a_notch
};

struct TouchingPair {
  std::vector<Vec2> lower;
  std::vector<Vec2> higher;
  int num_regions = 1;
};

/// Two blocks of about 1 m, the lower one below y = 0, the higher one sunk into it by `depth`, which part of
/// a flush joint varies by up to `tilt` of it.
inline TouchingPair touching_pair(std::mt19937 &engine, Touch touch, double depth, double tilt = 0.6) {
  const auto random = [&](double low, double high) { return uniform(engine, low, high); };
  const double slope = 2.0 * tilt * depth * random(-1.0, 1.0);
  const auto on = [&](double x) { return -depth + slope * x; }; // lower face of the higher block
  const auto slab = [&](double low, double high) {
    return std::vector<Vec2>{{low, on(low)},
                             {high, on(high)},
                             {high - random(0.0, 0.2), random(0.5, 0.9)},
                             {low + random(0.0, 0.2), random(0.5, 0.9)}};
  };
  std::vector<Vec2> lower{{-random(0.4, 0.6), -random(0.5, 0.9)},
                          {random(0.4, 0.6), -random(0.5, 0.9)},
                          {random(0.42, 0.7), 0.0},
                          {-random(0.42, 0.7), 0.0}};
  const auto teeth = [&](int count, double base, const auto &tip) { // from right to left
    std::vector<Vec2> outline{{-0.55, base}, {0.55, base}};
    for (int k = count - 1; k >= 0; --k) {
      const double middle = 1.1 * (k + 0.5) / count - 0.55;
      const double half = 0.35 / count * random(0.7, 1.0);
      const double valley = 0.5 * base;
      outline.push_back({k == count - 1 ? 0.55 : middle + half + 0.05 / count, valley});
      outline.push_back({middle + half, tip(middle + half)});
      outline.push_back({middle - half, tip(middle - half)});
      outline.push_back({k == 0 ? -0.55 : middle - half - 0.05 / count, valley});
    }
    return outline;
  };
  const auto flat = [](double) { return 0.0; };
  switch (touch) {
  case Touch::face_on_face:
    return {lower, slab(-random(0.3, 0.6), random(0.3, 0.6))};
  case Touch::corner_in_face: {
    const double x = random(-0.2, 0.2);
    return {lower,
            {{x, -depth},
             {x + random(0.3, 0.6), random(0.2, 0.6)},
             {x, random(0.8, 1.0)},
             {x - random(0.3, 0.6), random(0.2, 0.6)}}};
  }
  case Touch::corner_on_corner: {
    const double x = depth * random(-0.3, 0.3);
    return {{{-random(0.3, 0.6), -random(0.2, 0.6)},
             {0.0, -random(0.8, 1.0)},
             {random(0.3, 0.6), -random(0.2, 0.6)},
             {0.0, 0.0}},
            {{x, -depth},
             {random(0.3, 0.6), random(0.2, 0.6)},
             {0.0, random(0.8, 1.0)},
             {-random(0.3, 0.6), random(0.2, 0.6)}}};
  }
  case Touch::teeth_on_face: {
    const int count = 2 + static_cast<int>(engine() % 2);
    return {teeth(count, -0.6, flat), slab(-0.6, 0.6), count};
  }
  case Touch::teeth_on_teeth: {
    const int count = 1 + static_cast<int>(engine() % 3);
    std::vector<Vec2> higher = teeth(count, -0.6, [&](double x) { return -on(x); });
    for (Vec2 &v : higher) {
      v.y = -v.y;
    }
    return {teeth(count, -0.6, flat), {higher.rbegin(), higher.rend()}, count};
  }
  case Touch::in_a_notch:
    break;
  }
  const double side = depth * random(0.5, 1.5);
  return {
      {{-0.6, -0.5}, {0.5, -0.5}, {0.5, 0.6}, {0.0, 0.6}, {0.0, 0.0}, {-0.6, 0.0}},
      {{-random(0.4, 0.6), on(-0.5)}, {side, on(0.0)}, {side + slope * 0.5, 0.5}, {-0.4, random(0.4, 0.6)}},
      2};
}

/// Rows of mobile blocks that have the shapes given, at any angle; deformable ones are stretched and turned
/// by up to `strain` and 1 rad from the reference shapes that these follow from.
inline BlockSystem strained_blocks(std::mt19937 &engine, const std::vector<std::vector<Vec2>> &shapes,
                                   const std::vector<bool> &deforms, double youngs_modulus,
                                   double strain = 0.03) {
  BlockSystem system;
  const Rotation turn = Rotation::of(uniform(engine, -3.0, 3.0));
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    SceneBlock block;
    for (const Vec2 v : shapes[k]) {
      block.vertices.push_back(turn(v));
    }
    Mat2 gradient = Mat2::identity();
    if (deforms[k]) {
      const Rotation own = Rotation::of(uniform(engine, -1.0, 1.0));
      const double shear = strain * uniform(engine, -1.0, 1.0);
      gradient = Mat2{own.c, -own.s, own.s, own.c} * Mat2{1.0 + strain * uniform(engine, -1.0, 1.0), shear,
                                                          shear, 1.0 + strain * uniform(engine, -1.0, 1.0)};
      const Vec2 centre = polygon_moments(block.vertices).centroid;
      for (Vec2 &v : block.vertices) {
        v = centre + inverse(gradient)(v - centre);
      }
    }
    Material rock;
    rock.density = 2600.0;
    rock.youngs_modulus = youngs_modulus;
    rock.poissons_ratio = 0.25;
    append_block(system, BlockId{static_cast<std::int64_t>(k)}, block, rock,
                 deforms[k] ? BlockKind::deformable : BlockKind::rigid);
    if (deforms[k]) {
      system.deformation_of(k).trial = gradient;
    }
  }
  system.num_owned = shapes.size();
  pose(system, 0, system.num_rows());
  return system;
}

} // namespace gcpdda::testing
