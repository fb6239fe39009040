#pragma once

// Tables [[block]] of a scene.

#include "io/scene/scene_materials.hpp"

#include <map>
#include <string>
#include <vector>

namespace gcpdda::scene_text {

/// Names of blocks, walls and pyramids: each is given once.
class Names {
public:
  explicit Names(Faults &faults) : faults_(&faults) {}
  /// @param label  "block 'slider'"
  void add(const Section &section, const std::string &label, const std::string &name);

private:
  struct First {
    std::string label;
    toml::source_region where;
  };
  Faults *faults_;
  std::map<std::string, First> first_of_name_;
};

/// One SceneBlock per [[block]]; the faulty ones lack their faulty parts.
std::vector<SceneBlock> read_blocks(const SceneSource &source, Materials &materials, Names &names,
                                    Fidelity of_run, const JointLaws &joints);

} // namespace gcpdda::scene_text
