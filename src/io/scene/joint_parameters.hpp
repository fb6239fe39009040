#pragma once

// The parameters of joint laws: their keys in a scene, how they are judged, what the reference says of them.

#include "gcpdda/model/joint_law.hpp"
#include "io/scene/plausible_range.hpp"
#include "io/scene/scene_keys.hpp"

#include <span>

namespace gcpdda::scene_text {

/// One key of [joint.NAME], or a table that holds such keys.
struct JointParameter {
  Key key;
  double (*value)(
      const JointLaw &);    ///< in the unit of the key, 0 where it has no meaning; null: not a number
  PlausibleRange plausible; ///< its own key stays empty
};

/// All of them, in the order of their description. A law that is added has its rows here, its reading beside
/// them.
std::span<const JointParameter> joint_parameters();

} // namespace gcpdda::scene_text
