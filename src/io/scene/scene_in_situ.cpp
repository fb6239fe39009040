#include "io/scene/scene_in_situ.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace gcpdda::scene_text {

namespace {

class InSituReader {
public:
  InSituReader(const SceneSource &source, const Scene &scene)
      : source_(source), section_(section(source.root, "in_situ", source.faulty)), scene_(&scene) {}

  InSituStress read() {
    InSituStress stress;
    stress.present = true;
    stress.where = source_.faults.origins().position(section_.source());
    expect_one_stress();
    expect_company();
    const double gravity = norm(scene_->run.gravity);
    const Vec2 down = gravity > 0.0 ? (1.0 / gravity) * scene_->run.gravity : Vec2{0.0, -1.0};
    double vertical = 0.0;
    double k0 = 1.0;
    section_.read("vertical_stress", vertical);
    section_.read("k0", k0);
    stress.at_level = vertical * share_of(down, k0);
    if (has("principal_stresses")) {
      stress.at_level = read_principal();
    }
    if (has("level")) {
      section_.read("level", stress.level);
      stress.down = down;
      stress.growth = (density() * gravity) * share_of(down, k0);
    }
    return stress;
  }

private:
  [[nodiscard]] bool has(const char *key) const { return section_.given(key) != nullptr; }

  void fault(const toml::source_region &where, std::string what, std::string why, std::string hint) {
    source_.faults.add(where, std::move(what), std::move(why), std::move(hint));
  }

  static Mat2 share_of(Vec2 axis, double across) {
    return (1.0 - across) * outer(axis, axis) + across * Mat2::identity();
  }

  Mat2 read_principal() {
    Vec2 values;
    double angle = 0.0;
    section_.read("principal_stresses", values);
    section_.read("principal_angle_deg", angle);
    angle *= std::numbers::pi / 180.0;
    const Vec2 axis{std::cos(angle), std::sin(angle)};
    return (values.x - values.y) * outer(axis, axis) + values.y * Mat2::identity();
  }

  void expect_one_stress() {
    if (has("vertical_stress") && has("principal_stresses")) {
      fault(section_.given("principal_stresses")->source(),
            "[in_situ] gives vertical_stress and principal_stresses",
            "each says all of the stress at the level", "leave one of them out");
    } else if (!has("vertical_stress") && !has("principal_stresses") && !has("level")) {
      fault(section_.source(), "[in_situ] gives no stress",
            "it needs vertical_stress, principal_stresses or level", "for example level = 100.0");
    }
  }

  void expect_company() {
    const auto only_with = [&](const char *key, bool meant, const char *why) {
      if (has(key) && !meant) {
        fault(section_.given(key)->source(), section_.subject(key) + " has no meaning", why, "leave it out");
      }
    };
    only_with("principal_angle_deg", has("principal_stresses"), "it turns principal_stresses");
    only_with("density", has("level"), "the stress grows with depth only below a level");
    only_with("k0", !has("principal_stresses") || has("level"),
              "principal_stresses says both stresses, and without level they do not grow");
    only_with("level", scene_->run.gravity != Vec2{}, "without gravity there is no weight to bear");
    if (has("level") && scene_->run.gravity_ramp > 0.0) {
      const toml::node *ramp = source_.root["run"]["gravity_ramp"].node();
      fault(ramp->source(), "'gravity_ramp' in [run] has no meaning beside 'level' in [in_situ]",
            "the rock is in equilibrium under its whole weight", "leave one of them out");
    }
  }

  double density() {
    double value = 0.0;
    section_.read("density", value);
    if (has("density") || scene_->materials.empty()) {
      return value;
    }
    const auto [lightest, densest] =
        std::minmax_element(scene_->materials.begin(), scene_->materials.end(),
                            [](const Material &a, const Material &b) { return a.density < b.density; });
    if (lightest->density != densest->density) {
      fault(section_.source(), "'density' in [in_situ] is missing", "the materials have different ones",
            fmt::format("that of the rock above, for example density = {}", densest->density));
    }
    return densest->density;
  }

  SceneSource source_;
  Section section_;
  const Scene *scene_;
};

} // namespace

InSituStress read_in_situ(const SceneSource &source, const Scene &scene) {
  return source.root.contains("in_situ") ? InSituReader(source, scene).read() : InSituStress{};
}

} // namespace gcpdda::scene_text
