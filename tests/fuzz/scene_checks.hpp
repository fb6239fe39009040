#pragma once

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/model/scene.hpp"
#include "geometry/polygon.hpp"
#include "require.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace gcpdda::fuzz {

/// One line that says something.
inline void check_message(const Diagnostic &d) {
  require(!d.what.empty(), "a message says what is wrong");
  const std::string text = to_string(d);
  require(std::none_of(text.begin(), text.end(),
                       [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }),
          "a message is one line", text);
}

inline void check_block(const SceneBlock &block, std::size_t num_materials) {
  const auto sound = [](double x) { return std::abs(x) <= 1e9; };
  require(block.material >= 0 && static_cast<std::size_t>(block.material) < num_materials,
          "a block has a material", block.name);
  require(block.vertices.size() >= 3, "a block has three vertices", block.name);
  require(std::all_of(block.vertices.begin(), block.vertices.end(),
                      [&](Vec2 p) { return sound(p.x) && sound(p.y); }),
          "vertices are finite", block.name);
  require(signed_area(block.vertices) > 0.0, "an outline goes round counter-clockwise", block.name);
  require(std::all_of(block.velocity.begin(), block.velocity.end(), sound), "velocities are finite",
          block.name);
  require(!block.fixed ||
              std::all_of(block.velocity.begin(), block.velocity.end(), [](double v) { return v == 0.0; }),
          "a fixed block does not move", block.name);
}

} // namespace gcpdda::fuzz
