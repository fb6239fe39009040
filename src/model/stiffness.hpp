#pragma once

// Joint stiffness from an allowed overlap, and sizes of a model that it follows from.

#include "gcpdda/model/scene.hpp"

#include <limits>
#include <span>
#include <vector>

namespace gcpdda {

/// What the stiffness of an allowed overlap follows from; surveys of several lists of blocks combine by
/// largest, smallest and concatenation.
struct SizeSurvey {
  double densest = 0.0;                                 ///< kg/m3
  double low = std::numeric_limits<double>::infinity(); ///< extent along gravity, m
  double high = -std::numeric_limits<double>::infinity();
  std::vector<double> sizes;  ///< sqrt(area) of each block, m
  std::vector<double> widths; ///< narrowest, m
};

/// Over the blocks that are fixed, or over those that are not.
SizeSurvey survey_sizes(const Scene &scene, std::span<const SceneBlock> blocks, bool fixed);

/// Put a number into every law that was given as an allowed overlap e:
///
///     k_n = rho g h / (e L)                                             [src/README.md, 27]
///
/// rho the densest material in use, g = |gravity|, h the extent of the mobile blocks along gravity, L the
/// median of their sqrt(area). The extent is a pressure head: the deepest joint then closes by about e.
/// Where the scene has an in-situ stress, its largest compression at that extent stands for rho g h if it is
/// more. Without mobile blocks the fixed ones stand in (nothing can touch, any positive number does).
///
/// @param median_size  of the surveyed blocks, the (n/2)-th in ascending order from 0, m
void resolve_stiffness(Scene &scene, const SizeSurvey &survey, double median_size);

/// How far the top of a pile of the surveyed blocks may come down when it takes up its weight, m. A column of
/// n = h/b layers of height b has n joints, which bear the weight of 1, 2 ... n layers and close together by
/// rho g b n (n + 1)/(2 k_n); its rock bears rho g h/2 in the mean. Gravity that acts at once lets an
/// undamped column swing twice as far as the place where it rests:
///
///     rho g h ((h + b)/(k_n b) + h/E),
///
/// with the softest joints and the softest rock. 0 without gravity. Every joint has its stiffness by now.
/// @param median_width  b, of the surveyed blocks, m
double largest_sag(const Scene &scene, const SizeSurvey &survey, double median_width);

/// How deep a right-angled corner of a rigid block sinks into a flat face under a load (N/m) along the face's
/// normal, m. Let its two edges stand at the angles a = tilt and 90 degrees - a to the face, and let it be h
/// deep: the face is cut over the width w = h (cot a + tan a) = 2 h/sin 2a. On both edges the pressure is
/// (k_n/2) times the depth, (k_n/2) h w/2 over the width; on the face it is (k_n/2) times the distance to the
/// nearer edge, which rises from both ends to w sin a cos a/(sin a + cos a) = h/(sin a + cos a). Together
///
///     load = (k_n h^2/2) (1 + 1/(sin a + cos a))/sin 2a,
///
/// at 45 degrees k_n h^2 (1 + 1/sqrt(2))/2, where it sinks deepest: 1.08 sqrt(load/k_n). A flush joint of
/// length l closes by load/(k_n l), which is less wherever that is thin against l.
/// @param tilt  rad, between 0 and a right angle
double corner_sinking(double load, double normal_stiffness, double tilt);

} // namespace gcpdda
