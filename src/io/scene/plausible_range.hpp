#pragma once

// What quantities of a scene have in rock, soil, concrete, steel or masonry, and the units that are mistaken
// for theirs.

#include <numbers>
#include <string_view>
#include <vector>

namespace gcpdda {

/// A unit that people give a quantity in by mistake.
struct UnitSlip {
  double factor = 0.0; ///< from that unit to the one of the key
  std::string_view unit;
};

/// What a quantity of a scene has in rock, soil, concrete, steel or masonry. Zero means that there is none
/// and is always plausible.
struct PlausibleRange {
  std::string_view key; ///< path as in scene_keys.md
  std::string_view unit;
  double low = 0.0;
  double high = 0.0;
  double typical = 0.0;        ///< of two unit slips the one that comes nearer is named first
  std::vector<UnitSlip> slips; ///< none where no unit is mistaken for the right one
  std::string_view what;       ///< "natural and crushed rock ... have"
  std::string_view source;
};

// Shared by several quantities.
inline const std::vector<UnitSlip> of_stress{{1e3, "kPa"}, {1e6, "MPa"}};
inline const std::vector<UnitSlip> of_length{{1e-3, "mm"}, {1e-2, "cm"}};
inline const std::vector<UnitSlip> of_angle{{180.0 / std::numbers::pi, "radians"}};
inline const std::vector<UnitSlip> of_share{{1e-2, "per cent"}};

} // namespace gcpdda
