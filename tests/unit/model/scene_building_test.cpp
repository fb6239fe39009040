#include "gcpdda/model/scene_building.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace gcpdda::scene_building_test {
namespace {

JointLaw law() {
  JointLaw law;
  law.normal_stiffness = 1e9;
  return law;
}

TEST(SceneBuilding, TurnsOutlinesCounterClockwise) {
  Scene scene = make_scene(law(), 1.0);
  EXPECT_EQ(add_material(scene, {"rock", 2600.0}), 0);
  const SceneBlock &block = add_block(scene, "b", {{0, 0}, {0, 1}, {1, 1}, {1, 0}});
  EXPECT_EQ(block.vertices, (std::vector<Vec2>{{1, 0}, {1, 1}, {0, 1}, {0, 0}}));
}

TEST(SceneBuilding, GivesEveryPairOfMaterialsALaw) {
  Scene scene = make_scene(law(), 1.0);
  add_material(scene, {"rock", 2600.0});
  EXPECT_EQ(add_material(scene, {"fill", 1900.0}), 1);
  EXPECT_EQ(scene.joints.between(1, 0), 0);
  EXPECT_EQ(scene.joints.laws[0].name, "default");
}

TEST(SceneBuilding, RefusesWhatCannotBeMeant) {
  EXPECT_THROW(make_scene(JointLaw{}, 1.0), std::invalid_argument); // without a stiffness
  EXPECT_THROW(make_scene(law(), 0.0), std::invalid_argument);
  Scene scene = make_scene(law(), 1.0);
  EXPECT_THROW(add_material(scene, {"air", 0.0}), std::invalid_argument);
  EXPECT_THROW(add_material(scene, {"rubber", 1000.0, 1e6, 0.5}), std::invalid_argument);
  EXPECT_THROW(add_block(scene, "b", {{0, 0}, {1, 0}, {0, 1}}), std::invalid_argument); // no material yet
  add_material(scene, {"rock", 2600.0});
  EXPECT_THROW(add_block(scene, "b", {{0, 0}, {1, 0}}), std::invalid_argument);
  EXPECT_THROW(add_block(scene, "b", {{0, 0}, {1, 1}, {1, 0}, {0, 1}}), std::invalid_argument); // crosses
  EXPECT_THROW(add_block(scene, "b", {{0, 0}, {1, 0}, {0, 1}}, 1), std::invalid_argument);
  EXPECT_TRUE(scene.blocks.empty());
}

} // namespace
} // namespace gcpdda::scene_building_test
