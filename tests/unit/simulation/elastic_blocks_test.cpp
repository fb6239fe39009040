// Blocks that deform need Young's modulus and Poisson's ratio, also where the program chooses what deforms.

#include "simulation/simulation.hpp"

#include "support/scenes.hpp"
#include "support/setting.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gcpdda::testing::elastic_blocks_test {
namespace {

const std::string modulus_alone = R"([run]
duration = 0.1
[material.rock]
density = 2600.0
youngs_modulus = 1e9
[joint.default]
normal_stiffness = 1e10
friction_angle_deg = 30
)" + block_toml("floor", rectangle({-1.0, -1.0}, {2.0, 0.0}), "fixed = true") +
                                  block_toml("cube", rectangle({0.0, 0.0}, {1.0, 1.0}));

/// Errors of the set-up of a run.
std::vector<std::string> errors_of(const std::string &toml, const std::vector<std::string> &sets = {}) {
  std::vector<std::string> texts;
  try {
    const Simulation simulation(Communicator::world(), scene_of(toml, sets));
  } catch (const SceneError &error) {
    for (const Diagnostic &diagnostic : error.diagnostics()) {
      if (diagnostic.severity == Severity::error) {
        texts.push_back(to_string(diagnostic));
      }
    }
  }
  return texts;
}

using Strings = std::vector<std::string>;

const std::string without_ratio = "error: block 'cube' is deformable but its material 'rock' has no "
                                  "poissons_ratio, a deformable block has its "
                                  "stiffness from both, for example poissons_ratio = 0.25 in [material.rock]";

TEST(ElasticBlocks, NeedPoissonsRatioWhereTheProgramLetsThemDeform) {
  EXPECT_EQ(errors_of(modulus_alone), Strings{"test.toml:5:18: " + without_ratio});
  std::string without_modulus = modulus_alone;
  without_modulus.erase(without_modulus.find("youngs_modulus"), std::string("youngs_modulus = 1e9\n").size());
  EXPECT_EQ(errors_of(without_modulus), Strings{});
  EXPECT_EQ(errors_of(without_modulus, {"material.rock.youngs_modulus=1e9"}),
            Strings{"--set material.rock.youngs_modulus=1e9: " + without_ratio});
}

TEST(ElasticBlocks, NeedNoRatioWhereTheyAreRigid) {
  EXPECT_EQ(errors_of(modulus_alone, {"run.fidelity=rigid"}), Strings{});
  EXPECT_EQ(errors_of(modulus_alone, {"material.rock.youngs_modulus=1e14"}), Strings{});
  EXPECT_EQ(errors_of(modulus_alone, {"block.cube.fixed=true"}), Strings{});
  EXPECT_EQ(errors_of(modulus_alone, {"material.rock.poissons_ratio=0"}), Strings{});
}

TEST(ElasticBlocks, NeedARatioBeforeAStageSetsThemFree) {
  const std::string stages =
      "[[stage]]\nkind = \"run\"\nduration = 0.1\n"
      "[[stage]]\nkind = \"run\"\nduration = 0.1\nset = { \"block.cube.fixed\" = false }\n";
  EXPECT_EQ(errors_of(without_duration(modulus_alone) + stages, {"block.cube.fixed=true"}),
            Strings{"test.toml:5:18: " + without_ratio});
}

} // namespace
} // namespace gcpdda::testing::elastic_blocks_test
