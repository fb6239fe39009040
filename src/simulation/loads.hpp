#pragma once

// Forces and motions that a scene prescribes and that change in the course of time: gravity and its ramp,
// point loads and the stress on sides of the region (model/load_course.hpp), the ground, driven blocks.
//
// A material load names its course by a number; course 0 is the constant one. The list of courses is made
// from the scene and the times at which its stages began, the same on every rank, and stands in no
// checkpoint: a restart makes it again. First come those of the stress on sides, where a stage changes it: an
// edge on such a side has the forces of every stress that it will be under from the start on, and the course
// of each says when it acts. Those of point loads follow. A row's point loads stand before those of its
// sides, in the order of SceneBlock::loads.

#include "dynamics/ground_motion.hpp"
#include "dynamics/integrate.hpp"
#include "gcpdda/model/scene.hpp"
#include "model/block_system.hpp"
#include "model/generators.hpp"
#include "simulation/stages.hpp"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace gcpdda {

class Loads {
public:
  /// Motion of every block that has a velocity table, by ascending id: all ranks know them all.
  std::vector<std::pair<BlockId, PrescribedMotion>> prescribed;
  GroundMotion ground;
  double time = 0.0; ///< when loads were last evaluated, s

  Loads() = default;
  explicit Loads(const Scene &scene);

  /// Courses of the start; point loads of the scene get their numbers.
  void list_courses(Scene &scene, std::span<const Stage> stages);
  /// What a load of a row was in the last evaluation, N per metre.
  [[nodiscard]] Vec2 force_of(const MaterialLoad &load) const;
  [[nodiscard]] Vec2 gravity(const RunSettings &run) const;
  /// The stress on sides as point loads of the blocks that have edges there.
  void load_sides(std::span<SceneBlock> slab) const;
  /// The next stress on sides comes in, those before go.
  void change_side_stress(const Rise &change);
  /// What acts on a block once a stage has changed its loads.
  ///
  /// @param acting  before; numbered
  /// @param listed  in the scene of the stage
  std::vector<PointLoad> after(std::vector<PointLoad> acting, std::vector<PointLoad> listed,
                               const Rise &change);
  /// When the forces on sides, and on blocks that are still there, are what they stay, s; infinite where that
  /// is never, and at least now.
  /// @param now  s
  [[nodiscard]] double end_of_changes(const Scene &scene, const StageState &stage, double now) const;
  /// A block that is still there with a load whose table rises and falls between now and its end, one that is
  /// greatest when it comes in among them: who looks at its last value alone misses an extreme. -1: none.
  /// @param now  s
  [[nodiscard]] std::int64_t find_pulse(const Scene &scene, const StageState &stage, double now) const;

private:
  std::int64_t new_course(LoadCourse course);

  std::vector<LoadCourse> courses_;         ///< what loads are multiplied by; 0: the constant one
  std::vector<InSituStress> side_stresses_; ///< on sides of the region: at the start, then those of stages
};

/// True where both lists hold the same loads; the numbers of their courses are not compared.
bool same_loads(const std::vector<PointLoad> &a, const std::vector<PointLoad> &b);
/// A row's loads become those of its block in a later stage.
void adopt_loads(BlockSystem &blocks, std::size_t row, const std::vector<PointLoad> &before,
                 const std::vector<PointLoad> &after);

} // namespace gcpdda
