#include "gcpdda/model/scene_building.hpp"

#include "geometry/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace gcpdda {

namespace {

void require(bool condition, const std::string &what) {
  if (!condition) {
    throw std::invalid_argument(what);
  }
}

bool is_positive(double value) {
  return std::isfinite(value) && value > 0.0;
}

bool is_at_least_zero(double value) {
  return std::isfinite(value) && value >= 0.0;
}

} // namespace

Scene make_scene(const JointLaw &law, double duration) {
  require(is_positive(duration), "the duration must be positive");
  require(is_positive(law.normal_stiffness) || is_positive(law.allowed_overlap),
          "a joint law needs a positive normal_stiffness or allowed_overlap");
  require(is_positive(law.tangential_ratio), "tangential_ratio must be positive");
  require(is_at_least_zero(law.tan_friction) && is_at_least_zero(law.cohesion),
          "friction and cohesion must not be negative");
  Scene scene;
  scene.run.duration = duration;
  scene.output.interval = duration;
  scene.output.history_interval = duration;
  scene.joints.laws.push_back(law);
  scene.joints.laws.front().name = "default";
  return scene;
}

std::int32_t add_material(Scene &scene, const Material &material) {
  require(is_positive(material.density), "the density must be positive");
  require(is_at_least_zero(material.youngs_modulus), "youngs_modulus must not be negative");
  require(material.poissons_ratio >= 0.0 && material.poissons_ratio < 0.5,
          "poissons_ratio must lie in [0, 0.5)");
  scene.materials.push_back(material);
  const std::size_t count = scene.materials.size();
  scene.joints.num_materials = static_cast<std::int32_t>(count);
  scene.joints.of_material.assign(count * count, 0); // the default law
  return static_cast<std::int32_t>(count - 1);
}

SceneBlock &add_block(Scene &scene, std::string name, std::vector<Vec2> vertices, std::int32_t material) {
  require(vertices.size() >= 3, "block '" + name + "' needs three vertices or more");
  require(material >= 0 && material < scene.joints.num_materials,
          "block '" + name + "' has a material that the scene does not have");
  require(std::all_of(vertices.begin(), vertices.end(),
                      [](Vec2 x) { return std::isfinite(x.x) && std::isfinite(x.y); }) &&
              is_simple(vertices) && signed_area(vertices) != 0.0,
          "the outline of block '" + name + "' crosses itself or has no area");
  if (signed_area(vertices) < 0.0) {
    std::reverse(vertices.begin(), vertices.end());
  }
  SceneBlock block;
  block.name = std::move(name);
  block.material = material;
  block.vertices = std::move(vertices);
  return scene.blocks.emplace_back(std::move(block));
}

} // namespace gcpdda
