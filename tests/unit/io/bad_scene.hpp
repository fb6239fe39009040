#pragma once

// A small scene without faults, in which tests replace a line, and what is said of a scene.

#include "unit/scene_texts.hpp"

#include <string>
#include <vector>

namespace gcpdda::testing {

inline const std::vector<std::string> good_lines{
    R"([run])",                                       // 1
    R"(duration = 2.0)",                              // 2
    R"([material.granite])",                          // 3
    R"(density = 2600.0)",                            // 4
    R"([material.clay])",                             // 5
    R"(density = 1900.0)",                            // 6
    R"([joint.default])",                             // 7
    R"(normal_stiffness = 1e9)",                      // 8
    R"([[block]])",                                   // 9
    R"(name = "base")",                               // 10
    R"(material = "granite")",                        // 11
    R"(vertices = [[0, 0], [4, 0], [4, 1], [0, 1]])", // 12
    R"(fixed = true)",                                // 13
    R"([[block]])",                                   // 14
    R"(name = "slider")",                             // 15
    R"(material = "clay")",                           // 16
    R"(vertices = [[1, 1], [2, 1], [2, 2], [1, 2]])", // 17
};

/// The good scene with one line replaced, counted from 1; with line 0 as it is.
inline std::string scene_text(std::size_t line, const std::string &replacement) {
  std::string text;
  for (std::size_t i = 0; i < good_lines.size(); ++i) {
    text += (i + 1 == line ? replacement : good_lines[i]) + "\n";
  }
  return text;
}

/// Faults and warnings as a person reads them, of the scene in s.toml.
inline std::vector<std::string> messages(const std::string &text) {
  return messages(read_scene(text, "s.toml", {}));
}

} // namespace gcpdda::testing
