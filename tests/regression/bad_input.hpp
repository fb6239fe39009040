#pragma once

#include <string>
#include <vector>

namespace gcpdda::testing {

// clang-format off
inline const std::vector<std::string> good_lines{
    R"([run])",                                                       // 1
    R"(duration = 2.0)",                                              // 2
    R"([material.granite])",                                          // 3
    R"(density = 2600.0)",                                            // 4
    R"([material.clay])",                                             // 5
    R"(density = 1900.0)",                                            // 6
    R"(youngs_modulus = 1e8)",                                        // 7
    R"(poissons_ratio = 0.3)",                                        // 8
    R"([joint.default])",                                             // 9
    R"(normal_stiffness = 1e9)",                                      // 10
    R"([[block]])",                                                   // 11
    R"(name = "floor")",                                              // 12
    R"(material = "granite")",                                        // 13
    R"(vertices = [[0, 0], [9, 0], [9, 1], [0, 1]])",                 // 14
    R"(fixed = true)",                                                // 15
    R"([[block]])",                                                   // 16
    R"(name = "lever")",                                              // 17
    R"(material = "clay")",                                           // 18
    R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]])", // 19
    R"([[wall]])",                                                    // 20
    R"(name = "w")",                                                  // 21
    R"(material = "clay")",                                           // 22
    R"(origin = [10, 0])",                                            // 23
    R"(rows = 4)",                                                    // 24
    R"(columns = 6)",                                                 // 25
    R"(block_size = [0.4, 0.2])",                                     // 26
    R"([[pyramid]])",                                                 // 27
    R"(material = "granite")",                                        // 28
    R"(origin = [20, 0])",                                            // 29
    R"(rows = 5)",                                                    // 30
    R"(block_size = [0.4, 0.2])",                                     // 31
    R"([blocks])",                                                    // 32
    R"(file = "blocks.h5")",                                          // 33
    R"([[monitor]])",                                                 // 34
    R"(block = "w.1.6")",                                             // 35
    R"([[monitor]])",                                                 // 36
    R"(name = "roof")",                                               // 37
    R"(point = [1, 2])",                                              // 38
};
// clang-format on

/// A sound scene with blocks from all sources, blocks.h5 among them, or the same with one line (from 1)
/// replaced.
inline std::string scene_text(std::size_t line = 0, const std::string &replacement = "") {
  std::string text;
  for (std::size_t i = 0; i < good_lines.size(); ++i) {
    text += (i + 1 == line ? replacement : good_lines[i]) + "\n";
  }
  return text;
}

} // namespace gcpdda::testing
